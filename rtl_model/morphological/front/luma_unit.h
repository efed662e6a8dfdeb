// SPDX-License-Identifier: MIT
// Computes the luma of each pixel: 13933 R + 46871 G + 4732 B, U8.16, exact. With edges from colour
// it forwards the three codes. With bypass = masked it adds the mark.
//
// Position  SlotSequencer -> LumaUnit -> EdgeDetector.
// Stalls    downstream
#pragma once

#include <cstddef>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/morphological/common/frame_configuration.h"
#include "rtl_model/morphological/common/tokens.h"

namespace deburr::rtl::morphological {

class LumaUnit final : public Unit {
 public:
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  In<SlotToken> slots_in{"slots_in"};
  Out<LumaToken> lumas_out{"lumas_out"};

  LumaUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
           const spec::morphological::Parameters& parameters)
      : Unit(name, clock), lanes_(static_cast<std::size_t>(built_lanes(parameters))) {}
  Activity tick(Cycle cycle) override;
  void reset() override { pipe_.reset(); }

  static Datasheet datasheet(const spec::morphological::Parameters& parameters = {});

 private:
  const std::size_t lanes_;
  Pipe<LumaToken, spec::morphological::kLumaLatency> pipe_;
};

}  // namespace deburr::rtl::morphological
