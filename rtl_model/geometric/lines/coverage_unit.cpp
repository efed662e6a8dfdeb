// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/lines/coverage_unit.h"

#include <bit>
#include <cstdlib>
#include <span>
#include <string>

#include "rtl_model/geometric/common/hardware_lists.h"
#include "spec/geometric/tables.h"

namespace deburr::rtl::geometric {
namespace {

constexpr std::int32_t kHalf = 1 << (spec::geometric::kDistanceBits - 1);
constexpr std::int32_t kFractionMask = 2 * kHalf - 1;
// Distances in one half of the table.
constexpr std::size_t kInHalf = spec::geometric::kAreaDistances / 2;
constexpr int kAreaShift = spec::geometric::kDistanceBits - 6;

std::uint32_t lanes_of(const spec::geometric::Parameters& p) {
  return spec::geometric::kLaneCount[static_cast<std::size_t>(p.walkers)];
}

std::vector<std::uint8_t> areas(std::size_t from) {
  std::vector<std::uint8_t> words;
  for (const auto& slope : spec::geometric::kCutArea) {
    const auto first = slope.begin() + static_cast<std::ptrdiff_t>(from);
    words.insert(words.end(), first, first + static_cast<std::ptrdiff_t>(kInHalf));
  }
  return words;
}

MemoryShape rom_shape(std::uint32_t lanes) {
  return {.words = spec::geometric::kAreaSlopes * kInHalf,
          .word_bits = 8,
          .kind = MemoryKind::kRom,
          .read_ports = lanes,
          .write_ports = 0,
          .content = "area cut off by a line, by slope and distance"};
}

}  // namespace

CoverageUnit::CoverageUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
                           const spec::geometric::Parameters& p, EdgeLatency& latency)
    : Unit(name, clock),
      latency_(latency),
      near_rom_("near_area_rom", rom_shape(lanes_of(p)), std::span<const std::uint8_t>(areas(0))),
      far_rom_("far_area_rom", rom_shape(lanes_of(p)),
               std::span<const std::uint8_t>(areas(kInHalf))) {
  for (std::uint32_t lane = 0; lane < lanes_of(p); ++lane) {
    const std::string at = "lane " + std::to_string(lane);
    near_.emplace_back(near_rom_, at);
    far_.emplace_back(far_rom_, at);
  }
}

// Stages 1 and 2.
void CoverageUnit::find(Cycle cycle, const GroupToken& group, Beat& beat) const {
  CandidateToken& out = beat.out;
  out.end = group.end;
  out.candidates = out.forward = out.seconds = out.dropped = 0;
  beat.leaves = beat.half = 0;
  if (group.end) return;
  const FrameConfiguration& configuration = configuration_in.read(cycle);
  const auto rows =
      static_cast<std::int32_t>(group.vertical ? configuration.width : configuration.height);
  out.vertical = group.vertical;
  out.crease = group.crease;
  const auto major = static_cast<std::uint16_t>(group.column >> 2);
  // The rows of a group with a candidate are inside the frame.
  const auto minor =
      static_cast<std::uint16_t>(group.position[0] >> (spec::geometric::kDistanceBits + 2) & 0x7FF);
  out.block_x = group.vertical ? minor : major;
  out.block_y = group.vertical ? major : minor;
  const auto slope = static_cast<std::uint32_t>(std::abs(group.slope)) >>
                     (spec::geometric::kSlopeBits - spec::geometric::kDistanceBits);  // U1.16
  // In 1/32, ties up; minus one, since the table begins with the first.
  const std::uint32_t thirty_seconds = ((slope >> 10) + 1) >> 1,
                      row_of_table = thirty_seconds == 0 ? 0 : thirty_seconds - 1;
  std::int64_t depth = group.depth;
  for (std::uint32_t lane = 0; lane < group.count; ++lane, depth += group.step) {
    const std::int32_t row = group.position[lane] >> spec::geometric::kDistanceBits;
    const std::int32_t distance = (group.position[lane] & kFractionMask) - kHalf;
    const bool forward = distance > 0 || (distance == 0 && group.tie_forward);
    const std::int32_t neighbour = forward ? row + 1 : row - 1;
    const std::int32_t away = std::abs(distance), coverage = (kHalf - away + 128) >> 8;
    const bool leaves =
        configuration.area && 2 * away + static_cast<std::int32_t>(slope) > 2 * kHalf;
    if (row < 0 || row >= rows || neighbour < 0 || neighbour >= rows || (!leaves && coverage == 0))
      continue;
    const std::uint32_t column = (group.column + lane) & 3,
                        in_block = static_cast<std::uint32_t>(row) & 3;
    out.candidates |= static_cast<std::uint8_t>(1u << lane);
    out.forward |= static_cast<std::uint8_t>(forward << lane);
    out.place[lane] =
        static_cast<std::uint8_t>(group.vertical ? column << 2 | in_block : in_block << 2 | column);
    out.coverage[lane] = static_cast<std::uint8_t>(coverage);
    out.depth[lane] =
        static_cast<std::uint32_t>(depth >> spec::geometric::kDepthStepBits) & 0xFFFFFF;
    if (!leaves) continue;
    beat.leaves |= static_cast<std::uint8_t>(1u << lane);
    beat.half |= static_cast<std::uint8_t>((away == kHalf) << lane);
    const auto at = [&](std::int32_t from_centre) {
      return static_cast<std::uint16_t>(
          row_of_table * kInHalf +
          (static_cast<std::uint32_t>(from_centre >> kAreaShift) & (kInHalf - 1)));
    };
    beat.near[lane] = at(away);
    beat.far[lane] = at(2 * kHalf - away);
  }
}

