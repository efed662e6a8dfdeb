// SPDX-License-Identifier: MIT
// Deburr is closer to the supersampled reference than every other preset and than no filter, on
// edges and on silhouettes of every frame; exceptions must be listed
// (docs/measurements/morphological_quality.md, "Learned weights"). Uses third-party frames and
// meshes (DEBURR_DATA, or the data folder next to the repository) and the scenes in every clone.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "golden/morphological/configuration.h"
#include "golden/morphological/morphological_golden.h"
#include "studies/training/stand_ins.h"
#include "tb/harness/test_paths.h"
#include "tb/scene/image_io.h"
#include "tb/scene/quality.h"
#include "tb/scene/reference.h"
#include "tb/stimuli/reference_filters.h"

namespace deburr::studies::morphological_frames_test {

using tb::Image;
using tb::read_image;

namespace {

using golden::morphological::MorphologicalGolden;
using golden::morphological::preset_parameters;
using spec::morphological::Preset;

Image smoothed(const Image& frame, const spec::morphological::Parameters& parameters) {
  MorphologicalGolden golden(parameters, MorphologicalGolden::Detail::kPixels);
  Image out(frame.width, frame.height);
  out.pixels = golden.process({frame.pixels, frame.width, frame.height});
  return out;
}

struct Figures {
  double edges = 0, silhouettes = 0;  // PSNR, dB
};

class Checker {
 public:
  Checker(std::string name, const Image& frame, const Image& reference,
          const std::optional<tb::DepthImage>& depth)
      : name_(std::move(name)),
        frame_(frame),
        reference_(reference),
        edges_(tb::edge_mask(reference, frame)) {
    if (depth) silhouettes_ = tb::silhouette_mask(edges_, *depth);
  }
  Figures check(const std::string& method, const Image& image) const {
    const Figures f{psnr(image, reference_, edges_),
                    silhouettes_ ? psnr(image, reference_, *silhouettes_) : std::nan("")};
    std::cout << fmt::format("{:<12} {:<17} edges {:.2f} dB, silhouettes {:.2f} dB\n", name_,
                             method, f.edges, f.silhouettes);
    return f;
  }
  Figures check(Preset preset) const {
    return check(std::string(spec::morphological::kPresetNames[static_cast<std::size_t>(preset)]),
                 preset_parameters(preset));
  }
  Figures check(const std::string& method,
                const spec::morphological::Parameters& configuration) const {
    return check(method, smoothed(frame_, configuration));
  }
  const std::string& name() const { return name_; }
  const Image& frame() const { return frame_; }
  Figures check(const tb::stimuli::ReferenceFilter& reference) const {
    return check(reference.name, reference.filter(frame_, true));
  }

