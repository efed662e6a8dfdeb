// SPDX-License-Identifier: MIT
// Speed of the bit-exact reference of the morphological engine. items_per_second counts pixels;
// goals: 40 M/s for mlaa and 25 M/s for smaa and deburr on a 1080p frame with a tenth of its pixels
// on edges.
#include <benchmark/benchmark.h>

#include "golden/morphological/edges.h"
#include "golden/morphological/luma.h"
#include "golden/morphological/morphological_golden.h"
#include "tb/unit/golden/morphological/support.h"

namespace deburr {
namespace {

using golden::morphological::MorphologicalGolden;
using golden::morphological::preset_parameters;
using spec::morphological::Preset;
using tb::morphological::Frame;

const Frame& frame_1080p() {
  static const Frame frame = tb::morphological::rendered_like(1920, 1080, 12000);
  return frame;
}

void run(benchmark::State& state, const Frame& frame, Preset preset,
         MorphologicalGolden::Detail detail) {
  MorphologicalGolden golden(preset_parameters(preset), detail);
  for (auto _ : state) benchmark::DoNotOptimize(golden.process(frame.view()).data());
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(frame.pixels.size()));
  const auto pixels = static_cast<double>(frame.pixels.size());
  state.counters["edge_pixels_%"] = 100 * static_cast<double>(golden.work().edge_pixels) / pixels;
  state.counters["blended_%"] = 100 * static_cast<double>(golden.work().blended_pixels) / pixels;
}

void preset(benchmark::State& state, Preset which) {
  run(state, frame_1080p(), which, MorphologicalGolden::Detail::kPixels);
}
void everything(benchmark::State& state, Preset which) {
  run(state, frame_1080p(), which, MorphologicalGolden::Detail::kEverything);
}
void noise(benchmark::State& state, Preset which) {
  run(state, tb::morphological::noise_image(1920, 1080), which,
      MorphologicalGolden::Detail::kPixels);
}
BENCHMARK_CAPTURE(preset, mlaa, Preset::kMlaa)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(preset, mlaa_slope, Preset::kMlaaSlope)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(preset, smaa, Preset::kSmaa)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(preset, smaa_dynamic, Preset::kSmaaDynamic)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(preset, deburr_line, Preset::kDeburrLine)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(preset, deburr, Preset::kDeburr)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(everything, mlaa, Preset::kMlaa)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(everything, deburr, Preset::kDeburr)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(noise, mlaa, Preset::kMlaa)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(noise, smaa, Preset::kSmaa)->Unit(benchmark::kMillisecond);

void luma(benchmark::State& state) {
  const Frame& frame = frame_1080p();
  for (auto _ : state) benchmark::DoNotOptimize(golden::morphological::luma(frame.view()));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(frame.pixels.size()));
}
BENCHMARK(luma)->Unit(benchmark::kMillisecond);

void edges(benchmark::State& state, Preset which) {
  const Frame& frame = frame_1080p();
  const spec::morphological::Parameters p = preset_parameters(which);
  for (auto _ : state) benchmark::DoNotOptimize(golden::morphological::find_edges(p, frame.view()));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(frame.pixels.size()));
}
BENCHMARK_CAPTURE(edges, mlaa, Preset::kMlaa)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(edges, smaa, Preset::kSmaa)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(edges, smaa_dynamic, Preset::kSmaaDynamic)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(edges, deburr_line, Preset::kDeburrLine)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(edges, deburr, Preset::kDeburr)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace deburr

BENCHMARK_MAIN();