// End of stage 2.
void CoverageUnit::look_up(Cycle cycle, const Beat& beat) {
  for (std::uint32_t left = beat.leaves; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(left));
    near_[lane].read(cycle, beat.near[lane]);
    far_[lane].read(cycle, beat.far[lane]);
  }
}

// Stage 3; idempotent.
void CoverageUnit::finish(Cycle cycle, Beat& beat) const {
  CandidateToken& out = beat.out;
  for (std::uint32_t left = beat.leaves; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(left));
    const std::uint8_t far = far_[lane].at(cycle, beat.far[lane]),
                       near = near_[lane].at(cycle, beat.near[lane]);
    out.coverage[lane] = beat.half >> lane & 1 ? far : near;
    out.second[lane] = far;
    const auto bit = static_cast<std::uint8_t>(1u << lane);
    if (out.coverage[lane] == 0)
      out.candidates &= static_cast<std::uint8_t>(~bit);
    else if (far != 0)
      out.seconds |= bit;
  }
}

Activity CoverageUnit::tick(Cycle cycle) {
  const bool arrives = groups_in.can_pop(cycle);
  if (!arrives && pipe_.empty()) return kIdle;
  if (Beat* next = pipe_.at(2)) {
    if (next->leaves != 0) finish(cycle, *next);
    if ((next->out.candidates || next->out.end) && !candidates_out.can_push(cycle))
      return kStalledDownstream;
  }
  pipe_.move();
  if (const Beat* beat = pipe_.at(3)) {
    const CandidateToken& done = beat->out;
    if (!done.end) latency_.cover(done.candidates != 0);
    if (done.candidates || done.end) {
      candidates += count_of(done.candidates, done.seconds);
      candidates_out.push(cycle, done);
    }
  }
  if (const Beat* beat = pipe_.at(2); beat && beat->leaves != 0) look_up(cycle, *beat);
  if (arrives) find(cycle, groups_in.take(cycle), pipe_.enter());
  return kBusy;
}

Datasheet CoverageUnit::datasheet(const spec::geometric::Parameters& p) {
  const std::uint32_t lanes = lanes_of(p), thrice = lanes > 2;
  return {
      .unit = "CoverageUnit",
      .does =
          "Computes the area that a line cuts off each pixel of a group, and the side of the "
          "neighbour.",
      .latency = {3},
      .interval = {1, "one group per cycle; a group without candidates produces no output"},
      .stages = {{.clock = "1",
                  .work = "distance, direction, depth, magnitude of the slope",
                  .operators = {op::magnitude(16), op::logic(16)},
                  .longest = built({thrice * op::add(36), (lanes > 1) * op::add(36),
                                    (lanes == 1) * op::magnitude(26)}),
                  .registers = 16 + 16 + 1 + 24},
                 {.clock = "2",
                  .work = "coverage by distance, frame borders; check whether the line leaves the "
                          "pixel, addresses of the areas",
                  .operators = {2 * op::compare(14), 2 * op::subtract(17), op::add(18),
                                op::logic(20)},
                  .longest = {op::add(18), op::logic(6)},
                  .registers = 1 + 1 + 4 + 8 + 24 + 2},
                 {.clock = "3",
                  .work = "areas, candidates and second candidates",
                  .operators = {op::mux(8, 3), op::logic(20)},
                  .longest = {op::rom_read(8, 1024), op::mux(8, 3), op::logic(8)}}},
      .formats = "distance S0.16, slope U1.16 and in 1/32, coverage U0.8.",
      .copies = lanes,
      .per = "lane",
      .shared = built({op::magnitude(26), (lanes - 1) * op::add(36), thrice * op::add(36),
                       op::add(7), op::add(6), op::logic(20)}),
      .shared_registers = 17 + 2 + 13 + 3 + 2 + (22 + 2 + 2)};
}

}  // namespace deburr::rtl::geometric
