// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/lines/line_walker.h"

#include <algorithm>
#include <string>

#include "rtl_model/geometric/common/hardware_lists.h"

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

Datasheet LineWalker::datasheet(const spec::geometric::Parameters& p) {
  const std::uint32_t n = lane_count(p.walkers), thrice = n > 2, line = 172;
  return {
      .unit = "LineWalker",
      .does = "Steps along a line, one group of columns per cycle.",
      .latency = {1},
      .interval = {1, "one group per cycle, also across the ends of lines"},
      .stages = {{.clock = "1",
                  .work = "position + k slope for k = 1..N, block compares, selection of the next "
                          "position; the same for depth",
                  .operators = built({op::mux(line, 2), thrice * op::add(28), n * op::add(40),
                                      thrice * op::add(38), n * op::add(38),
                                      (n - 1) * op::equal(14), op::mux(40, n), op::mux(38, n),
                                      op::add(13), op::subtract(14), op::logic(60)}),
                  .longest =
                      built({op::mux(line, 2), thrice * op::add(28), op::add(40),
                             (n > 1) * op::equal(14), (n > 1) * op::logic(2 * n), op::mux(40, n)}),
                  .registers = line,
                  .on = "groups"}},
      .cost = "N = " + std::to_string(n) + "."};
}

}  // namespace deburr::rtl::geometric
