// SPDX-License-Identifier: MIT
// The bounds on the beats of a row that docs/morphological_hardware.md gives for a frame without a
// stall: for records, with the bursts that hurt most; for narrow rows; for memory.
#include <algorithm>
#include <cstdint>
#include <string>

#include "tb/unit/rtl/morphological/support.h"

namespace deburr::tb::morphological_rtl {
namespace {

using spec::morphological::Preset;

// What a fifth of the pixels on edges needs, if records come every second clock at most (one a
// clock: `one_a_clock`).
int least_beats(const Parameters& p, bool one_a_clock) {
  const int apart = one_a_clock ? 1 : 2;
  const int iterations = std::max(1, p.steps);
  // Clocks a record, times the predictors.
  const int q =
      std::max({apart * p.predictor_units, iterations, p.divider_interval * p.predictor_units});
  const int over = iterations + p.divider_latency + p.predictor_units * p.divider_interval + 7;
  // over / (1 + 0.2 apart - 0.2 q / units), rounded up
  const int under = (5 + apart) * p.predictor_units - q;
  return (5 * p.predictor_units * over + under - 1) / under;
}

std::uint64_t unstalled(const Frame& frame, const Parameters& p) {
  return static_cast<std::uint64_t>((frame.height + reach_of(p) + 5) * beats_a_row(frame, p)) +
         kPipe;
}

std::uint64_t stalls_of(const rtl::Unit& unit, const std::string& cause) {
  for (const auto& stall : unit.stalls())
    if (stall.name == cause) return stall.cycles;
  return 0;
}

// All edges of a row side by side at its right border, in diagonals of one pixel: a record every
// second clock, each extended to the full N.
Frame packed(int width, int height) {
  return draw(width, height, [=](int x, int y) {
    return grey(x >= width - width / 5 * 2 && (x + y) / 2 % 2 != 0 ? 255 : 0);
  });
}

// Combs at the right border: runs of a pixel that begin side by side, a record a clock.
Frame combs(int width, int height) {
  return draw(width, height, [=](int x, int y) {
    return grey(y % 8 == 7 && x >= width - width / 5 && x % 2 != 0 ? 255 : 0);
  });
}

struct Build {
  int lanes_code, steps, units, interval, latency;
};
void PrintTo(const Build& b, std::ostream* out) {
  *out << b.steps << " steps, " << b.units << " units, interval " << b.interval;
}
Parameters build(const Build& b) {
  Parameters p = preset(b.steps ? Preset::kDeburr : Preset::kMlaa);
  p.lanes = static_cast<spec::morphological::Lanes>(b.lanes_code);
  p.steps = b.steps;
  p.predictor_units = b.units;
  p.divider_interval = b.interval;
  p.divider_latency = b.latency;
  return p;
}

class Bursts : public ::testing::TestWithParam<Build> {};
TEST_P(Bursts, PassWithoutAStallAtTheBound) {
  Parameters p = build(GetParam());
  const bool one_a_clock = p.steps == 0;
  const int beats = least_beats(p, one_a_clock), width = beats * lanes_of(p);
  p.line_pixels = width;
  p.record_fifo = std::max(16, beats / 8 + 8);
  if (one_a_clock) p.record_fifo = std::max(16, beats / 5);
  EngineBench bench(p);
  const Frame in = one_a_clock ? combs(width, 60) : packed(width, 60);
  bench.run(in);
  const spec::morphological::Work work = bench.engine.work();
  if (!one_a_clock) {
    EXPECT_GE(work.edge_pixels * 1000, work.pixels * 180);
    EXPECT_GT(work.extended_runs, static_cast<std::uint64_t>(width));
  }
  EXPECT_GT(bench.engine.extractor.records_sent.value(), 50u);
  EXPECT_EQ(bench.engine.extractor.record_stalls.value(), 0u);
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), unstalled(in, p));
}
INSTANTIATE_TEST_SUITE_P(Builds, Bursts,
                         ::testing::Values(Build{0, 8, 2, 1, 24},  // deburr
                                           Build{1, 8, 2, 1, 24}, Build{2, 8, 2, 1, 24},
                                           Build{0, 5, 1, 1, 24}, Build{0, 10, 2, 1, 24},
                                           Build{0, 16, 4, 1, 24}, Build{0, 16, 4, 1, 14},
                                           Build{0, 8, 8, 1, 24}, Build{0, 8, 2, 4, 24},
                                           Build{2, 8, 2, 4, 15}, Build{0, 8, 4, 4, 24},
                                           Build{0, 0, 2, 1, 24}, Build{0, 0, 2, 5, 24},
                                           Build{0, 0, 2, 3, 64}, Build{1, 0, 2, 3, 15}));

TEST(Bursts, TheBoundOfTheDefaultsIs69Beats) {
  EXPECT_EQ(least_beats(build({0, 8, 2, 1, 24}), false), 69);
  EXPECT_EQ(least_beats(build({0, 0, 2, 1, 24}), true), 34);
}

