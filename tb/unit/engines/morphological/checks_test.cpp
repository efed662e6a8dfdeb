// SPDX-License-Identifier: MIT
// Failures that the checks of the morphological engine report.
#include "spec/morphological/registers.h"
#include "tb/engines/morphological/morphological_checks.h"
#include "tb/unit/platform/fakes.h"

namespace deburr::tb::checks_test {
namespace {

spec::morphological::BlendedBeat beat(bool start_of_frame, bool end_of_row) {
  spec::morphological::BlendedBeat result{};
  result.count = 1;
  result.start_of_frame = start_of_frame;
  result.end_of_row = end_of_row;
  return result;
}

TEST(MorphologicalChecks, FrameStartsWithFirstPixelOnly) {
  MorphologicalSetup setup;
  setup.morphological.lanes = spec::morphological::Lanes::kOne;
  MorphologicalChecks checks(setup, true);
  const MorphologicalInput frame{Image(4, 2), {}};
  checks.begin(frame);
  checks.got_frame(0, 0, 4, beat(true, false));
  checks.got_frame(1, 3, 1, beat(false, true));
  EXPECT_EQ(checks.pixels.mismatches(), 0u);
  checks.got_frame(0, 0, 4, beat(false, false));
  EXPECT_EQ(checks.pixels.mismatches(), 1u);
  checks.got_frame(4, 4, 4, beat(true, false));
  EXPECT_EQ(checks.pixels.mismatches(), 2u);
}

spec::morphological::BlendedBeat beat_of(int count, bool start_of_frame, bool end_of_row) {
  spec::morphological::BlendedBeat result = beat(start_of_frame, end_of_row);
  result.count = static_cast<std::uint8_t>(count);
  return result;
}

// Rows of 10 in beats of 4, 4 and 2: the pixel that is reported as wrong; empty: none.
TEST(MorphologicalChecks, EachBeatHasItsPixelsAndSignals) {
  MorphologicalSetup setup;
  setup.morphological.lanes = spec::morphological::Lanes::kFour;
  const MorphologicalInput frame{Image(10, 3), {}};
  const auto wrong = [&](std::size_t position, std::size_t left,
                         const spec::morphological::BlendedBeat& received) {
    MorphologicalChecks checks(setup, true);
    checks.begin(frame);
    checks.got_frame(7, position, left, received);
    EXPECT_EQ(checks.pixels.mismatches(), checks.pixels.differences().size());
    return checks.pixels.differences().empty() ? "" : checks.pixels.differences()[0].item;
  };
  EXPECT_EQ(wrong(0, 10, beat_of(4, true, false)), "");
  EXPECT_EQ(wrong(14, 6, beat_of(4, false, false)), "");
  EXPECT_EQ(wrong(28, 2, beat_of(2, false, true)), "");
  EXPECT_EQ(wrong(14, 6, beat_of(3, false, false)), "pixel (4, 1)") << "one too few";
  EXPECT_EQ(wrong(18, 2, beat_of(3, false, false)), "pixel (8, 1)") << "one too many";
  EXPECT_EQ(wrong(10, 10, beat_of(4, true, false)), "pixel (0, 1)") << "no first pixel";
  EXPECT_EQ(wrong(0, 10, beat_of(4, false, false)), "pixel (0, 0)") << "not said to be the first";
  EXPECT_EQ(wrong(14, 6, beat_of(4, false, true)), "pixel (8, 1)") << "the row lacks it";
  EXPECT_EQ(wrong(10, 10, beat_of(4, false, true)), "pixel (0, 1)") << "it has come twice";
  EXPECT_EQ(wrong(11, 9, beat_of(4, false, true)), "pixel (5, 1)") << "a half is lacking";
  EXPECT_EQ(wrong(18, 2, beat_of(2, false, false)), "pixel (9, 1)") << "its row should end";
}

TEST(MorphologicalChecks, NamePixelInNonSquareFrame) {
  MorphologicalSetup setup;
  MorphologicalChecks checks(setup, true);
  const MorphologicalInput frame{Image(5, 3), {}};
  checks.begin(frame);
  for (std::size_t i = 0; i < 15; ++i) {
    spec::morphological::Rgba8 pixel = checks.golden_model().pixels()[i];
    spec::morphological::BlendProbe probe = checks.golden_model().probes()[i];
    if (i == 13) pixel[3] ^= 1;
    if (i == 7) probe.first ^= 1;
    checks.got(pixel, probe, 4);
  }
  ASSERT_EQ(checks.probes.mismatches(), 1u);
  EXPECT_EQ(checks.probes.differences()[0].item, "pixel (2, 1)");
  ASSERT_EQ(checks.pixels.mismatches(), 1u);
  EXPECT_EQ(checks.pixels.differences()[0].item, "pixel (3, 2)");
}

// A run with too few comparisons must not pass: the comparisons of all frames are
// required.
TEST(MorphologicalChecks, RequireComparisonsOfAllFrames) {
  MorphologicalSetup setup;
  setup.morphological.storage = spec::morphological::Storage::kMemory;
  setup.descriptors = true;
  MorphologicalChecks checks(setup, true);
  const std::vector<MorphologicalInput> frames = {{Image(16, 4), {}}, {Image(20, 3), {}}};
  spec::morphological::Work work;
  work.horizontal_runs = 3;
  work.vertical_runs = 4;
  work.z_runs = 5;
  FakeRegisters registers;
  checks.finish(frames, work, 0, registers);
  const auto needed = [](const ScoreboardBase& board) {
    return error_of<spec::Error>([&] { board.check(); });
  };
  using testing::HasSubstr;
  EXPECT_THAT(needed(checks.pixels), HasSubstr("at least 124 are needed"));
  EXPECT_THAT(needed(checks.probes), HasSubstr("at least 124 are needed"));
  EXPECT_THAT(needed(checks.traffic), HasSubstr("at least 20 are needed"));
  EXPECT_THAT(needed(checks.runs), HasSubstr("at least 7 are needed"));
  EXPECT_THAT(needed(checks.lines), HasSubstr("at least 5 are needed"));
}

// Each count of the work of all frames is compared with its register, including cycles and errors.
TEST(MorphologicalChecks, EachCounterEqualsItsWork) {
  MorphologicalSetup setup;
  const std::vector<MorphologicalInput> frames(1, {Image(8, 4), {}});
  const auto mismatches = [&](std::uint32_t wrong) {
    MorphologicalChecks checks(setup, true);
    checks.begin(frames[0]);
    checks.end(0, 0);
    FakeRegisters registers;
    registers.values[spec::morphological::reg::kFrameCycles] = 1234;
    for (const spec::morphological::WorkCount& each : spec::morphological::kWorkCounts)
      registers.values[each.offset] =
          static_cast<std::uint32_t>(checks.golden_model().work().*each.count);
    if (wrong != 0) ++registers.values[wrong];
    checks.finish(frames, {}, 1234, registers);
    return checks.registers.board().mismatches();
  };
  EXPECT_EQ(mismatches(0), 0u);
  for (const spec::morphological::WorkCount& each : spec::morphological::kWorkCounts)
    EXPECT_EQ(mismatches(each.offset), 1u) << each.offset;
  EXPECT_EQ(mismatches(spec::morphological::reg::kFrameCycles), 1u);
  EXPECT_EQ(mismatches(spec::morphological::reg::kMemoryErrors), 1u);
}

// MEMORY_ERRORS accumulates over frames: a line that could not be written cannot be read.
TEST(MorphologicalChecks, MemoryErrorsAccumulateOverFrames) {
  const auto mismatches = [](std::uint32_t memory_errors) {
    MorphologicalSetup setup;
    setup.morphological.storage = spec::morphological::Storage::kMemory;
    setup.memory.error_address = 0;
    MorphologicalChecks checks(setup, true);
    const std::vector<MorphologicalInput> frames(2, {Image(16, 4), {}});
    for (std::size_t i = 0; i < frames.size(); ++i) {
      checks.begin(frames[i]);
      checks.end(0, i);
    }
    FakeRegisters registers;
    registers.values[spec::morphological::reg::kMemoryErrors] = memory_errors;
    checks.finish(frames, {}, 0, registers);
    return checks.registers.board().mismatches();
  };
  EXPECT_LT(mismatches(4), mismatches(2));
}

}  // namespace
}  // namespace deburr::tb::checks_test
