// SPDX-License-Identifier: MIT
// Pictures and quality of a run, complete or interrupted.
#include "tool/run/pictures.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "spec/error.h"
#include "tb/base/file.h"
#include "tb/scene/flip.h"
#include "tb/scene/image_io.h"
#include "tb/scene/ssim.h"

namespace deburr::tool::pictures_test {

using tb::Image;
using tb::Rgba8;

namespace {

constexpr Rgba8 kGrey = {128, 128, 128, 255}, kBlack = {0, 0, 0, 255},
                kWhite = {255, 255, 255, 255};

TEST(Quality, ComparesBothPicturesWithTheReference) {
  Image reference(8, 8, {100, 100, 100, 255}), before = reference, after = reference;
  before.at(3, 3) = {110, 100, 100, 255};
  after.at(3, 3) = {101, 100, 100, 255};
  const tb::Quality q = measure_quality("x", before, after, reference, nullptr);
  // One channel of one edge pixel: mse 100 / 3 and 1 / 3.
  EXPECT_NEAR(*q.psnr_edge_before_db, 32.90, 0.01);
  EXPECT_NEAR(*q.psnr_edge_db, 52.90, 0.01);
  EXPECT_NEAR(*q.psnr_db - *q.psnr_before_db, 20.0, 0.01);
  EXPECT_FALSE(q.psnr_silhouette_db || q.psnr_silhouette_before_db) << "no depth";
  const tb::DepthImage flat(8, 8, 1.0f);
  EXPECT_FALSE(measure_quality("x", before, after, reference, &flat).psnr_silhouette_db);
  const tb::Quality same = measure_quality("x", reference, reference, reference, nullptr);
  EXPECT_EQ(*same.psnr_db, std::numeric_limits<double>::infinity());
  EXPECT_FALSE(same.psnr_edge_db) << "no edge pixels";
}

TEST(Quality, GivesFlipAndSsimOfBothPictures) {
  const Image reference(16, 16, {100, 100, 100, 255});
  Image before = reference, after = reference;
  before.at(3, 8) = {200, 100, 100, 255};
  after.at(3, 8) = {120, 100, 100, 255};
  const tb::Quality q = measure_quality("x", before, after, reference, nullptr);
  EXPECT_EQ(*q.flip, tb::flip(reference, after));
  EXPECT_EQ(*q.flip_before, tb::flip(reference, before));
  EXPECT_GT(*q.flip_before, *q.flip);
  EXPECT_EQ(*q.ssim, ssim(reference, after));
  EXPECT_EQ(*q.ssim_before, ssim(reference, before));
  EXPECT_LT(*q.ssim_before, *q.ssim);
  const Image small(10, 40);
  EXPECT_FALSE(measure_quality("x", small, small, small, nullptr).ssim) << "no window fits";
}

TEST(Change, CountsPixelsByCodeDifference) {
  const Image before(10, 2, {100, 100, 100, 255});
  Image after = before, reference = before;
  after.at(0, 0)[0] = 102;  // 2: not more than 2
  after.at(1, 0)[1] = 97;   // 3
  after.at(2, 0)[2] = 116;  // 16
  after.at(3, 0)[0] = 117;  // 17, and this one was wrong
  after.at(4, 0)[3] = 0;    // alpha does not count
  reference.at(3, 0)[0] = 120;
  reference.at(5, 0)[0] = 98;  // right within 2 codes, and bypassed
  tb::Change change = measure_change(before, after, nullptr);
  EXPECT_DOUBLE_EQ(change.small_percent, 15);
  EXPECT_DOUBLE_EQ(change.large_percent, 5);
  EXPECT_FALSE(change.right_small_percent || change.right_large_percent) << "no reference";
  EXPECT_NEAR(change.psnr_db, 10 * std::log10(65025.0 * 60 / (4 + 9 + 256 + 289)), 1e-9);
  change = measure_change(before, after, &reference);
  EXPECT_DOUBLE_EQ(*change.right_small_percent, 100 * 2.0 / 19);
  EXPECT_DOUBLE_EQ(*change.right_large_percent, 0);
  after.at(6, 0)[0] = 120;  // 20, and it was right
  change = measure_change(before, after, &reference);
  EXPECT_DOUBLE_EQ(*change.right_small_percent, 100 * 3.0 / 19);
  EXPECT_DOUBLE_EQ(*change.right_large_percent, 100 * 1.0 / 19);
  const Image wrong(10, 2, {0, 0, 0, 255});
  EXPECT_FALSE(measure_change(before, after, &wrong).right_small_percent) << "nothing was right";
  EXPECT_EQ(measure_change(before, before, nullptr).psnr_db,
            std::numeric_limits<double>::infinity());
}

class Pictures : public testing::Test {
 protected:
  Pictures()
      : path_(std::filesystem::temp_directory_path() /
              ("deburr_pictures_" + std::to_string(::getpid()))) {}
  ~Pictures() override { std::filesystem::remove_all(path_); }

