// SPDX-License-Identifier: MIT
// Computes the number of samples, the mip level and the level fraction of a fragment, and selects
// its filter.
//
// Position  Log2Unit -> LevelUnit -> SampleWalker.
// Stalls    downstream  The whole unit stalls.
// Note      The model computes everything in stage 1, then delays. l is rounded once, for the
//           two-level modes.
// Source    Paper 1.3, equations 2, 3 and 12; `any` counts as in Vulkan; level of detail and modes
//           as in OpenGL.
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/descriptors.h"
#include "rtl_model/texture/tokens.h"
#include "rtl_model/texture/width.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

// The part that does not depend on the width.
class LevelUnitBase : public Unit {
 public:
  Counter magnified{"magnified", "fragments", "fragments with a level of detail of at most 0"};
  Counter two_levels{"two_levels", "fragments", "fragments that blend two levels"};

 protected:
  using Unit::Unit;
};

template <class Width>
class LevelUnitOf : public LevelUnitBase {
 public:
  In<typename Width::template Fragments<Log2Token>> logs_in{"logs_in"};
  Out<typename Width::template Fragments<LevelToken>> levels_out{"levels_out"};

  LevelUnitOf(const sc_core::sc_module_name& name, ClockDomain& clock,
              const Descriptors::Reader& descriptors, spec::texture::Axes axes,
              spec::texture::CountRule count, spec::texture::CountCap cap);
  Activity tick(Cycle cycle) override;
  void reset() override { pipe_.reset(); }

  static Datasheet datasheet(const spec::texture::Parameters& parameters = {});

 private:
  static constexpr int kStages = 3;
  void choose(const TextureState& texture, const Log2Token& in, LevelToken& out);
  void minify(const TextureState& texture, std::int32_t l, LevelToken& out);
  std::int32_t as_samples(std::int32_t lb_max, std::int32_t lb_minor, int limit) const;
  int last_index(std::int32_t as_samples) const;

  Descriptors::Reader descriptors_;
  bool area_;  // the second logarithm is that of the area
  spec::texture::CountRule count_;
  spec::texture::CountCap cap_;
  Pipe<typename Width::template Fragments<LevelToken>, kStages> pipe_;
};

class LevelUnit final : public LevelUnitOf<Narrow> {
 public:
  using LevelUnitOf::LevelUnitOf;
};
namespace wide {
class LevelUnit final : public LevelUnitOf<Wide> {
 public:
  using LevelUnitOf::LevelUnitOf;
};
}  // namespace wide

}  // namespace deburr::rtl::texture