 private:
  std::string name_;
  const Image &frame_, &reference_;
  tb::Mask edges_;
  std::optional<tb::Mask> silhouettes_;
};

// SMAA at each quality, and with the dynamic threshold of paper 003.
std::vector<std::pair<std::string, spec::morphological::Parameters>> smaa_configuration() {
  std::vector<std::pair<std::string, spec::morphological::Parameters>> all;
  for (const auto quality :
       {spec::morphological::Quality::kLow, spec::morphological::Quality::kMedium,
        spec::morphological::Quality::kHigh, spec::morphological::Quality::kUltra}) {
    all.emplace_back(
        fmt::format("smaa {}",
                    spec::morphological::kQualityNames[static_cast<std::size_t>(quality)]),
        preset_parameters(Preset::kSmaa, quality));
  }
  for (const int alpha : {838860, 1677721, 3355443}) {
    spec::morphological::Parameters p = preset_parameters(Preset::kSmaaDynamic);
    p.alpha = alpha;
    all.emplace_back(fmt::format("smaa-dynamic {:.2f}", alpha / 16777216.0), p);
  }
  return all;
}

// SMAA's blocks in deburr-line.
std::vector<std::pair<std::string, spec::morphological::Parameters>> mixed_configuration() {
  const spec::morphological::Parameters line = preset_parameters(Preset::kDeburrLine);
  std::vector<std::pair<std::string, spec::morphological::Parameters>> all;
  const auto add = [&](const char* name, auto&&... changes) {
    all.emplace_back(name, line);
    (changes(all.back().second), ...);
  };
  using Parameters = spec::morphological::Parameters;
  const auto diagonals = [](Parameters& p) { p.diagonals = true; };
  const auto corners = [](Parameters& p) { p.round_corners = true; };
  const auto strongest = [](Parameters& p) {
    p.blend = spec::morphological::BlendRule::kStrongest;
  };
  const auto crossings = [](Parameters& p) { p.ends = spec::morphological::Ends::kCrossings; };
  add("+ diagonals", diagonals);
  add("+ corners", corners);
  add("+ crossings", crossings);
  add("+ strongest", strongest);
  add("+ diag + strong", diagonals, strongest);
  add("+ all four", diagonals, corners, crossings, strongest);
  return all;
}

// Cases where another method is better than deburr, with the largest allowed difference in dB. The
// quality page has the same list.
struct Behind {
  std::string_view frame, method;
  double edges, silhouettes;
};
constexpr std::array<Behind, 1> kBehind = {{{"vehicle 2", "smaa medium", 0, 0.3}}};

// Deburr beats the method, or the pair is listed in kBehind. NaN: not compared.
void expect_ahead(const std::string& frame, const std::string& method, const Figures& deburr,
                  const Figures& other) {
  Behind said{frame, method, 0, 0};
  for (const Behind& b : kBehind)
    if (b.frame == frame && b.method == method) said = b;
  const auto expect = [&](double ours, double theirs, double slack, const char* where) {
    if (!std::isfinite(theirs)) return;
    EXPECT_GT(ours, theirs - slack) << frame << ", " << method << ", " << where;
    if (slack > 0) {
      EXPECT_LT(ours, theirs) << frame << ", " << method << ", " << where << ": better than said";
    }
  };
  expect(deburr.edges, other.edges, said.edges, "edges");
  expect(deburr.silhouettes, other.silhouettes, said.silhouettes, "silhouettes");
}

// Better than no filter and than every other preset; better than mlaa by more than `margin` dB.
void expect_deburr_best(const Checker& checker, double margin) {
  const Figures deburr = checker.check(Preset::kDeburr), mlaa = checker.check(Preset::kMlaa);
  EXPECT_GT(deburr.edges, mlaa.edges + margin);
  const auto ahead = [&](const std::string& method, const Figures& other) {
    expect_ahead(checker.name(), method, deburr, other);
  };
  ahead("none", checker.check("none", checker.frame()));
  ahead("mlaa", mlaa);
  ahead("mlaa-slope", checker.check(Preset::kMlaaSlope));
  ahead("deburr-line", checker.check(Preset::kDeburrLine));
  for (const auto& [name, configuration] : smaa_configuration())
    ahead(name, checker.check(name, configuration));
  for (const tb::stimuli::ReferenceFilter& reference : tb::stimuli::kReferenceFilters)
    ahead(reference.name, checker.check(reference));
  for (const auto& [name, configuration] : mixed_configuration())
    checker.check(name, configuration);
}

std::filesystem::path data(const char* name) { return tb::data_folder() / name; }

TEST(MorphologicalFrames, DeburrIsBestOnTrackAt720p) {
  if (!std::filesystem::exists(data("frames/track_720p_noaa.png")))
    GTEST_SKIP() << "no " << data("frames/track_720p_noaa.png")
                 << ": set DEBURR_DATA to the folder that holds frames/";
  const Image frame = read_image(data("frames/track_720p_noaa.png")),
              reference = read_image(data("frames/track_720p_ssaa256.png"));
  expect_deburr_best(
      {"track 720p", frame, reference, tb::read_depth(data("frames/track_720p_depth24.png"))},
      0.75);
}

TEST(MorphologicalFrames, DeburrIsBestOnTrackAt1080p) {
  if (!std::filesystem::exists(data("frames/track_1080p_noaa.png")))
    GTEST_SKIP() << "no " << data("frames/track_1080p_noaa.png")
                 << ": set DEBURR_DATA to the folder that holds frames/";
  const Image frame = read_image(data("frames/track_1080p_noaa.png")),
              reference = read_image(data("frames/track_1080p_ssaa64.png"));
  expect_deburr_best({"track 1080p", frame, reference, std::nullopt}, 0.75);
}

// The same scene from four other cameras.
TEST(MorphologicalFrames, DeburrIsBestOnTrackFromOtherCameras) {
  const std::filesystem::path mesh = data("meshes/scene_track.obj");
  if (!std::filesystem::exists(mesh))
    GTEST_SKIP() << "no " << mesh << ": set DEBURR_DATA to the folder that holds meshes/";
  struct View {
    Imath::V3d eye, target;
    double fov;
  };
  for (const View& view :
       {View{{-4, 1.5, 10}, {2, 0.5, -4}, 1.0}, View{{0.5, 4, 9}, {0, 0, -6}, 1.0},
        View{{8, 1.2, 2}, {-4, 0.8, -2}, 1.0}, View{{0, 8, 14}, {0, 0, -4}, 0.7}}) {
    tb::SceneOptions options;
    options.camera.emplace();
    options.camera->eye = view.eye;
    options.camera->target = view.target;
    options.camera->fov_y = view.fov;
    const tb::LitFrames lit = tb::render_lit_frames(tb::import_scene(mesh, options), 960, 540, 8);
    const Checker checker("track", lit.noaa, lit.reference, lit.depth);
    expect_deburr_best(checker, 0.2);
  }
}

struct Rendered {
  const char* source;  // a scene's name, or a mesh of the data folder
  int width, height;
  double margin;
};
void PrintTo(const Rendered& r, std::ostream* out) { *out << r.source; }

class RenderedFrames : public testing::TestWithParam<Rendered> {
 protected:
  void SetUp() override {
    const Rendered& r = GetParam();
    const bool file = std::filesystem::path(r.source).has_extension();
    if (file && !std::filesystem::exists(data(r.source)))
      GTEST_SKIP() << "no " << data(r.source) << ": set DEBURR_DATA to the folder that holds it";
    const tb::Scene scene = file ? tb::import_scene(data(r.source)) : tb::make_scene(r.source);
    lit_ = tb::render_lit_frames(scene, r.width, r.height, 8);
    check_.emplace(std::filesystem::path(r.source).stem().string(), lit_.noaa, lit_.reference,
                   lit_.depth);
    check_->check("MSAA 4x", tb::render_msaa4(scene, r.width, r.height));
  }
  tb::LitFrames lit_;
  std::optional<Checker> check_;
};

class DeburrIsBest : public RenderedFrames {};
TEST_P(DeburrIsBest, BeatsOthersOnEdgesAndSilhouettes) {
  expect_deburr_best(*check_, GetParam().margin);
}

std::string name_of(const testing::TestParamInfo<Rendered>& info) {
  std::string name = std::filesystem::path(info.param.source).stem().string();
  std::replace(name.begin(), name.end(), '-', '_');
  return name + "_" + std::to_string(info.param.width);
}

// Available in every clone. The weights were trained on them too.
INSTANTIATE_TEST_SUITE_P(
    Scenes, DeburrIsBest,
    testing::Values(Rendered{"cylinders", 640, 480, 3}, Rendered{"cylinders", 512, 512, 3},
                    Rendered{"object", 512, 512, 0.2}, Rendered{"object", 1280, 720, 0.2},
                    Rendered{"road", 512, 512, 0}, Rendered{"road", 640, 480, 0},
                    Rendered{"quad", 512, 512, 0}),
    name_of);

// Third-party meshes, from the camera that frames them. The weights were trained on them too.
INSTANTIATE_TEST_SUITE_P(
    Meshes, DeburrIsBest,
    testing::Values(Rendered{"meshes/teapot.obj", 512, 512, 0.2},
                    Rendered{"meshes/spot.obj", 512, 512, 0.1},
                    Rendered{"meshes/kenney_truck.obj", 512, 512, 0.5},
                    Rendered{"meshes/WusonOBJ.obj", 512, 512, 0.3},
                    Rendered{"meshes/wing.obj", 512, 512, 0.1},
                    Rendered{"meshes/wheelcover.obj", 512, 512, 0.1},
                    Rendered{"meshes/canopy_open.obj", 512, 512, 0.2},
                    Rendered{"kenney/city/models/building-garage.glb", 512, 512, 1},
                    Rendered{"kenney/city/models/building-small-a.glb", 512, 512, 1},
                    Rendered{"kenney/city/models/building-small-c.glb", 512, 512, 1},
                    Rendered{"kenney/city/models/road-straight-lightposts.glb", 512, 512, 1},
                    Rendered{"kenney/city/models/pavement-fountain.glb", 512, 512, 1},
                    Rendered{"kenney/city/models/grass-trees-tall.glb", 512, 512, 1},
                    Rendered{"kenney/racing/models/vehicle-truck-red.glb", 512, 512, 1},
                    Rendered{"kenney/racing/models/vehicle-motorcycle.glb", 512, 512, 1},
                    Rendered{"kenney/racing/models/track-finish.glb", 512, 512, 1},
                    Rendered{"kenney/racing/models/decoration-tents.glb", 512, 512, 1},
                    Rendered{"kenney/racing/models/decoration-forest.glb", 512, 512, 1}),
    name_of);

// Held out: first evaluated after the configuration was final, and never trained on.
INSTANTIATE_TEST_SUITE_P(
    HeldOut, DeburrIsBest,
    testing::Values(Rendered{"kenney/city/models/building-small-b.glb", 512, 512, 1},
                    Rendered{"kenney/city/models/building-small-d.glb", 512, 512, 1},
                    Rendered{"kenney/city/models/grass-trees.glb", 512, 512, 1},
                    Rendered{"kenney/city/models/grass.glb", 512, 512, 1},
                    Rendered{"kenney/city/models/pavement.glb", 512, 512, 1},
                    Rendered{"kenney/city/models/road-split.glb", 512, 512, 1},
                    Rendered{"kenney/city/models/road-straight.glb", 512, 512, 1},
                    Rendered{"kenney/city/models/road-corner.glb", 512, 512, 1},
                    Rendered{"kenney/city/models/road-intersection.glb", 512, 512, 1},
                    Rendered{"kenney/racing/models/track-corner.glb", 512, 512, 1},
                    Rendered{"kenney/racing/models/track-bump.glb", 512, 512, 1},
                    Rendered{"kenney/racing/models/track-straight.glb", 512, 512, 1},
                    Rendered{"kenney/racing/models/track-tents.glb", 512, 512, 1},
                    Rendered{"kenney/racing/models/vehicle-truck-purple.glb", 512, 512, 1},
                    Rendered{"kenney/racing/models/vehicle-truck-yellow.glb", 512, 512, 1},
                    Rendered{"kenney/racing/models/vehicle-truck-green.glb", 512, 512, 1},
                    Rendered{"kenney/racing/models/decoration-empty.glb", 512, 512, 1}),
    name_of);

// ---- stand-ins, for clones without the data folder ----------------------------------------------

struct StandIn {
  const char* kind;
  std::uint64_t seed;
};
void PrintTo(const StandIn& s, std::ostream* out) { *out << s.kind << ' ' << s.seed; }

class StandIns : public testing::TestWithParam<StandIn> {};
TEST_P(StandIns, DeburrIsBestOnStandIns) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("deburr_stand_in_{}", ::getpid());
  std::filesystem::create_directories(folder);
  const tb::Scene scene =
      tb::import_scene(write_stand_in(folder, GetParam().kind, GetParam().seed));
  std::filesystem::remove_all(folder);
  const tb::LitFrames lit = tb::render_lit_frames(scene, 512, 512, 8);
  const Checker checker(fmt::format("{} {}", GetParam().kind, GetParam().seed), lit.noaa,
                        lit.reference, lit.depth);
  expect_deburr_best(checker, 0.2);
}
INSTANTIATE_TEST_SUITE_P(
    Frames, StandIns,
    testing::Values(StandIn{"street", 1}, StandIn{"street", 2}, StandIn{"street", 3},
                    StandIn{"vehicle", 1}, StandIn{"vehicle", 2}, StandIn{"vehicle", 3},
                    StandIn{"forest", 1}, StandIn{"forest", 2}, StandIn{"forest", 3}),
    [](const auto& p) { return fmt::format("{}_{}", p.param.kind, p.param.seed); });

// Nearly all edges are texture, which every analytic preset blends at a loss.
INSTANTIATE_TEST_SUITE_P(Texture, DeburrIsBest,
                         testing::Values(Rendered{"tunnel", 512, 512, 1},
                                         Rendered{"plane", 512, 512, 4},
                                         Rendered{"meshes/terrain_open.obj", 512, 512, 2}),
                         name_of);

// Required of weights that were trained without these frames.
TEST(MorphologicalFrames, LearnedWeightsMeetTheirBoundsOutOfSample) {
  if (!std::filesystem::exists(data("frames/track_720p_noaa.png")))
    GTEST_SKIP() << "no " << data("frames/track_720p_noaa.png")
                 << ": set DEBURR_DATA to the folder that holds frames/";
  const Image small = read_image(data("frames/track_720p_noaa.png")),
              small_reference = read_image(data("frames/track_720p_ssaa256.png"));
  const Checker track("track 720p", small, small_reference,
                      tb::read_depth(data("frames/track_720p_depth24.png")));
  const Figures figures = track.check(Preset::kDeburr);
  EXPECT_GT(figures.edges, 30.55);
  EXPECT_GT(figures.silhouettes, 27.95);
  const Image large = read_image(data("frames/track_1080p_noaa.png")),
              large_reference = read_image(data("frames/track_1080p_ssaa64.png"));
  EXPECT_GT(
      Checker("track 1080p", large, large_reference, std::nullopt).check(Preset::kDeburr).edges,
      31.5);
}

// Injected fault: without the line fit and its edges the gain is gone.
TEST(MorphologicalFrames, DetectsWorseFilter) {
  const tb::LitFrames lit = tb::render_lit_frames(tb::make_scene("cylinders"), 320, 240, 8);
  const Checker checker("cylinders", lit.noaa, lit.reference, lit.depth);
  spec::morphological::Parameters worse = preset_parameters(Preset::kDeburrLine);
  worse.predictor = spec::morphological::Predictor::kNone;  // the injected fault
  worse.threshold = preset_parameters(Preset::kMlaa).threshold;
  EXPECT_LT(checker.check("worse", smoothed(lit.noaa, worse)).edges,
            checker.check(Preset::kMlaa).edges + 0.5);
}

}  // namespace
}  // namespace deburr::studies::morphological_frames_test
