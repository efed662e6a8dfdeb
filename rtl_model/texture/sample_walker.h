// SPDX-License-Identifier: MIT
// Walks N samples along the major axis of the footprint and emits one bilinear request per cycle,
// one or two per sample: sample by sample, or with `blend = level` level by level.
//
// Position  LevelUnit -> SampleWalker -> TexelAddresser.
// Interval  No gap between fragments: the next ones are prepared meanwhile. Above width 1 up to
//           `width` requests per cycle, of the older of two fragment groups first.
// Stalls    downstream  Each stage stalls independently.
// Method    `kernel = axis`: if N is 5 or more and the major axis a diagonal, the fragment is a
// tent;
//           its requests say so to the FilterPipeline. If N is a power of two, the division by N is
//           a shift. The accumulators step by twice the product. Sample N - 1 lies opposite sample
//           0, so with `blend = level` the second level starts at the negated accumulators.
// Source    Paper 2.2 (4); kernels, spread and `any` are ours.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/tokens.h"
#include "rtl_model/texture/width.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

// The part that does not depend on the width.
class SampleWalkerBase : public Unit {
 public:
  Counter samples{"samples", "samples", "samples along major axes, one or two requests each"};

 protected:
  using Unit::Unit;
};

template <class Width>
class SampleWalkerOf : public SampleWalkerBase {
 public:
  In<typename Width::template Fragments<LevelToken>> levels_in{"levels_in"};
  Out<typename Width::template Requests<SampleToken>> samples_out{"samples_out"};

  SampleWalkerOf(const sc_core::sc_module_name& name, ClockDomain& clock,
                 spec::texture::CountRule count, spec::texture::Kernel kernel, std::int32_t spread,
                 spec::texture::Blend blend = spec::texture::Blend::kSample,
                 const spec::texture::Build& build = {});
  Activity tick(Cycle cycle) override;
  void reset() override {
    scaled_.occupied = divided_.occupied = false;
    walking_ = fragment_ = 0;
  }

  static Datasheet datasheet(const spec::texture::Parameters& parameters);

 private:
  // A fragment being prepared; from here on its `diagonal` says that it selects a tent.
  struct Prepared {
    LevelToken fragment;
    std::int64_t step_s, step_t;  // S10.30, spread x axis; after divide() S10.46
  };
  struct Preparing {
    bool occupied = false;
    typename Width::template Fragments<Prepared> group;
  };
  // A fragment with requests left.
  struct Walk {
    LevelToken fragment;
    bool second_level;            // the next request is of the coarser level
    std::uint8_t index;           // U4, current sample
    std::uint8_t weights;         // U5, `last_index` of its requests
    std::int64_t step_s, step_t;  // S10.46, spread x axis / N
    std::int64_t walk_s, walk_t;  // S14.46, (2i + 1 - N) x spread x axis / N
  };
  // Walking registers: at width 1 one fragment, above two groups, the older first.
  static constexpr std::size_t kWalking = Width::kMost == 1 ? 1 : 2;

  void scale(Cycle cycle, const typename Width::template Fragments<LevelToken>& group);
  void divide(Cycle cycle);
  void start(Preparing& next);
  [[gnu::always_inline]] void begin(const Prepared& prepared, Walk& walk) const;
  void emit(Cycle cycle);
  [[gnu::always_inline]] bool step(Walk& walk, SampleToken& out);
  [[gnu::noinline]] static void advance_by_level(Walk& walk, bool last_sample);

  std::int32_t box_spread_, tent_spread_;  // U2.6
  std::uint8_t first_tent_;                // N - 1 from which on a fragment may be a tent
  bool by_axis_;                           // `kernel = axis`: if its axis is a diagonal
  bool by_level_;                          // `blend = level`
  // `any` only: entry N - 1 is 1 / N, U1.16.
  std::unique_ptr<Memory<std::uint32_t>> reciprocal_;
  std::vector<ReadPort<std::uint32_t>> reads_;  // one per fragment of a group
  std::size_t width_, fragments_;               // most in a group
  // Registers.
  Preparing scaled_{}, divided_{};
  std::array<typename Width::template Fragments<Walk>, kWalking> walks_{};
  std::size_t older_ = 0,
              walking_ = 0;   // first of the groups that have requests left, their number
  std::size_t fragment_ = 0;  // current fragment of the older group
};

class SampleWalker final : public SampleWalkerOf<Narrow> {
 public:
  using SampleWalkerOf::SampleWalkerOf;
};
namespace wide {
class SampleWalker final : public SampleWalkerOf<Wide> {
 public:
  using SampleWalkerOf::SampleWalkerOf;
};
}  // namespace wide

}  // namespace deburr::rtl::texture
