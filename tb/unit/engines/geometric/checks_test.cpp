// SPDX-License-Identifier: MIT
// Failures that the checks of the geometric engine report.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tb/engines/geometric/geometric_checks.h"
#include "tb/system/geometric_runs.h"

namespace deburr::tb::checks_test {
namespace {

using geometric::Frame;

struct Checked {
  explicit Checked(bool golden = true)
      : frames{geometric_system::random_frame(21, 14, 3, 60),
               geometric_system::scene_frame("cube", 30, 17)},
        regions(regions_of(frames, setup.geometric)),
        checks(setup, regions, golden) {}
  // Passes the golden results of the current frame to the checks; one entry of a list may be wrong
  // or missing.
  void deliver(const std::string& wrong = "", bool missing = false) {
    const auto& golden = checks.golden_model();
    const auto all = [&](const char* list, const auto& records, auto&& spoil) {
      for (std::size_t i = 0; i < records.size(); ++i) {
        auto record = records[i];
        const bool here = wrong == list && i == records.size() / 2;
        if (here && missing) continue;
        if (here) spoil(record);
        checks.got(record, 10 + i);
      }
    };
    all("lines", golden.lines(), [](auto& line) { line.slope ^= 1; });
    all("candidates", golden.candidates(), [](auto& c) { c.passed = !c.passed; });
    all("blocks", golden.blocks(), [](auto& block) { block.weights[15][3] ^= 1; });
  }
  Image picture(const Frame& frame) const {
    Image image(frame.image.width, frame.image.height);
    image.pixels = checks.golden_model().pixels();
    return image;
  }
  std::string wrong() const {
    std::string text;
    for (const ScoreboardBase* board : {static_cast<const ScoreboardBase*>(&checks.lines),
                                        static_cast<const ScoreboardBase*>(&checks.candidates),
                                        static_cast<const ScoreboardBase*>(&checks.blocks),
                                        static_cast<const ScoreboardBase*>(&checks.pixels)})
      if (board->mismatches() + board->leftovers() > 0)
        text += fmt::format("{} {}+{} ", board->name(), board->mismatches(), board->leftovers());
    return text;
  }
  GeometricSetup setup;
  std::vector<Frame> frames;
  platform::GeometricRegions regions;
  GeometricChecks checks;
};

TEST(GeometricChecks, EachEntryOfEachListIsCompared) {
  for (const std::string list : {"lines", "candidates", "blocks"})
    for (const bool missing : {false, true}) {
      Checked c;
      for (const Frame& frame : c.frames) {
        c.checks.begin(frame);
        ASSERT_GT(c.checks.golden_model().blocks().size(), 2u);
        c.deliver(&frame == &c.frames[1] ? list : "", missing);
        c.checks.end(c.picture(frame), 99);
      }
      EXPECT_EQ(c.wrong(), list + " 1+0 ") << missing;
      EXPECT_EQ(c.checks.pixels.comparisons(), 21u * 14 + 30 * 17);
    }
}

TEST(GeometricChecks, DifferencesNameTheirItem) {
  Checked c;
  const Frame& frame = c.frames[1];
  c.checks.begin(frame);
  const auto candidates = c.checks.golden_model().candidates();
  const auto blocks = c.checks.golden_model().blocks();
  c.deliver("candidates");
  const auto& candidate = candidates[candidates.size() / 2];
  EXPECT_EQ(c.checks.candidates.differences().at(0).item,
            fmt::format("pixel ({}, {})", candidate.x, candidate.y));
  Checked other;
  other.checks.begin(other.frames[1]);
  other.deliver("blocks");
  const auto& block = blocks[blocks.size() / 2];
  EXPECT_EQ(other.checks.blocks.differences().at(0).item,
            fmt::format("block ({}, {})", block.x, block.y));
  Image after = c.picture(frame);
  after.at(23, 11)[2] ^= 1;
  c.checks.end(after, 99);
  ASSERT_EQ(c.checks.pixels.mismatches(), 1u);
  EXPECT_EQ(c.checks.pixels.differences()[0].item, "pixel (23, 11)");
  EXPECT_EQ(c.checks.pixels.differences()[0].where, "cycle 99");
}

// Results of a frame that was reset are discarded, and the whole frame is expected again.
TEST(GeometricChecks, RestartedFrameIsExpectedOnce) {
  Checked c;
  c.checks.begin(c.frames[0]);
  c.checks.got(c.checks.golden_model().lines()[0], 3);
  c.checks.restart();
  EXPECT_EQ(c.wrong(), "");
  EXPECT_EQ(c.checks.traffic.leftovers(), 0u);
  c.checks.begin(c.frames[0]);
  EXPECT_GT(c.checks.traffic.leftovers(), 10u);
  c.deliver();
  c.checks.end(c.picture(c.frames[0]), 99);
  EXPECT_EQ(c.wrong(), "");
}

TEST(GeometricChecks, ComparesNothingWithoutGolden) {
  Checked c(false);
  c.checks.begin(c.frames[0]);
  c.checks.got(spec::geometric::LineRecord(), 1);
  c.checks.got(spec::geometric::Candidate(), 1);
  c.checks.got(spec::geometric::BlockRecord(), 1);
  c.checks.end(Image(21, 14), 2);
  EXPECT_EQ(c.wrong(), "");
  EXPECT_EQ(c.checks.lines.comparisons() + c.checks.candidates.comparisons() +
                c.checks.blocks.comparisons() + c.checks.pixels.comparisons(),
            0u);
}

}  // namespace
}  // namespace deburr::tb::checks_test
