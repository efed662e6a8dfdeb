// SPDX-License-Identifier: MIT
// Splits a quad into its covered fragments and computes for each the coordinate differences along
// its row and column (`derivatives = coarse`: along row 0 and column 0 of the quad), in texture
// coordinates and in texels of level 0.
//
// Position  First unit of the AddressUnit.
// Interval  One covered lane; above width 1 the next ones of a quad, at most `fragments`.
// Stalls    downstream  The whole unit stalls. Takes no quad while CONTROL.enable is 0.
// Note      The model computes everything in stage 1, then delays.
// Source    Paper 2.2 (1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/latency_probe.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/descriptors.h"
#include "rtl_model/texture/tokens.h"
#include "rtl_model/texture/width.h"
#include "spec/texture/packets.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

// The part that does not depend on the width.
class DerivativeUnitBase : public Unit {
 public:
  In<spec::texture::Quad> quads_in{"quads_in"};
  Counter quads{"quads", "quads", "quads taken"};
  Counter fragments{"fragments", "fragments", "covered fragments taken"};
  Counter clamped{"clamped", "fragments",
                  "covered fragments whose coordinates were clamped upstream"};
  Counter saturated{"saturated", "fragments", "fragments with a derivative beyond U15.16 texels"};
  Counter invalid{"invalid", "fragments", "covered fragments of quads with an invalid descriptor"};

 protected:
  using Unit::Unit;
};

template <class Width>
class DerivativeUnitOf : public DerivativeUnitBase {
 public:
  Out<typename Width::template Fragments<DerivativeToken>> derivatives_out{"derivatives_out"};

  DerivativeUnitOf(const sc_core::sc_module_name& name, ClockDomain& clock,
                   ControlRegisters& registers, const Descriptors::Reader& descriptors,
                   LatencyProbe& probe,
                   spec::texture::Derivatives derivatives = spec::texture::Derivatives::kFine,
                   std::int32_t most = 1);
  Activity tick(Cycle cycle) override;
  void reset() override;

  static Datasheet datasheet(const spec::texture::Parameters& parameters = {});

 private:
  static constexpr int kStages = 3;
  [[gnu::always_inline]] void take(Cycle cycle);
  [[gnu::always_inline]] void split(const TextureState& texture, DerivativeToken& out);

  ControlRegisters& registers_;
  Descriptors::Reader descriptors_;
  LatencyProbe& probe_;
  std::size_t most_;  // fragments in a group
  unsigned
      own_;  // mask of a lane: its own row and column with `fine`, row 0 and column 0 with `coarse`
  // Registers.
  spec::texture::Quad quad_{};
  unsigned waiting_ = 0;  // U4, covered lanes of quad_ still to be sent
  Pipe<typename Width::template Fragments<DerivativeToken>, kStages> pipe_;
};

class DerivativeUnit final : public DerivativeUnitOf<Narrow> {
 public:
  using DerivativeUnitOf::DerivativeUnitOf;
};
namespace wide {
class DerivativeUnit final : public DerivativeUnitOf<Wide> {
 public:
  using DerivativeUnitOf::DerivativeUnitOf;
};
}  // namespace wide

}  // namespace deburr::rtl::texture
