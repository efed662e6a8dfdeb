// SPDX-License-Identifier: MIT
// TextGuard: the drawings of the contract, arbitrary pictures against the golden model, and its
// cycles. In the engine: bypassed pixels, and that nothing waits for the TextGuard.
#include "golden/morphological/text_guard.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "golden/morphological/morphological_golden.h"
#include "spec/morphological/vectors.h"
#include "tb/base/apply_settings.h"
#include "tb/base/forked.h"
#include "tb/base/random.h"
#include "tb/base/sanitized.h"
#include "tb/harness/monitor.h"
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/morphological/parts.h"

namespace deburr::tb::morphological_rtl::text_guard_test {
namespace {

using namespace rtl::morphological;  // NOLINT: a test of these
using golden::morphological::colour_hash;
using golden::morphological::MorphologicalGolden;
using spec::morphological::Preset;
using Rows = std::vector<std::string>;

Parameters guarded(int lanes_code = 0, int search_rows = kReach) {
  Parameters p = preset(Preset::kMlaa, search_rows, 8);
  p.lanes = static_cast<spec::morphological::Lanes>(lanes_code);
  p.text_guard = true;
  p.line_pixels = 64;
  return p;
}

// '#' for each guarded pixel, '.' for the others, one string per row.
Rows by_golden(const Frame& frame) {
  const golden::morphological::TextGuard guard({frame.pixel, frame.width, frame.height});
  Rows rows;
  for (int y = 0; y < frame.height; ++y) {
    rows.emplace_back();
    for (int x = 0; x < frame.width; ++x) rows.back() += guard.at(x, y).guarded() ? '#' : '.';
  }
  return rows;
}

// ---- the unit -----------------------------------------------------------------------------------

struct GuardBench {
  explicit GuardBench(const Parameters& p, Cycle opens = 0)
      : lanes(lanes_of(p)), registers(p), guard("guard", clock, p), gate("gate", clock, opens) {
    guard.configuration_in(registers.configuration);
    source.out(slots);
    guard.slots_in(slots);
    gate.in(guard.guards());
  }
  // Sends the slots of a frame from the given cycle on, including the rows after the frame, with
  // noise where nothing is read.
  void send(const Frame& frame, Cycle from = 0) {
    registers.frame(frame.width, frame.height, clock.cycle());
    width = frame.width;
    height = frame.height;
    const int beats = (width + lanes - 1) / lanes;
    for (int y = 0; y < height + 8; ++y)
      for (int beat = 0; beat < beats; ++beat) {
        GuardSlotToken token{};
        token.row = static_cast<std::uint16_t>(y);
        token.beat = static_cast<std::uint16_t>(beat);
        for (int lane = 0; lane < lanes; ++lane) {
          const int x = beat * lanes + lane;
          auto& pixel = token.pixel[static_cast<std::size_t>(lane)];
          for (std::size_t c = 0; c < 3; ++c)
            pixel[c] = x < width && y < height ? frame.at(x, y)[c]
                                               : static_cast<std::uint8_t>(random.word());
        }
        source.add(from, token);
      }
    sent += static_cast<std::size_t>(beats * (height + 8));
    wanted += static_cast<std::size_t>(beats * height);
  }
  Rows finish(Cycle limit = 200'000) {
    EXPECT_TRUE(clock.run_until(
        [&] { return gate.taken.size() == wanted && source.sent() == sent; }, limit));
    clock.run(40);
    EXPECT_EQ(gate.taken.size(), wanted) << "a beat too many";
    const int beats = (width + lanes - 1) / lanes;
    const std::size_t from = wanted - static_cast<std::size_t>(beats * height);
    Rows rows;
    for (int y = 0; y < height; ++y) {
      rows.emplace_back();
      for (int x = 0; x < width; ++x)
        rows.back() +=
            gate.taken[from + static_cast<std::size_t>(y * beats + x / lanes)].token.guarded >>
                        (x % lanes) &
                    1
                ? '#'
                : '.';
    }
    return rows;
  }
  void reset() {
    reset_by(clock);
    sent = wanted = 0;
  }
  Rows run(const Frame& frame) {
    send(frame);
    return finish();
  }

