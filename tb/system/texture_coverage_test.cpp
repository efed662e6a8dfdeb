// SPDX-License-Identifier: MIT
// Functional coverage of the texture unit over a set of directed runs on the hardware model: each
// mode with each wrap and layout, each N with each major axis, magnification by each filter, what
// can happen to a request in the cache, and by random quads what pictures seldom have: ties,
// saturation, flat footprints, levels at their limits. Every bin must be hit.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <string>

#include "tb/harness/coverage.h"
#include "tb/harness/forked.h"
#include "tb/stimuli/texture_quads.h"
#include "tb/system/texture_quad_bench.h"
#include "tb/system/texture_runs.h"

namespace deburr::tb {
namespace {

constexpr std::size_t kDirections = 8;
constexpr std::array<std::string_view, 2> kTentBins = {"tent.narrow", "tent.wide"};
// Of each number of axes: two candidates are equally long, and no other longer; a derivative is
// saturated; the minor axis is 0, the major one not; the level of detail ends at a clamp.
constexpr std::array<std::string_view, 5> kLimitBins = {"tie", "saturated", "flat", "low", "high"};
constexpr std::array<std::string_view, 4> kCacheBins = {"hit", "miss", "merged", "queue_full"};

Coverage declared() {
  Coverage coverage;
  for (const auto mode : spec::texture::kMinFilterNames)
    for (const auto wrap : spec::texture::kWrapNames)
      for (const auto layout : spec::texture::kLayoutNames)
        coverage.declare(fmt::format("mode.{}.{}.{}", mode, wrap, layout));
  for (std::size_t n = 1; n <= 16; ++n) coverage.declare(fmt::format("samples.{}", n));
  for (const int axes : {2, 4, 8})
    for (int k = 0; k < axes; ++k) coverage.declare(fmt::format("major.{}.{}", axes, k));
  for (const auto bin : kLimitBins)
    for (const int axes : {2, 4, 8}) coverage.declare(fmt::format("limit.{}.{}", bin, axes));
  for (const auto bin : kTentBins) coverage.declare(std::string(bin));
  for (const auto output : spec::texture::kSrgbOutputNames)
    coverage.declare(fmt::format("output.{}", output));
  for (const auto filter : spec::texture::kMagFilterNames)
    coverage.declare(fmt::format("magnified.{}", filter));
  for (const auto format : spec::texture::kFormatNames)
    coverage.declare(fmt::format("format.{}", format));
  for (const auto bin : kCacheBins) coverage.declare(fmt::format("cache.{}", bin));
  return coverage;
}

// What one run met; plain numbers, because it comes from another process.
struct Met {
  std::array<std::uint64_t, 17> samples{};         // by N
  std::array<std::uint64_t, kDirections> major{};  // by direction
  std::array<std::uint64_t, 2> tent{};             // of fewer than four samples, of more
  std::uint64_t magnified = 0, fragments = 0;
  std::array<std::uint64_t, 4> cache{};
};

Met run(const SceneParameters& scene, const SamplerParameters& sampler,
        const TextureRunOptions& options) {
  return forked<Met>([&] {
    const TextureScene built(scene, sampler, 1);
    Simulation simulation(options);
    TextureEnvironment environment(simulation, built, options);
    simulation.elaborate(environment);
    simulation.run();
    environment.check();
    Met met;
    const golden::texture::TextureGolden golden = make_golden(built, options.texture);
    for (const spec::texture::Quad& quad : built.stream().quads) {
      for (int lane = 0; lane < 4; ++lane) {
        if (!(quad.coverage >> lane & 1)) continue;
        const golden::texture::FragmentAnalysis a = golden.analyse(quad, lane);
        if (!a.valid) continue;
        const bool tent = options.texture.kernel == spec::texture::Kernel::kTent;
        ++met.samples[static_cast<std::size_t>(a.lod.samples)];
        ++met.major[static_cast<std::size_t>(a.footprint.major)];
        if (tent) ++met.tent[a.lod.samples < 4 ? 0 : 1];
        met.magnified += a.lod.magnified;
        ++met.fragments;
      }
    }
    const auto& tags = environment.unit().cache.tag_stage;
    met.cache = {tags.hits.value(), tags.misses.value(), tags.merged.value(), 0};
    for (const rtl::Unit::StallCause& cause : tags.stalls())
      if (cause.name == "miss_queue_full") met.cache[3] = cause.cycles;
    return met;
  });
}

void record(Coverage& coverage, const Met& met, const SamplerParameters& sampler,
            const spec::texture::Rules& rules) {
  const auto index = [](auto e) { return static_cast<std::size_t>(e); };
  coverage.hit(fmt::format("mode.{}.{}.{}", spec::texture::kMinFilterNames[index(sampler.mode)],
                           kWrapChoiceNames[index(sampler.wrap)],
                           spec::texture::kLayoutNames[index(sampler.layout)]),
               met.fragments - met.magnified);
  coverage.hit(fmt::format("format.{}", spec::texture::kFormatNames[index(sampler.format)]),
               met.fragments);
  coverage.hit(
      fmt::format("magnified.{}", spec::texture::kMagFilterNames[index(sampler.magnification)]),
      met.magnified);
  for (std::size_t n = 1; n < met.samples.size(); ++n)
    coverage.hit(fmt::format("samples.{}", n), met.samples[n]);
  const int axes = 2 << static_cast<int>(rules.axes);
  for (int k = 0; k < axes; ++k)
    coverage.hit(fmt::format("major.{}.{}", axes, k), met.major[static_cast<std::size_t>(k)]);
  for (std::size_t i = 0; i < kTentBins.size(); ++i)
    coverage.hit(std::string(kTentBins[i]), met.tent[i]);
  coverage.hit(fmt::format("output.{}", spec::texture::kSrgbOutputNames[index(rules.srgb_output)]),
               sampler.format == spec::texture::Format::kSrgb8A8 ? met.fragments : 0);
  for (std::size_t i = 0; i < kCacheBins.size(); ++i)
    coverage.hit(fmt::format("cache.{}", kCacheBins[i]), met.cache[i]);
}

// Random quads over random descriptors; every fourth quad is a square turned by 45 degrees, of
// which row and column (or, by the measure `max`, the two diagonals) are equally long.
using Limits = std::array<std::uint64_t, kLimitBins.size()>;
Limits run_limits(const spec::texture::Parameters& parameters) {
  return forked<Limits>([&] {
    namespace gold = golden::texture;
    constexpr std::uint32_t kMemoryBytes = 1u << 16, kQuads = 400;
    Random random(1, "limits");
    QuadInput input;
    input.memory.resize(kMemoryBytes);
    for (std::uint8_t& byte : input.memory) byte = static_cast<std::uint8_t>(random.next());
    for (int handle = 0; handle < spec::texture::kMaxTextures; ++handle)
      input.textures.push_back(random_texture(random, kMemoryBytes));
    input.textures[0].width = input.textures[0].height = 64;
    input.textures[0].levels = 7;
    for (std::uint32_t tag = 0; tag < kQuads; ++tag) {
      const bool square = tag % 4 == 0;
      input.quads.push_back(random_quad(
          random, tag, square ? std::uint8_t{0} : static_cast<std::uint8_t>(random.below(16))));
      if (!square) continue;
      const std::int32_t a = 1 << (10 + tag % 12);
      input.quads.back().s = {0, a, a, 2 * a};
      input.quads.back().t = {0, a, -a, 0};
    }
    QuadBench bench(input, parameters);
    bench.reset();
    const std::string differences = bench.judge(input, bench.run());
    if (!differences.empty()) throw spec::CheckFailed(differences);
    gold::TextureGolden golden(parameters, input.memory);
    for (int handle = 0; handle < spec::texture::kMaxTextures; ++handle)
      golden.set_texture(handle, input.textures[static_cast<std::size_t>(handle)]);
    Limits met{};
    for (const spec::texture::Quad& quad : input.quads)
      for (int lane = 0; lane < 4; ++lane) {
        const gold::FragmentAnalysis a = golden.analyse(quad, lane);
        if (!a.valid || !(quad.coverage >> lane & 1)) continue;
        int longest = 0;
        for (int k = 0; k < gold::candidates(parameters.axes); ++k) {
          const gold::Magnitudes u = gold::candidate_in_texels(parameters.axes, k, a.p_x, a.p_y);
          longest += gold::footprint_side(parameters.footprint, u.s, u.t) == a.footprint.d_max;
        }
        const spec::texture::Descriptor& d = golden.texture(quad.texture);
        const std::int32_t free = a.lod.lb_d_max - a.lod.sampled + d.lod_bias * 16;
        met[0] += longest > 1 && a.footprint.d_max != 0;
        met[1] += a.saturated;
        met[2] += a.footprint.d_max != 0 && a.footprint.d_min == 0 && a.footprint.area == 0;
        met[3] += free < d.min_lod * 16;
        met[4] += free > d.max_lod * 16;
      }
    return met;
  });
}

TEST(TextureCoverage, EveryBinIsHit) {
  Coverage coverage = declared();
  int number = 0;
  for (int mode = 0; mode < 6; ++mode) {
    for (int wrap = 1; wrap < 4; ++wrap) {
      for (int layout = 0; layout < 2; ++layout, ++number) {
        SamplerParameters sampler;
        sampler.mode = static_cast<spec::texture::MinFilter>(mode);
        sampler.wrap = static_cast<WrapChoice>(wrap);
        sampler.layout = static_cast<spec::texture::Layout>(layout);
        sampler.format = static_cast<spec::texture::Format>(number % 5);
        sampler.magnification = static_cast<spec::texture::MagFilter>(number & 1);
        TextureRunOptions options;
        options.texture.cache_bytes = 2048;
        options.texture.cache_outstanding = 4;  // so that the miss queue runs full
        options.texture.axes = static_cast<spec::texture::Axes>(number % 3);
        options.texture.kernel = static_cast<spec::texture::Kernel>(number / 3 % 2);
        options.texture.srgb_output = static_cast<spec::texture::SrgbOutput>(number / 5 % 2);
        // The tunnel's walls have their long axis across on two sides and upright on the others.
        record(coverage, run(picture(number % 4 ? "tunnel" : "plane", 48), sampler, options),
               sampler, options.texture);
        if (mode > 0) continue;
        SceneParameters near = picture("quad", 48);
        near.texture_size = 8;
        record(coverage, run(near, sampler, options), sampler, options.texture);
      }
    }
  }
  for (int axes = 0; axes < 3; ++axes)
    for (std::size_t rule = 0; rule < spec::texture::kFootprintNames.size(); ++rule) {
      spec::texture::Parameters parameters;
      parameters.axes = static_cast<spec::texture::Axes>(axes);
      parameters.footprint = static_cast<spec::texture::FootprintRule>(rule);
      const Limits met = run_limits(parameters);
      for (std::size_t i = 0; i < kLimitBins.size(); ++i)
        coverage.hit(fmt::format("limit.{}.{}", kLimitBins[i], 2 << axes), met[i]);
    }
  std::ofstream(DEBURR_COVERAGE_FILE) << coverage.json();
  EXPECT_TRUE(coverage.holes().empty()) << coverage.json();
}

TEST(TextureCoverage, AHoleIsReported) {
  Coverage coverage = declared();
  SamplerParameters sampler;
  sampler.wrap = WrapChoice::kRepeat;
  record(coverage, run(picture("quad", 32), sampler, {}), sampler, spec::texture::Rules{});
  EXPECT_GT(coverage.holes().size(), 30u);
  EXPECT_THROW(coverage.hit("mode.cubic"), spec::CheckFailed);
}

}  // namespace
}  // namespace deburr::tb
