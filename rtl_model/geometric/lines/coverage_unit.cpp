// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/lines/coverage_unit.h"

#include <bit>
#include <cstdlib>

namespace deburr::rtl::geometric {
namespace {

constexpr std::int32_t kHalf = 1 << (spec::geometric::kDistanceBits - 1);
constexpr std::int32_t kFractionMask = 2 * kHalf - 1;

}  // namespace

void CoverageUnit::find(Cycle cycle, const GroupToken& group, CandidateToken& out) const {
  out.end = group.end;
  out.candidates = out.forward = 0;
  if (group.end) return;
  const FrameRules& rules = rules_in.read(cycle);
  const auto rows = static_cast<std::int32_t>(group.vertical ? rules.width : rules.height);
  out.vertical = group.vertical;
  const auto major = static_cast<std::uint16_t>(group.column >> 2);
  // A group with a candidate has its rows in the frame.
  const auto minor =
      static_cast<std::uint16_t>(group.position[0] >> (spec::geometric::kDistanceBits + 2) & 0x7FF);
  out.block_x = group.vertical ? minor : major;
  out.block_y = group.vertical ? major : minor;
  std::int64_t depth = group.depth;
  for (std::uint32_t lane = 0; lane < group.count; ++lane, depth += group.step) {
    const std::int32_t row = group.position[lane] >> spec::geometric::kDistanceBits;
    const std::int32_t distance = (group.position[lane] & kFractionMask) - kHalf;
    const bool forward = distance > 0 || (distance == 0 && group.tie_forward);
    const std::int32_t neighbour = forward ? row + 1 : row - 1;
    const std::int32_t coverage = (kHalf - std::abs(distance) + 128) >> 8;
    if (row < 0 || row >= rows || neighbour < 0 || neighbour >= rows || coverage == 0) continue;
    const std::uint32_t column = (group.column + lane) & 3,
                        in_block = static_cast<std::uint32_t>(row) & 3;
    out.candidates |= static_cast<std::uint8_t>(1u << lane);
    out.forward |= static_cast<std::uint8_t>(forward << lane);
    out.place[lane] =
        static_cast<std::uint8_t>(group.vertical ? column << 2 | in_block : in_block << 2 | column);
    out.coverage[lane] = static_cast<std::uint8_t>(coverage);
    out.depth[lane] =
        static_cast<std::uint32_t>(depth >> spec::geometric::kDepthStepBits) & 0xFFFFFF;
  }
}

Activity CoverageUnit::tick(Cycle cycle) {
  const bool arrives = groups_in.can_pop(cycle);
  if (!arrives && pipe_.empty()) return kIdle;
  if (const CandidateToken* next = pipe_.at(1);
      next && (next->candidates || next->end) && !candidates_out.can_push(cycle))
    return kStalledDownstream;
  pipe_.move();
  if (const CandidateToken* done = pipe_.at(2)) {
    if (!done->end) latency_.cover(done->candidates != 0);
    if (done->candidates || done->end) {
      candidates += static_cast<std::uint64_t>(std::popcount(done->candidates));
      candidates_out.push(cycle, *done);
    }
  }
  if (arrives) find(cycle, groups_in.take(cycle), pipe_.enter());
  return kBusy;
}

Datasheet CoverageUnit::datasheet() {
  return {.unit = "CoverageUnit",
          .does = "What a line cuts off each pixel of a group, and across which side.",
          .latency = {2},
          .interval = {1, "a group a clock; one without a candidate leaves nothing"},
          .stages = {{"1", "distance, direction, depth", "38-bit add"},
                     {"2", "coverage, borders, candidates"}},
          .formats = "distance S0.16, coverage U0.8.",
          .cost = "a lane: 17-bit add, 17-bit magnitude, two 14-bit compares; 4 adds of 38 bits."};
}

}  // namespace deburr::rtl::geometric
