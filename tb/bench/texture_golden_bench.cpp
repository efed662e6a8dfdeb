// SPDX-License-Identifier: MIT
// Speed of the bit-exact reference of the texture unit. items_per_second counts samples (a
// trilinear sample is two bilinear requests); goal: 10 M/s trilinear without traffic prediction.
// --samples NAME N filters about N samples and prints the exact number, for tb/speed.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <iostream>
#include <string>

#include "golden/texture/texture_golden.h"
#include "tb/unit/golden/texture/support.h"

namespace deburr {
namespace {

using golden::texture::TextureGolden;
using tb::texture::GroundPlane;

spec::texture::Descriptor trilinear(int max_anisotropy_log2) {
  spec::texture::Descriptor d;
  d.format = spec::texture::Format::kRgba8;
  d.layout = spec::texture::Layout::kTiled;
  d.max_anisotropy_log2 = static_cast<std::uint8_t>(max_anisotropy_log2);
  return d;
}

const tb::texture::Pyramid& picture() {
  static const tb::texture::Pyramid pyramid = tb::texture::noise(1024, 1024, 7);
  return pyramid;
}

void run(benchmark::State& state, int max_anisotropy_log2, TextureGolden::Traffic traffic) {
  const tb::texture::EncodedTexture texture(picture(), trilinear(max_anisotropy_log2));
  const std::vector<spec::texture::Quad> quads = GroundPlane{.size = 256, .height = 0.3}.quads();
  TextureGolden golden(spec::texture::Parameters{}, texture.memory, traffic);
  golden.set_texture(0, texture.descriptor);
  for (auto _ : state) {
    for (const spec::texture::Quad& quad : quads) benchmark::DoNotOptimize(golden.process(quad));
  }
  const golden::texture::TextureWork& work = golden.work();
  state.SetItemsProcessed(static_cast<std::int64_t>(work.samples));
  state.counters["bilinears/s"] =
      benchmark::Counter(static_cast<double>(work.bilinears), benchmark::Counter::kIsRate);
  state.counters["fragments/s"] =
      benchmark::Counter(static_cast<double>(work.fragments), benchmark::Counter::kIsRate);
  state.counters["bilinears/sample"] =
      static_cast<double>(work.bilinears) / static_cast<double>(work.samples);
}

void trilinear_colours(benchmark::State& state) { run(state, 0, TextureGolden::Traffic::kIgnore); }
void trilinear_colours_and_traffic(benchmark::State& state) {
  run(state, 0, TextureGolden::Traffic::kPredict);
}
void anisotropic_colours(benchmark::State& state) {
  run(state, 4, TextureGolden::Traffic::kIgnore);
}
void anisotropic_colours_and_traffic(benchmark::State& state) {
  run(state, 4, TextureGolden::Traffic::kPredict);
}
BENCHMARK(trilinear_colours);
BENCHMARK(trilinear_colours_and_traffic);
BENCHMARK(anisotropic_colours);
BENCHMARK(anisotropic_colours_and_traffic);

// Filters whole planes until at least `wanted` samples are done; returns their number.
std::uint64_t filter(bool anisotropic, TextureGolden::Traffic traffic, std::uint64_t wanted) {
  const tb::texture::EncodedTexture texture(picture(), trilinear(anisotropic ? 4 : 0));
  const std::vector<spec::texture::Quad> quads = GroundPlane{.size = 128, .height = 0.3}.quads();
  TextureGolden golden(spec::texture::Parameters{}, texture.memory, traffic);
  golden.set_texture(0, texture.descriptor);
  while (golden.work().samples < wanted) {
    for (const spec::texture::Quad& quad : quads) benchmark::DoNotOptimize(golden.process(quad));
  }
  return golden.work().samples;
}

}  // namespace
}  // namespace deburr

int main(int argc, char** argv) {
  using Traffic = deburr::golden::texture::TextureGolden::Traffic;
  if (argc == 4 && std::string(argv[1]) == "--samples") {
    const std::string name = argv[2];
    const Traffic traffic = name.ends_with("_traffic") ? Traffic::kPredict : Traffic::kIgnore;
    const std::uint64_t wanted = std::strtoull(argv[3], nullptr, 10);
    std::cout << deburr::filter(name.starts_with("anisotropic"), traffic, wanted) << " samples\n";
    return 0;
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
