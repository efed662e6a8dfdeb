// SPDX-License-Identifier: MIT
// Walks N samples along the major axis of the footprint and emits one bilinear request per cycle,
// one or two per sample: sample by sample, or with `blend = level` level by level.
//
// Position  LevelUnit -> SampleWalker -> TexelAddresser.
// Interval  No gap between fragments: the next ones are prepared meanwhile.
// Stalls    downstream  Each stage stalls independently.
// Method    If N is a power of two, the division by N is a shift. The accumulators step by twice
//           the product. Sample N - 1 lies opposite sample 0, so with `blend = level` the second
//           level starts at the negated accumulators.
// Source    Paper 2.2 (4); kernels, spread and `any` are ours.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class SampleWalker final : public Unit {
 public:
  In<LevelToken> levels_in{"levels_in"};
  Out<SampleToken> samples_out{"samples_out"};

  SampleWalker(const sc_core::sc_module_name& name, ClockDomain& clock,
               spec::texture::CountRule count, spec::texture::Kernel kernel, std::int32_t spread,
               spec::texture::Blend blend = spec::texture::Blend::kSample);
  Activity tick(Cycle cycle) override;
  void reset() override { scaled_.occupied = divided_.occupied = walking_ = false; }

  Counter samples{"samples", "samples", "samples along major axes, one or two requests each"};

  static Datasheet datasheet(const spec::texture::Parameters& parameters);

 private:
  // A fragment being prepared.
  struct Prepared {
    bool occupied = false;
    LevelToken fragment;
    std::int64_t step_s, step_t;  // S10.30, spread x axis; after divide() S10.46
  };
  void scale(Cycle cycle, const LevelToken& fragment);
  void divide(Cycle cycle);
  void start(Prepared& next);
  void emit(Cycle cycle);

  std::int32_t spread_, narrow_spread_;  // U2.6; narrow: for a tent with fewer than four samples
  bool by_level_;                        // `blend = level`
  // `any` only: entry N - 1 is 1 / N, U1.16.
  std::unique_ptr<Memory<std::uint32_t>> reciprocal_;
  std::optional<ReadPort<std::uint32_t>> read_;
  // Registers.
  Prepared scaled_{}, divided_{};
  LevelToken fragment_{};
  bool walking_ = false;                  // fragment_ has requests left
  bool second_level_ = false;             // the next request is of the coarser level
  std::uint8_t index_ = 0;                // U4, current sample
  std::int64_t step_s_ = 0, step_t_ = 0;  // S10.46, spread x axis / N
  std::int64_t walk_s_ = 0, walk_t_ = 0;  // S14.46, (2i + 1 - N) x spread x axis / N
};

}  // namespace deburr::rtl::texture
