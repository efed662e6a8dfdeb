// SPDX-License-Identifier: MIT
// Cycles of the texture unit at every width: equal to those of the predictor, with the fills and
// colours of width 1 (docs/reference/texture/width.md).
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

class Width : public testing::TestWithParam<std::tuple<Build, const char*>> {};

TEST_P(Width, CyclesEqualPrediction) {
  const auto& [build, source] = GetParam();
  for (const auto& [latency, bytes] : {std::pair{100, 64}, {20, 64}, {60, 16}}) {
    TextureRunOptions options;
    options.texture = parameters(build);
    options.memory.latency = latency;
    options.memory.bytes_per_cycle = bytes;
    const SceneParameters scene = picture(source, 96);
    const CyclePrediction expected = predicted(scene, {}, options);
    const TextureOutcome outcome =
        forked<TextureOutcome>([&] { return simulate(scene, {}, options); });
    EXPECT_EQ(outcome.mismatches, 0u);
    EXPECT_EQ(outcome.fills, expected.fills);
    EXPECT_EQ(outcome.cycles, expected.cycles + kAroundUnit)
        << "latency " << latency << ", " << bytes << " bytes per cycle";
    EXPECT_EQ(outcome.slots, expected.slots);
    EXPECT_EQ(outcome.all_slots, expected.slots.all());
    EXPECT_EQ(outcome.output_slots, 0u);
  }
}

INSTANTIATE_TEST_SUITE_P(Texture, Width,
                         testing::Combine(testing::ValuesIn(kBuilds),
                                          testing::Values("plane", "tunnel", "object")),
                         [](const auto& p) {
                           return std::string(std::get<0>(p.param).name) + "_" +
                                  std::get<1>(p.param);
                         });

}  // namespace
}  // namespace deburr::tb::texture_width_test
