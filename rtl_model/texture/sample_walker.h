// SPDX-License-Identifier: MIT
// Walks N samples along the major axis of the footprint and emits a bilinear request a clock, one
// or two a sample.
//
// Where: after the LevelUnit. Three stages: 1 spread times axis, 2 offset of the first sample, 3 a
// request a clock. Latency 3 to the first request, initiation interval N x (1 or 2) clocks a
// fragment (1 for an invalid descriptor), no clock between two fragments: the next ones are
// prepared meanwhile. Stalled by `downstream`. Made for 250 MHz; longest path: 33 x 8 bit multiply,
// or a 46-bit rounding addition, a choice of 1 in 5 shifts and a 34-bit addition. Formats: axis
// S8.24, spread U1.6, offset rounded to S9.24, position exact in S9.24. Cost: two 33 x 8 bit
// multipliers, two 46-bit subtractors, two 46-bit accumulators that step by twice the product, four
// shifters, two adders, registers of three fragments. Source: paper 2.2 (4); kernels and spread are
// ours.
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class SampleWalker final : public Unit {
 public:
  In<LevelToken> levels_in{"levels_in"};
  Out<SampleToken> samples_out{"samples_out"};

  SampleWalker(const sc_core::sc_module_name& name, ClockDomain& clock,
               spec::texture::Kernel kernel, std::int32_t spread);
  Activity tick(Cycle cycle) override;
  void reset() override { scaled_.occupied = walking_ = false; }

  Counter samples{"samples", "samples", "samples along major axes, one or two requests each"};

 private:
  // After stage 1.
  struct Scaled {
    bool occupied = false;
    LevelToken fragment;
    std::int64_t step_s, step_t;  // S9.30, spread x axis
  };
  void scale(const LevelToken& fragment);
  void start();
  void emit(Cycle cycle);
  unsigned kernel_weight() const;

  spec::texture::Kernel kernel_;
  std::int32_t spread_;  // U1.6
  // Registers.
  Scaled scaled_{};
  LevelToken fragment_{};
  bool walking_ = false;                  // fragment_ has requests left
  bool second_level_ = false;             // the next request is the coarser level of its sample
  unsigned index_ = 0;                    // U4, sample in hand
  std::int64_t step_s_ = 0, step_t_ = 0;  // S9.30, spread x axis
  std::int64_t walk_s_ = 0, walk_t_ = 0;  // S13.30, (2i + 1 - N) x spread x axis
};

}  // namespace deburr::rtl::texture
