// SPDX-License-Identifier: MIT
// Flicker over the frames of a run: every figure computed by hand.
#include "tool/run/flicker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "spec/error.h"
#include "tb/base/file.h"
#include "tb/base/interrupt.h"

namespace deburr::tool::flicker_test {
namespace {

tb::Image picture(int left, int right) {
  const auto code = [](int v) { return static_cast<std::uint8_t>(v); };
  tb::Image image(2, 1, {code(left), code(left), code(left), 255});
  image.at(1, 0) = {code(right), code(right), code(right), 255};
  return image;
}

// Left and right pixel of input, output and reference.
struct Frame {
  tb::Image before, after, reference;
  std::optional<tb::Mask> drawn{};
};

// A directory for the files of a run.
struct Folder {
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "deburr-XXXXXX").string();
    path = ::mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path); }
  std::filesystem::path path;
};

struct Measured {
  tb::Result result;
  std::map<std::string, double> work;
  std::string rows;          // of frames.csv
  std::size_t pictures = 0;  // frame_NNNN.png
};
Measured measured(const std::vector<Frame>& frames) {
  const Folder folder;
  const tb::ParameterSet set;
  RunContext context(folder.path, set, "", 1);
  context.set_quiet(true);
  context.claim();
  Measured m;
  std::vector<int> asked;
  measure_flicker(static_cast<int>(frames.size()), context, m.result, [&](int i) {
    asked.push_back(i);
    const Frame& frame = frames[static_cast<std::size_t>(i)];
    return SequencePicture{frame.before, frame.after, frame.reference, frame.drawn};
  });
  for (std::size_t i = 0; i < asked.size(); ++i) EXPECT_EQ(asked[i], static_cast<int>(i));
  const auto draft = folder.path / ".deburr_run";
  m.rows = tb::read_file(draft / "frames.csv", 1 << 20);
  for (const auto& entry : std::filesystem::directory_iterator(draft))
    if (entry.path().extension() == ".png") ++m.pictures;
  for (const tb::WorkItem& item : m.result.work) {
    if (const auto* real = std::get_if<double>(&item.value)) m.work[item.name] = *real;
    if (const auto* whole = std::get_if<std::uint64_t>(&item.value))
      m.work[item.name] = static_cast<double>(*whole);
  }
  return m;
}

// The steps of the output differ from those of the reference by -4, 0 and +6, 0, and then 0, 3;
// those of the input by 10, 0 and 0, 0 and 0, 20.
TEST(Flicker, ComparesEachPairOfFramesWithItsReference) {
  const Measured m = measured({{picture(10, 10), picture(10, 20), picture(10, 50)},
                               {picture(30, 10), picture(16, 20), picture(20, 50)},
                               {picture(30, 10), picture(22, 20), picture(20, 50)},
                               {picture(10, 40), picture(2, 33), picture(0, 60)}});
  EXPECT_EQ(m.work.size(), 4u);
  EXPECT_DOUBLE_EQ(m.work.at("flicker"), std::sqrt((16.0 / 2 + 36.0 / 2 + (0 + 9.0) / 2) / 3));
  EXPECT_DOUBLE_EQ(m.work.at("flicker_worst"), std::sqrt(18.0));
  EXPECT_EQ(m.work.at("flicker_worst_frame"), 2);
  EXPECT_DOUBLE_EQ(m.work.at("flicker_before"), std::sqrt((100.0 / 2 + 0 + 400.0 / 2) / 3));
  ASSERT_EQ(m.result.terminal.size(), 2u);
  EXPECT_EQ(m.result.terminal[1].text,
            "frame_0000.png to frame_0003.png, their quality in frames.csv");
  EXPECT_EQ(m.result.terminal[0].text,
            "3.19/255 over 4 frames (worst 4.24, at frame 2), against 9.13 of the input");
  ASSERT_EQ(m.result.figures.size(), 2u);
  EXPECT_EQ(m.result.figures[0].key, "work.flicker");
  EXPECT_EQ(m.result.figures[0].against, "work.flicker_worst");
  EXPECT_EQ(m.result.figures[1].against, "work.flicker_before");
  EXPECT_FALSE(m.result.interrupted);
}

