// SPDX-License-Identifier: MIT
// coarse_lines: the DepthScreen by itself, what DepthTest makes of what it drops, and the engine
// with both. Memory answers 20 cycles after a request.
#include <algorithm>

#include "rtl_model/geometric/common/sizing.h"
#include "rtl_model/geometric/lines/depth_screen.h"
#include "rtl_model/geometric/lines/depth_test.h"
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
  // A candidate at this pixel, that takes from the given side.
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
  // Inside of line (u, v) of coarse depth.
  static CandidateToken inside(std::uint32_t u, std::uint32_t v) {
    return pixel(64 * u + 13, 32 * v + 13, kUp);
  }
  // Between it and the next one to the right.
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

TEST(DepthScreen, LatencyOfTheDatasheetOrWaitsForALine) {
  ScreenBench b;
  EXPECT_EQ(b.latency(b.ends, ScreenBench::inside(1, 1)), "31");
  b.clock.run(10);
  const std::string there = b.latency(b.ends, ScreenBench::inside(1, 1));
  expect_notices_a_clock(DepthScreen::datasheet(), &rtl::Datasheet::latency,
                         [&](const rtl::Datasheet& sheet) { expect_latency_of(sheet, there); });
  // The second miss comes a clock later.
  EXPECT_EQ(b.latency(b.ends, ScreenBench::across(3, 1)), "32");
  EXPECT_EQ(b.unit.lookups.value(), 4u);
  EXPECT_EQ(b.unit.misses.value(), 3u);
  EXPECT_EQ(b.unit.groups.value(), 3u);
  EXPECT_EQ(b.unit.both_missed.value(), 1u);
}
TEST(DepthScreen, AGroupAClockWhereAtMostOneLookUpMisses) {
  ScreenBench b;
  for (std::uint32_t i = 0; i < 60; ++i) b.ends.source.add(ScreenBench::across(i % 9, i / 9));
  finish(b, b.ends, 60);
  // Of each row of lines the first group misses twice.
  EXPECT_EQ(spread(b.ends), 59 * DepthScreen::datasheet().interval.cycles + 6);
  EXPECT_EQ(b.unit.both_missed.value(), 7u);
}
// N = 4 = 2^2: index (U mod 2) + 2 (V mod 2). N = 8: (U mod 4) + 4 (V mod 2).
TEST(DepthScreen, LinesOfOneIndexReplaceEachOther) {
  struct Row {
    CoarseLines lines;
    std::vector<std::uint64_t> read;
  };
  for (const Row& row : {Row{CoarseLines::k4, {0, 1, 10, 11, 2, 0, 20, 0, 3, 1}},
                         Row{CoarseLines::k8, {0, 1, 10, 11, 2, 20, 0, 3}},
                         Row{CoarseLines::k64, {0, 1, 10, 11, 2, 20, 3}}}) {
    const std::string got = in_child([&] {
      ScreenBench b(coarse(row.lines));
      std::size_t tokens = 0;
      for (const auto& [u, v] : {std::pair{0u, 0u},
                                 {1u, 0u},
                                 {0u, 1u},
                                 {1u, 1u},
                                 {2u, 0u},
                                 {0u, 0u},
                                 {0u, 2u},
                                 {0u, 0u},
                                 {3u, 0u},
                                 {1u, 0u},
                                 {1u, 1u}}) {
        b.ends.source.add(ScreenBench::inside(u, v));
        ++tokens;
      }
      finish(b, b.ends, tokens);
      EXPECT_EQ(b.lines(), row.read);
      return std::string("done");
    });
    EXPECT_EQ(got, "done");
  }
}
TEST(DepthScreen, ARowOfLinesIsAsWideAsTheFrame) {
  for (const auto& [width, across] : {std::pair{576, 9}, {577, 10}, {640, 10}, {641, 11}}) {
    const std::string got = in_child([width = width] {
      ScreenBench b(coarse(), width);
      b.ends.source.add(ScreenBench::inside(0, 1));
      finish(b, b.ends, 1);
      return std::to_string(b.lines()[0]);
    });
    EXPECT_EQ(got, std::to_string(across)) << width;
  }
}
// c = 256 e; dropped below c - (c >> 4).
TEST(DepthScreen, DropsWhatLiesBeforeTheBound) {
  struct Row {
    std::uint32_t entry, depth;
    bool dropped;
  };
  for (const Row& row :
       {Row{0, 0, false}, Row{1, 239, true}, Row{1, 240, false}, Row{0x8000, 0x780000, false},
        Row{0x8000, 0x77FFFF, true}, Row{0xFFFF, 0xFFFF00 - 0xFFFF0, false},
        Row{0xFFFF, 0xFFFF00 - 0xFFFF0 - 1, true}, Row{0xFFFF, 0xFFFFFF, false},
        Row{0xFFFF, 0, true}}) {
    const std::string got = in_child([&] {
      ScreenBench b;
      b.set(3, 2, row.entry);
      for (int i = 0; i < 2; ++i)
        b.ends.source.add(ScreenBench::pixel(27, 20, ScreenBench::kUp, row.depth));
      finish(b, b.ends, 2);
      return b.dropped() + " " + std::to_string(b.unit.dropped.value());
    });
    EXPECT_EQ(got, row.dropped ? "11 2" : "00 0") << row.entry << " " << row.depth;
  }
}
TEST(DepthScreen, TheBiasIsThatOfTheRules) {
  for (const std::int32_t bias : {1, 8, 24}) {
    const std::string got = in_child([bias] {
      Parameters p = coarse();
      p.depth_bias = bias;
      ScreenBench b(p);
      b.set(0, 0, 0xC000);
      const std::uint32_t c = 0xC00000, least = c - (c >> bias);
      b.ends.source.add(ScreenBench::pixel(1, 1, ScreenBench::kUp, least));
      b.ends.source.add(ScreenBench::pixel(1, 1, ScreenBench::kUp, least - 1));
      finish(b, b.ends, 2);
      return b.dropped();
    });
    EXPECT_EQ(got, "01") << bias;
  }
}
// Tile (3, 2) is pixels 24..31, 16..23. Beyond a side of it the lesser of both entries counts,
// inside, and away from that side, its own alone.
TEST(DepthScreen, ANeighbourInAnotherTileCounts) {
  struct Row {
    std::uint32_t x, y;
    ScreenBench::Side side;
    int tile;  // of the neighbour: up, down, left, right of tile (3, 2); -1: its own
  };
  constexpr std::array<std::array<std::uint32_t, 2>, 4> kTiles = {{{3, 1}, {3, 3}, {2, 2}, {4, 2}}};
  for (const Row& row : {Row{26, 16, ScreenBench::kUp, 0}, Row{26, 16, ScreenBench::kDown, -1},
                         Row{26, 17, ScreenBench::kUp, -1}, Row{26, 20, ScreenBench::kUp, -1},
                         Row{26, 23, ScreenBench::kDown, 1}, Row{26, 23, ScreenBench::kUp, -1},
                         Row{26, 19, ScreenBench::kDown, -1}, Row{24, 18, ScreenBench::kLeft, 2},
                         Row{24, 18, ScreenBench::kRight, -1}, Row{24, 18, ScreenBench::kUp, -1},
                         Row{28, 18, ScreenBench::kLeft, -1}, Row{31, 18, ScreenBench::kRight, 3},
                         Row{31, 18, ScreenBench::kLeft, -1}, Row{27, 18, ScreenBench::kRight, -1}})
    for (const bool own_is_lesser : {false, true}) {
      const std::string got = in_child([&] {
        ScreenBench b;
        b.set(3, 2, own_is_lesser ? 100 : 200);
        for (const auto& tile : kTiles) b.set(tile[0], tile[1], 150);
        // Dropped with 200 (48000) and 150 (36000), and with 100 (24000) not.
        for (const std::uint32_t depth : {23999u, 24000u, 35999u, 36000u, 47999u, 48000u})
          b.ends.source.add(ScreenBench::pixel(row.x, row.y, row.side, depth));
        finish(b, b.ends, 6);
        return b.dropped() + " " + text_of(b.unit.dropped_sides) + "; " +
               text_of(b.unit.lesser_tiles);
      });
      const std::string side = std::to_string(static_cast<int>(row.side)) + " x ";
      const std::string wanted = own_is_lesser  ? "100000 " + side + "1; "
                                 : row.tile < 0 ? "111110 " + side + "5; "
                                                : "111000 " + side + "3; ";
      EXPECT_EQ(got, wanted + (row.tile < 0    ? ""
                               : own_is_lesser ? "0 x 6"
                                               : "1 x 6"))
          << row.x << " " << row.y << " side " << row.side;
    }
}
// Groups of one tile and of two, in one line and in two, each after each other one: what the group
// before looked at is of no account, whether its lines were there or came.
TEST(DepthScreen, AGroupHasNothingOfTheOneBefore) {
  struct Row {
    std::uint32_t x;
    ScreenBench::Side side;
    std::uint32_t least;  // entry of its tiles
  };
  // Tile tx has entry 100 (tx - 5). A line is eight tiles; that of tiles 16.. has the index of
  // that of tiles 0...
  const std::vector<Row> rows = {{52, ScreenBench::kUp, 100},      {55, ScreenBench::kRight, 100},
                                 {56, ScreenBench::kLeft, 100},    {60, ScreenBench::kUp, 200},
                                 {63, ScreenBench::kRight, 200},   {64, ScreenBench::kLeft, 200},
                                 {70, ScreenBench::kUp, 300},      {71, ScreenBench::kRight, 300},
                                 {72, ScreenBench::kLeft, 300},    {76, ScreenBench::kUp, 400},
                                 {127, ScreenBench::kRight, 1000}, {128, ScreenBench::kLeft, 1000},
                                 {130, ScreenBench::kUp, 1100}};
  ScreenBench b;
  for (std::uint32_t tx = 6; tx <= 16; ++tx) b.set(tx, 0, 100 * (tx - 5));
  std::string wanted;
  std::size_t tokens = 0;
  const auto add = [&](const Row& row, bool dropped) {
    // 256 e, less a sixteenth of it.
    const std::uint32_t bound = 240 * row.least;
    b.ends.source.add(ScreenBench::pixel(row.x, 1, row.side, dropped ? bound - 1 : bound));
    wanted += dropped ? "1" : "0";
    ++tokens;
  };
  for (const Row& before : rows)
    for (const Row& row : rows) {
      add(before, false);
      add(row, true);
      add(before, true);
      add(row, false);
    }
  finish(b, b.ends, tokens);
  EXPECT_EQ(b.dropped(), wanted);
  EXPECT_GT(b.unit.misses.value(), 100u);
  EXPECT_LT(b.unit.misses.value(), b.unit.lookups.value() / 2);
}
// depth_test = own looks at no neighbour's tile; off at none, and drops nothing.
TEST(DepthScreen, TilesByTheRuleOfTheTest) {
  for (const auto& [test, wanted] : {std::pair{spec::geometric::DepthTest::kOwn, "1 1 1"},
                                     {spec::geometric::DepthTest::kFarther, "0 2 2"},
                                     {spec::geometric::DepthTest::kOff, "0 0 0"}}) {
    const std::string got = in_child([test = test] {
      Parameters p = coarse();
      ScreenBench b(p);
      rtl::geometric::FrameConfiguration configuration = decode(b.control);
      configuration.depth_test = test;
      b.configuration.drive(b.clock.cycle() - 1, configuration);
      b.set(7, 1, 1000);
      b.ends.source.add(ScreenBench::pixel(63, 12, ScreenBench::kRight, 5));
      finish(b, b.ends, 1);
      return b.dropped() + " " + std::to_string(b.unit.lookups.value()) + " " +
             std::to_string(b.memory.reads());
    });
    EXPECT_EQ(got, wanted);
  }
}
// Each lane by itself; second candidates go with the first of their column; what is no candidate is
// not dropped.
TEST(DepthScreen, EachLaneByItself) {
  ScreenBench b;
  b.set(0, 0, 0x1000);
  CandidateToken group = ScreenBench::pixel(0, 0, ScreenBench::kDown);
  group.candidates = 0b1011;
  group.forward = 0b1111;
  group.seconds = 0b0011;
  group.place = {4, 5, 6, 7};
  group.depth = {0, 0xFFFFFF, 0, 0};
  b.ends.source.add(group);
  CandidateToken end{};
  end.end = true;
  b.ends.source.add(end);
  finish(b, b.ends, 2);
  const CandidateToken& out = b.ends.sink.taken[0].token;
  EXPECT_EQ(out.dropped, 0b1001);
  EXPECT_EQ(out.candidates, group.candidates);
  EXPECT_EQ(out.seconds, group.seconds);
  EXPECT_EQ(out.depth, group.depth);
  EXPECT_EQ(b.unit.dropped.value(), 3u);
  EXPECT_TRUE(b.ends.sink.taken[1].token.end);
  EXPECT_EQ(b.unit.groups.value(), 1u);
}
TEST(DepthScreen, CountsWhatIsKeptJustAtTheBound) {
  ScreenBench b;
  b.set(0, 0, 16);  // 4096 - 256
  for (const std::uint32_t depth : {3839u, 3840u, 3841u, 3840u, 3840u})
    b.ends.source.add(ScreenBench::pixel(1, 1, ScreenBench::kUp, depth));
  finish(b, b.ends, 5);
  EXPECT_EQ(b.unit.kept_at_bound.value(), 3u);
  EXPECT_EQ(b.unit.dropped.value(), 1u);
}
TEST(DepthScreen, StallsByCause) {
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

// ---- DepthTest after it

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
// They look nothing up, do not pass, and are observed in the order of all.
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
TEST(DepthTest, AGroupThatIsDroppedTakesAClock) {
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

// ---- the engine

// By the tables of docs/reference/geometric/memory.md, of its two units.
TEST(MemoriesOfLessTraffic, AreThoseOfThePage) {
  Parameters p = coarse(CoarseLines::k64);
  p.records = spec::geometric::RecordsLayout::kSplit;
  EngineBench b(p);
  std::string text;
  for (const rtl::MemoryBase* memory : b.engine.memories()) {
    const std::string name = std::string(memory->name()).substr(std::string("engine.").size());
    if (name.rfind("pair_fetch.", 0) != 0 && name.rfind("depth_screen.", 0) != 0) continue;
    text += name + " " + rtl::name_of(memory->memory_kind()) + " " +
            std::to_string(memory->words()) + " x " + std::to_string(memory->word_bits()) + " " +
            (name.ends_with("fifo") ? "FIFO" : memory->ports()) + "\n";
  }
  EXPECT_EQ(text, R"(pair_fetch.pair_tags flops 2 x 22 1R1W
pair_fetch.pair_lines flops 2 x 480 1R1W
pair_fetch.pair_fills sram 108 x 480 1R1W
pair_fetch.latency_fifo sram 128 x 9 FIFO
depth_screen.coarse_tags flops 64 x 16 2R1W
depth_screen.coarse_lines sram 64 x 512 2R1W
depth_screen.coarse_fills sram 108 x 512 1R1W
depth_screen.latency_fifo sram 128 x 243 FIFO
)");
}

TEST(CoarseTest, ChangesNoPixel) {
  for (const char name : {'a', 'b', 'd', 'g', 'm'})
    for (const char* const lines : {"4", "64"}) {
      const std::string got = in_child([&] {
        Configuration c = configuration(name);
        apply_settings(c.p, std::string("coarse_lines=") + lines);
        Scene scene = contract_scene();
        // What is near hides much.
        for (std::size_t i = 0; i < scene.depths.size(); ++i)
          scene.depths[i] = std::max(scene.depths[i], i % 61 < 32 ? 9'000'000u : 0u);
        std::string text;
        for (const bool screened : {false, true}) {
          Parameters p = c.p;
          if (!screened) p.coarse_lines = CoarseLines::kNone;
          const std::string one = in_child([&] {
            EngineBench b(p);
            b.load(scene);
            for (int frame = 0; frame < 2; ++frame) {
              b.load_frame(scene);
              b.run();
            }
            if (screened) {
              EXPECT_GT(b.engine.depth_screen->dropped.value(), 100u);
              EXPECT_GT(b.reads(b.bases.coarse).size(), 0u);
            }
            const spec::geometric::Work work = b.engine.work();
            return std::to_string(b.pixel_hash()) + " " + std::to_string(b.weight_hash()) + " " +
                   std::to_string(work.candidates) + " " + std::to_string(work.passed);
          });
          if (!screened)
            text = one;
          else if (one != text)
            return one + ", not " + text;
        }
        return std::string("same");
      });
      EXPECT_EQ(got, "same") << name << ", " << lines;
    }
}

}  // namespace
}  // namespace deburr::tb::geometric_rtl::screen_test
