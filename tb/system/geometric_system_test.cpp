// SPDX-License-Identifier: MIT
// Whole frames through the hardware model of the geometric engine: every line, candidate, block,
// pixel, counter and memory line equal to the golden model, for every preset and build; and
// conditions that must not change the picture.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <tuple>

#include "spec/error.h"
#include "tb/base/forked.h"
#include "tb/engines/geometric/geometric_frames.h"
#include "tb/harness/test_paths.h"
#include "tb/system/geometric_runs.h"

namespace deburr::tb::geometric_system::geometric_system_test {
namespace {

using Frames = std::vector<Frame>;

// Everything was delivered and compared, including each pixel.
GeometricOutcome expect_identical(const Frames& frames, const GeometricRunOptions& options) {
  const GeometricOutcome outcome = simulate(frames, options);
  EXPECT_EQ(outcome.mismatches, 0u);
  EXPECT_EQ(outcome.traffic_mismatches, 0u);
  std::uint64_t pixels = 0, edges = 0;
  for (const Frame& frame : frames) {
    pixels += frame.image.pixels.size();
    edges += frame.screen.edges.size();
  }
  EXPECT_GE(outcome.comparisons, pixels + outcome.lines + outcome.candidates);
  EXPECT_GE(outcome.traffic_comparisons, edges / 4);
  return outcome;
}

template <class Tuple>
std::string name_of(const testing::TestParamInfo<Tuple>& info) {
  std::string name{
      spec::geometric::kPresetNames[static_cast<std::size_t>(std::get<0>(info.param))]};
  std::replace(name.begin(), name.end(), '-', '_');
  return fmt::format("{}_{}", name, info.index);
}

// ---- presets x layouts x walkers x edge lanes ---------------------------------------------------

using Variant = std::tuple<Preset, Layout, Lanes, Lanes>;
class EveryVariant : public testing::TestWithParam<Variant> {};

TEST_P(EveryVariant, ConsecutiveFramesAreIdenticalToGolden) {
  const auto [which, layout, walkers, edge_lanes] = GetParam();
  GeometricRunOptions options;
  options.geometric = preset(which);
  options.geometric.layout = layout;
  options.geometric.walkers = walkers;
  options.geometric.edge_lanes = edge_lanes;
  options.geometric.line_pixels = 1024;
  const GeometricOutcome outcome = expect_identical(
      {random_frame(131, 77, 1), random_frame(5, 90, 2, 90), random_frame(603, 9, 3, 200),
       random_frame(64, 64, 4, 700), random_frame(1, 1, 5, 40)},
      options);
  EXPECT_GT(outcome.blended, 4000u);
}

INSTANTIATE_TEST_SUITE_P(Geometric, EveryVariant,
                         testing::Combine(testing::ValuesIn(kPresets),
                                          testing::Values(Layout::kRaster, Layout::kTiled),
                                          testing::Values(Lanes::kOne, Lanes::kTwo, Lanes::kFour),
                                          testing::Values(Lanes::kOne, Lanes::kTwo, Lanes::kFour)),
                         name_of<Variant>);

class EveryMix : public testing::TestWithParam<int> {};

// Each option and each size is drawn at random.
TEST_P(EveryMix, FramesMatchGolden) {
  const auto seed = static_cast<std::uint64_t>(GetParam());
  Random random(seed, "mix");
  const auto below = [&](int n) {
    return static_cast<int>(random.below(static_cast<std::uint32_t>(n)));
  };
  const auto lanes = [&] { return static_cast<Lanes>(below(3)); };
  const auto cache = [&] { return static_cast<CacheLines>(below(below(2) ? 7 : 2)); };
  GeometricRunOptions options;
  Parameters& p = options.geometric;
  p.select = static_cast<spec::geometric::Select>(below(4) == 0 ? 0 : 1 + below(2));
  p.crease = static_cast<spec::geometric::Crease>(below(3));
  p.depth_test = static_cast<spec::geometric::DepthTest>(below(3));
  p.depth_bias = 1 + below(24);
  p.combine = static_cast<spec::geometric::Combine>(below(3));
  p.coverage = static_cast<spec::geometric::CoverageRule>(below(3) != 0);
  p.cull = static_cast<spec::geometric::Cull>(below(2));
  p.crease_depth = below(2) ? 0 : below(25);
  p.linear_light = below(2) != 0;
  p.mark = below(2) != 0;
  p.layout = static_cast<Layout>(below(2));
  p.frame_copy = below(3) == 0;
  p.line_pixels = 300;
  p.touched_words = 16 + below(64);
  p.face_limit = 8192 + 512 * below(3);
  p.edge_lanes = lanes();
  p.edge_lines = 4 + below(60);
  p.vertex_lines = cache();
  p.pipelined = below(3) == 0;
  p.dividers = 1 + below(8);
  p.reciprocal_table = p.pipelined ? 0 : below(12);
  p.line_fifo = 2 + below(20);
  p.walkers = lanes();
  p.depth_lines = cache();
  p.weight_blocks = cache();
  p.fills = spec::geometric::kMinFills + below(below(2) ? 60 : 4);
  p.latency_fifo = 4 + below(200);
  p.resolve_lanes = lanes();
  p.resolve_lines = 16 + below(100);
  p.copy_lines = 2 + below(40);
  p.memory_outstanding = p.fills + below(80);
  p.records = static_cast<spec::geometric::RecordsLayout>(below(2));
  p.colour_lines = below(2) ? 0 : 1 + below(below(2) ? 256 : 12);
  p.write_buffer = below(2) ? 0 : 1 + below(below(2) ? 128 : 6);
  if (p.depth_test != spec::geometric::DepthTest::kOff)
    p.coarse_lines = static_cast<spec::geometric::CoarseLines>(below(6));
  options.memory.latency = 1 + below(60);
  options.memory.latency_max = below(2) ? 0 : options.memory.latency + below(120);
  options.memory.banks = 1 << below(4);
  options.memory.bank_busy = below(6);
  options.seed = seed + 1;
  const auto frame = [&](int most_width, int most_lines, auto frame_seed) {
    const int lines = 1 + below(most_lines), height = 1 + below(60);
    Frame drawn = random_frame(1 + below(most_width), height, frame_seed, lines);
    // Every other tile is near, so that its depth bound hides lines.
    for (std::size_t i = 0; i < drawn.depths.size(); ++i) {
      const int x = static_cast<int>(i) % drawn.image.width,
                y = static_cast<int>(i) / drawn.image.width;
      if ((x / 8 + y / 8) % 2 != 0) drawn.depths[i] |= 8'000'000;
    }
    return drawn;
  };
  expect_identical(
      {frame(300, 500, seed + 100), frame(70, 500, seed + 200), frame(24, 80, seed + 300)},
      options);
}

INSTANTIATE_TEST_SUITE_P(Geometric, EveryMix, testing::Range(0, 80));

// ---- scenes, and external meshes ---------------------------------------------------------------

using Named = std::tuple<Preset, const char*>;
class RenderedFrame : public testing::TestWithParam<Named> {};

TEST_P(RenderedFrame, FramesMatchGolden) {
  const auto [which, scene] = GetParam();
  GeometricRunOptions options;
  options.geometric = preset(which);
  options.check_links = false;
  const GeometricOutcome outcome = expect_identical({scene_frame(scene, 320, 240)}, options);
  EXPECT_GT(outcome.blended, 300u);
}

INSTANTIATE_TEST_SUITE_P(Geometric, RenderedFrame,
                         testing::Combine(testing::ValuesIn(kPresets),
                                          testing::Values("cube", "wheelcover", "wing", "canopy",
                                                          "sphere", "terrain", "object")),
                         name_of<Named>);

// Each option that a preset combines, alone and all together, with any order of edges.
struct Rule {
  const char* name;
  void (*set)(Parameters&);
};
constexpr Rule kConfiguration[] = {
    {"none", [](Parameters&) {}},
    {"outermost", [](Parameters& p) { p.combine = spec::geometric::Combine::kOutermost; }},
    {"area", [](Parameters& p) { p.coverage = spec::geometric::CoverageRule::kArea; }},
    {"crease", [](Parameters& p) { p.crease_depth = 4; }},
    {"cull", [](Parameters& p) { p.cull = spec::geometric::Cull::kNone; }},
    {"all", [](Parameters& p) {
       p.combine = spec::geometric::Combine::kOutermost;
       p.coverage = spec::geometric::CoverageRule::kArea;
       p.crease_depth = 4;
       p.cull = spec::geometric::Cull::kNone;
     }}};
class OptionFrame : public testing::TestWithParam<std::tuple<std::size_t, const char*>> {};

TEST_P(OptionFrame, FramesMatchGoldenInAnyOrderOfEdges) {
  const auto& [rule, scene] = GetParam();
  std::vector<std::uint64_t> hashes;
  for (const std::uint64_t shuffle : {0u, 7u}) {
    const GeometricOutcome outcome = forked<GeometricOutcome>([&, rule = rule, scene = scene] {
      GeometricRunOptions options;
      Parameters& p = options.geometric;
      p.combine = spec::geometric::Combine::kMax;
      p.coverage = spec::geometric::CoverageRule::kDistance;
      p.crease_depth = 0;
      p.cull = spec::geometric::Cull::kBack;
      kConfiguration[rule].set(p);
      options.memory.latency = 30;
      options.memory.latency_max = 90;
      options.stall_permille = shuffle != 0 ? 100 : 0;
      Frames frames = {scene_frame(scene, 200, 150)};
      if (shuffle != 0) shuffle_edges(frames.front(), shuffle);
      return simulate(frames, options);
    });
    EXPECT_EQ(outcome.mismatches, 0u);
    EXPECT_EQ(outcome.traffic_mismatches, 0u);
    EXPECT_GT(outcome.blended, 200u);
    hashes.push_back(outcome.hash);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

INSTANTIATE_TEST_SUITE_P(Geometric, OptionFrame,
                         testing::Combine(testing::Range(std::size_t{0}, std::size(kConfiguration)),
                                          testing::Values("wheelcover", "object", "terrain")),
                         [](const auto& row) {
                           return fmt::format("{}_{}", kConfiguration[std::get<0>(row.param)].name,
                                              std::get<1>(row.param));
                         });

class DataMesh : public testing::TestWithParam<Named> {};

TEST_P(DataMesh, FramesMatchGolden) {
  const auto [which, name] = GetParam();
  const std::filesystem::path file = data_folder() / "meshes" / name;
  if (!std::filesystem::exists(file))
    GTEST_SKIP() << "no " << file << ": set DEBURR_DATA to the folder that holds meshes/";
  GeometricSceneParameters scene;
  scene.source = file.string();
  GeometricRunOptions options;
  options.geometric = preset(which);
  options.geometric.face_limit = 1 << 17;
  options.check_links = false;
  const LoadedGeometricFrame loaded = load_geometric_frame(scene, 1, false);
  const GeometricOutcome outcome = expect_identical({loaded.frame}, options);
  EXPECT_GT(outcome.blended, 300u);
}

INSTANTIATE_TEST_SUITE_P(Geometric, DataMesh,
                         testing::Values(std::tuple{Preset::kDeburr, "scene_track.obj"},
                                         std::tuple{Preset::kGpaaOptimised, "scene_track.obj"},
                                         std::tuple{Preset::kDeburr, "teapot.obj"},
                                         std::tuple{Preset::kGpaa, "teapot.obj"},
                                         std::tuple{Preset::kDeburr, "spot.obj"},
                                         std::tuple{Preset::kDeburr, "WusonOBJ.obj"},
                                         std::tuple{Preset::kDeburr, "kenney_truck.obj"}),
                         name_of<Named>);

// ---- conditions that must not change the picture -----------------------------------------------

class SamePicture : public testing::TestWithParam<Preset> {};

TEST_P(SamePicture, BuildAndOrderOfEdgesDoNotMatter) {
  const Preset which = GetParam();
  const auto run = [&](auto&& change, std::uint64_t shuffle = 0) {
    return forked<GeometricOutcome>([&] {
      GeometricRunOptions options;
      options.geometric = preset(which);
      change(options.geometric);
      Frames frames = {scene_frame("object", 160, 120), random_frame(97, 61, 8)};
      if (shuffle != 0)
        for (Frame& frame : frames) shuffle_edges(frame, shuffle);
      return simulate(frames, options);
    });
  };
  const GeometricOutcome built = run([](Parameters&) {});
  const auto expect_same = [&](const GeometricOutcome& other, const char* what) {
    EXPECT_EQ(other.hash, built.hash) << what;
    EXPECT_EQ(other.candidates, built.candidates) << what;
    EXPECT_NE(other.cycles, built.cycles) << what << " shows nowhere";
  };
  expect_same(run([](Parameters& p) { p.walkers = Lanes::kOne; }), "one walker");
  expect_same(run([](Parameters& p) { p.walkers = Lanes::kTwo; }), "two walkers");
  expect_same(run([](Parameters& p) { p.layout = Layout::kRaster; }), "raster");
  expect_same(run([](Parameters& p) { p.frame_copy = !p.frame_copy; }), "frame_copy");
  expect_same(run([](Parameters& p) { p.weight_blocks = CacheLines::k16; }), "few blocks");
  expect_same(run([](Parameters& p) {
                p.pipelined = false;
                p.reciprocal_table = 10;
              }),
              "a divider and a table");
  const bool any_order = preset(which).combine != spec::geometric::Combine::kLast;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const GeometricOutcome shuffled = run([](Parameters&) {}, seed);
    EXPECT_EQ(shuffled.candidates, built.candidates);
    EXPECT_EQ(shuffled.hash == built.hash, any_order) << "shuffled by " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Geometric, SamePicture, testing::ValuesIn(kPresets),
                         [](const auto& row) { return fmt::format("{}", row.index); });

// ---- memory errors -----------------------------------------------------------------------------

using Broken = std::tuple<Preset, std::size_t>;
class BrokenMemory : public testing::TestWithParam<Broken> {};

// The golden model predicts the data read as zeros, and counts the error responses.
TEST_P(BrokenMemory, ErrorResponsesReadAsZeroAndAreReported) {
  const auto [which, region] = GetParam();
  GeometricRunOptions options;
  options.geometric = preset(which);
  options.geometric.weight_blocks = CacheLines::k16;
  const auto index = static_cast<spec::geometric::Region>(region);
  if (index == spec::geometric::Region::kPairs)
    options.geometric.records = spec::geometric::RecordsLayout::kSplit;
  if (index == spec::geometric::Region::kCoarse)
    options.geometric.coarse_lines = spec::geometric::CoarseLines::k4;
  const std::vector<Frame> frames = {random_frame(90, 50, region + 20)};
  const platform::GeometricRegions map = regions_of(frames, options.geometric);
  const std::uint64_t from = map.base(index);
  options.memory.error_address = static_cast<std::int64_t>(from);
  options.memory.error_bytes = 64 * 9;
  Simulation simulation(options);
  GeometricEnvironment environment(simulation, frames, options);
  simulation.elaborate(environment);
  const bool used = index == spec::geometric::Region::kCopy    ? options.geometric.frame_copy
                    : index == spec::geometric::Region::kFaces ? which != Preset::kGpaa
                                                               : true;
  if (!used) {
    EXPECT_NO_THROW(simulation.run());
    EXPECT_THROW(environment.reject_unused_errors(), spec::ConfigError);
    return;
  }
  EXPECT_THROW(simulation.run(), spec::SimulationError);
  EXPECT_NO_THROW(environment.check());
  namespace reg = spec::geometric::reg;
  EXPECT_NE(environment.host().read(reg::kStatus) & reg::kStatusMemoryError, 0u);
  EXPECT_EQ(environment.host().read(reg::kMemoryErrors),
            environment.golden_model().memory_errors());
  EXPECT_GT(environment.golden_model().memory_errors(), 0u);
}

INSTANTIATE_TEST_SUITE_P(Geometric, BrokenMemory,
                         testing::Combine(testing::ValuesIn(kPresets),
                                          testing::Range(std::size_t{0},
                                                         platform::GeometricRegions::kCount)),
                         name_of<Broken>);

}  // namespace
}  // namespace deburr::tb::geometric_system::geometric_system_test