  int lanes, width = 0, height = 0;
  ClockDomain clock{"clock", period()};
  Registers registers;
  Link<GuardSlotToken> slots{"slots"};
  unit_bench::Source<GuardSlotToken> source{"source", clock};
  TextGuard guard;
  unit_bench::Sink<GuardToken> gate;
  Random random{1, "noise"};
  std::size_t sent = 0, wanted = 0;
};

// Splits the contract's drawings into rows.
Rows split(std::string_view text) {
  Rows rows(1);
  for (const char c : text) {
    if (c == ' ')
      rows.emplace_back();
    else
      rows.back() += c;
  }
  return rows;
}
Rows transposed(const Rows& rows) {
  Rows other(rows[0].size());
  for (const std::string& row : rows)
    for (std::size_t x = 0; x < row.size(); ++x) other[x] += row[x];
  return other;
}
Frame drawing(const Rows& rows) {
  return draw(static_cast<int>(rows[0].size()), static_cast<int>(rows.size()), [&](int x, int y) {
    const char letter = rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
    return letter == '.'   ? Rgba8{250, 240, 230, 255}
           : letter == '#' ? Rgba8{30, 50, 70, 255}
                           : grey(128);
  });
}
class Drawings : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Lanes, Drawings, ::testing::Range(0, 3));

TEST_P(Drawings, GuardedPixelsMatchTheContract) {
  GuardBench bench(guarded(GetParam()));
  for (const spec::morphological::GuardVector& v : spec::morphological::kGuardVectors) {
    Rows expected = split(v.guarded);
    for (std::string& row : expected)
      for (char& c : row) c = c == 'g' ? '#' : '.';
    EXPECT_EQ(bench.run(drawing(split(v.rows))), expected) << v.name;
    EXPECT_EQ(bench.run(drawing(transposed(split(v.rows)))), transposed(expected)) << v.name;
  }
}

// Stretches of two colours; some pictures add a third colour, or one with the hash of the first.
Frame text(int width, int height, std::uint64_t seed) {
  Random random(seed);
  const std::uint32_t weight = random.between(100, 900), other = random.below(3);
  const auto any = [&] {
    const std::uint32_t word = random.word();
    return Rgba8{static_cast<std::uint8_t>(word), static_cast<std::uint8_t>(word >> 8),
                 static_cast<std::uint8_t>(word >> 16), 255};
  };
  const Rgba8 ink = any(), paper = any();
  Rgba8 third = any();
  while (other == 1 && colour_hash(third) != colour_hash(ink)) third = any();
  std::uint32_t word = 0;
  return draw(width, height, [&](int x, int) {
    if (x == 0 || random.chance(weight)) word = random.word();
    if (other != 2 && random.below(400) == 0) return third;
    return (word & 1) != 0 ? ink : paper;
  });
}

struct Size {
  int width, height;
};
void PrintTo(const Size& size, std::ostream* out) { *out << size.width << 'x' << size.height; }
class RandomPictures : public ::testing::TestWithParam<std::tuple<Size, int>> {};

TEST_P(RandomPictures, GuardedPixelsMatchGolden) {
  const auto& [size, lanes_code] = GetParam();
  Parameters p = guarded(lanes_code);
  p.line_pixels = std::max(size.width, 1);
  GuardBench bench(p);
  std::size_t found = 0, pixels = 0;
  const int frames = size.width * size.height > 5000 ? 2 : 12;
  for (int seed = 1; seed <= frames; ++seed) {
    const Frame frame = text(size.width, size.height, static_cast<std::uint64_t>(seed));
    const Rows expected = by_golden(frame);
    ASSERT_EQ(bench.run(frame), expected) << "picture " << seed;
    for (const std::string& row : expected)
      found += static_cast<std::size_t>(std::count(row.begin(), row.end(), '#'));
    pixels += frame.pixel.size();
  }
  EXPECT_EQ(bench.guard.guarded_pixels.value(), found);
  if (size.width > 6 && size.height > 6) {
    EXPECT_GT(found, pixels / 10);
    EXPECT_LT(found, pixels);
  }
  EXPECT_EQ(stalls(bench.guard, "downstream"), 0u);
}
INSTANTIATE_TEST_SUITE_P(
    Sizes, RandomPictures,
    ::testing::Combine(::testing::Values(Size{1, 1}, Size{2, 1}, Size{1, 2}, Size{3, 200},
                                         Size{200, 3}, Size{5, 30}, Size{9, 17}, Size{23, 23},
                                         Size{64, 20}, Size{kSanitized ? 320 : 1920, 14}),
                       ::testing::Range(0, 3)));

// Frames of other sizes and other pictures follow each other; nothing remains of the previous one.
TEST(TextGuardBlock, FramesDoNotAffectEachOther) {
  GuardBench bench(guarded(1));
  for (const Size size : {Size{40, 30}, Size{7, 9}, Size{64, 12}, Size{3, 3}, Size{12, 40}}) {
    const Frame frame = text(size.width, size.height, static_cast<std::uint64_t>(size.width));
    EXPECT_EQ(bench.run(frame), by_golden(frame));
    const Frame board = drawing({".#.#", "#.#.", ".#.#"});
    EXPECT_EQ(bench.run(board), by_golden(board));
  }
}

// ---- cycles -------------------------------------------------------------------------------------

class TextGuardCycles : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Lanes, TextGuardCycles, ::testing::Range(0, 3));