TEST(Flicker, WritesEveryFrameWithItsQuality) {
  const tb::Image before(16, 16, {100, 100, 100, 255}), reference(16, 16, {110, 110, 110, 255});
  const Measured m = measured({{before, reference, reference}, {before, before, {}}});
  EXPECT_EQ(m.pictures, 2u);
  EXPECT_THAT(m.rows, testing::StartsWith("frame,file,psnr_db,psnr_before_db,"));
  // 20 lg(255 / 10)
  EXPECT_THAT(m.rows, testing::HasSubstr("\n0,frame_0000.png,inf,28.13"));
  EXPECT_THAT(m.rows, testing::EndsWith("\n1,frame_0001.png,,,,,,,,\n"));
}

// Frames without a reference use the input instead.
TEST(Flicker, UsesInputWithoutReference) {
  const Measured m = measured({{picture(10, 10), picture(10, 10), {}},
                               {picture(20, 10), picture(23, 10), {}},
                               {picture(20, 10), picture(23, 10), picture(20, 10)}});
  EXPECT_DOUBLE_EQ(m.work.at("flicker"), std::sqrt((9.0 / 2 + 0) / 2));
  EXPECT_EQ(m.work.at("flicker_before"), 0);
  EXPECT_EQ(m.result.terminal[0].text,
            "1.50/255 over 3 frames (worst 2.12, at frame 1), beyond that of the input");
  ASSERT_EQ(m.result.figures.size(), 1u);
}

TEST(Flicker, EmptySequenceHasNoWorstFrame) {
  const Frame still{picture(1, 2), picture(3, 4), picture(5, 6)};
  const Measured m = measured({still, still, still});
  EXPECT_EQ(m.work.at("flicker"), 0);
  EXPECT_EQ(m.work.count("flicker_worst_frame"), 0u) << "null";
  EXPECT_EQ(m.result.work.size(), 4u);
  EXPECT_EQ(m.result.terminal[0].text, "0.00/255 over 3 frames, against 0.00 of the input");
}

TEST(Flicker, CountsOnlyDrawnPixels) {
  tb::Mask left(2, 1);
  left.at(0, 0) = 1;
  const Measured m = measured({{picture(0, 0), picture(0, 0), picture(0, 0), left},
                               {picture(0, 0), picture(5, 90), picture(0, 0), left}});
  EXPECT_DOUBLE_EQ(m.work.at("flicker"), 5);
}

TEST(Flicker, RejectsFramesOfDifferentSizes) {
  const tb::Image wide(3, 1), high(2, 2);
  for (const tb::Image& other : {wide, high})
    EXPECT_THROW(measured({{picture(0, 0), picture(0, 0), picture(0, 0)}, {other, other, other}}),
                 spec::ConfigError);
}

TEST(Flicker, InterruptedRunHasNoFigures) {
  const Folder folder;
  const tb::ParameterSet set;
  RunContext context(folder.path, set, "", 1);
  context.set_quiet(true);
  context.claim();
  tb::Result result;
  measure_flicker(3, context, result, [&](int i) -> SequencePicture {
    if (i == 2) throw tb::Interrupted();
    return {picture(0, 0), picture(i, 0), picture(0, 0)};
  });
  EXPECT_TRUE(result.interrupted);
  EXPECT_TRUE(result.work.empty());
  EXPECT_TRUE(result.figures.empty());
}

TEST(Flicker, CameraMovesWithoutListOfFrames) {
  tb::SequenceParameters sequence;
  sequence.motion = tb::Motion::kPan;
  tb::FrameLists lists;
  lists.add("scene.source", {"a"});
  EXPECT_EQ(move_of(sequence, lists, 2).frame, 2);
  EXPECT_EQ(move_of(sequence, lists, 2).motion, tb::Motion::kPan);
  lists.add("scene.eye", {"0,0,1", "0,0,2", "0,0,3"});
  EXPECT_EQ(move_of(sequence, lists, 2).frame, 0);
}

}  // namespace
}  // namespace deburr::tool::flicker_test
