// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/lines/depth_test.h"

#include <algorithm>
#include <bit>
#include <string>

#include "rtl_model/geometric/common/hardware_lists.h"
#include "spec/geometric/records.h"

namespace deburr::rtl::geometric {
namespace {

constexpr std::uint32_t kDepthTagBits = 23;

std::uint32_t depth_tag_of(std::uint32_t u, std::uint32_t v, bool tiled) {
  // Either layout fits in 22 bits: 9 + 13 (raster) or 11 + 11 (tiled).
  return 1u << (kDepthTagBits - 1) | (tiled ? v << 11 | u : v << 9 | u);
}

std::uint32_t not_dropped(const CandidateToken& group) {
  return group.candidates & ~std::uint32_t{group.dropped};
}

template <class Visit>
void for_each_lane(std::uint32_t lanes, Visit&& visit) {
  for (; lanes != 0; lanes &= lanes - 1) visit(static_cast<std::size_t>(std::countr_zero(lanes)));
}

}  // namespace

DepthTest::DepthTest(const sc_core::sc_module_name& name, ClockDomain& clock,
                     const spec::geometric::Parameters& p, EdgeLatency& latency)
    : Unit(name, clock),
      latency_(latency),
      index_bits_(spec::geometric::kCacheLineBits[static_cast<std::size_t>(p.depth_lines)]),
      cache_({.lines = spec::geometric::kCacheLineCount[static_cast<std::size_t>(p.depth_lines)],
              .ports = 2,
              .tags = {"depth_tags", "tile position u, v, valid", kDepthTagBits},
              .data = {"depth_data", "sixteen depths", 24 * spec::geometric::kPixelsInLine},
              .fills = {"depth_fills", "depths in flight", p.fills},
              .no_line = declare_stall("depth", "a line of depths has not arrived"),
              .no_fill = declare_stall("fills", "no fill entry for a line of depths is free")}),
      fifo_("latency_fifo", static_cast<std::uint32_t>(p.latency_fifo),
            candidates_shape(p, p.coarse_lines != spec::geometric::CoarseLines::kNone, "group.")) {}

// Returns the line's index among the lines of the group.
std::uint8_t DepthTest::add_line(Wanted& wanted, Place line, bool tiled) const {
  Lookup& l = wanted.lookup;
  for (std::uint8_t i = 0; i < l.count; ++i)
    if (wanted.line[i] == line) return i;
  const std::uint32_t half = (index_bits_ + 1) / 2;
  const std::uint32_t low = tiled ? half : half > 3 ? half - 2 : 1;
  wanted.line[l.count] = line;
  l.index[l.count] = static_cast<std::uint16_t>(
      (line.u & ((1u << low) - 1)) | (line.v & ((1u << (index_bits_ - low)) - 1)) << low);
  return l.count++;
}

// Stage 1.
void DepthTest::find_lines(Cycle cycle, const CandidateToken& group, Wanted& out) const {
  const FrameConfiguration& configuration = configuration_in.read(cycle);
  Lookup& l = out.lookup;
  l.group = group;
  l.count = l.missed = 0;
  if (group.end || configuration.depth_test == spec::geometric::DepthTest::kOff) return;
  const auto find = [&](std::uint32_t x, std::uint32_t y, std::uint8_t& line, std::uint8_t& word) {
    const auto at = [&](std::uint32_t u, std::uint32_t v, std::uint32_t w) {
      line = add_line(out, {static_cast<std::uint16_t>(u), static_cast<std::uint16_t>(v)},
                      configuration.tiled);
      word = static_cast<std::uint8_t>(w);
    };
    if (configuration.tiled)
      at(x >> 2, y >> 2, (y & 3) << 2 | (x & 3));
    else
      at(x >> 4, y, x & 15);
  };
  for_each_lane(not_dropped(group), [&](std::size_t lane) {
    const std::uint32_t x = group.block_x * 4u + (group.place[lane] & 3),
                        y = group.block_y * 4u + (group.place[lane] >> 2);
    find(x, y, l.own_line[lane], l.own_word[lane]);
    if (configuration.depth_test != spec::geometric::DepthTest::kFarther) return;
    const std::uint32_t step = group.forward >> lane & 1 ? 1 : ~0u;
    find(group.vertical ? x + step : x, group.vertical ? y : y + step, l.other_line[lane],
         l.other_word[lane]);
  });
}

// Stage 2, for the next pair to look up.
void DepthTest::read_tags(Cycle cycle) {
  for (std::size_t port = 0; port < 2 && pair_ + port < looking_.lookup.count; ++port) {
    const Place line = looking_.line[pair_ + port];
    cache_.find(cycle, port, looking_.lookup.index[pair_ + port],
                depth_tag_of(line.u, line.v, configuration_in.read(cycle).tiled));
  }
}

// Stage 3; kIdle: the pair is done.
Activity DepthTest::look_up_pair(Cycle cycle) {
  const Activity done = cache_.look_up(cycle, memory, [&](std::size_t port) {
    const FrameConfiguration& configuration = configuration_in.read(cycle);
    const Place line = looking_.line[pair_ + port];
    ++misses;
    return configuration.depth_base + configuration.line_offset(line.u, line.v);
  });
  lookups += cache_.decided(cycle);
  if (done == kIdle) looking_.lookup.missed |= static_cast<std::uint8_t>(cache_.missed() << pair_);
  return done;
}

// Stages 3 to 1.
Activity DepthTest::look_up(Cycle cycle) {
  bool did = false;
  if (is_looking_) {
    const std::size_t count = looking_.lookup.count;
    const bool last = pair_ + 2 >= count;
    if (last && !fifo_.can_push(cycle)) return kStalledDownstream;
    if (count != 0)
      if (const Activity done = look_up_pair(cycle); done != kIdle) return done;
    did = true;
    if (last) {
      if (count != 0) group_lines.record(count);
      fifo_.push(cycle, looking_.lookup);
      is_looking_ = false;
    } else {
      pair_ += 2;
      read_tags(cycle);
    }
  }
  if (!is_looking_ && has_addressed_) {
    looking_ = addressed_;
    has_addressed_ = false;
    is_looking_ = did = true;
    pair_ = 0;
    read_tags(cycle);
  }
  if (!has_addressed_ && candidates_in.can_pop(cycle)) {
    find_lines(cycle, candidates_in.take(cycle), addressed_);
    has_addressed_ = did = true;
  }
  return did ? kBusy : kIdle;
}

void DepthTest::capture(Cycle cycle, Work& work, std::size_t which, const DepthLine& line) const {
  const Lookup& l = work.lookup;
  const bool farther =
      configuration_in.read(cycle).depth_test == spec::geometric::DepthTest::kFarther;
  for_each_lane(not_dropped(l.group), [&](std::size_t lane) {
    if (l.own_line[lane] == which) work.own[lane] = line[l.own_word[lane]];
    if (farther && l.other_line[lane] == which) work.other[lane] = line[l.other_word[lane]];
  });
}

// Stage 5.
void DepthTest::capture_words(Cycle cycle) {
  Work& work = reading_last_ ? *pipe_.at(2) : work_;
  for (std::size_t port = 0; port < 2; ++port)
    if (reading_ >> port & 1) {
      const std::size_t which = reading_step_ + port;
      capture(cycle, work, which, cache_.word(cycle, port, work.lookup.index[which]));
    }
  reading_ = 0;
}

// Stage 6.
void DepthTest::compare(Cycle cycle, Work& work) const {
  work.nearer = work.farther = 0;
  const bool farther =
      configuration_in.read(cycle).depth_test == spec::geometric::DepthTest::kFarther;
  for_each_lane(not_dropped(work.lookup.group), [&](std::size_t lane) {
    const std::uint32_t own = work.own[lane], other = work.other[lane];
    work.far[lane] = farther ? std::min(own, other) : own;
    if (!farther) return;
    work.nearer |= static_cast<std::uint8_t>((own > other) << lane);
    work.farther |= static_cast<std::uint8_t>((own < other) << lane);
  });
}

void DepthTest::show(const CandidateToken& group, std::size_t lane, bool passes) const {
  const bool forward = group.forward >> lane & 1;
  const auto x = static_cast<std::uint16_t>(group.block_x * 4 + (group.place[lane] & 3)),
             y = static_cast<std::uint16_t>(group.block_y * 4 + (group.place[lane] >> 2));
  const auto direction = [&](bool to) {
    return static_cast<spec::geometric::Direction>(2 * group.vertical + to);
  };
  observer({x, y, direction(forward), group.coverage[lane], group.depth[lane], passes});
  if (!(group.seconds >> lane & 1)) return;
  const int step = forward ? 1 : -1;
  observer({static_cast<std::uint16_t>(group.vertical ? x + step : x),
            static_cast<std::uint16_t>(group.vertical ? y : y + step), direction(!forward),
            group.second[lane], group.depth[lane], passes});
}

// Stage 7.
void DepthTest::test(Cycle cycle, const Work& work) {
  const FrameConfiguration& configuration = configuration_in.read(cycle);
  const CandidateToken& group = work.lookup.group;
  const bool off = configuration.depth_test == spec::geometric::DepthTest::kOff,
             limited = group.crease && configuration.crease_depth != 0;
  std::uint8_t passing = 0;
  for_each_lane(group.candidates, [&](std::size_t lane) {
    const std::uint32_t far = work.far[lane], depth = group.depth[lane];
    const bool before = depth >= far - (far >> configuration.depth_bias),
               near = !limited || far >= depth - (depth >> configuration.crease_depth),
               passes = off || (before && near && !(group.dropped >> lane & 1));
    passing |= static_cast<std::uint8_t>(passes << lane);
    if (observer) show(group, lane, passes);
  });
  if (!group.end) latency_.test(passing != 0);
  if (passing == 0 && !group.end) return;
  WeightToken& out = weights_out.emplace(cycle);
  out.block_x = group.block_x;
  out.block_y = group.block_y;
  out.vertical = group.vertical;
  out.candidates = passing;
  out.forward = group.forward;
  out.seconds = group.seconds & passing;
  out.nearer = work.nearer;
  out.farther = work.farther;
  out.place = group.place;
  out.coverage = group.coverage;
  out.second = group.second;
  out.end = group.end;
  passed += count_of(passing, out.seconds);
}

// Stages 7 to 4.
Activity DepthTest::deliver(Cycle cycle) {
  if (!working_ && !fifo_.can_pop(cycle) && pipe_.empty()) return kIdle;
  if (pipe_.leaves() && !weights_out.can_push(cycle)) return kStalledDownstream;
  pipe_.move();
  if (const Work* work = pipe_.at(4)) test(cycle, *work);
  if (Work* work = pipe_.at(3)) compare(cycle, *work);
  if (reading_ != 0) capture_words(cycle);
  if (!working_) {
    if (!fifo_.can_pop(cycle)) return kBusy;
    work_.lookup = fifo_.take(cycle);
    working_ = true;
    step_ = 0;
  }
  const Lookup& l = work_.lookup;
  const std::uint32_t lines = l.count - step_ > 1 ? 3 : l.count - step_ == 1,
                      missed = l.missed >> step_ & 3;
  const Activity done = cache_.collect(
      cycle, &l.index[step_], missed, lines & ~missed,
      [&](std::size_t port, const DepthLine& line) { capture(cycle, work_, step_ + port, line); });
  if (done != kIdle) return done;
  reading_ = static_cast<std::uint8_t>(lines & ~missed);
  reading_step_ = step_;
  step_ += 2;
  reading_last_ = step_ >= l.count;
  if (reading_last_) {
    pipe_.enter() = work_;
    working_ = false;
  }
  return kBusy;
}

Activity DepthTest::tick(Cycle cycle) {
  const Phase phase = phase_in.read(cycle);
  if (phase != Phase::kEdges)
    return phase == Phase::kBegin ? cache_.clear(cycle, cleared_out) : kIdle;
  if (cleared_out.driven()) cleared_out.drive(cycle, false);
  const Activity data = deliver(cycle), tags = look_up(cycle);
  return cache_.finish(cycle, memory, data, tags, [](DepthLine& depths, const Line& line) {
    for (std::size_t i = 0; i < depths.size(); ++i) depths[i] = word_of(line, i) & 0xFFFFFF;
  });
}

void DepthTest::reset() {
  cache_.reset();
  fifo_.reset();
  pipe_.reset();
  has_addressed_ = is_looking_ = working_ = false;
  reading_ = 0;
}

Datasheet DepthTest::datasheet(const spec::geometric::Parameters& p) {
  const bool screened = p.coarse_lines != spec::geometric::CoarseLines::kNone;
  // n: own and other depths of all lanes, and the most lines of a group.
  const std::uint32_t lanes = lane_count(p.walkers), n = 2 * lanes, more = lanes > 1,
                      cached =
                          spec::geometric::kCacheLineCount[static_cast<std::size_t>(p.depth_lines)],
                      group = Payload::of<CandidateToken>(candidates_shape(p, screened)).bits(),
                      places = n * (bits_below(n) + 4) + bits_below(n + 1);
  constexpr std::uint32_t kPlace = kDepthTagBits - 1;  // bits of u, v
  const Hardware fills = fill_store(p.fills), tags = line_cache(cached, kDepthTagBits, 2, true);
  return {
      .unit = "DepthTest",
      .variant = screened ? "with `coarse_lines`" : "without `coarse_lines`",
      .does = "Drops the candidates that are hidden in the frame.",
      .latency = {7, "7, plus the wait for a line"},
      .interval =
          {1,
           "the lookups of a group are made in pairs; a pair takes one cycle, two if both miss; "
           "at least 1"},
      .stages = {{.clock = "1",
                  .work = "lines, first use of each",
                  .operators = built({2 * op::add(11), op::logic(30 * lanes),
                                      n * op::mux(kPlace, 2), n * (n - 1) / 2 * op::equal(kPlace),
                                      n * op::count_ones(n - 1), n * op::mux(kPlace, lanes)}),
                  .longest = built({op::add(11), op::mux(kPlace, 2), op::equal(kPlace),
                                    op::count_ones(n - 1), more * op::mux(kPlace, lanes)}),
                  .registers = group + n * kPlace + places + 1},
                 {.clock = "2",
                  .work = "tag addresses, products of the line addresses",
                  .operators = built({2 * op::mux(kPlace, lanes), 2 * op::mux(13, 2),
                                      2 * op::mux(10, 2), 2 * op::multiply(13, 10), op::add(3)}),
                  .longest = built({op::mux(kPlace, lanes), op::mux(13, 2), op::multiply(13, 10)}),
                  .registers = group + n * kPlace + places + 2 * kPlace + 2 * 24 + n + 4},
                 {.clock = "3",
                  .work = "two tags, one fill request per cycle; FIFO",
                  .path = "SRAM read",
                  .operators = built({2 * op::add(22), 2 * op::add(26), op::mux(26, 2)},
                                     built(tags.operators, fills.operators)),
                  .longest = {op::equal(kDepthTagBits), op::logic(8), op::mux(26, 2)},
                  .registers = tags.registers + fills.registers},
                 {.clock = "4",
                  .work = "line install, word addresses",
                  .operators = built({n * op::mux(24, 16), op::logic(4 * n),
                                      2 * op::mux(bits_below(cached), lanes), op::add(4)}),
                  .longest = {op::mux(24, 16)},
                  .registers = group + n * 24 + places + n * bits_below(cached) + n + 8},
                 {.clock = "5",
                  .work = "two lines per cycle, two choices of a depth per lane",
                  .path = "SRAM read",
                  .operators = {n * op::mux(24, 32), n * op::mux(24, 2), op::logic(4 * n)},
                  .longest = {op::mux(24, 32), op::mux(24, 2)},
                  .registers = group + n * 24 + 1},
                 {.clock = "6",
                  .work = "nearer pixel, farther depth",
                  .operators = {lanes * op::compare(24), lanes * op::equal(24),
                                lanes * op::mux(24, 2)},
                  .longest = {op::compare(24), op::mux(24, 2)},
                  .registers = group + lanes * (24 + 2) + 1},
                 {.clock = "7",
                  .work = "depth test of the line, and crease test",
                  .operators = {n * op::shift(24, 24), n * op::subtract(24), n * op::compare(24),
                                op::logic(6 * lanes)},
                  .longest = {op::shift(24, 24), op::subtract(24), op::compare(24), op::logic(4)}}},
      .cost = "walkers = " + std::to_string(lanes) + "."};
}

}  // namespace deburr::rtl::geometric
