// SPDX-License-Identifier: MIT
// Splits a quad into its covered fragments and gives each the differences of its own row and
// column, in texture coordinates and in texels of level 0.
//
// Where: head of the AddressUnit. The model does all in stage 1, then delays. Stalled by
// `downstream`, and then holds still as a whole; takes no quad while CONTROL.enable is 0. Saturated
// derivatives are counted. Source: paper 2.2 (1).
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/latency_probe.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/descriptors.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/packets.h"

namespace deburr::rtl::texture {

class DerivativeUnit final : public Unit {
 public:
  In<spec::texture::Quad> quads_in{"quads_in"};
  Out<DerivativeToken> derivatives_out{"derivatives_out"};

  DerivativeUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
                 ControlRegisters& registers, const Descriptors::Reader& descriptors,
                 LatencyProbe& probe);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter quads{"quads", "quads", "quads taken"};
  Counter fragments{"fragments", "fragments", "covered fragments taken"};
  Counter clamped{"clamped", "fragments", "covered fragments whose coordinates had been clamped"};
  Counter saturated{"saturated", "fragments", "fragments with a derivative beyond U15.16 texels"};
  Counter invalid{"invalid", "fragments", "covered fragments of quads with an invalid descriptor"};

  static Datasheet datasheet();

 private:
  static constexpr int kStages = 3;
  void take(Cycle cycle);
  void split(Cycle cycle, DerivativeToken& out);

  ControlRegisters& registers_;
  Descriptors::Reader descriptors_;
  LatencyProbe& probe_;
  // Registers.
  spec::texture::Quad quad_{};
  unsigned waiting_ = 0;  // U4, covered lanes of quad_ that have not left yet
  Pipe<DerivativeToken, kStages> pipe_;
};

}  // namespace deburr::rtl::texture
