// SPDX-License-Identifier: MIT
// Functional coverage of the texture unit over a set of directed runs on the hardware model: each
// mode with each wrap and layout, each N with each major axis, magnification by each filter, and
// what can happen to a request in the cache. Every bin must be hit.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <string>

#include "tb/harness/coverage.h"
#include "tb/harness/forked.h"
#include "tb/system/texture_runs.h"

namespace deburr::tb {
namespace {

constexpr std::array<std::string_view, 2> kAxes = {"x", "y"};
constexpr std::array<std::string_view, 4> kCacheBins = {"hit", "miss", "merged", "queue_full"};

Coverage declared() {
  Coverage coverage;
  for (const auto mode : spec::texture::kMinFilterNames)
    for (const auto wrap : spec::texture::kWrapNames)
      for (const auto layout : spec::texture::kLayoutNames)
        coverage.declare(fmt::format("mode.{}.{}.{}", mode, wrap, layout));
  for (int n = 1; n <= 16; n *= 2)
    for (const auto axis : kAxes) coverage.declare(fmt::format("samples.{}.major_{}", n, axis));
  for (const auto filter : spec::texture::kMagFilterNames)
    coverage.declare(fmt::format("magnified.{}", filter));
  for (const auto format : spec::texture::kFormatNames)
    coverage.declare(fmt::format("format.{}", format));
  for (const auto bin : kCacheBins) coverage.declare(fmt::format("cache.{}", bin));
  return coverage;
}

// What one run met; plain numbers, because it comes from another process.
struct Met {
  std::array<std::array<std::uint64_t, 2>, 5> samples{};  // [lb N][axis]
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
        ++met.samples[static_cast<std::size_t>(a.lod.lb_n)][a.footprint.major_is_x ? 0 : 1];
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

void record(Coverage& coverage, const Met& met, const SamplerParameters& sampler) {
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
  for (std::size_t n = 0; n < met.samples.size(); ++n)
    for (std::size_t axis = 0; axis < 2; ++axis)
      coverage.hit(fmt::format("samples.{}.major_{}", 1 << n, kAxes[axis]), met.samples[n][axis]);
  for (std::size_t i = 0; i < kCacheBins.size(); ++i)
    coverage.hit(fmt::format("cache.{}", kCacheBins[i]), met.cache[i]);
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
        // The tunnel's walls have their long axis across on two sides and upright on the others.
        record(coverage, run(picture(number % 3 ? "tunnel" : "plane", 48), sampler, options),
               sampler);
        if (mode > 0) continue;
        SceneParameters near = picture("quad", 48);
        near.texture_size = 8;
        record(coverage, run(near, sampler, options), sampler);
      }
    }
  }
  std::ofstream(DEBURR_COVERAGE_FILE) << coverage.json();
  EXPECT_TRUE(coverage.holes().empty()) << coverage.json();
}

TEST(TextureCoverage, AHoleIsReported) {
  Coverage coverage = declared();
  SamplerParameters sampler;
  sampler.wrap = WrapChoice::kRepeat;
  record(coverage, run(picture("quad", 32), sampler, {}), sampler);
  EXPECT_GT(coverage.holes().size(), 30u);
  EXPECT_THROW(coverage.hit("mode.cubic"), spec::CheckFailed);
}

}  // namespace
}  // namespace deburr::tb
