// SPDX-License-Identifier: MIT
// Shared by the tests of the morphological engine's RTL model: the images of the contract's test
// vectors, the whole engine between a driver and a sink, and single blocks between tokens.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <systemc>
#include <utility>
#include <vector>

#include "rtl_model/morphological/morphological_engine.h"
#include "rtl_model/platform/memory_model.h"
#include "rtl_model/platform/morphological_driver.h"
#include "rtl_model/platform/register_host.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"
#include "tb/engines/morphological/morphological_unprogrammed.h"
#include "tb/harness/bench.h"
#include "tb/harness/driver.h"
#include "tb/harness/unit_bench.h"
#include "tb/stimuli/frames.h"

namespace deburr::tb::morphological_rtl {

using rtl::ClockDomain;
using rtl::Cycle;
using rtl::Link;
using spec::morphological::Parameters;
using spec::morphological::Rgba8;

// Holds RESET_N low for the given cycles.
inline void reset_by(ClockDomain& clock, Cycle cycles = 1) {
  clock.set_reset_n(false);
  clock.run(cycles);
  clock.set_reset_n(true);
}

struct Frame {
  int width = 0, height = 0;
  std::vector<Rgba8> pixel;
  std::vector<std::uint32_t> depth;
  Frame() = default;
  Frame(int w, int h)
      : width(w),
        height(h),
        pixel(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)),
        depth(pixel.size()) {}
  Frame(const Image& image)
      : width(image.width), height(image.height), pixel(image.pixels), depth(pixel.size()) {}
  Rgba8& at(int x, int y) { return pixel[static_cast<std::size_t>(y * width + x)]; }
  const Rgba8& at(int x, int y) const { return pixel[static_cast<std::size_t>(y * width + x)]; }
};

using stimuli::grey;

template <class Colour>
Frame draw(int width, int height, Colour&& colour) {
  Frame frame(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) frame.at(x, y) = colour(x, y);
  return frame;
}

inline Frame noise(int width = 97, int height = 61) { return stimuli::noise_image(width, height); }
inline Frame line(int width = 200, int height = 150) { return stimuli::line_image(width, height); }
inline Frame blocks(int width = 90, int height = 80) {
  return stimuli::blocks_image(width, height);
}

inline std::uint64_t hash(const Frame& frame) {
  Image image(frame.width, frame.height);
  image.pixels = frame.pixel;
  return stimuli::hash(image);
}

// The configuration of a preset with R and C; a small line_pixels keeps tests fast.
inline Parameters preset(spec::morphological::Preset which, int search_rows = 32,
                         int search_columns = 256) {
  Parameters p = preset_parameters(which);
  p.window_rows = 2 * search_rows + 2;
  p.search_columns = search_columns;
  p.line_pixels = 256;
  return p;
}

// The SMAA presets, with the window of the given quality.
inline Parameters smaa(spec::morphological::Quality quality = spec::morphological::Quality::kHigh,
                       spec::morphological::Preset which = spec::morphological::Preset::kSmaa) {
  Parameters p = preset_parameters(which, quality);
  p.line_pixels = 256;
  return p;
}

inline Parameters deburr_line() { return preset(spec::morphological::Preset::kDeburrLine); }
inline Parameters deburr() { return preset(spec::morphological::Preset::kDeburr); }
inline Parameters in_memory() {
  Parameters p = preset(spec::morphological::Preset::kMlaa);
  p.storage = spec::morphological::Storage::kMemory;
  return p;
}

using platform::lanes_of;
using unit_bench::period, unit_bench::stalls;
inline int search_range_of(const Parameters& p) { return p.window_rows / 2 - 1; }
// Cycles from a slot to its output beat.
inline constexpr unsigned kPipe = spec::morphological::kPipelineLatency;
inline int beats_a_row(const Frame& frame, const Parameters& p) {
  return static_cast<int>(platform::beats_a_row(frame.width, lanes_of(p)));
}

