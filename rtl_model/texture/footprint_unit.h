// SPDX-License-Identifier: MIT
// Computes the lengths of both sides of a fragment's footprint, orders them, and outputs the
// texture coordinate difference along the longer side.
//
// Position  DerivativeUnit -> FootprintUnit -> Log2Unit.
// Stalls    downstream  The whole unit stalls.
// Accuracy  Every shift truncates. Error relative to the square root: half 0 to +11.9 %, quarter
//           -11.7 to +3.1 %, two_segment -2.8 to +0.8 %, max -29.3 to 0 %, exact none
//           (TextureRtlFootprint.ErrorIsAsDocumented).
// Note      The model computes both stages in the first, then delays. `exact` uses the
//           RootPipeline.
// Source    Paper 1.2, equations 10 and 11.
#pragma once

#include <array>
#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/root_pipeline.h"
#include "rtl_model/texture/tokens.h"
#include "rtl_model/texture/width.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

template <class Width>
class FootprintUnitOf : public Unit {
 public:
  In<typename Width::template Fragments<DerivativeToken>> derivatives_in{"derivatives_in"};
  Out<typename Width::template Fragments<FootprintToken>> footprints_out{"footprints_out"};

  FootprintUnitOf(const sc_core::sc_module_name& name, ClockDomain& clock,
                  spec::texture::FootprintRule rule);
  Activity tick(Cycle cycle) override;
  void reset() override;

  // Length of one side by any rule but `exact`: U15.16 in, U16.16 out. Hardware selects the longer
  // line of `two_segment` in stage 2.
  static std::uint32_t side(spec::texture::FootprintRule rule, std::uint32_t s, std::uint32_t t);

  static Datasheet datasheet(const spec::texture::Parameters& parameters);

 private:
  static constexpr int kStages = 2;
  Activity tick_exact(Cycle cycle);
  [[gnu::always_inline]] void order(const DerivativeToken& in, FootprintToken& out) const;

  spec::texture::FootprintRule rule_;
  Pipe<typename Width::template Fragments<FootprintToken>, kStages> pipe_;
  // One per fragment of a group, in step.
  std::array<RootPipeline, Width::kMost> roots_;
};

class FootprintUnit final : public FootprintUnitOf<Narrow> {
 public:
  using FootprintUnitOf::FootprintUnitOf;
};
namespace wide {
class FootprintUnit final : public FootprintUnitOf<Wide> {
 public:
  using FootprintUnitOf::FootprintUnitOf;
};
}  // namespace wide

}  // namespace deburr::rtl::texture
