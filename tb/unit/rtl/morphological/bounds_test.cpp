// SPDX-License-Identifier: MIT
// The minimum beats per row of docs/reference/morphological/hardware.md for a frame without stalls:
// for descriptors, with the worst bursts; for narrow rows; and for memory.
#include <algorithm>
#include <cstdint>
#include <string>
#include <tuple>

#include "tb/unit/rtl/morphological/support.h"

namespace deburr::tb::morphological_rtl::bounds_test {
namespace {

using spec::morphological::Preset;

// Beats that a row needs for this number of adjacent descriptors of N steps at its end, if one
// comes every second cycle (`one_per_cycle`: every cycle).
int least_beats(const Parameters& p, int descriptors, bool one_per_cycle) {
  const int apart = one_per_cycle ? 1 : 2, trials = p.trial_cycles * p.steps;
  const int held =
      p.steps == 0 ? 1 : trials + std::max(p.trial_cycles, p.trial_cycles == 2 ? 4 : 3);
  // q: cycles per descriptor, times the predictors. way: latency of the last descriptor.
  const int q = std::max({apart * p.predictor_units, held, p.divider_interval * p.predictor_units});
  const int way =
      (p.steps == 0 ? 10 : held + 12) + p.divider_latency + p.predictor_units * p.divider_interval;
  const int units = p.predictor_units;
  return std::max((descriptors * q + units - 1) / units,
                  (descriptors * (q - apart * units) + units - 1) / units + way);
}

std::uint64_t unstalled(const Frame& frame, const Parameters& p) {
  return static_cast<std::uint64_t>((frame.height + search_range_of(p) + 5) *
                                    beats_a_row(frame, p)) +
         kPipe;
}

// Adjacent diagonals of one pixel at the right border: one descriptor every second cycle, each
// extended to the full N.
Frame packed(int width, int height, int descriptors) {
  return draw(width, height, [=](int x, int y) {
    return grey(x >= width - 2 * descriptors && (x + y) / 2 % 2 != 0 ? 255 : 0);
  });
}

// Combs at the right border: adjacent runs of one pixel, one descriptor per cycle.
Frame combs(int width, int height, int descriptors) {
  return draw(width, height, [=](int x, int y) {
    return grey(y % 8 == 7 && x >= width - descriptors && x % 2 != 0 ? 255 : 0);
  });
}

struct Build {
  int lanes_code, steps, units, trial_cycles, interval, latency;
};
void PrintTo(const Build& b, std::ostream* out) {
  *out << b.steps << " steps, " << b.units << " units, trials of " << b.trial_cycles
       << ", interval " << b.interval;
}
Parameters build(const Build& b) {
  Parameters p = preset(b.steps ? Preset::kDeburrLine : Preset::kMlaa);
  p.lanes = static_cast<spec::morphological::Lanes>(b.lanes_code);
  p.steps = b.steps;
  p.predictor_units = b.units;
  p.trial_cycles = b.trial_cycles;
  p.divider_interval = b.interval;
  p.divider_latency = b.latency;
  return p;
}

class Bursts : public ::testing::TestWithParam<Build> {
 protected:
  static constexpr int kDescriptors = 30;  // per lane
  // Cycles for which the slots wait for descriptors, in rows of the given number of beats.
  static std::uint64_t stalls(int beats) {
    Parameters p = build(GetParam());
    const int width = beats * lanes_of(p), descriptors = kDescriptors * lanes_of(p);
    p.line_pixels = width;
    p.descriptor_fifo = kDescriptors + 8;
    EngineBench bench(p);
    const Frame in = p.steps == 0 ? combs(width, 60, descriptors) : packed(width, 60, descriptors);
    bench.run(in);
    if (p.steps != 0) {
      EXPECT_GT(bench.engine.work().extended_runs, 2u * 30u * static_cast<unsigned>(descriptors));
    }
    EXPECT_GT(bench.engine.extractor.descriptors_sent.value(), 50u);
    const std::uint64_t stalls = bench.engine.extractor.descriptor_stalls.value();
    EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), unstalled(in, p) + stalls);
    return stalls;
  }
  static int bound() {
    const Parameters p = build(GetParam());
    return least_beats(p, kDescriptors, p.steps == 0);
  }
};
TEST_P(Bursts, BoundAvoidsStalls) { EXPECT_EQ(stalls(bound()), 0u); }
class LongBursts : public Bursts {};
TEST_P(LongBursts, RowsOneTenthShorterStall) { EXPECT_GT(stalls(bound() * 9 / 10), 0u); }
INSTANTIATE_TEST_SUITE_P(Builds, Bursts,
                         ::testing::Values(Build{0, 8, 2, 4, 1, 24},  // deburr
                                           Build{1, 8, 2, 4, 1, 24}, Build{2, 8, 2, 4, 1, 24},
                                           Build{0, 8, 1, 4, 1, 24}, Build{0, 8, 4, 4, 1, 24},
                                           Build{0, 16, 2, 4, 1, 24}, Build{0, 5, 2, 4, 1, 24},
                                           Build{0, 8, 2, 1, 1, 24}, Build{0, 8, 2, 2, 1, 24},
                                           Build{0, 8, 2, 3, 1, 24}, Build{0, 8, 4, 8, 1, 24},
                                           Build{0, 8, 2, 4, 20, 24}, Build{0, 8, 2, 4, 1, 64},
                                           Build{0, 0, 2, 4, 1, 24}, Build{0, 0, 2, 4, 5, 24}));