inline std::vector<spec::morphological::PixelBeat> beats_of(const Frame& frame, int lanes) {
  return platform::beats_of({frame.width, frame.height, frame.pixel, frame.depth}, lanes);
}

// driver -> engine -> sink, a memory if the engine needs one, and the test harness around them.
struct EngineBench {
  struct Options {
    BenchOptions bench;
    EndOptions driver, sink;
    std::uint32_t memory_latency = 20, memory_scatter = 0;
    platform::MemoryModelParameters memory;
    bool program = false;  // write the configuration after each reset(), over other values
    sc_core::sc_time period = unit_bench::period();
  };
  explicit EngineBench(const Parameters& p) : EngineBench(p, Options{}) {}
  EngineBench(const Parameters& p, Options options)
      : clock("clock", options.period),
        driver("driver", clock, options.driver),
        engine("engine", clock, options.program ? unprogrammed(p) : p),
        sink("sink", clock, options.sink),
        software(bus, p),
        configuration(p),
        program(options.program) {
    driver.beats_out(in);
    engine.pixels_in(in);
    engine.pixels_out(out);
    sink.beats_in(out);
    bus.bus.bind(engine.registers);
    if (engine.memory() != nullptr) {
      options.memory.bytes = 1u << 20;
      options.memory.latency_min = options.memory_latency;
      options.memory.latency_max = options.memory_latency + options.memory_scatter;
      memory = std::make_unique<platform::MemoryModel>("memory", options.period, options.memory);
      engine.memory()->bind(memory->ports);
    }
    bench = std::make_unique<Bench>(clock, options.bench);
    driver.on_send = [this](Cycle cycle, const spec::morphological::PixelBeat&) {
      sent.push_back(cycle);
    };
  }

  void reset(Cycle cycles) {
    reset_by(clock, cycles);
    if (program) software.set_configuration(configuration);
  }

  void send(const Frame& frame) {
    software.set_size(frame.width, frame.height);
    driver.send(beats_of(frame, lanes_of(engine.parameters())));
    wanted += static_cast<std::uint64_t>(beats_a_row(frame, engine.parameters()) * frame.height);
  }
  // Runs until everything that was sent has come out.
  void finish(const std::function<void()>& each_cycle = {}, Cycle limit = 5'000'000) {
    const auto done = [&] {
      if (each_cycle) each_cycle();
      return sink.received() == wanted && engine.idle();
    };
    bench->run(done, limit);
  }
  // Runs one frame and returns it. Frames that were sent before come out first.
  Frame run(const Frame& frame, Cycle limit = 5'000'000) {
    send(frame);
    finish({}, limit);
    return last(frame.width, frame.height);
  }
  // The newest frame in the sink.
  Frame last(int width, int height) const {
    Frame frame(width, height);
    const auto beats = static_cast<std::size_t>(beats_a_row(frame, engine.parameters()) * height);
    std::size_t at = 0, index = sink.beats().size() - beats;
    for (std::size_t k = 0; k < beats; ++k)
      for (std::size_t i = 0; i < sink.beats()[index + k].count; ++i)
        frame.pixel[at++] = sink.beats()[index + k].pixel[i];
    return frame;
  }

  ClockDomain clock;
  Link<spec::morphological::PixelBeat> in{"in"};
  Link<spec::morphological::BlendedBeat> out{"out"};
  Driver<spec::morphological::PixelBeat> driver;
  rtl::morphological::MorphologicalEngine engine;
  Sink<spec::morphological::BlendedBeat> sink;
  platform::RegisterHost bus{"bus"};
  platform::MorphologicalDriver software;
  Parameters configuration;
  bool program;
  std::unique_ptr<platform::MemoryModel> memory;
  std::unique_ptr<Bench> bench;
  std::vector<Cycle> sent;  // when each beat was pushed into the engine's link
  std::uint64_t wanted = 0;
};

}  // namespace deburr::tb::morphological_rtl