// Measured from the last beat of row 8 to the first beat of row 0; then one beat per cycle.
TEST_P(TextGuardCycles, RowLeavesEightRowsLater) {
  const Parameters p = guarded(GetParam());
  GuardBench bench(p);
  const Frame frame = text(40, 12, 1);
  bench.run(frame);
  const auto beats = static_cast<Cycle>(beats_a_row(frame, p));
  // Pushed from 0 on, popped from 1 on.
  const auto check = [&](const rtl::Datasheet& sheet) {
    expect_cycles(sheet, cycles_of(bench.gate), 9 * beats);
  };
  expect_detects_one_cycle(TextGuard::datasheet(p), &rtl::Datasheet::latency, check);
  expect_detects_one_cycle(TextGuard::datasheet(p), &rtl::Datasheet::interval, check);
  expect_stages_in_order(TextGuard::datasheet(p));
}

// If the last beat of a row is late, the row is late by the same number of cycles. A row that has
// started is not delayed: its last beats need no beat of the next row.
TEST_P(TextGuardCycles, RowWaitsOnlyForItsOwnLastBeat) {
  const Parameters p = guarded(GetParam());
  const Frame frame = text(40, 12, 1);
  const auto beats = static_cast<std::size_t>(beats_a_row(frame, p));
  const auto latency = TextGuard::datasheet(p).latency.cycles;
  GuardBench bench(p);
  for (const std::size_t held : {9 * beats - 1, 9 * beats, 9 * beats + 1}) {
    bench.reset();
    const Cycle begin = bench.clock.cycle();
    bench.send(frame, begin);
    bench.source.delay(held, begin + 2000);  // pushed; popped one cycle later
    ASSERT_EQ(bench.finish(), by_golden(frame));
    const Cycle first = begin + (held < 9 * beats ? 2001 : 9 * beats) + latency,
                second = begin + 2000 + 10 * beats - held + latency;
    for (std::size_t beat = 0; beat < beats; ++beat) {
      ASSERT_EQ(bench.gate.taken[beat].cycle, first + beat) << held;
      // The next row, whose last beat is late in any case.
      ASSERT_EQ(bench.gate.taken[beats + beat].cycle, second + beat) << held;
    }
  }
}

// While the bits are not taken, the unit stalls once the FIFO is full, and nothing is lost.
TEST_P(TextGuardCycles, DownstreamStallLosesNothing) {
  const Parameters p = guarded(GetParam());
  const Frame frame = text(60, 40, 2);
  GuardBench bench(p, 3000);
  bench.send(frame);
  EXPECT_EQ(bench.finish(), by_golden(frame));
  EXPECT_GT(stalls(bench.guard, "downstream"), 100u);
  for (std::size_t i = 0; i < bench.gate.taken.size(); ++i)
    ASSERT_EQ(bench.gate.taken[i].cycle, 3000 + i) << "a beat a clock";
}

// ---- in the engine ------------------------------------------------------------------------------

struct Build {
  Preset preset;
  int search_rows;
  const char* settings;
};
void PrintTo(const Build& b, std::ostream* out) {
  *out << spec::morphological::kPresetNames[static_cast<std::size_t>(b.preset)] << " R "
       << b.search_rows << ' ' << b.settings;
}
Parameters parameters_of(const Build& b) {
  Parameters p = preset(b.preset, b.search_rows, 20);
  p.steps = std::min(p.steps, 2);
  p.diagonal_steps = std::min(p.diagonal_steps, 4);
  p.line_pixels = 128;
  apply_settings(p, b.settings);
  p.text_guard = true;
  return p;
}

class TextGuardEngine : public ::testing::TestWithParam<Build> {};
INSTANTIATE_TEST_SUITE_P(
    Builds, TextGuardEngine,
    ::testing::Values(Build{Preset::kMlaa, 4, ""}, Build{Preset::kMlaa, 4, "lanes=2"},
                      Build{Preset::kMlaa, 4, "lanes=4"}, Build{Preset::kDeburr, 5, ""},
                      Build{Preset::kDeburr, 8, "lanes=4"},
                      Build{Preset::kDeburrLine, 32, "lanes=2"},
                      Build{Preset::kSmaa, 16, "lanes=4"}, Build{Preset::kSmaa, 8, ""},
                      Build{Preset::kMlaa, 4, "storage=memory"},
                      Build{Preset::kDeburr, 8, "storage=memory lanes=4"}));