  // Writes the pictures of a 4 x 3 frame of which this many pixels were delivered.
  void leave(std::size_t delivered) {
    const Image before(4, 3, {10, 10, 10, 255}), reference(4, 3, {14, 10, 10, 255});
    Image after(4, 3);  // pixels that were not delivered have arbitrary values
    for (std::size_t i = 0; i < delivered; ++i) after.pixels[i] = {12, 10, 10, 255};
    Image golden(4, 3, {12, 10, 10, 255});
    golden.at(1, 0) = {13, 10, 10, 255};
    tb::ParameterSet parameters;
    RunContext context(path_, parameters, "x", 0);
    context.set_leaves(
        {{"before", "after", "golden", "difference", "reference", "error", "change"}, {}});
    context.claim();
    add_frame_pictures(context, {before, after, delivered, &golden, &reference, "", ""});
    tb::Result result;
    result.unit = "smoother";
    context.finish(result);
  }
  Image picture(const char* name) const {
    return tb::read_image(path_ / (std::string(name) + ".png"));
  }

  std::filesystem::path path_;
};

TEST_F(Pictures, WholeFrameComparesEveryPixel) {
  leave(12);
  EXPECT_EQ(picture("after"), Image(4, 3, {12, 10, 10, 255}));
  EXPECT_EQ(picture("error"), Image(4, 3, {8, 0, 0, 255}));
  EXPECT_EQ(picture("change"), Image(4, 3, {8, 0, 0, 255}));
  const Image difference = picture("difference");
  EXPECT_EQ(difference.at(1, 0), (Rgba8{255, 0, 0, 255})) << "golden says 13";
  EXPECT_EQ(difference.at(2, 0), kBlack);
}

TEST_F(Pictures, InterruptedFrameHidesMissingPixels) {
  leave(5);
  const Image after = picture("after");
  EXPECT_EQ(after.at(0, 1), (Rgba8{12, 10, 10, 255}));
  EXPECT_EQ(after.at(1, 1), kGrey);
  EXPECT_EQ(after.at(3, 2), kGrey);
  for (const char* name : {"error", "change", "difference"}) {
    const Image compared = picture(name);
    EXPECT_EQ(compared.at(1, 1), kBlack) << name;
    EXPECT_EQ(compared.at(3, 2), kBlack) << name;
  }
  EXPECT_EQ(picture("error").at(0, 1), (Rgba8{8, 0, 0, 255}));
  const std::string manifest = tb::read_file(path_ / "manifest.json", 1 << 20);
  EXPECT_NE(manifest.find("5 of 12 pixels"), std::string::npos);
}

// A picture with an undeclared name could replace a user's file.
TEST_F(Pictures, RejectsUndeclaredNames) {
  tb::ParameterSet parameters;
  RunContext context(path_, parameters, "x", 0);
  context.set_leaves({{"after"}, {"level"}});
  context.claim();
  context.add_image("after", Image(1, 1), "", "");
  EXPECT_THROW(context.add_image("classes", Image(1, 1), "", ""), spec::CheckFailed);
  context.add_map(tb::PictureMap("level", "", "", "", 1, 1));
  EXPECT_THROW(context.add_map(tb::PictureMap("texture_level", "", "", "", 1, 1)),
               spec::CheckFailed);
}

TEST(WeightsPicture, DoublesBrightnessAndShowsOverlapInBlue) {
  const Image weights = weights_picture(3, 1, {{40, 10, false}, {200, 3, true}, {}});
  EXPECT_EQ(weights.pixels,
            (std::vector<Rgba8>{{80, 20, 0, 255}, {255, 6, 160, 255}, {0, 0, 0, 255}}));
}

TEST(DeliveredPart, FillsTheRestFromAnotherPicture) {
  const Image white(2, 2, kWhite);
  EXPECT_EQ(delivered_part(white, 4, kBlack), white);
  EXPECT_EQ(delivered_part(white, 9, kBlack), white);
  EXPECT_EQ(delivered_part(white, 0, kBlack), Image(2, 2, kBlack));
  EXPECT_EQ(delivered_part(white, 3, kBlack).pixels,
            (std::vector<Rgba8>{kWhite, kWhite, kWhite, kBlack}));
}

}  // namespace
}  // namespace deburr::tool::pictures_test
