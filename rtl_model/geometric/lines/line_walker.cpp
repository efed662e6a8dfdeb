// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/lines/line_walker.h"

#include <algorithm>

namespace deburr::rtl::geometric {
namespace {

constexpr int kRowShift = spec::geometric::kSlopeBits, kBlockShift = 2;
constexpr int kDistanceShift = spec::geometric::kSlopeBits - spec::geometric::kDistanceBits;

}  // namespace

Activity LineWalker::tick(Cycle cycle) {
  const bool begins = line_.count == 0;
  if (begins && !lines_in.can_pop(cycle)) return kIdle;
  if (!groups_out.can_push(cycle)) return kStalledDownstream;
  GroupToken& group = groups_out.emplace(cycle);
  group.end = false;
  if (begins) {
    const LineToken& token = lines_in.take(cycle);
    if (token.end) {
      group.end = true;
      return kBusy;
    }
    line_ = token.line;
    line_columns.record(line_.count);
  }
  // Considers only columns of one block of the major axis.
  const std::uint32_t most =
      std::min({walkers_, std::uint32_t{line_.count},
                spec::geometric::kBlockSize - (line_.first & (spec::geometric::kBlockSize - 1u))});
  std::int64_t position = line_.position, depth = line_.depth;
  const std::int64_t block = position >> (kRowShift + kBlockShift);
  std::uint32_t count = 0;
  do {
    group.position[count++] = static_cast<std::int32_t>(position >> kDistanceShift);
    position += line_.slope;
    depth += line_.depth_step;
  } while (count < most && position >> (kRowShift + kBlockShift) == block);
  group.vertical = line_.axis == spec::geometric::Axis::kVertical;
  group.tie_forward = line_.tie_forward;
  group.crease = line_.crease;
  group.slope = line_.slope;
  group.column = line_.first;
  group.count = static_cast<std::uint8_t>(count);
  group.depth = line_.depth;
  group.step = line_.depth_step;
  line_.position = position;
  line_.depth = depth;
  line_.first = static_cast<std::uint16_t>(line_.first + count);
  line_.count = static_cast<std::uint16_t>(line_.count - count);
  latency_.walk(line_.count == 0);
  columns += count;
  ++groups;
  return kBusy;
}

Datasheet LineWalker::datasheet() {
  return {
      .unit = "LineWalker",
      .does = "Steps along a line, one group of columns per cycle.",
      .latency = {1},
      .interval = {1, "one group per cycle, also across the ends of lines"},
      .stages =
          {{"1", "position + k slope for k = 0..N, block compares, selection of the next position",
            "2 : 1 choice, with four walkers 3 x slope (an add), 40-bit add + 13-bit compare + "
            "5 : 1 choice: 1.22 of the multiply with four walkers"}},
      .cost =
          "9 adds of 40 bits (position + k slope, the next position), 5 of 38 (the next "
          "depth), 3 comparators of 14 bits, a 5 : 1 choice."};
}

}  // namespace deburr::rtl::geometric
