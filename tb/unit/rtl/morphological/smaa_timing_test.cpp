// SPDX-License-Identifier: MIT
// Cycles of an engine with SMAA's blocks: the latency of every beat, when a record is finished, and
// words that are used before they are there.
#include <string>

#include "tb/unit/rtl/morphological/parts.h"

namespace deburr::tb::morphological_rtl::smaa_timing_test {
namespace {

using spec::morphological::Preset;
using spec::morphological::Quality;

struct Case {
  Quality quality;
  int width, height, lanes_code;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.width << 'x' << c.height; }

class SmaaLatency : public ::testing::TestWithParam<Case> {};

// As without: SMAA's blocks cost no clock, on a line and on random pixels of 37 % edges.
TEST_P(SmaaLatency, IsThatOfTheFormula) {
  const Case c = GetParam();
  Parameters p = smaa(c.quality);
  p.lanes = static_cast<spec::morphological::Lanes>(c.lanes_code);
  p.line_pixels = c.width;
  EngineBench bench(p);
  stimuli::Sequence s;
  const Frame in = draw(c.width, c.height, [&](int x, int y) {
    if (x > c.width / 2) return grey(s.next() % 100 < 13 ? 255 : 0);
    return grey(7 * x > 31 * y ? 255 : 0);
  });
  bench.run(in);
  const auto beats = static_cast<Cycle>(beats_a_row(in, p));
  const Cycle latency = static_cast<Cycle>(search_range_of(p) + 5) * beats + kPipe;
  EXPECT_EQ(bench.engine.beat_latency.min(), latency);
  EXPECT_EQ(bench.engine.beat_latency.max(), latency);
  EXPECT_EQ(bench.engine.extractor.descriptor_stalls.value(), 0u);
  EXPECT_EQ(bench.engine.sequencer.frame_cycles.value(),
            static_cast<Cycle>(c.height + search_range_of(p) + 5) * beats + kPipe);
  if (bench.engine.diagonals) {
    EXPECT_EQ(stalls(bench.engine.area, "diagonals"), 0u);
    EXPECT_EQ(stalls(bench.engine.extractor, "diagonals"), 0u);
    EXPECT_EQ(stalls(*bench.engine.diagonals, "downstream"), 0u);
  }
  for (const rtl::MemoryBase* memory : bench.engine.memories())
    EXPECT_EQ(memory->not_implementable(), "") << memory->name();
}

INSTANTIATE_TEST_SUITE_P(
    Sizes, SmaaLatency,
    ::testing::Values(Case{Quality::kLow, 200, 60, 0}, Case{Quality::kMedium, 200, 40, 1},
                      Case{Quality::kHigh, 200, 40, 0}, Case{Quality::kHigh, 400, 40, 1},
                      Case{Quality::kUltra, 400, 30, 2}, Case{Quality::kUltra, 1920, 6, 0}));

// The line takes a stage more at the entrance of an AreaUnit with a table.
TEST(SmaaInterlock, ADescriptorIsFinishedAClockLater) {
  Parameters p = preset(Preset::kMlaa);
  p.area = spec::morphological::AreaSource::kTableFull;
  EngineBench bench(p);
  bench.run(draw(20, 40, [](int x, int y) { return grey(x >= 17 && y >= 20 ? 255 : 0); }));
  constexpr unsigned kFound = 6, kFinished = 6;
  EXPECT_EQ(bench.engine.extractor.interlock_stalls.value(), kFound + 24 + kFinished - 21);
}

class ShortRows : public ::testing::TestWithParam<int> {};

// A row of fewer beats than a diagonal takes: rows wait for the one before, and all goes on.
TEST_P(ShortRows, WaitForTheDiagonalsOfTheRowBefore) {
  Parameters p = smaa(Quality::kUltra);
  p.line_pixels = 64;
  EngineBench bench(p);
  const int width = GetParam();
  bench.run(draw(width, 60, [](int x, int y) { return grey(x >= y % 16 ? 255 : 0); }), 100'000);
  EXPECT_EQ(stalls(bench.engine.extractor, "diagonals") != 0, width < 17);
  EXPECT_EQ(stalls(bench.engine.area, "diagonals"), 0u);
}
INSTANTIATE_TEST_SUITE_P(Beats, ShortRows, ::testing::Values(1, 2, 4, 5, 16, 17, 18));

}  // namespace
}  // namespace deburr::tb::morphological_rtl::smaa_timing_test
