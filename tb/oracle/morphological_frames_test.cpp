// SPDX-License-Identifier: MIT
// Does deburr come nearer to supersampled truth than mlaa and mlaa-slope, on edges and on
// silhouettes? On frames that others rendered (DEBURR_DATA, or data beside the repository) and on
// the scene of five cylinders, which every clone has.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <string>

#include "golden/morphological/configuration.h"
#include "golden/morphological/morphological_golden.h"
#include "tb/scene/image_io.h"
#include "tb/scene/quality.h"
#include "tb/scene/truth.h"

namespace deburr::tb {
namespace {

using golden::morphological::MorphologicalGolden;
using golden::morphological::preset_parameters;
using spec::MorphologicalPreset;

Image smoothed(const Image& frame, const spec::MorphologicalParameters& parameters) {
  MorphologicalGolden golden(parameters, MorphologicalGolden::Detail::kPixels);
  Image out(frame.width, frame.height);
  out.pixels = golden.process({frame.pixels, frame.width, frame.height});
  return out;
}

struct Figures {
  double edges = 0, silhouettes = 0;  // PSNR, dB
};

class Judge {
 public:
  Judge(std::string name, const Image& frame, const Image& truth,
        const std::optional<DepthImage>& depth)
      : name_(std::move(name)), frame_(frame), truth_(truth), edges_(edge_mask(truth, frame)) {
    if (depth) silhouettes_ = silhouette_mask(edges_, *depth);
  }
  Figures judge(const std::string& method, const Image& image) const {
    const Figures f{psnr(image, truth_, edges_),
                    silhouettes_ ? psnr(image, truth_, *silhouettes_) : 0};
    std::cout << fmt::format("{:<12} {:<11} edges {:.2f} dB, silhouettes {:.2f} dB\n", name_,
                             method, f.edges, f.silhouettes);
    return f;
  }
  Figures judge(MorphologicalPreset preset) const {
    return judge(std::string(spec::kMorphologicalPresetNames[static_cast<std::size_t>(preset)]),
                 smoothed(frame_, preset_parameters(preset)));
  }
  bool has_silhouettes() const { return silhouettes_.has_value(); }

 private:
  std::string name_;
  const Image &frame_, &truth_;
  Mask edges_;
  std::optional<Mask> silhouettes_;
};

void expect_deburr_best(const Judge& judge, const Image& frame) {
  const Figures none = judge.judge("none", frame), mlaa = judge.judge(MorphologicalPreset::kMlaa),
                slope = judge.judge(MorphologicalPreset::kMlaaSlope),
                deburr = judge.judge(MorphologicalPreset::kDeburr);
  EXPECT_GT(mlaa.edges, none.edges);
  EXPECT_GT(deburr.edges, mlaa.edges + 0.5);
  EXPECT_GT(deburr.edges, slope.edges + 0.5);
  if (!judge.has_silhouettes()) return;
  EXPECT_GT(deburr.silhouettes, mlaa.silhouettes + 0.5);
  EXPECT_GT(deburr.silhouettes, slope.silhouettes + 0.5);
}

std::filesystem::path data(const char* name) {
  const char* folder = std::getenv("DEBURR_DATA");
  return (folder ? folder : std::filesystem::path(DEBURR_SOURCE_DIR) / "../shared/data") /
         "frames" / name;
}

TEST(MorphologicalFrames, DeburrIsBestOnTrackAt720p) {
  if (!std::filesystem::exists(data("track_720p_noaa.png")))
    GTEST_SKIP() << "no " << data("track_720p_noaa.png")
                 << ": set DEBURR_DATA to the folder that holds frames/";
  const Image frame = read_image(data("track_720p_noaa.png")),
              truth = read_image(data("track_720p_ssaa256.png"));
  expect_deburr_best({"track 720p", frame, truth, read_depth(data("track_720p_depth24.png"))},
                     frame);
}

TEST(MorphologicalFrames, DeburrIsBestOnTrackAt1080p) {
  if (!std::filesystem::exists(data("track_1080p_noaa.png")))
    GTEST_SKIP() << "no " << data("track_1080p_noaa.png")
                 << ": set DEBURR_DATA to the folder that holds frames/";
  const Image frame = read_image(data("track_1080p_noaa.png")),
              truth = read_image(data("track_1080p_ssaa64.png"));
  expect_deburr_best({"track 1080p", frame, truth, std::nullopt}, frame);
}

TEST(MorphologicalFrames, DeburrIsBestOnCylinders) {
  const LitFrames lit = render_lit_frames(make_scene("cylinders"), 640, 480, 8);
  expect_deburr_best({"cylinders", lit.noaa, lit.truth, lit.depth}, lit.noaa);
}

// The check can fail: without the line fit and its edges there is nothing to be better by.
TEST(MorphologicalFrames, AWorseFilterIsCaught) {
  const LitFrames lit = render_lit_frames(make_scene("cylinders"), 320, 240, 8);
  const Judge judge("cylinders", lit.noaa, lit.truth, lit.depth);
  spec::MorphologicalParameters worse = preset_parameters(MorphologicalPreset::kDeburr);
  worse.predictor = spec::Predictor::kNone;  // the planted fault
  worse.threshold = preset_parameters(MorphologicalPreset::kMlaa).threshold;
  EXPECT_LT(judge.judge("worse", smoothed(lit.noaa, worse)).edges,
            judge.judge(MorphologicalPreset::kMlaa).edges + 0.5);
}

}  // namespace
}  // namespace deburr::tb