// Text on the left, a scene on the right.
Frame page(int width, int height) {
  Frame frame = text(width, height, 3);
  const Frame scene = line(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = width * 2 / 3; x < width; ++x) frame.at(x, y) = scene.at(x, y);
  return frame;
}

std::string text_of(const std::vector<Cycle>& cycles) {
  std::string text;
  for (const Cycle cycle : cycles) text += std::to_string(cycle) + ' ';
  return text;
}

// Every beat is taken and delivered in the same cycle as in a build without the TextGuard, with
// stalls on either side.
TEST_P(TextGuardEngine, GuardDelaysNoBeat) {
  const Parameters p = parameters_of(GetParam());
  Parameters without = p;
  without.text_guard = false;
  for (const std::uint32_t source : {0u, 300u, 900u})
    for (const std::uint32_t sink : {0u, 300u, 900u}) {
      if (kSanitized && source != sink) continue;
      EngineBench::Options options;
      options.driver.stall_permille = source;
      options.sink.stall_permille = sink;
      for (const auto& [width, height] : {std::pair{61, 20}, {1, 25}, {3, 30}, {7, 1}, {16, 12}}) {
        const Frame frame = page(width, height);
        const int line_pixels = width,
                  fewest = p.storage == spec::morphological::Storage::kMemory ? 17 : 1;
        const auto cycles = [&](const Parameters& q) {
          return forked_text([&] {
            Parameters as_wide = q;  // so that the FIFO has the same size
            as_wide.line_pixels = std::max(line_pixels, fewest);
            EngineBench bench(as_wide, options);
            std::vector<Cycle> taken;
            const Monitor<spec::morphological::PixelBeat> in(
                bench.clock, bench.in, {},
                [&](Cycle c, const spec::morphological::PixelBeat&) { taken.push_back(c); });
            bench.run(frame);
            if (q.text_guard) {
              EXPECT_EQ(stalls(*bench.engine.text_guard, "downstream"), 0u);
            }
            return text_of(taken) + "| " + text_of(bench.sink.cycles());
          });
        };
        ASSERT_EQ(cycles(p), cycles(without)) << width << "x" << height << " stalls of the source "
                                              << source << ", of the sink " << sink;
      }
    }
}

// The source stops in the middle of a row: the beats that have come deliver the same output as
// without the TextGuard.
TEST_P(TextGuardEngine, GuardDelaysNoBeatOfAStoppedSource) {
  const Parameters p = parameters_of(GetParam());
  Parameters without = p;
  without.text_guard = false;
  const Frame frame = page(32, 60);
  const auto row = static_cast<std::size_t>(beats_a_row(frame, p));
  // Slots before the first one that delivers a beat.
  const std::size_t before = static_cast<std::size_t>(GetParam().search_rows + 5) * row;
  for (const std::size_t more :
       {std::size_t{1}, row / 2, row - 1, row, row + 1, 3 * row + row / 2, 4 * row - 1}) {
    const std::size_t stop = before + more;
    const auto delivered = [&](const Parameters& q) {
      return forked_text([&] {
        EngineBench bench(q);
        const auto beats = beats_of(frame, lanes_of(q));
        bench.software.set_size(frame.width, frame.height);
        bench.driver.send({beats.begin(), beats.begin() + static_cast<std::ptrdiff_t>(stop)});
        bench.clock.run(3000);
        return text_of(bench.sink.cycles());
      });
    };
    const std::string expected = delivered(without);
    ASSERT_EQ(std::count(expected.begin(), expected.end(), ' '), static_cast<std::ptrdiff_t>(more));
    ASSERT_EQ(delivered(p), expected) << more;
  }
}

// With stalls at each link, and noise in words that were not written.
TEST_P(TextGuardEngine, PixelsMatchGolden) {
  const Parameters p = parameters_of(GetParam());
  const Frame frame = page(61, 30);
  const auto hash_with = [&](const EngineBench::Options& options) {
    return forked<std::uint64_t>([&] {
      EngineBench bench(p, options);
      const std::uint64_t found = hash(bench.run(frame));
      return bench.engine.work().bypassed_pixels > 0 ? found : 0;
    });
  };
  MorphologicalGolden golden(p);
  golden.process({frame.pixel, frame.width, frame.height});
  Frame smoothed = frame;
  smoothed.pixel = golden.pixels();
  const std::uint64_t expected = hash(smoothed);
  EXPECT_EQ(hash_with({}), expected);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    EngineBench::Options options;
    options.bench.stall_permille = 200;
    options.bench.seed = seed;
    options.bench.poison = true;
    options.bench.check_widths = true;
    options.bench.shuffle = seed;
    EXPECT_EQ(hash_with(options), expected) << seed;
  }
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::text_guard_test