INSTANTIATE_TEST_SUITE_P(Builds, LongBursts,
                         ::testing::Values(Build{0, 8, 2, 4, 1, 24}, Build{2, 8, 2, 4, 1, 24},
                                           Build{0, 8, 1, 4, 1, 24}, Build{0, 8, 4, 4, 1, 24},
                                           Build{0, 16, 2, 4, 1, 24}, Build{0, 5, 2, 4, 1, 24},
                                           Build{0, 8, 2, 1, 1, 24}, Build{0, 8, 2, 2, 1, 24},
                                           Build{0, 8, 2, 3, 1, 24}, Build{0, 8, 4, 8, 1, 24},
                                           Build{0, 8, 2, 4, 20, 24}));

// Descriptors for which only classes are found: vertical runs of one pixel, one descriptor per
// cycle at the end of a row.
class Classes : public ::testing::TestWithParam<std::tuple<int, int, int>> {
 protected:
  static constexpr int kDescriptors = 120;
  static Parameters built(int beats) {
    const auto [lanes_code, units, trial_cycles] = GetParam();
    Parameters p = preset(Preset::kDeburr);
    p.lanes = static_cast<spec::morphological::Lanes>(lanes_code);
    p.predictor_units = units;
    p.trial_cycles = trial_cycles;
    p.line_pixels = beats * lanes_of(p);
    return p;
  }
  static std::uint64_t stalls(int beats) {
    const Parameters p = built(beats);
    EngineBench bench(p);
    const Frame in = combs(p.line_pixels, 60, kDescriptors * lanes_of(p));
    bench.run(in);
    EXPECT_GT(bench.engine.extractor.descriptors_sent.value(), 500u);
    const std::uint64_t stalls = bench.engine.extractor.descriptor_stalls.value();
    EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), unstalled(in, p) + stalls);
    return stalls;
  }
  static int bound() {
    const auto [lanes_code, units, cycles] = GetParam();
    const int held = cycles >= 3 ? cycles : cycles == 2 ? 4 : 2;
    return std::max(kDescriptors, kDescriptors * (held - units) / units + 2 * held + 12);
  }
};
TEST_P(Classes, BoundAvoidsStalls) { EXPECT_EQ(stalls(bound()), 0u); }
INSTANTIATE_TEST_SUITE_P(Builds, Classes,
                         ::testing::Values(std::tuple{0, 2, 4}, std::tuple{0, 1, 4},
                                           std::tuple{0, 1, 8}, std::tuple{1, 2, 4},
                                           std::tuple{2, 2, 4}, std::tuple{2, 2, 3},
                                           std::tuple{2, 2, 8}, std::tuple{2, 4, 4},
                                           std::tuple{2, 4, 8}, std::tuple{0, 1, 1},
                                           std::tuple{0, 1, 2}, std::tuple{0, 1, 3}));
class LongClasses : public Classes {};
TEST_P(LongClasses, RowsOneTenthShorterStall) { EXPECT_GT(stalls(bound() * 9 / 10), 0u); }
INSTANTIATE_TEST_SUITE_P(Builds, LongClasses,
                         ::testing::Values(std::tuple{0, 1, 4}, std::tuple{0, 1, 8},
                                           std::tuple{0, 1, 2}, std::tuple{0, 2, 4},
                                           std::tuple{1, 2, 4}, std::tuple{2, 2, 4},
                                           std::tuple{2, 2, 8}, std::tuple{2, 4, 8}));

TEST(Bursts, BoundsOfTheDefaultBuilds) {
  const Parameters deburr = build({0, 8, 2, 4, 1, 24}), mlaa = build({0, 0, 2, 4, 1, 24});
  EXPECT_EQ(least_beats(deburr, 1, false), 16 + 36 + 24 + 2 + 12);
  EXPECT_EQ(least_beats(deburr, 40, false), 720);
  EXPECT_EQ(least_beats(mlaa, 40, true), 40);
}

