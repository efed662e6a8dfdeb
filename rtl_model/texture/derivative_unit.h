// SPDX-License-Identifier: MIT
// Splits a quad into its covered fragments and gives each the differences of its own row and
// column, in texture coordinates and in texels of level 0.
//
// Where: head of the AddressUnit. Three stages: 1 the next covered lane, its four differences, and
// the choice of the descriptor; 2 four products of a difference with the texture's width or height;
// 3 magnitude, rounding, saturation of each. The model does all in stage 1, then delays. Latency 3,
// initiation interval one clock a covered lane (a quad without covered lanes: 1); stalled by
// `downstream`, and then holds still as a whole; takes no quad while CONTROL.enable is 0. Made for
// 250 MHz; longest path: 33 x 13 bit multiply. Formats: S7.24 in; S8.24 and U15.16 out, rounded to
// nearest, saturated at 2^31 - 1 (counted). Cost: four 33-bit subtractors, four 33 x 13 bit
// multipliers, four 46-bit adders, registers of a quad and of two fragments. Source: paper 2.2 (1).
#pragma once

#include <cstdint>
#include <systemc>

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
  Counter clamped{"clamped", "fragments",
                  "covered fragments whose coordinates were clamped before"};
  Counter saturated{"saturated", "fragments", "fragments with a derivative beyond U15.16 texels"};
  Counter invalid{"invalid", "fragments", "covered fragments of quads with an invalid descriptor"};

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
