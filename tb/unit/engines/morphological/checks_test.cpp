// SPDX-License-Identifier: MIT
// What the checks of the morphological engine complain of.
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

TEST(MorphologicalChecks, AFrameStartsWithItsFirstPixelAlone) {
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

// MEMORY_ERRORS counts on from frame to frame: a line that cannot be read could not be written.
TEST(MorphologicalChecks, MemoryErrorsAreThoseOfAllFrames) {
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
