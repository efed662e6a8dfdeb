// SPDX-License-Identifier: MIT
// coarse_lines: the DepthScreen on its own, and DepthTest with candidates that it dropped. Memory
// responds 20 cycles after a request.
#include <algorithm>

#include "golden/geometric/coarse.h"
#include "rtl_model/geometric/common/sizing.h"
#include "rtl_model/geometric/lines/depth_screen.h"
#include "rtl_model/geometric/lines/depth_test.h"
#include "tb/base/random.h"
#include "tb/unit/rtl/geometric/parts.h"

namespace deburr::tb::geometric_rtl::screen_test {
namespace {

using namespace rtl::geometric;  // NOLINT: names of units and tokens
using spec::geometric::CoarseLines;

Parameters coarse(CoarseLines lines = CoarseLines::k4) {
  Parameters p;
  p.coarse_lines = lines;
  p.depth_bias = 4;
  return p;
}

constexpr std::uint32_t kBase = 0x10000;

// A frame of 610 x 512 pixels: 77 x 64 tiles, 10 x 16 lines.
struct ScreenBench : Frame {
  explicit ScreenBench(const Parameters& p = coarse(), int width = 610)
      : Frame(p), unit("unit", clock, sized(p, {20, 1})), ends(clock) {
    arbiter.connect(Client::kCoarse, unit.memory);
    unit.configuration_in(configuration);
    unit.phase_in(phase);
    unit.candidates_in(ends.in);
    unit.screened_out(ends.out);
    bus.write(reg::kCoarseBase, kBase);
    begin(width, 512);
  }
  void set(std::uint32_t tx, std::uint32_t ty, std::uint32_t entry) {
    const std::uint32_t at = kBase + 64 * (ty / 4 * 10 + tx / 8) + 2 * (8 * (ty % 4) + tx % 8);
    memory.preload(at, std::vector<std::uint8_t>{static_cast<std::uint8_t>(entry),
                                                 static_cast<std::uint8_t>(entry >> 8)});
  }
  // A candidate at this pixel that takes from the given side.
  enum Side { kUp, kDown, kLeft, kRight };
  static CandidateToken pixel(std::uint32_t x, std::uint32_t y, Side side,
                              std::uint32_t depth = 0) {
    CandidateToken token{};
    token.block_x = static_cast<std::uint16_t>(x / 4);
    token.block_y = static_cast<std::uint16_t>(y / 4);
    token.vertical = side >= kLeft;
    token.candidates = 1;
    token.forward = side & 1;
    token.place[0] = static_cast<std::uint8_t>(4 * (y % 4) + x % 4);
    token.depth[0] = depth;
    return token;
  }
  // A candidate inside the line (u, v) of coarse depth.
  static CandidateToken inside(std::uint32_t u, std::uint32_t v) {
    return pixel(64 * u + 13, 32 * v + 13, kUp);
  }
  // A candidate whose neighbour is in the next line to the right.
  static CandidateToken across(std::uint32_t u, std::uint32_t v) {
    return pixel(64 * u + 63, 32 * v + 13, kRight);
  }
  std::string dropped() const {
    std::string text;
    for (const auto& each : ends.sink.taken)
      text += std::to_string(static_cast<int>(each.token.dropped));
    return text;
  }
  std::vector<std::uint64_t> lines() const {
    std::vector<std::uint64_t> all;
    for (const std::uint64_t line : memory.lines_read()) all.push_back((line - kBase) / 64);
    return all;
  }
  DepthScreen unit;
  Ends<CandidateToken, CandidateToken> ends;
};

TEST(DepthScreen, LatencyMatchesDatasheetUnlessALineIsMissing) {
  ScreenBench b;
  EXPECT_EQ(b.latency(b.ends, ScreenBench::inside(1, 1)), "31");
  b.clock.run(10);
  const std::string hit_latency = b.latency(b.ends, ScreenBench::inside(1, 1));
  expect_detects_one_cycle(
      DepthScreen::datasheet(), &rtl::Datasheet::latency,
      [&](const rtl::Datasheet& sheet) { expect_latency_of(sheet, hit_latency); });
  // The second miss comes one cycle later.
  EXPECT_EQ(b.latency(b.ends, ScreenBench::across(3, 1)), "32");
  EXPECT_EQ(b.unit.lookups.value(), 4u);
  EXPECT_EQ(b.unit.misses.value(), 3u);
  EXPECT_EQ(b.unit.groups.value(), 3u);
  EXPECT_EQ(b.unit.both_missed.value(), 1u);
}
TEST(DepthScreen, OneGroupPerCycleWithAtMostOneMiss) {
  ScreenBench b;
  for (std::uint32_t i = 0; i < 60; ++i) b.ends.source.add(ScreenBench::across(i % 9, i / 9));
  finish(b, b.ends, 60);
  // The first group of each row of lines misses twice.
  EXPECT_EQ(spread(b.ends), 59 * DepthScreen::datasheet().interval.cycles + 6);
  EXPECT_EQ(b.unit.both_missed.value(), 7u);
}
// Candidates inside tiles and at each side of them, with depths at the bound and next to it, for
// every test and bias. Also compares the lines that are read for them, with few and with many lines
// of cache.
TEST(DepthScreen, DropsMatchGolden) {
  using spec::geometric::DepthTest;
  namespace gold = golden::geometric;
  for (const auto& [lines, bits] :
       {std::pair{CoarseLines::k4, 2}, {CoarseLines::k8, 3}, {CoarseLines::k64, 6}}) {
    const std::string got = in_child([lines = lines, bits = bits] {
      Parameters p = coarse(lines);
      ScreenBench b(p);
      const gold::CoarseLayout layout(610, 512);
      gold::DirectMapped cache;
      cache.reset(bits, gold::block_column_bits(bits));
      Random random(static_cast<std::uint64_t>(bits), "tiles");
      std::vector<std::uint16_t> entries;
      for (std::uint32_t ty = 0; ty < 64; ++ty)
        for (std::uint32_t tx = 0; tx < 77; ++tx) {
          entries.push_back(static_cast<std::uint16_t>(
              random.chance(100) ? 0xFFFF : random.word() >> random.between(16, 31)));
          b.set(tx, ty, entries.back());
        }
      FrameConfiguration configuration = decode(b.control);
      rtl::Histogram sides("sides", "side", "expected"), lesser("lesser", "tile", "expected");
      std::vector<CandidateToken> wanted;
      std::vector<std::uint64_t> read;
      std::uint64_t dropped = 0, at_bound = 0, groups = 0, lookups = 0;
      for (int rule = 0; rule < 72; ++rule) {
        p.depth_test = static_cast<DepthTest>(rule % 3);
        p.depth_bias = 1 + rule / 3;
        configuration.depth_test = p.depth_test;
        configuration.depth_bias = static_cast<std::uint32_t>(p.depth_bias);
        b.configuration.drive(b.clock.cycle() - 1, configuration);
        const int bx = random.between(1, 140), by = random.between(1, 116);
        for (int i = 0; i < 40; ++i) {
          const bool vertical = random.chance(500);
          CandidateToken token{};
          token.block_x = static_cast<std::uint16_t>(bx + random.between(0, 11));
          token.block_y = static_cast<std::uint16_t>(by + random.between(0, 11));
          token.vertical = vertical;
          token.candidates = static_cast<std::uint8_t>(random.between(1, 15));
          token.forward = static_cast<std::uint8_t>(random.below(16));
          token.seconds = static_cast<std::uint8_t>(token.candidates & random.below(16));
          std::uint8_t drops = 0;
          std::vector<gold::LineOfPixels> looked;
          const auto look_up = [&](const gold::CoarseLayout::Tile& tile) {
            const gold::LineOfPixels line = gold::CoarseLayout::line_of(tile);
            if (std::find(looked.begin(), looked.end(), line) != looked.end()) return;
            looked.push_back(line);
            std::uint64_t replaced = 0;
            if (!cache.look_up(line.u, line.v, replaced))
              read.push_back(layout.offset_of(line) / 64);
          };
          for (unsigned lane = 0; lane < 4; ++lane) {
            const int place = random.between(0, 15), step = token.forward >> lane & 1 ? 1 : -1,
                      x = 4 * token.block_x + place % 4, y = 4 * token.block_y + place / 4;
            const auto own = gold::CoarseLayout::tile_of(x, y),
                       other = gold::CoarseLayout::tile_of(x + (vertical ? step : 0),
                                                           y + (vertical ? 0 : step));
            const bool two = p.depth_test == DepthTest::kFarther && other != own;
            const std::uint16_t first = entries[layout.index_of(own)],
                                second = two ? entries[layout.index_of(other)] : first,
                                entry = std::min(first, second);
            const std::uint32_t c = 256u * entry, least = c - (c >> p.depth_bias);
            token.place[lane] = static_cast<std::uint8_t>(place);
            token.depth[lane] = std::min(0xFFFFFFu, std::max(2u, least + random.below(5)) - 2);
            if (p.depth_test == DepthTest::kOff || !(token.candidates >> lane & 1)) continue;
            look_up(own);
            if (two) look_up(other);
            at_bound += entry != 0 && token.depth[lane] == least;
            if (two) lesser.record(first < second ? 0 : first > second ? 1 : 2);
            if (!gold::is_dropped(p, token.depth[lane], entry)) continue;
            drops |= static_cast<std::uint8_t>(1u << lane);
            dropped += 1 + (token.seconds >> lane & 1);
            sides.record(2u * vertical + (token.forward >> lane & 1));
          }
          groups += !looked.empty();
          lookups += looked.size();
          b.ends.source.add(token);
          token.dropped = drops;
          wanted.push_back(token);
        }
        finish(b, b.ends, wanted.size());
      }
      for (std::size_t i = 0; i < wanted.size(); ++i)
        EXPECT_EQ(rtl::payload_difference(wanted[i], b.ends.sink.taken.at(i).token), "") << i;
      EXPECT_EQ(b.lines(), read);
      EXPECT_EQ(b.unit.dropped.value(), dropped);
      EXPECT_EQ(b.unit.kept_at_bound.value(), at_bound);
      EXPECT_EQ(b.unit.groups.value(), groups);
      EXPECT_EQ(b.unit.lookups.value(), lookups);
      EXPECT_EQ(b.unit.misses.value(), read.size());
      EXPECT_EQ(text_of(b.unit.dropped_sides), text_of(sides));
      EXPECT_EQ(text_of(b.unit.lesser_tiles), text_of(lesser));
      return std::string("compared");
    });
    EXPECT_EQ(got, "compared") << bits;
  }
}
TEST(DepthScreen, StallsAreCountedByCause) {
  ScreenBench b;
  b.latency(b.ends, ScreenBench::inside(0, 0));
  EXPECT_EQ(stalls(b.unit, "coarse"), 26u - 1) << "an answer is taken in one of them";
  const Cycle from = b.clock.cycle();
  b.ends.sink.hold_from = from;
  b.ends.sink.hold_to = from + 50;
  for (int i = 0; i < 20; ++i) b.ends.source.add(ScreenBench::inside(0, 0));
  finish(b, b.ends, 21);
  EXPECT_GT(stalls(b.unit, "downstream"), 20u);
  EXPECT_EQ(b.ends.sink.taken.back().cycle, from + 50 + 19) << "a clock each, from then on";
  EXPECT_EQ(stalls(b.unit, "fills"), 0u);
}

// ---- DepthTest after the screen

struct AfterScreen : Frame {
  AfterScreen()
      : Frame(coarse()), unit("unit", clock, sized(coarse(), {}), edge_latency), ends(clock) {
    arbiter.connect(Client::kDepth, unit.memory);
    unit.configuration_in(configuration);
    unit.candidates_in(ends.in);
    unit.weights_out(ends.out);
    unit.phase_in(phase);
    wire(unit.cleared_out, &sequencer.depth_cleared_in);
    unit.observer = [this](const spec::geometric::Candidate& c) {
      seen += std::to_string(c.x) + (c.passed ? "+ " : "- ");
    };
    begin(256, 256);
  }
  rtl::geometric::DepthTest unit;
  Ends<CandidateToken, WeightToken> ends;
  std::string seen;
};
// Dropped candidates are not looked up and do not pass; the observer sees all candidates in order.
TEST(DepthTest, DroppedCandidatesDoNotPass) {
  AfterScreen b;
  CandidateToken group = ScreenBench::pixel(8, 9, ScreenBench::kDown);
  group.candidates = 0b1111;
  group.forward = 0b1111;
  group.place = {4, 5, 6, 7};
  group.dropped = 0b0101;
  b.ends.source.add(group);
  b.clock.run(60);
  ASSERT_EQ(b.ends.sink.taken.size(), 1u);
  EXPECT_EQ(b.ends.sink.taken[0].token.candidates, 0b1010);
  EXPECT_EQ(b.seen, "8- 9+ 10- 11+ ");
  EXPECT_EQ(b.unit.lookups.value(), 1u);
  EXPECT_EQ(b.unit.passed.value(), 2u);
}
TEST(DepthTest, DroppedGroupTakesOneCycle) {
  AfterScreen b;
  CandidateToken kept = ScreenBench::pixel(8, 9, ScreenBench::kDown), dropped = kept;
  dropped.dropped = 1;
  b.ends.source.add(kept);
  for (int i = 0; i < 30; ++i) b.ends.source.add(dropped);
  b.ends.source.add(kept);
  b.clock.run(100);
  ASSERT_EQ(b.ends.sink.taken.size(), 2u);
  EXPECT_EQ(spread(b.ends), 31u);
  EXPECT_EQ(b.unit.lookups.value(), 2u);
  EXPECT_EQ(b.memory.reads(), 1u);
}

}  // namespace
}  // namespace deburr::tb::geometric_rtl::screen_test
