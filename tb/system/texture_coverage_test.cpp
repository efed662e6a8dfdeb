// SPDX-License-Identifier: MIT
// Functional coverage of the texture unit over directed runs of the hardware model: each mode with
// each wrap and layout, each N with each major axis, magnification by each filter, and the outcomes
// of a request in the cache. Every bin must be hit.
#include "tb/engines/texture/texture_coverage.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tb/base/forked.h"
#include "tb/base/random.h"
#include "tb/stimuli/compressed_files.h"
#include "tb/system/coverage_text.h"
#include "tb/system/texture_runs.h"

namespace deburr::tb::texture_coverage_test {
namespace {

void run(Coverage& coverage, const SceneParameters& scene, const SamplerParameters& sampler,
         TextureRunOptions options) {
  options.coverage = true;
  add_text(coverage, forked_text([&] {
             const TextureScene built(scene, sampler, 1);
             Simulation simulation(options);
             TextureEnvironment environment(simulation, built, options);
             simulation.elaborate(environment);
             simulation.run();
             environment.check();
             return text_of(environment.coverage());
           }));
}

TEST(TextureCoverage, EveryBinIsHit) {
  Coverage coverage = TextureCoverage::declared();
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
        if (number == 17) sampler.anisotropy = 2;  // diagonals with the kernel axis and few samples
        TextureRunOptions options;
        options.texture.cache_bytes = 2048;
        options.texture.cache_outstanding = 4;  // so that the miss queue becomes full
        options.texture.axes = static_cast<spec::texture::Axes>(number % 3);
        options.texture.kernel = static_cast<spec::texture::Kernel>(number / 3 % 3);
        options.texture.srgb_output = static_cast<spec::texture::SrgbOutput>(number / 5 % 2);
        // The long axis is horizontal on two of the tunnel's walls and vertical on the others.
        run(coverage, picture(number % 4 ? "tunnel" : "plane", 48), sampler, options);
        if (mode > 0) continue;
        SceneParameters near = picture("quad", 48);
        near.texture_size = 8;
        run(coverage, near, sampler, options);
      }
    }
  }
  // Groups end at each limit of a small cache with few ports, and each unit after it stops them.
  for (int ways = 1; ways <= 2; ++ways) {
    TextureRunOptions options;
    options.texture.width = options.texture.fragments = 4;
    options.texture.blend = spec::texture::Blend::kLevel;
    options.texture.derivatives = spec::texture::Derivatives::kCoarse;
    options.texture.cache_bytes = 2048;
    options.texture.cache_ways = ways;
    options.texture.cache_outstanding = 8;
    options.texture.cache_allocations = 1;
    options.stall_permille = ways == 1 ? 0 : 100;
    SamplerParameters sampler;
    sampler.layout = spec::texture::Layout::kLinear;
    SceneParameters odd = picture("tunnel", 48);
    odd.texture_size = 63;
    run(coverage, odd, sampler, options);
    sampler.mode = spec::texture::MinFilter::kNearest;
    sampler.anisotropy = 0;  // quads on an edge have fewer than four requests
    run(coverage, picture("object", 48), sampler, options);
  }
  // Random blocks have every mode; a group of many blocks ends at the decoders.
  Random random(1, "blocks");
  for (std::size_t code = 0; code < spec::texture::kFormatNames.size(); ++code) {
    const auto format = static_cast<spec::texture::Format>(code);
    if (!is_compressed(format)) continue;
    CompressedTexture texture = stimuli::compressed(noise(64, 64), format, 7);
    for (CompressedTexture::Level& level : texture.levels)
      for (std::uint8_t& byte : level.blocks) byte = static_cast<std::uint8_t>(random.below(256));
    const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "blocks.ktx2";
    std::ofstream(file, std::ios::binary) << stimuli::ktx2_file(texture);
    TextureRunOptions options;
    options.texture.decode = spec::texture::Decode::kBefore;
    SamplerParameters sampler;
    sampler.format = format;
    SceneParameters scene = picture("tunnel", 48);
    scene.texture = file.string();
    run(coverage, scene, sampler, options);
    options.texture.decode = spec::texture::Decode::kAfter;
    options.texture.width = options.texture.fragments = 4;
    options.texture.cache_lookups = 8;
    options.texture.cache_line_banks = options.texture.cache_fill_writes = 4;
    options.texture.cache_bank_reads = 2;
    options.texture.cache_decoders = 4;
    run(coverage, scene, sampler, options);
  }
  EXPECT_GT(coverage.size(), 90u);
  EXPECT_TRUE(coverage.holes().empty()) << testing::PrintToString(coverage.holes());
}

TEST(TextureCoverage, MissedBinIsReported) {
  Coverage coverage = TextureCoverage::declared();
  SamplerParameters sampler;
  sampler.wrap = WrapChoice::kRepeat;
  run(coverage, picture("quad", 32), sampler, {});
  EXPECT_GT(coverage.holes().size(), 30u);
  EXPECT_THROW(coverage.hit("texture/mode/cubic"), spec::CheckFailed);
}

}  // namespace
}  // namespace deburr::tb::texture_coverage_test