// A burst at the end of one row and one at the beginning of the next.
struct Depth {
  int beats, descriptors, fifo;
  bool stalls;
};
void PrintTo(const Depth& d, std::ostream* out) {
  *out << d.descriptors << " records in rows of " << d.beats << ", FIFO of " << d.fifo;
}
// Depth for both bursts: one burst fits if descriptor_fifo >= n (1 - 2 / q) + 8.
constexpr int depth_for(int descriptors) {
  constexpr int kCycles = 18;  // q of deburr
  return 2 * ((descriptors * (kCycles - 2) + kCycles - 1) / kCycles + 8);
}
class FifoDepth : public ::testing::TestWithParam<Depth> {};
TEST_P(FifoDepth, FifoHoldsBothBursts) {
  Parameters p = preset(Preset::kDeburrLine);
  const int width = GetParam().beats, descriptors = GetParam().descriptors;
  p.line_pixels = width;
  p.descriptor_fifo = GetParam().fifo;
  EngineBench bench(p);
  const Frame in = draw(width, 120, [=](int x, int y) {
    const bool burst = y % 40 < 20 ? x >= width - 2 * descriptors : x < 2 * descriptors;
    return grey(burst && (x + y) / 2 % 2 != 0 ? 255 : 0);
  });
  bench.run(in);
  const std::uint64_t stalls = bench.engine.extractor.descriptor_stalls.value();
  EXPECT_EQ(stalls != 0, GetParam().stalls);
  EXPECT_EQ(bench.engine.extractor.interlock_stalls.value(), 0u);
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), unstalled(in, p) + stalls);
}
// Rows of 1200, 1920 and 2480 beats with the largest number of descriptors: the depth of the
// formula suffices, and two thirds of it do not. The default of 256 suffices for rows of 1920
// beats.
INSTANTIATE_TEST_SUITE_P(Depths, FifoDepth,
                         ::testing::Values(Depth{800, 20, 24, true}, Depth{800, 20, 44, false},
                                           Depth{1200, 66, depth_for(66), false},
                                           Depth{1200, 66, depth_for(66) * 2 / 3, true},
                                           Depth{1920, 106, 256, false},
                                           Depth{1920, 106, depth_for(106) * 2 / 3, true},
                                           Depth{2480, 137, depth_for(137), false},
                                           Depth{2480, 137, depth_for(137) * 2 / 3, true}));

// Rows shorter than the pipeline wait for the line buffers, with or without descriptors.
struct Narrow {
  int lanes_code, width;
  std::uint64_t rows;
};
void PrintTo(const Narrow& n, std::ostream* out) { *out << n.width; }
class NarrowRows : public ::testing::TestWithParam<Narrow> {};
TEST_P(NarrowRows, NarrowRowsWaitForLineBuffers) {
  Parameters p = preset(Preset::kMlaa);
  p.lanes = static_cast<spec::morphological::Lanes>(GetParam().lanes_code);
  EngineBench bench(p);
  const Frame in = draw(GetParam().width, 100, [](int, int) { return grey(128); });
  const Frame out = bench.run(in);
  EXPECT_EQ(out.pixel, in.pixel);
  EXPECT_EQ(bench.engine.extractor.descriptor_stalls.value(), 0u);
  EXPECT_EQ(stalls(bench.engine.pixel_store, "rows") != 0, GetParam().rows != 0);
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(), unstalled(in, p) + GetParam().rows);
}
INSTANTIATE_TEST_SUITE_P(Widths, NarrowRows,
                         ::testing::Values(Narrow{0, 1, 90}, Narrow{0, 2, 80}, Narrow{0, 3, 46},
                                           Narrow{0, 4, 0}, Narrow{2, 4, 90}, Narrow{2, 8, 80},
                                           Narrow{2, 12, 46}, Narrow{2, 16, 0}));

// storage = memory loads two rows ahead, so two rows must last for the latency of a line plus its
// beats.
struct Load {
  int lanes_code;
  std::uint32_t latency;
  int beats;
  bool stalls;
};
void PrintTo(const Load& l, std::ostream* out) { *out << l.latency << ' ' << l.beats; }
class MemoryRows : public ::testing::TestWithParam<Load> {};
TEST_P(MemoryRows, RowsMustCoverTheLineLatency) {
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
                         ::testing::Values(Load{0, 80, 49, true}, Load{0, 80, 50, false},
                                           Load{0, 80, 51, false}, Load{0, 100, 59, true},
                                           Load{0, 100, 60, false}, Load{1, 100, 55, true},
                                           Load{1, 100, 56, false}, Load{2, 100, 53, true},
                                           Load{2, 100, 54, false}));

}  // namespace
}  // namespace deburr::tb::morphological_rtl::bounds_test
