// SPDX-License-Identifier: MIT
// Cycles of the texture unit at every width: equal to those of the predictor, with the fills and
// colours of width 1 (docs/reference/texture/width.md).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include "golden/texture/cycle_predictor.h"
#include "tb/base/forked.h"
#include "tb/system/texture_runs.h"

namespace deburr::tb::texture_width_test {
namespace {

using golden::texture::CyclePrediction;
using spec::texture::Blend;
using spec::texture::Parameters;

struct Build {
  const char* name;
  std::int32_t width, fragments, lookups, allocations, line_banks, bank_reads, fill_writes;
};
// The named builds; width 2 as narrow as it gets; each port of `wide` at its smallest.
constexpr std::array kBuilds = {
    Build{"width_1", 1, 1, 4, 4, 1, 1, 1},      Build{"width_2", 2, 2, 4, 2, 4, 1, 2},
    Build{"narrow_ports", 2, 1, 4, 1, 1, 1, 1}, Build{"lean", 4, 4, 6, 2, 4, 2, 2},
    Build{"wide", 4, 4, 8, 4, 4, 2, 4},         Build{"two_fragments", 4, 2, 8, 4, 4, 2, 4},
    Build{"four_lookups", 4, 4, 4, 4, 4, 2, 4}, Build{"one_read", 4, 4, 8, 4, 8, 1, 4},
    Build{"one_write", 4, 4, 8, 1, 4, 2, 1}};

Parameters parameters(const Build& build) {
  Parameters p;
  p.blend = Blend::kLevel;
  p.width = build.width;
  p.fragments = build.fragments;
  p.cache_lookups = build.lookups;
  p.cache_allocations = build.allocations;
  p.cache_line_banks = build.line_banks;
  p.cache_bank_reads = build.bank_reads;
  p.cache_fill_writes = build.fill_writes;
  if (build.width > 1) p.cache_outstanding = 0;
  return p;
}

CyclePrediction predicted(const SceneParameters& scene, const SamplerParameters& sampler,
                          const TextureRunOptions& options) {
  const TextureScene built(scene, sampler, 1);
  golden::texture::TextureGolden golden(options.texture, built.memory().bytes());
  int handle = 0;
  for (const spec::texture::Descriptor& descriptor : built.memory().descriptors())
    golden.set_texture(handle++, descriptor);
  golden::texture::CyclePredictor predictor(options.texture,
                                            {.latency = options.memory.latency,
                                             .bytes_per_cycle = options.memory.bytes_per_cycle,
                                             .outstanding = options.memory.outstanding});
  std::vector<golden::texture::CacheRequest> requests;
  for (const spec::texture::Quad& quad : built.stream().quads) {
    requests.clear();
    golden.process(quad, requests);
    predictor.add(requests);
  }
  return predictor.finish();
}

// The driver pushes the first quad in the first cycle after reset, and the sink pops the last
// colour: cycles of a run that the prediction does not count.
constexpr std::uint64_t kAroundUnit = 2;

void expect_prediction(const SceneParameters& scene, const SamplerParameters& sampler,
                       const TextureRunOptions& options) {
  const CyclePrediction expected = predicted(scene, sampler, options);
  const TextureOutcome outcome =
      forked<TextureOutcome>([&] { return simulate(scene, sampler, options); });
  EXPECT_EQ(outcome.mismatches, 0u);
  EXPECT_EQ(outcome.fills, expected.fills);
  EXPECT_EQ(outcome.cycles, expected.cycles + kAroundUnit);
  EXPECT_EQ(outcome.slots, expected.slots);
  EXPECT_EQ(outcome.all_slots, expected.slots.all());
  EXPECT_EQ(outcome.output_slots, 0u);
}

class Width : public testing::TestWithParam<std::tuple<Build, const char*>> {};

TEST_P(Width, CyclesEqualPrediction) {
  const auto& [build, source] = GetParam();
  for (const auto& [latency, bytes] : {std::pair{100, 64}, {20, 64}, {60, 16}}) {
    SCOPED_TRACE(std::to_string(latency) + " cycles, " + std::to_string(bytes) + " bytes");
    TextureRunOptions options;
    options.texture = parameters(build);
    options.memory.latency = latency;
    options.memory.bytes_per_cycle = bytes;
    expect_prediction(picture(source, 96), {}, options);
  }
}

INSTANTIATE_TEST_SUITE_P(Texture, Width,
                         testing::Combine(testing::ValuesIn(kBuilds),
                                          testing::Values("plane", "tunnel", "object")),
                         [](const auto& p) {
                           return std::string(std::get<0>(p.param).name) + "_" +
                                  std::get<1>(p.param);
                         });

// Blocks: formats of both sizes, in both layouts, with more and fewer decoders than blocks, and
// with small lines. A mip level of 63 x 63 texels has blocks that reach beyond its edge.
TEST_P(Width, CyclesOfBlocksEqualPrediction) {
  using spec::texture::Format, spec::texture::Layout;
  const auto& [build, source] = GetParam();
  struct Blocks {
    Format format;
    Layout layout;
    std::int32_t decoders, line_bytes;
    std::int32_t compressed_lines = 0;  // not 0: decoded before the cache
  };
  for (const Blocks& blocks : {Blocks{Format::kBc1, Layout::kTiled, 0, 64},
                               {Format::kBc3, Layout::kLinear, 4, 64},
                               {Format::kEtc2Rgba8, Layout::kTiled, build.width == 1 ? 1 : 5, 64},
                               {Format::kBc4, Layout::kLinear, build.width == 1 ? 2 : 4, 32},
                               {Format::kBc1, Layout::kLinear, 0, 64, 16},
                               {Format::kBc5, Layout::kTiled, 0, 64, 4},
                               {Format::kEtc2Rgb, Layout::kTiled, 0, 64, 64},
                               {Format::kRgba8, Layout::kLinear, 0, 64, 8}}) {
    SCOPED_TRACE(std::string(spec::texture::kFormatNames[static_cast<std::size_t>(blocks.format)]));
    TextureRunOptions options;
    options.texture = parameters(build);
    options.texture.decode = blocks.compressed_lines != 0 ? spec::texture::Decode::kBefore
                                                          : spec::texture::Decode::kAfter;
    options.texture.cache_decoders = blocks.decoders;
    options.texture.cache_compressed_lines = blocks.compressed_lines;
    options.texture.cache_line_bytes = blocks.line_bytes;
    options.texture.cache_bytes = 8192;
    SamplerParameters sampler;
    sampler.format = blocks.format;
    sampler.layout = blocks.layout;
    SceneParameters scene = picture(source, 64);
    if (blocks.layout == Layout::kLinear) scene.texture_size = 63;
    expect_prediction(scene, sampler, options);
  }
}

// Turned lines, texels of one bank in one request, lines of two beats, few lines in flight: on the
// ports of `wide` and on those of `narrow_ports`.
struct Other {
  const char* name;
  void (*change)(TextureRunOptions&, SamplerParameters&, SceneParameters&);
};
const std::array kOthers = {
    Other{"linear_layout",
          [](TextureRunOptions&, SamplerParameters& sampler, SceneParameters& scene) {
            sampler.layout = spec::texture::Layout::kLinear;
            scene.texture_size = 63;
          }},
    Other{"texels_of_16_bits",
          [](TextureRunOptions& options, SamplerParameters& sampler, SceneParameters&) {
            sampler.layout = spec::texture::Layout::kLinear;
            sampler.format = spec::texture::Format::kRgb565;
            options.texture.cache_bytes = 2048;
          }},
    Other{"lines_of_128_bytes",
          [](TextureRunOptions& options, SamplerParameters& sampler, SceneParameters&) {
            sampler.layout = spec::texture::Layout::kLinear;
            options.texture.cache_line_bytes = 128;
          }},
    Other{"lines_of_32_bytes", [](TextureRunOptions& options, SamplerParameters&,
                                  SceneParameters&) { options.texture.cache_line_bytes = 32; }},
    Other{"one_way",
          [](TextureRunOptions& options, SamplerParameters&, SceneParameters&) {
            options.texture.cache_ways = 1;
            options.texture.cache_bytes = 2048;
          }},
    Other{"eight_in_flight",
          [](TextureRunOptions& options, SamplerParameters&, SceneParameters&) {
            options.texture.cache_outstanding = 8;
            options.texture.cache_fifo_depth = 8;
          }},
    Other{"by_sample", [](TextureRunOptions& options, SamplerParameters&, SceneParameters&) {
            options.texture.blend = Blend::kSample;
            options.texture.axes = spec::texture::Axes::kEight;
            options.texture.axis_cycles = 4;
            options.texture.derivatives = spec::texture::Derivatives::kCoarse;
          }}};

class Others : public testing::TestWithParam<std::tuple<std::size_t, Other>> {};

TEST_P(Others, CyclesEqualPrediction) {
  const auto& [build, other] = GetParam();
  TextureRunOptions options;
  options.texture = parameters(kBuilds[build]);
  SamplerParameters sampler;
  SceneParameters scene = picture("object", 96);
  other.change(options, sampler, scene);
  expect_prediction(scene, sampler, options);
}

INSTANTIATE_TEST_SUITE_P(Texture, Others,
                         testing::Combine(testing::Values(std::size_t{2}, std::size_t{4}),
                                          testing::ValuesIn(kOthers)),
                         [](const auto& p) {
                           return std::string(kBuilds[std::get<0>(p.param)].name) + "_" +
                                  std::get<1>(p.param).name;
                         });

// The ports that follow from W and F.
TEST(TextureWidth, MemoriesHavePortsOfTheirGroups) {
  const std::string ports = forked_text([] {
    Parameters p = parameters(kBuilds[5]);  // two fragments
    p.log2 = spec::texture::Log2Rule::kExact;
    p.kernel = spec::texture::Kernel::kTent;
    p.srgb_output = spec::texture::SrgbOutput::kEncoded;
    rtl::ClockDomain clock("clock", sc_core::sc_time(1, sc_core::SC_NS));
    const rtl::texture::TextureUnit unit("unit", clock, p);
    std::string text;
    for (const rtl::MemoryBase* memory : unit.memories())
      text += std::string(memory->basename()) + " " + memory->ports() + "\n";
    return text;
  });
  for (const char* const memory :
       {"descriptors 4R1W", "table 8R", "reciprocal 2R", "srgb 48R", "weights 4R", "codes 12R"})
    EXPECT_THAT(ports, testing::HasSubstr(std::string(memory) + "\n"));
}

}  // namespace
}  // namespace deburr::tb::texture_width_test
