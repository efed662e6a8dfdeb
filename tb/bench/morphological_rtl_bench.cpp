// SPDX-License-Identifier: MIT
// Speed of the morphological engine's hardware model on frames of 1920 x 1080.
//
//   morphological_rtl_bench     wall time and cycles per second with one lane, and speed of the
//       golden model relative to the hardware model on the same frame
//   morphological_rtl_bench --frames <image> <preset> <lanes> <n> [memory]   only n frames:
//       cycles, stalls, edges, memory bits; for counting instructions with callgrind
//   morphological_rtl_bench --trade                            bits of the edge memories and cycles
//       of a frame by predictors and trial_cycles: the table of
//       docs/reference/morphological/hardware.md
// Images: facets (slanted halves in cells of 32 pixels, about 10 % edge pixels), noise, flat,
// stripes.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "golden/morphological/configuration.h"
#include "golden/morphological/morphological_golden.h"
#include "rtl_model/morphological/morphological_engine.h"
#include "rtl_model/platform/memory_model.h"
#include "rtl_model/platform/morphological_driver.h"
#include "rtl_model/platform/register_host.h"
#include "tb/base/forked.h"
#include "tb/harness/driver.h"
#include "tb/stimuli/frames.h"

namespace deburr::tb {
namespace {

using rtl::Cycle;
using spec::morphological::Parameters;

constexpr int kWidth = 1920, kHeight = 1080;

std::uint32_t mix(std::uint32_t v) {
  v = (v ^ v >> 16) * 0x85EBCA6Bu;
  v = (v ^ v >> 13) * 0xC2B2AE35u;
  return v ^ v >> 16;
}

spec::morphological::Rgba8 colour(const std::string& image, int x, int y) {
  const auto at = static_cast<std::uint32_t>(y * kWidth + x);
  std::uint32_t v = 128;
  if (image == "noise") {
    v = mix(at) & 1 ? 255 : 0;
  } else if (image == "stripes") {
    v = y & 1 ? 255 : 0;
  } else if (image == "burst") {
    v = x < kWidth / 5 && (x + y) / 2 % 2 != 0 ? 255 : 0;
  } else if (image == "facets") {
    const std::uint32_t cell = mix(static_cast<std::uint32_t>(y / 32 * 64 + x / 32));
    const int a = static_cast<int>(cell & 31) - 16, b = static_cast<int>(cell >> 5 & 31) - 16;
    v = (a * (x % 32 - 16) + b * (y % 32 - 16) > 0 ? cell >> 10 : cell >> 18) & 255;
  }
  const auto code = static_cast<std::uint8_t>(v);
  return {code, code, code, 255};
}

// Colour of a pixel: spec::morphological::Rgba8 picture(x, y).
template <class Picture>
std::vector<spec::morphological::PixelBeat> beats_of(Picture&& picture, int lanes) {
  std::vector<spec::morphological::Rgba8> pixels;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) pixels.push_back(picture(x, y));
  return platform::beats_of({kWidth, kHeight, pixels, {}}, lanes);
}

std::vector<spec::morphological::PixelBeat> beats(const std::string& image, int lanes) {
  return beats_of([&](int x, int y) { return colour(image, x, y); }, lanes);
}

Parameters parameters(const std::string& preset, int lanes) {
  const auto& names = spec::morphological::kPresetNames;
  const auto* const which = std::find(names.begin(), names.end(), preset);
  DEBURR_CHECK(which != names.end(), "unknown preset " + preset);
  Parameters p = golden::morphological::preset_parameters(
      static_cast<spec::morphological::Preset>(which - names.begin()));
  p.lanes = lanes == 1   ? spec::morphological::Lanes::kOne
            : lanes == 2 ? spec::morphological::Lanes::kTwo
                         : spec::morphological::Lanes::kFour;
  p.line_pixels = kWidth;
  return p;
}

// The engine in a minimal environment.
struct Setup {
  rtl::ClockDomain clock{"clock", sc_core::sc_time(1, sc_core::SC_NS)};
  rtl::Link<spec::morphological::PixelBeat> in{"in"};
  rtl::Link<spec::morphological::BlendedBeat> out{"out"};
  Driver<spec::morphological::PixelBeat> driver{"driver", clock};
  rtl::morphological::MorphologicalEngine engine;
  Sink<spec::morphological::BlendedBeat> sink{"sink", clock};
  platform::RegisterHost bus{"bus"};
  platform::MorphologicalDriver software;
  std::unique_ptr<platform::MemoryModel> memory;
  std::vector<spec::morphological::PixelBeat> frame;
  std::uint64_t frames = 0;

