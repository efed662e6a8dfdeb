// SPDX-License-Identifier: MIT
// Walks N samples along the major axis of the footprint and emits a bilinear request a clock, one
// or two a sample.
//
// Where: after the LevelUnit. Stages: 1 spread times axis, with `count = any` beside a read of 1/N;
// `any` alone: times 1/N; then offset of the first sample (where N is a power of two, division by
// it is a shift here); then a request a clock. Latency 3 to the first request, 4 with `any`;
// initiation interval N x (1 or 2) clocks a fragment (1 for an invalid descriptor), no clock
// between two fragments: the next ones are prepared meanwhile. Stalled by `downstream`. Made for
// 250 MHz; longest path: 41 x 17 bit multiply (17 rows of partial products where 24 x 24 has 24),
// or 1 in 5 shifts, then a 57-bit subtraction (`any`: 57 x 4 bit multiply), or a 57-bit rounding
// addition, then a 34-bit one. Formats: axis S9.24, spread U2.6, 1/N U1.16, step S10.46, offset
// rounded to S9.24, position exact in S9.24. Cost: two 34 x 8 bit multipliers, two shifters and two
// subtractors (`any`: two 41 x 17 bit multipliers, two 57 x 4 bit ones, and the ROM `reciprocal`,
// 16 x 17 bits), two 61-bit accumulators that step by twice the product, four adders, registers of
// three fragments (`any`: four). Source: paper 2.2 (4); kernels, spread and `any` are ours.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <systemc>

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
               spec::texture::CountRule count, spec::texture::Kernel kernel, std::int32_t spread);
  Activity tick(Cycle cycle) override;
  void reset() override { scaled_.occupied = divided_.occupied = walking_ = false; }

  Counter samples{"samples", "samples", "samples along major axes, one or two requests each"};

 private:
  // A fragment on its way to the walk.
  struct Prepared {
    bool occupied = false;
    LevelToken fragment;
    std::int64_t step_s, step_t;  // S10.30, spread x axis; once divided S10.46
  };
  void scale(Cycle cycle, const LevelToken& fragment);
  void divide(Cycle cycle);
  void start(Prepared& next);
  void emit(Cycle cycle);

  std::int32_t spread_, narrow_spread_;  // U2.6; narrow: of a tent with too few samples for one
  // `any` alone: entry N - 1 is 1/N, U1.16.
  std::unique_ptr<Memory<std::uint32_t>> reciprocal_;
  std::optional<ReadPort<std::uint32_t>> read_;
  // Registers.
  Prepared scaled_{}, divided_{};
  LevelToken fragment_{};
  bool walking_ = false;                  // fragment_ has requests left
  bool second_level_ = false;             // the next request is the coarser level of its sample
  std::uint8_t index_ = 0;                // U4, sample in hand
  std::int64_t step_s_ = 0, step_t_ = 0;  // S10.46, spread x axis / N
  std::int64_t walk_s_ = 0, walk_t_ = 0;  // S14.46, (2i + 1 - N) x spread x axis / N
};

}  // namespace deburr::rtl::texture
