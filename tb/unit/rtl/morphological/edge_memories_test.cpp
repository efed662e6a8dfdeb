// SPDX-License-Identifier: MIT
// Edge memories: shared ports, reads at borders, and rejection of reads that are too many, too
// early or too late. Steps are compared with the golden model line by line.
#include "tb/unit/rtl/morphological/edge_memories.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "rtl_model/morphological/runs/port_schedule.h"
#include "tb/base/random.h"
#include "tb/unit/rtl/morphological/parts.h"
#include "tb/unit/rtl/morphological/support.h"

namespace deburr::tb::morphological_rtl::edge_memories_test {
namespace {

using namespace rtl::morphological;  // NOLINT: a test of these
using spec::morphological::Lanes;
using spec::morphological::Preset;

Parameters built(bool contiguous, int search_rows = 32, int search_columns = 256) {
  Parameters p = preset(Preset::kDeburrLine, search_rows, search_columns);
  p.contiguous = contiguous;
  return p;
}

// Memories with random edges of a frame of 70 rows, at the time when row 30 has been found.
struct Shown {
  Shown(const Parameters& p, int width, std::uint32_t permille)
      : configuration(Registers(p, width, 70).configuration.driven()), memories(p) {
    Random random(permille);
    const auto edge = [&](int, int) { return random.chance(permille); };
    memories.show(configuration, 30, edge, edge);
  }
  const FrameConfiguration configuration;
  EdgeMemories memories;
};

struct Sharing {
  int trial_cycles, units, lanes_code, ports;
};
void PrintTo(const Sharing& s, std::ostream* out) {
  *out << s.trial_cycles << ' ' << s.units << ' ' << s.lanes_code;
}
class Schedule : public ::testing::TestWithParam<Sharing> {};

// Each predictor has two reads per trial, no two share a port in one cycle, and there are no more
// ports than needed. The left side reads in the cycle of the right one or in the next.
TEST_P(Schedule, EachReadHasItsOwnPhaseAndPort) {
  const Sharing s = GetParam();
  Parameters p = built(true);
  p.trial_cycles = s.trial_cycles;
  p.predictor_units = s.units;
  p.lanes = static_cast<Lanes>(s.lanes_code);
  const PortSchedule schedule(p);
  const int predictors = s.units * lanes_of(p);
  EXPECT_EQ(schedule.ports(), s.ports);
  EXPECT_LT((schedule.ports() - 1) * s.trial_cycles, 2 * predictors);
  std::set<std::pair<int, int>> places;
  for (int i = 0; i < predictors; ++i)
    for (const int side : {0, 1}) {
      const int phase = schedule.phase(i, side), port = schedule.port(i, side);
      EXPECT_LT(phase, s.trial_cycles);
      EXPECT_LT(port, s.ports);
      EXPECT_TRUE(places.emplace(phase, port).second) << i;
      const int after = phase - schedule.phase(i, 0);
      EXPECT_TRUE(after == 0 || (after == 1 && side == 1));
      for (const Cycle from : {Cycle{0}, Cycle{7}, Cycle{1'000'003}}) {
        const Cycle wait = schedule.wait(from, phase);
        EXPECT_EQ((from + wait) % static_cast<Cycle>(s.trial_cycles), static_cast<Cycle>(phase));
        EXPECT_LT(wait, static_cast<Cycle>(s.trial_cycles));
      }
    }
}
INSTANTIATE_TEST_SUITE_P(Builds, Schedule,
                         ::testing::Values(Sharing{4, 2, 0, 1}, Sharing{4, 1, 0, 1},
                                           Sharing{4, 4, 0, 2}, Sharing{4, 2, 1, 2},
                                           Sharing{4, 2, 2, 4}, Sharing{1, 2, 0, 4},
                                           Sharing{2, 1, 0, 1}, Sharing{3, 4, 0, 3},
                                           Sharing{8, 4, 0, 1}, Sharing{5, 3, 2, 5}));

TEST(EdgeMemory, BuiltFromOneCopyPerReadPort) {
  Parameters p = built(true);
  p.line_pixels = 1920;
  EngineBench bench(p);
  const auto& window = bench.engine.window.memory;
  EXPECT_EQ(window.memory_kind(), rtl::MemoryKind::kSram);
  EXPECT_EQ(window.ports(), "2R1W of 2 words");
  EXPECT_EQ(window.logical_bits(), 257'280u);
  EXPECT_EQ(window.physical_bits(), 2u * 257'280u);
  EXPECT_EQ(window.bits_at(960), 257'280u / 2);
  for (const auto& rows : bench.engine.rows.memory) {
    EXPECT_EQ(rows.memory_kind(), rtl::MemoryKind::kSram);
    EXPECT_EQ(rows.ports(), "1R1W of 4 words");
    EXPECT_EQ(rows.logical_bits(), 18u * 30u * 128u);
    EXPECT_EQ(rows.physical_bits(), rows.logical_bits());
    EXPECT_EQ(rows.bits_at(960), rows.logical_bits() / 2);
    EXPECT_EQ(rows.banks(), 4u);  // 130 columns may lie in four words
  }
}

// The text names the memory and the cause.
template <class Access>
void expect_stop(Access&& access, const std::string& text) {
  try {
    access();
    ADD_FAILURE() << "no error";
  } catch (const spec::CheckFailed& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr(text));
  }
}

TEST(EdgeMemory, OneAccessTooManyPerCycleStops) {
  Shown shown(built(true), 150, 500);
  EdgeWindow& window = shown.memories.window;
  EdgeRows& rows = shown.memories.rows;
  Trial across{40, 30, 3, 20, true, 2, 1}, along{31, 40, 3, 20, true, 2, 1};
  for (const Cycle cycle : {Cycle{7}, Cycle{8}, Cycle{100}}) {
    window.read(cycle, shown.configuration, 0, across);
    expect_stop([&] { window.read(cycle, shown.configuration, 0, across); }, "edge_window");
    rows.read(cycle, shown.configuration, 0, along);
    expect_stop([&] { rows.read(cycle, shown.configuration, 0, along); }, "edge_rows");
    window.read_beat(cycle, shown.configuration, 5);
    expect_stop([&] { window.read_beat(cycle, shown.configuration, 6); }, "edge_window");
  }
}

TEST(EdgeMemory, WordArrivesOneCycleAfterItsRead) {
  Shown shown(built(true), 150, 500);
  EdgeWindow& window = shown.memories.window;
  EdgeRows& rows = shown.memories.rows;
  Trial across{40, 30, 3, 20, true, 2, 1}, along{31, 40, 3, 20, true, 2, 1};
  // Nothing has been read yet.
  expect_stop([&] { window.hits(7, shown.configuration, 0, across); }, "edge_window");
  expect_stop([&] { rows.hits(7, shown.configuration, 0, along); }, "edge_rows");
  window.read(7, shown.configuration, 0, across);
  rows.read(7, shown.configuration, 0, along);
  expect_stop([&] { window.hits(7, shown.configuration, 0, across); }, "edge_window");
  expect_stop([&] { rows.hits(7, shown.configuration, 0, along); }, "edge_rows");
  EXPECT_NO_THROW(window.hits(8, shown.configuration, 0, across));
  EXPECT_NO_THROW(rows.hits(8, shown.configuration, 0, along));
  // A read issued too late leaves the previous word on the port.
  Trial next_across{60, 30, 3, 20, true, 2, 1}, next_along{33, 140, 3, 20, true, 2, 1};
  window.read(9, shown.configuration, 0, next_across);
  rows.read(9, shown.configuration, 0, next_along);
  expect_stop([&] { window.hits(9, shown.configuration, 0, next_across); }, "edge_window");
  expect_stop([&] { rows.hits(9, shown.configuration, 0, next_along); }, "edge_rows");
  // The new word has replaced the old one.
  expect_stop([&] { window.hits(10, shown.configuration, 0, across); }, "edge_window");
  expect_stop([&] { rows.hits(10, shown.configuration, 0, along); }, "edge_rows");
  EXPECT_NO_THROW(window.hits(10, shown.configuration, 0, next_across));
  EXPECT_NO_THROW(rows.hits(10, shown.configuration, 0, next_along));
}

// The window holds the last window_rows + 1 rows of a column; it is one row further where the beats
// of a new row have passed. Reading any other row is an error of the reader.
TEST(EdgeMemory, WindowTracksItsRows) {
  constexpr int kRows = 2 * 8 + 3;
  Shown shown(built(false, 8, 60), 150, 500);
  EdgeWindow& window = shown.memories.window;
  // All columns hold rows up to 30 + 8 + 1; of the next row the first 40 columns have come.
  const int newest = 30 + 8 + 1;
  Cycle cycle = Cycle{1} << 50;
  for (int x = 0; x < 40; ++x) {
    window.read_beat(cycle++, shown.configuration, x);
    window.write_beat(cycle++, shown.configuration, x, newest + 2, {});
  }
  // The corner of row y reads rows y and y - 1. Both columns of line 39 have come, but only the
  // left column of line 40.
  for (const auto& [line, latest] :
       {std::pair{1, newest + 1}, {39, newest + 1}, {40, newest}, {41, newest}, {150, newest}}) {
    const auto ask = [&, line = line](int y) {
      Trial trial{line, y - 3, 3, 20, true, 0, 0};
      // Only L is tried; its corner is row y.
      trial.length = 2;
      trial.room = 1;
      trial.from = y - 1;
      window.read(++cycle, shown.configuration, 0, trial);
      return window.hits(++cycle, shown.configuration, 0, trial);
    };
    EXPECT_NO_THROW(ask(latest)) << line;
    EXPECT_NO_THROW(ask(latest - kRows + 2)) << line;
    const int above = latest + 1;
    const int below = latest - kRows + 1;
    expect_stop([&] { ask(above); }, "is not among the last " + std::to_string(kRows) +
                                         " rows, up to row " + std::to_string(latest));
    expect_stop([&] { ask(below); }, "row " + std::to_string(below - 1) + " is not among");
  }
}

// With every edge set, a step can go along any line except the frame's right border. Only the edges
// across that border exist, so there is no line to follow for any corners.
TEST(EdgeMemory, NoStepRunsAlongRightBorder) {
  constexpr int kWidth = 150;
  constexpr std::uint8_t kAll = kBeforeBit | kAfterBit | kFirstBit | kSecondBit;
  Shown shown(built(true), kWidth, 1000);
  EdgeWindow& window = shown.memories.window;
  Cycle cycle = 0;
  for (const bool right : {false, true})
    for (const int length : {1, 2, 7}) {
      const auto hits = [&](int line, std::uint8_t corner) {
        Trial trial{line, 30, length, 20, right, corner, corner};
        window.read(++cycle, shown.configuration, 0, trial);
        return window.hits(++cycle, shown.configuration, 0, trial);
      };
      EXPECT_EQ(hits(kWidth - 1, kAll), kEqual | kLonger | (length > 1 ? kShorter : 0));
      EXPECT_EQ(hits(kWidth, kAll), 0);
      EXPECT_EQ(hits(kWidth, kFirstBit), 0) << "its corners are as they are";
    }
}

// A port returns enough words for the longest step, and for a class on top of it. 125 columns per
// side need steps of 62 and 63, 65 columns with the corner's own, starting at the last column of a
// word; 126 need no more; 127 need steps of 63 and 64.
TEST(EdgeMemory, LongestStepFitsTheWordsOfAPort) {
  struct Longest {
    int search_range;
    bool learned;
  };
  for (const auto [search_range, learned] :
       {Longest{125, false}, Longest{126, false}, Longest{127, false}, Longest{127, true}})
    for (const bool right : {false, true}) {
      Parameters p =
          learned ? preset(Preset::kDeburr, 32, search_range) : built(true, 32, search_range);
      p.contiguous = !learned;
      p.line_pixels = 256;
      Shown shown(p, 256, 1000);
      EdgeRows& rows = shown.memories.rows;
      const int length = search_range / 2, room = search_range - length;
      for (int from = 62 + 65; from < 62 + 65 + 64; ++from) {
        Trial trial{31, right ? from - 62 : from, length, room, right, 3, 3};
        trial.classes = learned;
        const Cycle cycle = (Cycle{1} << 50) + 2 * static_cast<Cycle>(from) + (right ? 1000 : 0);
        EXPECT_NO_THROW(rows.read(cycle, shown.configuration, 0, trial))
            << search_range << ' ' << from;
        EXPECT_NO_THROW(rows.hits(cycle + 1, shown.configuration, 0, trial))
            << search_range << ' ' << from;
        EXPECT_LE(trial.last - trial.first + 1, (search_range + 1) / 2 + 2);
      }
    }
}

// If the edges of a step need not all be set, only the corners of its three candidates are read:
// four columns.
TEST(EdgeMemory, StepReadsTheFourColumnsAtItsEnd) {
  Shown shown(built(false), 150, 500);
  Cycle cycle = 0;
  for (const bool right : {false, true})
    for (const int length : {1, 2, 3, 40}) {
      Trial trial{31, 75, length, 60, right, 3, 3};
      shown.memories.rows.read(++cycle, shown.configuration, 0, trial);
      const int from = right ? 75 + length - 2 : 75 - length - 2;
      EXPECT_EQ(trial.first, from) << length;
      EXPECT_EQ(trial.last, from + 3) << length;
    }
}

// Three edges up to the frame's border and a crossing that ends there: class 2 + 3, whatever word
// the port has returned earlier for the columns beyond.
TEST(EdgeMemory, ClassEndsAtTheFrameBorder) {
  constexpr int kWidth = 128, kFrom = kWidth - 3;
  Shown shown(preset(Preset::kDeburr), kWidth, 0);
  EdgeRows& rows = shown.memories.rows;
  shown.memories.show(
      shown.configuration, 30, [](int, int) { return false; },
      [](int x, int y) { return y == 31 && (x == 64 || x >= kFrom); });
  Cycle cycle = 0;
  for (int i = 0; i < 8; ++i) {
    Trial both{31, 60, 3, 20, true, 3, 3};
    both.classes = true;
    rows.read(++cycle, shown.configuration, 0, both);  // words 0 and 1
    ASSERT_TRUE(both.first < 64 && both.last >= 64);
  }
  Trial last{31, kFrom, 3, 20, true, 3, 3};
  last.tries = false;
  last.crossing = kFirstBit;
  last.classes = true;
  last.looks = kMostLooks;
  rows.read(++cycle, shown.configuration, 0, last);
  EXPECT_EQ(rows.crossing_class(cycle + 1, shown.configuration, 0, last), 2 + 3);
}

// All edges of a step that ends in the newest row lie in the rows above it.
TEST(EdgeMemory, StepMayEndInTheNewestRow) {
  constexpr int kNewest = 30 + 8 + 1;
  constexpr std::uint8_t kAll = kBeforeBit | kAfterBit | kFirstBit | kSecondBit;
  Shown shown(built(true, 8, 60), 150, 1000);
  // Steps of two and of three; a longer one exceeds the search range.
  Trial trial{40, kNewest - 3, 3, 3, true, kAll, kAll};
  shown.memories.window.read(1, shown.configuration, 0, trial);
  EXPECT_EQ(shown.memories.window.hits(2, shown.configuration, 0, trial), kShorter | kEqual);
}

TEST(EdgeMemory, BeatIsWrittenOneCycleAfterItsRead) {
  Shown shown(built(true), 150, 500);
  EdgeWindow& window = shown.memories.window;
  window.read_beat(7, shown.configuration, 5);
  expect_stop([&] { window.write_beat(7, shown.configuration, 5, 64, {}); }, "edge_window");
  EXPECT_NO_THROW(window.write_beat(8, shown.configuration, 5, 64, {}));
  expect_stop([&] { window.write_beat(9, shown.configuration, 6, 64, {}); }, "edge_window");
}

// There are no more ports than needed: the busiest cycle uses all of them.
struct Built {
  int lanes_code, units, trial_cycles;
  bool contiguous;
};
void PrintTo(const Built& b, std::ostream* out) { *out << b.lanes_code << ' ' << b.units; }
class BusiestCycle : public ::testing::TestWithParam<Built> {};
TEST_P(BusiestCycle, BusiestCycleUsesEveryPort) {
  Parameters p = built(GetParam().contiguous);
  p.lanes = static_cast<Lanes>(GetParam().lanes_code);
  p.predictor_units = GetParam().units;
  p.trial_cycles = GetParam().trial_cycles;
  EngineBench bench(p);
  const Frame in = draw(96, 80, [](int x, int y) { return grey((x + y) / 2 % 2 != 0 ? 255 : 0); });
  bench.send(in);
  const auto& window = bench.engine.window.memory;
  const auto& rows = bench.engine.rows.memory;
  std::uint64_t window_before = 0, rows_before[2] = {}, most_window = 0, most_rows = 0;
  bench.finish([&] {
    most_window = std::max(most_window, window.reads() - window_before);
    window_before = window.reads();
    for (std::size_t i = 0; i < 2; ++i) {
      most_rows = std::max(most_rows, rows[i].reads() - rows_before[i]);
      rows_before[i] = rows[i].reads();
    }
  });
  EXPECT_EQ(most_window, window.shape().read_ports);
  EXPECT_EQ(most_rows, rows[0].shape().read_ports);
}
INSTANTIATE_TEST_SUITE_P(Builds, BusiestCycle,
                         ::testing::Values(Built{0, 2, 4, true}, Built{1, 2, 4, true},
                                           Built{2, 2, 4, true}, Built{0, 1, 4, false},
                                           Built{0, 4, 4, true}, Built{2, 1, 4, false},
                                           Built{0, 2, 1, true}, Built{0, 3, 3, true}));

}  // namespace
}  // namespace deburr::tb::morphological_rtl::edge_memories_test
