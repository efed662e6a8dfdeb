// SPDX-License-Identifier: MIT
// Speed of the bit-exact reference of the geometric engine. items_per_second counts edges of the
// table; goal: a 1080p frame of 30 000 edges in 5 ms, mostly for copying the frame.
#include <benchmark/benchmark.h>

#include "golden/geometric/geometric_golden.h"
#include "tb/engines/geometric/geometric_stimuli.h"

namespace deburr {
namespace {

using golden::geometric::GeometricGolden;
using golden::geometric::preset_parameters;
using spec::geometric::Preset;
using tb::geometric::Frame;

const Frame& knot_1080p() {
  static const Frame frame =
      tb::geometric::make_frame(tb::make_scene("object", {.texture_size = 64}), 1920, 1080);
  return frame;
}

void run(benchmark::State& state, Preset preset, GeometricGolden::Detail detail) {
  const Frame& frame = knot_1080p();
  GeometricGolden golden(preset_parameters(preset), detail);
  for (auto _ : state) benchmark::DoNotOptimize(golden.process(frame.input()).data());
  state.SetItemsProcessed(state.iterations() *
                          static_cast<std::int64_t>(frame.screen.edges.size()));
  state.counters["columns"] = static_cast<double>(golden.work().columns);
  state.counters["blended"] = static_cast<double>(golden.work().blended_pixels);
}

void pixels(benchmark::State& state, Preset preset) {
  run(state, preset, GeometricGolden::Detail::kPixels);
}
void everything(benchmark::State& state, Preset preset) {
  run(state, preset, GeometricGolden::Detail::kEverything);
}
BENCHMARK_CAPTURE(pixels, gpaa, Preset::kGpaa)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(pixels, gpaa_optimised, Preset::kGpaaOptimised)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(pixels, deburr, Preset::kDeburr)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(everything, gpaa, Preset::kGpaa)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(everything, deburr, Preset::kDeburr)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace deburr

BENCHMARK_MAIN();
