// SPDX-License-Identifier: MIT
// The memories of edges: what they show, their ports shared in time, and that nobody reads too
// much, too early or too late.
#include "tb/unit/rtl/morphological/edge_memories.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "rtl_model/morphological/runs/port_schedule.h"
#include "tb/base/forked.h"
#include "tb/base/random.h"
#include "tb/unit/rtl/morphological/support.h"

namespace deburr::tb::morphological_rtl::edge_memories_test {
namespace {

using namespace rtl::morphological;  // NOLINT: a test of these
using spec::morphological::Axis;
using spec::morphological::Lanes;
using spec::morphological::Preset;

Parameters built(bool contiguous, int search_rows = 32, int search_columns = 256) {
  Parameters p = preset(Preset::kDeburrLine, search_rows, search_columns);
  p.contiguous = contiguous;
  return p;
}

// Memories that show a frame of random edges when row `row` has been found.
struct Shown {
  Shown(const Parameters& p, int width_, int height_, int row_, std::uint32_t permille)
      : width(width_),
        height(height_),
        row(row_),
        configuration(Registers(p, width_, height_).configuration.driven()),
        memories(p) {
    Random random(permille);
    for (int i = 0; i < 2 * width * height; ++i) bits.push_back(random.chance(permille));
    memories.show(
        configuration, row, [&](int x, int y) { return edge(false, x, y); },
        [&](int x, int y) { return edge(true, x, y); });
  }
  bool edge(bool top, int x, int y) const {
    if (x < 0 || y < 0 || x >= width || y >= height) return false;
    return bits[static_cast<std::size_t>((top ? height : 0) + y) * static_cast<std::size_t>(width) +
                static_cast<std::size_t>(x)];
  }
  int width, height, row;
  std::vector<bool> bits;
  const FrameConfiguration configuration;
  EdgeMemories memories;
};

// The same for either axis.
struct Planes {
  const Shown& shown;
  bool vertical;
  std::int32_t line;
  bool along(std::int32_t p) const {
    return vertical ? shown.edge(false, line, p) : shown.edge(true, p, line);
  }
  std::uint8_t code(std::int32_t p) const {
    const bool first = vertical ? shown.edge(true, line - 1, p) : shown.edge(false, p, line - 1);
    const bool second = vertical ? shown.edge(true, line, p) : shown.edge(false, p, line);
    return static_cast<std::uint8_t>(int{along(p - 1)} | int{along(p)} << 1 | int{first} << 2 |
                                     int{second} << 3);
  }
  bool unbroken(std::int32_t from, std::int32_t end) const {
    for (; from < end; ++from)
      if (!along(from)) return false;
    return true;
  }
};

struct Look {
  int lanes_code, search_rows, search_columns;
  bool contiguous;
};
void PrintTo(const Look& l, std::ostream* out) { *out << l.search_rows << ' ' << l.search_columns; }
class EdgeMemoriesShow : public ::testing::TestWithParam<Look> {};

// Any trial, also beyond the frame's border, shows what the planes hold.
TEST_P(EdgeMemoriesShow, WhatHasBeenWritten) {
  const Look look = GetParam();
  Parameters p = built(look.contiguous, look.search_rows, look.search_columns);
  p.lanes = static_cast<Lanes>(look.lanes_code);
  constexpr int kWidth = 150, kHeight = 70;
  Random random(look.contiguous ? 3 : 4);
  std::uint64_t found = 0;
  Shown shown(p, kWidth, kHeight, 30, 800);
  rtl::Cycle cycle = 0;
  const int steps = std::min(16, look.search_rows - 1);
  for (int i = 0; i < 40'000; ++i) {
    const bool vertical = random.chance(500);
    const int search_range = vertical ? look.search_rows : look.search_columns;
    const int length = 1 + static_cast<int>(random.below(static_cast<std::uint32_t>(
                               std::min(search_range, random.chance(700) ? 4 : 60))));
    const int start = vertical ? 30 : static_cast<int>(random.below(kWidth));
    const int k = 1 + static_cast<int>(random.below(static_cast<std::uint32_t>(steps)));
    Trial trial{};
    trial.to_the_right = random.chance(500);
    const int across = vertical ? static_cast<int>(random.below(kWidth + 1)) : 30;
    trial.line = across + (vertical ? 0 : random.chance(500) ? k : -k);
    trial.length = length;
    const int used = length + static_cast<int>(random.below(
                                  static_cast<std::uint32_t>(std::max(1, search_range - length))));
    trial.room = search_range - used;
    trial.from = start + (trial.to_the_right ? used : length - used);
    if (trial.room < std::max(1, length - 1)) continue;
    trial.corner = static_cast<std::uint8_t>(random.below(16));
    const Planes planes{shown, vertical, trial.line};
    trial.origin = planes.code(trial.from);
    if (random.chance(800)) trial.corner = planes.code(trial.at(length));
    // The run's own: an edge on this side of them, none on the other.
    trial.origin |= trial.to_the_right ? 2 : 1;
    trial.corner |= trial.to_the_right ? 1 : 2;
    std::uint8_t hits = 0;
    ++cycle;
    if (vertical) {
      shown.memories.window.read(cycle, shown.configuration, 0, trial);
      hits = shown.memories.window.hits(cycle + 1, shown.configuration, 0, trial);
    } else {
      shown.memories.rows.read(cycle, shown.configuration, 0, trial);
      hits = shown.memories.rows.hits(cycle + 1, shown.configuration, 0, trial);
    }
    found += hits != 0;
    ASSERT_EQ(hits, hits_of(trial, planes, look.contiguous))
        << i << (vertical ? " vertical " : " horizontal ") << trial.line << ' ' << trial.from << ' '
        << length << ' ' << trial.room;
  }
  EXPECT_GT(found, 3'000u);
}
INSTANTIATE_TEST_SUITE_P(Builds, EdgeMemoriesShow,
                         ::testing::Values(Look{0, 32, 256, true}, Look{1, 32, 60, true},
                                           Look{2, 8, 17, true}, Look{0, 4, 4, true},
                                           Look{0, 32, 256, false}, Look{2, 60, 128, false}));

// Records of a row are under way until the next one has been found, and with it one more row
// written: all that the last of their seven steps looks at is still there.
TEST(EdgeMemory, TheNextRowLeavesWhatTheRecordsOfThisOneLookAt) {
  constexpr int kWidth = 150, kRow = 30, kSteps = 7;
  Shown shown(built(false, kSteps + 1, 60), kWidth, 70, kRow, 500);
  EdgeRows& rows = shown.memories.rows;
  Cycle cycle = Cycle{1} << 50;
  for (const int row : {kRow, kRow + 1})
    for (int x = 0; x < kWidth; ++x) {
      const int y = row + rows.ahead();
      rows.write(cycle++, shown.configuration, y, x, shown.edge(false, x, y),
                 shown.edge(true, x, y));
    }
  for (const int line : {kRow - kSteps, kRow + kSteps}) {
    const Planes planes{shown, false, line};
    for (int x = 0; x < kWidth - 4; ++x) {
      Trial trial{line, x, 3, 20, true, planes.code(x), planes.code(x + 3)};
      rows.read(++cycle, shown.configuration, 0, trial);
      EXPECT_EQ(rows.hits(++cycle, shown.configuration, 0, trial), hits_of(trial, planes, false))
          << line << ' ' << x;
    }
  }
}

struct Sharing {
  int trial_cycles, units, lanes_code, ports;
};
void PrintTo(const Sharing& s, std::ostream* out) {
  *out << s.trial_cycles << ' ' << s.units << ' ' << s.lanes_code;
}
class Schedule : public ::testing::TestWithParam<Sharing> {};

// Two reads a trial of each predictor, no two in one place, no port that stands idle for want of a
// port; the left side in the clock of the right one or in the next.
TEST_P(Schedule, GivesEachReadAPlaceOfItsOwn) {
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

TEST(EdgeMemory, IsBuiltFromOneCopyAReadPort) {
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

// With text: which memory, which clock.
template <class Access>
void expect_stop(Access&& access, const std::string& text) {
  try {
    access();
    ADD_FAILURE() << "no error";
  } catch (const spec::CheckFailed& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr(text));
  }
}

TEST(EdgeMemory, OneAccessTooManyInAClockStops) {
  Shown shown(built(true), 150, 70, 30, 500);
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

TEST(EdgeMemory, AWordIsThereAClockAfterItsReadAndNotBefore) {
  Shown shown(built(true), 150, 70, 30, 500);
  EdgeWindow& window = shown.memories.window;
  EdgeRows& rows = shown.memories.rows;
  Trial across{40, 30, 3, 20, true, 2, 1}, along{31, 40, 3, 20, true, 2, 1};
  // None has been read yet.
  expect_stop([&] { window.hits(7, shown.configuration, 0, across); }, "edge_window");
  expect_stop([&] { rows.hits(7, shown.configuration, 0, along); }, "edge_rows");
  window.read(7, shown.configuration, 0, across);
  rows.read(7, shown.configuration, 0, along);
  expect_stop([&] { window.hits(7, shown.configuration, 0, across); }, "edge_window");
  expect_stop([&] { rows.hits(7, shown.configuration, 0, along); }, "edge_rows");
  EXPECT_NO_THROW(window.hits(8, shown.configuration, 0, across));
  EXPECT_NO_THROW(rows.hits(8, shown.configuration, 0, along));
  // A read that is issued too late leaves the word of the one before.
  Trial next_across{60, 30, 3, 20, true, 2, 1}, next_along{33, 140, 3, 20, true, 2, 1};
  window.read(9, shown.configuration, 0, next_across);
  rows.read(9, shown.configuration, 0, next_along);
  expect_stop([&] { window.hits(9, shown.configuration, 0, next_across); }, "edge_window");
  expect_stop([&] { rows.hits(9, shown.configuration, 0, next_along); }, "edge_rows");
  // The next one's word has taken the place of the old one.
  expect_stop([&] { window.hits(10, shown.configuration, 0, across); }, "edge_window");
  expect_stop([&] { rows.hits(10, shown.configuration, 0, along); }, "edge_rows");
  EXPECT_NO_THROW(window.hits(10, shown.configuration, 0, next_across));
  EXPECT_NO_THROW(rows.hits(10, shown.configuration, 0, next_along));
}

// The window has the last window_rows + 1 rows of a column, of which one is a row ahead where the
// beats of a row have been; any other row is a mistake of who asks.
TEST(EdgeMemory, TheWindowTracksWhichRowsItHolds) {
  constexpr int kRows = 2 * 8 + 3;
  Shown shown(built(false, 8, 60), 150, 70, 30, 500);
  EdgeWindow& window = shown.memories.window;
  // All columns have rows up to 30 + 8 + 1; in the next row the first 40 have come.
  const int newest = 30 + 8 + 1;
  Cycle cycle = Cycle{1} << 50;
  for (int x = 0; x < 40; ++x) {
    window.read_beat(cycle++, shown.configuration, x);
    window.write_beat(cycle++, shown.configuration, x, newest + 2, {});
  }
  // The corner of row y looks at rows y and y - 1. Both columns of line 39 have come, and of line
  // 40 the one before it.
  for (const auto& [line, latest] :
       {std::pair{1, newest + 1}, {39, newest + 1}, {40, newest}, {41, newest}, {150, newest}}) {
    const auto ask = [&, line = line](int y) {
      Trial trial{line, y - 3, 3, 20, true, 0, 0};
      // L alone is tried, whose corner is row y.
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

// With every edge set a step may go along any line but the frame's right border, where only the
// edges across it are left: there is none to go along, whatever the corners are.
TEST(EdgeMemory, NoStepGoesAlongTheRightBorder) {
  constexpr int kWidth = 150;
  constexpr std::uint8_t kAll = kBeforeBit | kAfterBit | kFirstBit | kSecondBit;
  Shown shown(built(true), kWidth, 70, 30, 1000);
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

// A port shows as many words as the longest step can lie in, and a class with it: of 125 columns a
// side steps of 62 and 63, with the corner's own column 65, from the last one of a word on; of 126
// no more; of 127 steps of 63 and 64.
TEST(EdgeMemory, TheLongestStepLiesInTheWordsOfAPort) {
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
      Shown shown(p, 256, 70, 30, 1000);
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

// Where the edges of a step need not be all set: the corners of its three candidates, which are
// four columns.
TEST(EdgeMemory, AStepShowsTheFourColumnsAtItsEnd) {
  Shown shown(built(false), 150, 70, 30, 500);
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

// Three edges to the border of the frame and a crossing that does not go on: class 2 + 3, whatever
// word the port has shown behind it before.
TEST(EdgeMemory, AClassEndsWithTheFrame) {
  constexpr int kWidth = 128, kFrom = kWidth - 3;
  Shown shown(preset(Preset::kDeburr), kWidth, 70, 30, 0);
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

// All edges of a step that ends in the newest row are in the rows above it.
TEST(EdgeMemory, AStepMayEndInTheNewestRow) {
  constexpr int kNewest = 30 + 8 + 1;
  constexpr std::uint8_t kAll = kBeforeBit | kAfterBit | kFirstBit | kSecondBit;
  Shown shown(built(true, 8, 60), 150, 70, 30, 1000);
  // Steps of two and of three; one more is beyond the reach.
  Trial trial{40, kNewest - 3, 3, 3, true, kAll, kAll};
  shown.memories.window.read(1, shown.configuration, 0, trial);
  EXPECT_EQ(shown.memories.window.hits(2, shown.configuration, 0, trial), kShorter | kEqual);
}

TEST(EdgeMemory, ABeatIsWrittenAClockAfterItWasReadAndNotBefore) {
  Shown shown(built(true), 150, 70, 30, 500);
  EdgeWindow& window = shown.memories.window;
  window.read_beat(7, shown.configuration, 5);
  expect_stop([&] { window.write_beat(7, shown.configuration, 5, 64, {}); }, "edge_window");
  EXPECT_NO_THROW(window.write_beat(8, shown.configuration, 5, 64, {}));
  expect_stop([&] { window.write_beat(9, shown.configuration, 6, 64, {}); }, "edge_window");
}

// No step is longer than a port shows: half the reach, then one more, as odd reaches allow.
class LongestStep : public ::testing::TestWithParam<int> {
 protected:
  static constexpr int kFrom = 90;
  static Parameters parameters() {
    // A side that the window ends keeps what it has.
    Parameters p = preset(Preset::kDeburrLine, 32, GetParam());
    p.trim = false;
    return p;
  }
  // Steps of `length` and `next` between long flat parts; the line goes down to the right.
  static Frame stairs(int length, int next) {
    return draw(250, 30, [=](int x, int y) {
      const int row = x < kFrom                   ? 10
                      : x < kFrom + length        ? 11
                      : x < kFrom + length + next ? 12
                                                  : 13;
      return grey(y >= row ? 255 : 0);
    });
  }
  // Steps to the right of the run in row 11.
  static int steps(EngineBench& bench, int length, int next) {
    int found = -1;
    bench.engine.observe_lines([&](const spec::morphological::LineDescriptor& line) {
      if (line.run.axis != Axis::kHorizontal || line.run.line != 11) return;
      EXPECT_EQ(line.run.start, kFrom);
      EXPECT_EQ(line.run.length, length);
      EXPECT_EQ(line.left_steps, 0);
      EXPECT_EQ(found, -1) << "one run";
      found = line.right_steps;
    });
    bench.run(stairs(length, next));
    return found;
  }
};
TEST_P(LongestStep, FitsIntoAPort) {
  const int search_range = GetParam(), half = search_range / 2, more = (search_range + 1) / 2;
  EngineBench bench(parameters());
  EXPECT_EQ(steps(bench, half, search_range - half), 1) << "all of the reach is used";
  EXPECT_EQ(steps(bench, more, search_range + 1 - more), 0) << "a pixel beyond it";
}
INSTANTIATE_TEST_SUITE_P(Reaches, LongestStep, ::testing::Values(4, 5, 8, 9, 16, 33, 64, 65, 129));

// No more ports than are used: the busiest clock uses every one.
struct Built {
  int lanes_code, units, trial_cycles;
  bool contiguous;
};
void PrintTo(const Built& b, std::ostream* out) { *out << b.lanes_code << ' ' << b.units; }
class BusiestClock : public ::testing::TestWithParam<Built> {};
TEST_P(BusiestClock, UsesEveryPort) {
  Parameters p = built(GetParam().contiguous);
  p.lanes = static_cast<Lanes>(GetParam().lanes_code);
  p.predictor_units = GetParam().units;
  p.trial_cycles = GetParam().trial_cycles;
  EngineBench bench(p);
  const Frame in = draw(96, 80, [](int x, int y) { return grey((x + y) / 2 % 2 != 0 ? 255 : 0); });
  bench.software.set_size(in.width, in.height);
  bench.driver.send(beats_of(in, lanes_of(p)));
  const auto beats = static_cast<std::uint64_t>(beats_a_row(in, p) * in.height);
  const auto& window = bench.engine.window.memory;
  const auto& rows = bench.engine.rows.memory;
  std::uint64_t window_before = 0, rows_before[2] = {}, most_window = 0, most_rows = 0;
  bench.bench->run(
      [&] {
        most_window = std::max(most_window, window.reads() - window_before);
        window_before = window.reads();
        for (std::size_t i = 0; i < 2; ++i) {
          most_rows = std::max(most_rows, rows[i].reads() - rows_before[i]);
          rows_before[i] = rows[i].reads();
        }
        return bench.sink.received() == beats && bench.engine.idle();
      },
      1'000'000);
  EXPECT_EQ(most_window, window.shape().read_ports);
  EXPECT_EQ(most_rows, rows[0].shape().read_ports);
}
INSTANTIATE_TEST_SUITE_P(Builds, BusiestClock,
                         ::testing::Values(Built{0, 2, 4, true}, Built{1, 2, 4, true},
                                           Built{2, 2, 4, true}, Built{0, 1, 4, false},
                                           Built{0, 4, 4, true}, Built{2, 1, 4, false},
                                           Built{0, 2, 1, true}, Built{0, 3, 3, true}));

// A rule that the engine was not built for counts as off.
TEST(Contiguous, IsOffInAnEngineBuiltWithoutIt) {
  namespace reg = spec::morphological::reg;
  constexpr std::uint32_t kContiguous = 1u << 14;
  const auto with = forked<std::uint64_t>([] {
    EngineBench bench(built(true));
    return hash(bench.run(blocks()));
  });
  EngineBench bench(built(false));
  const Frame without = bench.run(blocks());
  const std::uint64_t steps = bench.engine.work().steps;
  bench.bus.write(reg::kConfiguration, bench.bus.read(reg::kConfiguration) | kContiguous);
  EXPECT_EQ(hash(bench.run(blocks())), hash(without));
  EXPECT_EQ(bench.engine.work().steps, 2 * steps);
  EXPECT_NE(hash(without), with) << "the rule changes the frame";
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::edge_memories_test
