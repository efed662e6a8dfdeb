// SPDX-License-Identifier: MIT
// Number of samples, mip level and level fraction of a fragment, and which filter is in force.
//
// Where: after the Log2Unit. Three stages: 1 difference of the logarithms (of an area:
// from twice that of the axis), how much of it is taken
// as samples, and the choice of the descriptor; 2 level of detail with bias, clamped to its range;
// number of samples (`any`: 15 comparisons side by side, whose ones are counted); 3 level and
// fraction by mode, filter. The model does all in stage 1, then delays. Latency 3, initiation
// interval 1; stalled by `downstream`, and then holds still as a whole. Made for 250 MHz; longest
// path: 20-bit addition of three operands, then two 20-bit comparisons with a choice. Formats:
// S5.12 in; L in U6.12, E in U3.12; l in S8.12, rounded once to S8.8 for the two-level modes. Cost:
// nine 20-bit adders or comparators and a few multiplexers; `any`: 15 comparators of 15 bits with a
// constant and a counter of their ones, no adder to round L; no multiplier and no divider;
// registers of two fragments. Source: paper 1.3, equations 2, 3 and 12; `any` as Vulkan counts;
// level of detail and modes as in GL.
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/descriptors.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class LevelUnit final : public Unit {
 public:
  In<Log2Token> logs_in{"logs_in"};
  Out<LevelToken> levels_out{"levels_out"};

  LevelUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
            const Descriptors::Reader& descriptors, spec::texture::Axes axes,
            spec::texture::CountRule count, spec::texture::CountCap cap);
  Activity tick(Cycle cycle) override;
  void reset() override { pipe_.reset(); }

  Counter magnified{"magnified", "fragments", "fragments with a level of detail of at most 0"};
  Counter two_levels{"two_levels", "fragments", "fragments that blend two levels"};

 private:
  static constexpr int kStages = 3;
  void choose(Cycle cycle, const Log2Token& in, LevelToken& out);
  std::int32_t as_samples(std::int32_t lb_max, std::int32_t lb_minor, int limit) const;
  int last_index(std::int32_t as_samples) const;

  Descriptors::Reader descriptors_;
  bool area_;  // the logarithm beside that of the major axis is the area's
  spec::texture::CountRule count_;
  spec::texture::CountCap cap_;
  Pipe<LevelToken, kStages> pipe_;
};

}  // namespace deburr::rtl::texture