  explicit Setup(const Parameters& p) : engine("engine", clock, p), software(bus, p) {
    driver.beats_out(in);
    engine.pixels_in(in);
    engine.pixels_out(out);
    sink.beats_in(out);
    sink.keep(false);
    bus.bus.bind(engine.registers);
    if (engine.memory()) {
      platform::MemoryModelParameters m;
      m.bytes = 1u << 24;
      memory = std::make_unique<platform::MemoryModel>("memory", clock.period(), m);
      engine.memory()->bind(memory->ports);
    }
    driver.send([this](std::uint64_t index, spec::morphological::PixelBeat& beat) {
      if (index >= frames * frame.size()) return false;
      beat = frame[index % frame.size()];
      return true;
    });
    software.set_size(kWidth, kHeight);
  }
  Cycle run(std::uint64_t count) {
    frames = count;
    const Cycle from = clock.cycle();
    const std::uint64_t wanted = engine.sequencer.frames.value() + count;
    clock.run_until([&] { return engine.sequencer.frames.value() == wanted; }, 1'000'000'000);
    return clock.cycle() - from;
  }
};

// SystemC elaborates once per process, so all benchmarks share the engine.
Setup& setup_of(const std::string& image) {
  static Setup setup(parameters("deburr-line", 1));
  setup.frame = beats(image, 1);
  return setup;
}

Cycle run_frame(Setup& setup) {
  // The driver stops at the end of a frame; a reset restarts it.
  setup.clock.set_reset_n(false);
  setup.clock.run(1);
  setup.clock.set_reset_n(true);
  setup.software.set_size(kWidth, kHeight);
  return setup.run(1);
}

void bm_engine(benchmark::State& state, const std::string& image) {
  Setup& setup = setup_of(image);
  Cycle cycles = 0;
  for (auto _ : state) cycles += run_frame(setup);
  state.counters["cycles"] =
      benchmark::Counter(static_cast<double>(cycles), benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(bm_engine, facets, std::string("facets"))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(bm_engine, flat, std::string("flat"))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(bm_engine, noise, std::string("noise"))->Unit(benchmark::kMillisecond);

// The golden model on the same frame, in turns, so that the ratio is valid on a busy machine.
using golden::morphological::MorphologicalGolden;
void bm_golden_over_rtl(benchmark::State& state, MorphologicalGolden::Detail detail) {
  Setup& setup = setup_of("facets");
  std::vector<spec::morphological::Rgba8> pixels;
  for (const spec::morphological::PixelBeat& beat : setup.frame) pixels.push_back(beat.pixel[0]);
  MorphologicalGolden golden(parameters("deburr-line", 1), detail);
  std::clock_t rtl_time = 0, golden_time = 0;
  for (auto _ : state) {
    const std::clock_t begin = std::clock();
    run_frame(setup);
    const std::clock_t middle = std::clock();
    benchmark::DoNotOptimize(golden.process({pixels, kWidth, kHeight}).data());
    rtl_time += middle - begin;
    golden_time += std::clock() - middle;
  }
  state.counters["golden/rtl"] = static_cast<double>(rtl_time) / static_cast<double>(golden_time);
}
BENCHMARK_CAPTURE(bm_golden_over_rtl, pixels, MorphologicalGolden::Detail::kPixels)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(bm_golden_over_rtl, everything, MorphologicalGolden::Detail::kEverything)
    ->Unit(benchmark::kMillisecond);

int count_instructions(const std::string& image, const std::string& preset, int lanes,
                       std::uint64_t frames, bool memory) {
  Parameters p = parameters(preset, lanes);
  if (memory) p.storage = spec::morphological::Storage::kMemory;
  Setup setup(p);
  setup.frame = beats(image, lanes);
  const auto start = std::chrono::steady_clock::now();
  const Cycle cycles = setup.run(frames);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  const spec::morphological::Work work = setup.engine.work();
  std::cout << fmt::format(
      "{} cycles, {:.2f} Mcycle/s; last frame {} cycles; {:.1f} % edge pixels, {} descriptor "
      "stalls "
      "({} interlock), latency {}..{}\n",
      cycles, static_cast<double>(cycles) / seconds.count() / 1e6,
      setup.engine.sequencer.frame_cycles.value(),
      100.0 * static_cast<double>(work.edge_pixels) / static_cast<double>(work.pixels),
      setup.engine.extractor.descriptor_stalls.value(),
      setup.engine.extractor.interlock_stalls.value(), setup.engine.beat_latency.min(),
      setup.engine.beat_latency.max());
  std::uint64_t bits = 0;
  for (const rtl::MemoryBase* storage : setup.engine.memories()) {
    std::cout << fmt::format("  {:40} {:8} bits {}\n", storage->name(), storage->logical_bits(),
                             storage->ports());
    bits += storage->logical_bits();
  }
  std::cout << fmt::format("  {:40} {:8} bits\n", "sum", bits);
  for (const rtl::Unit* unit : setup.engine.units())
    std::cout << fmt::format("  {:40} busy {:9} stalled {:9} idle {:9}\n", unit->name(),
                             unit->busy_cycles(), unit->stalled_cycles(), unit->idle_cycles());
  return 0;
}

// One row of the trade table: bits of the edge memories, and cycles of frames in excess of the
// formula. Runs in its own process.
std::string trade(int predictors, int trial_cycles) {
  Parameters p = parameters("deburr-line", 1);
  p.predictor_units = predictors;
  p.trial_cycles = trial_cycles;
  Setup setup(p);
  const auto& engine = setup.engine;
  std::uint64_t bits = engine.window.memory.physical_bits();
  for (const auto& rows : engine.rows.memory) bits += rows.physical_bits();
  std::string row =
      fmt::format("| {} | {} | {} | {:.0f}", predictors, trial_cycles,
                  engine.rows.memory[0].shape().read_ports, static_cast<double>(bits) / 1000);
  const std::uint64_t unstalled =
      (kHeight + static_cast<std::uint64_t>(p.window_rows / 2 - 1) + spec::morphological::kRowLag) *
          kWidth +
      spec::morphological::kPipelineLatency;
  const auto add = [&](auto&& picture) {
    setup.frame = beats_of(picture, 1);
    run_frame(setup);
    row += fmt::format(" | {:.3f}", static_cast<double>(engine.sequencer.frame_cycles.value()) /
                                        static_cast<double>(unstalled));
  };
  for (const int permille : {10, 100, 200, 500}) {
    const Image image = stimuli::random_edges(kWidth, kHeight, permille);
    add([&](int x, int y) { return image.at(x, y); });
  }
  constexpr int kRecords = 40;
  add([](int x, int y) {
    return stimuli::grey(x >= kWidth - 2 * kRecords && (x + y) / 2 % 2 != 0 ? 255 : 0);
  });
  return row + " |\n";
}

int print_trade() {
  std::cout << "| predictors | T | ports | kbit | 1 % | 10 % | 20 % | 50 % | 40 descriptors |\n"
               "|---|---|---|---|---|---|---|---|---|\n";
  for (const int predictors : {1, 2, 4})
    for (int cycles = 1; cycles <= 8; ++cycles)
      std::cout << forked_text([=] { return trade(predictors, cycles); }) << std::flush;
  return 0;
}

}  // namespace
}  // namespace deburr::tb

// NOLINTNEXTLINE(bugprone-exception-escape): an exception ends the program with its message.
int main(int argc, char** argv) {
  if (argc >= 6 && std::strcmp(argv[1], "--frames") == 0)
    return deburr::tb::count_instructions(argv[2], argv[3], std::atoi(argv[4]),
                                          std::strtoull(argv[5], nullptr, 10), argc > 6);
  if (argc == 2 && std::strcmp(argv[1], "--trade") == 0) return deburr::tb::print_trade();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
