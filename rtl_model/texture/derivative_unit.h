// SPDX-License-Identifier: MIT
// Splits a quad into its covered fragments and gives each the differences of its own row and
// column, in texture coordinates and in texels of level 0.
//
// Where: head of the AddressUnit. Latency 1, initiation interval one clock a covered lane (a quad
// without covered lanes: 1); stalled by `downstream`; takes no quad while CONTROL.enable is 0.
// Formats: S7.24 in; S8.24 and U15.16 out, rounded to nearest, saturated at 2^31 - 1 (counted).
// Cost: four 33-bit subtractors, four 33 x 13 bit multipliers, one quad of registers. Source: paper
// 2.2 (1).
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/fragment_probe.h"
#include "rtl_model/texture/parameter_store.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/packets.h"

namespace deburr::rtl::texture {

class DerivativeUnit final : public Unit {
 public:
  In<spec::texture::Quad> quads_in{"quads_in"};
  Out<DerivativeToken> derivatives_out{"derivatives_out"};

  DerivativeUnit(const sc_core::sc_module_name& name, ClockDomain& clock, ParameterStore& store,
                 FragmentProbe& probe);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter quads{"quads", "quads", "quads taken"};
  Counter fragments{"fragments", "fragments", "covered fragments taken"};
  Counter clamped{"clamped", "fragments",
                  "covered fragments whose coordinates were clamped before"};
  Counter saturated{"saturated", "fragments", "fragments with a derivative beyond U15.16 texels"};
  Counter invalid{"invalid", "fragments", "covered fragments of quads with an invalid descriptor"};

 private:
  void emit(Cycle cycle, unsigned lane);

  ParameterStore& store_;
  FragmentProbe& probe_;
  // Registers.
  spec::texture::Quad quad_{};
  unsigned waiting_ = 0;  // U4, covered lanes of quad_ that have not left yet
};

}  // namespace deburr::rtl::texture
