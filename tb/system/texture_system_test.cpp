// SPDX-License-Identifier: MIT
// Whole frames through the hardware model of the texture unit: every colour, line fill and status
// register equal to the golden model, for every mode, sample count, format, wrap and configuration.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <tuple>

#include "tb/base/forked.h"
#include "tb/engines/texture/texture_expectation.h"
#include "tb/harness/test_paths.h"
#include "tb/system/texture_runs.h"

namespace deburr::tb::texture_system_test {
namespace {

// Every covered fragment was delivered and compared.
void expect_identical(const TextureOutcome& outcome, int line_bytes = 64) {
  const std::uint64_t reads_a_fill = static_cast<std::uint64_t>(line_bytes + 63) / 64;
  EXPECT_EQ(outcome.mismatches, 0u);
  EXPECT_EQ(outcome.traffic_mismatches, 0u);
  EXPECT_GE(outcome.comparisons, outcome.colours);
  EXPECT_EQ(outcome.traffic_comparisons, outcome.fills * reads_a_fill);
  EXPECT_GT(outcome.colours, 0u);
  EXPECT_GT(outcome.fills, 0u);
}

// Hashes are compared with those of the same model on other machines, so only this test detects a
// channel that the hash omits.
TEST(Texture, HashCoversEveryChannelAndPositionOfEveryColour) {
  TextureRunOptions options;
  options.stand_ins = stand_ins_of_suite(options.texture, memory_cycles(options), options.seed);
  const TextureScene scene(picture("tunnel", 32), {}, 1);
  Simulation simulation(options);
  TextureEnvironment environment(simulation, scene, options);
  simulation.elaborate(environment);
  simulation.run();
  environment.check();
  expect_counterparts_of_suite(environment.unit());
  OutputHash hash;
  const TextureExpectation expected = expected_of(scene, options.texture);
  for (const spec::texture::Colour& colour : expected.colours) {
    hash.add(colour.tag);
    hash.add(2u * colour.lane + (colour.last ? 1 : 0));
    for (std::size_t c = 0; c < 4; ++c) hash.add(colour.rgba[c]);
  }
  EXPECT_EQ(environment.delivered(), expected.colours.size());
  EXPECT_EQ(environment.colour_hash(), hash.value());
}

// ---- three scenes x six modes x five sample counts ----------------------------------------------

using Mode = std::tuple<const char*, int, int>;
class EveryMode : public testing::TestWithParam<Mode> {};

TEST_P(EveryMode, FramesMatchGolden) {
  const auto [source, mode, lb_n] = GetParam();
  SamplerParameters sampler;
  sampler.mode = static_cast<spec::texture::MinFilter>(mode);
  sampler.anisotropy = static_cast<std::uint8_t>(lb_n);
  for (const TextureRunOptions& options : {paper_options(), TextureRunOptions{}})
    expect_identical(forked<TextureOutcome>(
        [&, &name = source] { return simulate(picture(name, 128), sampler, options); }));
}

INSTANTIATE_TEST_SUITE_P(
    Texture, EveryMode,
    testing::Combine(testing::Values("plane", "quad", "tunnel"), testing::Range(0, 6),
                     testing::Range(0, 5)),
    [](const auto& p) {
      return fmt::format(
          "{}_{}_n{}", std::get<0>(p.param),
          spec::texture::kMinFilterNames[static_cast<std::size_t>(std::get<1>(p.param))],
          1 << std::get<2>(p.param));
    });

// ---- formats x layouts x wraps, with a texture whose size is not a power of two
// ------------------

using Storage = std::tuple<int, int, int>;
class EveryFormat : public testing::TestWithParam<Storage> {};

TEST_P(EveryFormat, FramesMatchGolden) {
  const auto [format, layout, wrap] = GetParam();
  SamplerParameters sampler;
  sampler.format = static_cast<spec::texture::Format>(format);
  sampler.layout = static_cast<spec::texture::Layout>(layout);
  sampler.wrap = static_cast<WrapChoice>(wrap);
  SceneParameters scene = picture("plane", 96);
  scene.texture_size = 331;
  expect_identical(simulate(scene, sampler, {}));
}

INSTANTIATE_TEST_SUITE_P(Texture, EveryFormat,
                         testing::Combine(testing::Range(0, 5), testing::Range(0, 2),
                                          testing::Range(1, 4)),
                         [](const auto& p) {
                           const auto i = [](int v) { return static_cast<std::size_t>(v); };
                           return fmt::format("{}_{}_{}",
                                              spec::texture::kFormatNames[i(std::get<0>(p.param))],
                                              spec::texture::kLayoutNames[i(std::get<1>(p.param))],
                                              kWrapChoiceNames[i(std::get<2>(p.param))]);
                         });

// ---- axes x count x kernel x footprint x log x output -------------------------------------------

// Axes, count and footprint in all 45 combinations with each kernel; logarithm, cap, spread,
// output and cycles of the directions vary along with them.
using Configuration = std::tuple<int, int, int, int>;
class EveryOption : public testing::TestWithParam<Configuration> {};

spec::texture::Parameters configuration_of(const Configuration& configuration) {
  const auto [axes, count, footprint, kernel] = configuration;
  const int round = axes + 2 * count + footprint + 3 * kernel;
  spec::texture::Parameters p;
  p.axes = static_cast<spec::texture::Axes>(axes);
  p.count = static_cast<spec::texture::CountRule>(count);
  p.footprint = static_cast<spec::texture::FootprintRule>(footprint);
  p.kernel = static_cast<spec::texture::Kernel>(kernel);
  p.log2 = static_cast<spec::texture::Log2Rule>(round % 4);
  p.count_cap = static_cast<spec::texture::CountCap>(round / 2 % 2);
  p.spread = round % 3 == 0 ? 102 : 64;
  p.srgb_output = static_cast<spec::texture::SrgbOutput>(round % 2);
  p.axis_cycles = 1 << round % (axes + 1);
  return p;
}

TEST_P(EveryOption, FramesMatchGolden) {
  TextureRunOptions options;
  options.texture = configuration_of(GetParam());
  SamplerParameters sampler;
  sampler.format = spec::texture::Format::kSrgb8A8;
  expect_identical(simulate(picture("tunnel", 64), sampler, options));
}

INSTANTIATE_TEST_SUITE_P(Texture, EveryOption,
                         testing::Combine(testing::Range(0, 3), testing::Range(0, 3),
                                          testing::Range(0, 5), testing::Range(0, 3)),
                         [](const auto& p) {
                           const auto i = [](auto e) { return static_cast<std::size_t>(e); };
                           const spec::texture::Parameters r = configuration_of(p.param);
                           return fmt::format("{}_{}_{}_{}_{}_cap_{}_{}",
                                              spec::texture::kAxesNames[i(r.axes)],
                                              spec::texture::kCountNames[i(r.count)],
                                              spec::texture::kFootprintNames[i(r.footprint)],
                                              spec::texture::kKernelNames[i(r.kernel)],
                                              spec::texture::kLog2Names[i(r.log2)],
                                              spec::texture::kCountCapNames[i(r.count_cap)],
                                              spec::texture::kSrgbOutputNames[i(r.srgb_output)]);
                         });

// ---- cache geometries ---------------------------------------------------------------------------

struct Geometry {
  int bytes, line, ways, outstanding, fifo;
};
class EveryCache : public testing::TestWithParam<std::tuple<Geometry, int>> {};

TEST_P(EveryCache, FillsThePredictedLines) {
  const auto [geometry, replacement] = GetParam();
  TextureRunOptions options;
  options.texture.cache_bytes = geometry.bytes;
  options.texture.cache_line_bytes = geometry.line;
  options.texture.cache_ways = geometry.ways;
  options.texture.cache_outstanding = geometry.outstanding;
  options.texture.cache_fifo_depth = geometry.fifo;
  options.texture.cache_replacement = static_cast<spec::texture::Replacement>(replacement);
  expect_identical(simulate(picture("plane", 96), {}, options), geometry.line);
}

INSTANTIATE_TEST_SUITE_P(
    Texture, EveryCache,
    testing::Combine(testing::Values(Geometry{16384, 64, 2, 32, 160}, Geometry{1024, 64, 1, 4, 2},
                                     Geometry{4096, 128, 4, 16, 40}, Geometry{4096, 32, 2, 16, 40},
                                     Geometry{512, 64, 8, 8, 16}, Geometry{32768, 64, 8, 256, 400}),
                     testing::Range(0, 3)),
    [](const auto& p) {
      const Geometry& g = std::get<0>(p.param);
      return fmt::format(
          "bytes{}_line{}_ways{}_{}", g.bytes, g.line, g.ways,
          spec::texture::kReplacementNames[static_cast<std::size_t>(std::get<1>(p.param))]);
    });

// ---- depth of the latency FIFO

std::int32_t fifo_depth(const TextureRunOptions& options) {
  return rtl::texture::LatencyFifo::depth(options.texture, memory_cycles(options));
}

std::uint64_t cycles_with(TextureRunOptions options, std::int32_t fifo_depth) {
  options.texture.cache_fifo_depth = fifo_depth;
  return forked<std::uint64_t>([&] { return simulate(picture("plane", 64), {}, options).cycles; });
}

// The default is at the knee: more entries save no cycle, fewer cost some.
class FifoDepth : public testing::TestWithParam<std::tuple<bool, int>> {};

TEST_P(FifoDepth, DefaultIsTheKnee) {
  const auto [paper, latency] = GetParam();
  TextureRunOptions options = paper ? paper_options() : TextureRunOptions{};
  options.memory.latency = latency;
  const std::int32_t depth = fifo_depth(options);
  EXPECT_EQ(depth, latency + 7);
  const std::uint64_t cycles = cycles_with(options, 0);
  EXPECT_EQ(cycles_with(options, 2 * depth), cycles);
  EXPECT_GT(cycles_with(options, depth - 1), cycles);
}

INSTANTIATE_TEST_SUITE_P(Texture, FifoDepth,
                         testing::Combine(testing::Bool(), testing::Values(40, 108, 200)),
                         [](const auto& p) {
                           return fmt::format("{}_{}", std::get<0>(p.param) ? "paper" : "deburr",
                                              std::get<1>(p.param));
                         });

TEST(FifoDepthOfAMemoryThatVaries, DepthFollowsTheSlowestResponse) {
  TextureRunOptions options;
  options.memory.latency = 20;
  options.memory.latency_max = 300;
  EXPECT_EQ(fifo_depth(options), 300 + 7);
  options.memory.latency_max = 9000;
  EXPECT_EQ(fifo_depth(options), 4096);
  options.texture.cache_fifo_depth = 33;
  EXPECT_EQ(fifo_depth(options), 33);
}

// With several cycles per line there is a bend instead of a knee: the loss is below half a percent.
TEST(FifoDepthOfANarrowMemory, DefaultDepthCostsLittle) {
  TextureRunOptions options;
  options.memory.bytes_per_cycle = 16;
  const std::int32_t depth = fifo_depth(options);
  EXPECT_EQ(depth, options.memory.latency + 4 * 4 + 3);
  const auto most = static_cast<double>(cycles_with(options, 4 * depth));
  EXPECT_LE(static_cast<double>(cycles_with(options, 0)), 1.005 * most);
  EXPECT_GT(static_cast<double>(cycles_with(options, depth - 12)), 1.01 * most);
}

// ---- magnification, bias and clamps -------------------------------------------------------------

TEST(Texture, MagnificationBiasAndClampsAreIdenticalToGolden) {
  SceneParameters scene = picture("plane", 128);
  scene.texture_size = 16;
  SamplerParameters sampler;
  sampler.magnification = spec::texture::MagFilter::kNearest;
  sampler.lod_bias = -300;
  sampler.min_lod = 100;
  sampler.max_lod = 700;
  expect_identical(simulate(scene, sampler, {}));
}

TEST(Texture, ShortenedMipChainIsIdenticalToGolden) {
  SamplerParameters sampler;
  sampler.levels = 3;
  expect_identical(simulate(picture("plane", 128), sampler, {}));
}

TEST(Texture, OverdrawIsIdenticalToGolden) {
  SceneParameters scene = picture("object", 128);
  scene.visibility = Visibility::kOverdraw;
  expect_identical(simulate(scene, {}, {}));
}

TEST(Texture, FullHdFrameIsIdenticalToGolden) {
  SceneParameters scene = picture("road", 1);
  scene.width = 1920;
  scene.height = 1080;
  SamplerParameters sampler;
  sampler.anisotropy = 2;
  expect_identical(simulate(scene, sampler, {}));
  rusage usage{};
  ASSERT_EQ(getrusage(RUSAGE_SELF, &usage), 0);
  EXPECT_LT(usage.ru_maxrss, 1L << 20) << "KiB: the frame is to be checked as it comes, not kept";
}

// ---- cache traffic against an independent simulation -------------------------------------------

struct Traffic {
  const char* source;
  double misses_per_texel, texels_per_fragment, bilinears_per_fragment;
  std::uint64_t fills, bilinears, fragments;  // our values, equal on every machine
};
class CacheTraffic : public testing::TestWithParam<Traffic> {};

TEST_P(CacheTraffic, MatchesIndependentSimulation) {
  const Traffic& wanted = GetParam();
  const TextureOutcome got =
      simulate(picture(wanted.source, 512), {}, paper_options());  // 16 KB, 2 ways, 64 bytes
  expect_identical(got);
  const auto fills = static_cast<double>(got.fills), bilinears = static_cast<double>(got.bilinears),
             fragments = static_cast<double>(got.colours);
  const auto expect_near = [](const char* what, double value, double expected) {
    testing::Test::RecordProperty(what, fmt::format("{:.3f}", value));
    // The other simulation's rasteriser covers less of the picture.
    EXPECT_NEAR(value, expected, 0.12 * expected) << what;
  };
  expect_near("misses_per_texel_percent", 100 * fills / (4 * bilinears), wanted.misses_per_texel);
  expect_near("texels_fetched_per_fragment", 16 * fills / fragments, wanted.texels_per_fragment);
  expect_near("bilinears_per_fragment", bilinears / fragments, wanted.bilinears_per_fragment);
  EXPECT_EQ(got.fills, wanted.fills);
  EXPECT_EQ(got.bilinears, wanted.bilinears);
  EXPECT_EQ(got.colours, wanted.fragments);
}

INSTANTIATE_TEST_SUITE_P(Texture, CacheTraffic,
                         testing::Values(Traffic{"plane", 1.81, 9.0, 7.8, 141431, 2030284, 262144},
                                         Traffic{"quad", 2.76, 3.7, 2.1, 48124, 466436, 234202},
                                         Traffic{"tunnel", 3.28, 10.5, 5.0, 170261, 1331329,
                                                 259636}),
                         [](const auto& p) { return std::string(p.param.source); });

// ---- external meshes and textures ---------------------------------------------------------------

class RealInput : public testing::TestWithParam<std::tuple<const char*, const char*>> {};

TEST_P(RealInput, FramesMatchGolden) {
  const std::filesystem::path data = data_folder();
  const auto [mesh, texture] = GetParam();
  if (!std::filesystem::exists(data / mesh)) {
    GTEST_SKIP() << "no " << (data / mesh) << ": set DEBURR_DATA to a folder with " << mesh;
  }
  SceneParameters scene = picture((data / mesh).string(), 192);
  if (*texture) scene.texture = (data / texture).string();
  expect_identical(simulate(scene, {}, {}));
}

INSTANTIATE_TEST_SUITE_P(
    Texture, RealInput,
    testing::Values(std::tuple{"meshes/scene_track.obj", "textures/road_512.png"},
                    std::tuple{"meshes/spot.obj", "textures/spot_texture.png"},
                    std::tuple{"meshes/teapot.obj", "textures/brick.png"},
                    std::tuple{"kenney/racing/models/vehicle-truck-red.glb", ""}));

}  // namespace
}  // namespace deburr::tb::texture_system_test
