// SPDX-License-Identifier: MIT
// The posteriser: registers and one unit that takes one pixel per cycle.
//
//   tones_in -> LevelUnit -> tones_out
//                   └ registers, with one Counter of pixels and one of changes
//
// Latency   1 cycle to the output link. Interval  1 Stalls    downstream
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/engine.h"
#include "rtl_model/fabric/histogram.h"
#include "rtl_model/fabric/unit.h"
#include "spec/posteriser/packets.h"
#include "spec/posteriser/parameters.h"

namespace deburr::rtl::posteriser {

class LevelUnit final : public Unit {
 public:
  In<spec::posteriser::Tone> tones_in{"tones_in"};
  Out<spec::posteriser::Tone> tones_out{"tones_out"};

  LevelUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
            const ControlRegisters& control)
      : Unit(name, clock), control_(control) {}
  Activity tick(Cycle cycle) override;
  void reset() override {}

  Counter pixels{"pixels", "pixels", "pixels delivered"};
  Counter changed{"changed", "pixels", "pixels that the posteriser changed"};

  static Datasheet datasheet();

 private:
  const ControlRegisters& control_;
};

class Posteriser final : public Engine {
 public:
  In<spec::posteriser::Tone> tones_in{"tones_in"};
  Out<spec::posteriser::Tone> tones_out{"tones_out"};

  // Throws ConfigError if a parameter is out of range.
  Posteriser(const sc_core::sc_module_name& name, ClockDomain& clock,
             const spec::posteriser::Parameters& parameters);
  const char* kind() const override { return "deburr_posteriser"; }
  bool idle() const override { return !tones_in.can_pop(clock_.cycle()); }

 private:
  ClockDomain& clock_;

 public:
  LevelUnit levels;
};

}  // namespace deburr::rtl::posteriser