// Below, the rows wait for the queue: 130 clocks where a record alone would have had room.
TEST(Bursts, StallInRowsThatHoldTheWayOfARecordOnly) {
  const Parameters p = preset(Preset::kDeburr);
  EngineBench bench(p);
  const Frame in = packed(48, 80);
  bench.run(in);
  EXPECT_LT(bench.engine.work().edge_pixels * 1000, bench.engine.work().pixels * 200);
  EXPECT_EQ(bench.engine.extractor.interlock_stalls.value(), 130u);
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), unstalled(in, p) + 130);
}

// A burst at the end of a row and one at the beginning of the next.
struct Depth {
  int fifo;
  std::uint64_t stalls;
};
void PrintTo(const Depth& d, std::ostream* out) { *out << d.fifo; }
class FifoDepth : public ::testing::TestWithParam<Depth> {};
TEST_P(FifoDepth, OfATenthOfARowBearsABurst) {
  Parameters p = preset(Preset::kDeburr);
  p.record_fifo = GetParam().fifo;
  EngineBench bench(p);
  const Frame in = draw(200, 120, [](int x, int y) {
    return grey((y % 40 < 20 ? x >= 120 : x < 80) && (x + y) / 2 % 2 != 0 ? 255 : 0);
  });
  bench.run(in);
  EXPECT_EQ(bench.engine.extractor.record_stalls.value(), GetParam().stalls);
  EXPECT_EQ(bench.engine.extractor.interlock_stalls.value(), 0u);
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), unstalled(in, p) + GetParam().stalls);
}
INSTANTIATE_TEST_SUITE_P(Depths, FifoDepth, ::testing::Values(Depth{20, 12}, Depth{28, 0}));

// Rows shorter than the pipe wait for the line buffers, records or not.
struct Narrow {
  int lanes_code, width;
  std::uint64_t rows;
};
void PrintTo(const Narrow& n, std::ostream* out) { *out << n.width; }
class NarrowRows : public ::testing::TestWithParam<Narrow> {};
TEST_P(NarrowRows, WaitForThePlaceOfTheirPixels) {
  Parameters p = preset(Preset::kMlaa);
  p.lanes = static_cast<spec::morphological::Lanes>(GetParam().lanes_code);
  EngineBench bench(p);
  const Frame in = draw(GetParam().width, 100, [](int, int) { return grey(128); });
  const Frame out = bench.run(in);
  EXPECT_EQ(out.pixel, in.pixel);
  EXPECT_EQ(bench.engine.extractor.record_stalls.value(), 0u);
  // With three beats a row, the side that sends is busy whenever a beat waits.
  EXPECT_EQ(stalls_of(bench.engine.pixel_store, "rows") != 0, GetParam().rows > 23);
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), unstalled(in, p) + GetParam().rows);
}
INSTANTIATE_TEST_SUITE_P(Widths, NarrowRows,
                         ::testing::Values(Narrow{0, 1, 75}, Narrow{0, 2, 60}, Narrow{0, 3, 23},
                                           Narrow{0, 4, 0}, Narrow{2, 4, 75}, Narrow{2, 8, 60},
                                           Narrow{2, 12, 23}, Narrow{2, 16, 0}));

// storage = memory loads two rows ahead: two rows last as long as a line takes to come, and a
// line's beats.
struct Load {
  int lanes_code;
  std::uint32_t latency;
  int beats;
  bool stalls;
};
void PrintTo(const Load& l, std::ostream* out) { *out << l.latency << ' ' << l.beats; }
class MemoryRows : public ::testing::TestWithParam<Load> {};
TEST_P(MemoryRows, AreAsLongAsALineTakes) {
  Parameters p = preset(Preset::kMlaa);
  p.lanes = static_cast<spec::morphological::Lanes>(GetParam().lanes_code);
  p.storage = spec::morphological::Storage::kMemory;
  p.line_pixels = GetParam().beats * lanes_of(p);
  EngineBench::Options options;
  options.memory_latency = GetParam().latency;
  EngineBench bench(p, options);
  const Frame in = noise(p.line_pixels, 40);
  bench.run(in);
  const std::uint64_t frame = bench.engine.sequencer.frame_cycles.value();
  if (GetParam().stalls)
    EXPECT_GT(frame, unstalled(in, p));
  else
    EXPECT_EQ(frame, unstalled(in, p));
}
INSTANTIATE_TEST_SUITE_P(Rows, MemoryRows,
                         ::testing::Values(Load{0, 60, 39, true}, Load{0, 60, 40, false},
                                           Load{0, 60, 41, false}, Load{0, 100, 59, true},
                                           Load{0, 100, 60, false}, Load{1, 100, 55, true},
                                           Load{1, 100, 56, false}, Load{2, 100, 53, true},
                                           Load{2, 100, 54, false}));

}  // namespace
}  // namespace deburr::tb::morphological_rtl
