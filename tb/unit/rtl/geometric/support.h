// SPDX-License-Identifier: MIT
// Shared by the tests of the geometric engine's RTL model: the engine with its memory and host, the
// contract's scene, and the contract's hashes.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <systemc>
#include <utility>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/geometric/geometric_engine.h"
#include "rtl_model/platform/geometric_driver.h"
#include "rtl_model/platform/memory_model.h"
#include "rtl_model/platform/register_host.h"
#include "spec/geometric/packets.h"
#include "spec/geometric/parameters.h"
#include "spec/geometric/records.h"
#include "spec/geometric/registers.h"
#include "spec/geometric/vectors.h"
#include "tb/engines/geometric/geometric_unprogrammed.h"
#include "tb/harness/bench.h"
#include "tb/harness/unit_bench.h"
#include "tb/stimuli/vector_hash.h"
#include "tb/unit/spec/geometric/vector_frame.h"
#include "tb/unit/spec/vectors.h"

namespace deburr::tb::geometric_rtl {

using rtl::ClockDomain;
using rtl::Cycle;
using spec::geometric::Parameters;
namespace reg = spec::geometric::reg;

using unit_bench::period;

constexpr std::uint32_t vector_base(spec::geometric::Region region) {
  return spec::geometric::kVectorBases[static_cast<std::size_t>(region)];
}

// Base addresses of the contract's vectors.
struct Bases {
  std::uint32_t edges = vector_base(spec::geometric::Region::kEdges);
  std::uint32_t vertices = vector_base(spec::geometric::Region::kVertices);
  std::uint32_t faces = vector_base(spec::geometric::Region::kFaces);
  std::uint32_t depth = vector_base(spec::geometric::Region::kDepth);
  std::uint32_t colour = vector_base(spec::geometric::Region::kColour);
  std::uint32_t weights = vector_base(spec::geometric::Region::kWeights);
  std::uint32_t copy = vector_base(spec::geometric::Region::kCopy);
  std::uint32_t pairs = vector_base(spec::geometric::Region::kPairs);
  std::uint32_t coarse = vector_base(spec::geometric::Region::kCoarse);
};
inline constexpr std::uint32_t kRegionBytes = 0x10000;

// A frame as it is stored in memory.
struct Scene {
  int width = 0, height = 0;
  std::vector<std::array<std::uint8_t, 4>> colours;
  std::vector<std::uint32_t> depths;
  std::vector<spec::geometric::Vertex> vertices;
  std::vector<spec::geometric::Edge> edges;
  std::vector<bool> facing;
};

// A scene of the contract's vectors.
inline Scene contract_scene(
    spec::geometric::DrawnFrame which = spec::geometric::DrawnFrame::kRandom) {
  geometric::VectorFrame frame = geometric::vector_frame(which);
  return {frame.width,
          frame.height,
          std::move(frame.colours),
          std::move(frame.depths),
          std::move(frame.vertices),
          std::move(frame.edges),
          std::move(frame.facing)};
}

struct EngineOptions {
  std::uint32_t latency = 20, scatter = 0;
  std::uint32_t memory_bytes = 1u << 20;
  BenchOptions bench = {};
  bool program = false;  // write the configuration after each reset(), over other values
  sc_core::sc_time period = unit_bench::period();
};

// The engine with memory, host and checkers.
class EngineBench {
 public:
  static platform::MemoryModelParameters memory_parameters(const EngineOptions& options) {
    platform::MemoryModelParameters p;
    p.bytes = options.memory_bytes;
    p.latency_min = options.latency;
    p.latency_max = options.latency + options.scatter;
    p.outstanding = 1024;
    p.record_writes = true;
    return p;
  }

  explicit EngineBench(const Parameters& parameters = {}, const EngineOptions& options = {})
      : p(parameters),
        clock("clock", options.period),
        engine("engine", clock, options.program ? unprogrammed(parameters) : parameters),
        memory("memory", options.period, memory_parameters(options)),
        driver(bus, memory, options.program ? unprogrammed(parameters) : parameters),
        program(options.program) {
    engine.memory()->bind(memory.ports);
    bus.bus.bind(engine.registers);
    engine.line_setup.observer = [this](const spec::geometric::LineRecord& l) {
      lines.push_back(l);
    };
    engine.depth_test.observer = [this](const spec::geometric::Candidate& c) {
      candidates.push_back(c);
    };
    engine.resolver.observer = [this](const spec::geometric::BlockRecord& b) {
      blocks.push_back(b);
    };
    bench = std::make_unique<Bench>(clock, options.bench);
  }

  // Writes a scene to memory, and its sizes and bases to the registers. Uses the contract's bases
  // if every region fits between them.
  void load(const Scene& scene) {
    width = scene.width;
    height = scene.height;
    const platform::GeometricSizes sizes = {width,
                                            height,
                                            scene.edges.size(),
                                            scene.vertices.size(),
                                            scene.facing.size(),
                                            platform::boundaries_of(scene.edges)};
    const auto bytes = platform::GeometricRegions::needed(sizes, driver.configuration());
    const bool fits = std::all_of(bytes.begin(), bytes.end(),
                                  [](std::uint64_t size) { return size <= kRegionBytes; });
    place(fits ? contract_regions()
               : platform::GeometricRegions::allocate({&sizes, 1}, driver.configuration()));
    Pixels pixels(scene);
    const std::vector<std::uint8_t> facing = platform::facing_bits(scene.facing);
    driver.load({width, height, scene.edges, scene.vertices, scene.facing.size(), facing,
                 pixels.depths, pixels.colours});
    driver.program();
  }
  bool tiled() const { return driver.configuration().layout == spec::geometric::Layout::kTiled; }
  void start() { driver.start(); }
  // Runs a whole frame and returns its cycles.
  Cycle run(Cycle limit = 2'000'000) {
    return run([this] { start(); }, limit);
  }
  // The same with another way to start the frame.
  Cycle run(const std::function<void()>& starts, Cycle limit = 2'000'000) {
    forget();
    starts();
    return bench->run([this] { return engine.idle(); }, limit);
  }
  // Discards the records of earlier frames.
  void forget() {
    lines.clear();
    candidates.clear();
    blocks.clear();
    memory.clear_statistics();
  }
  void reset(Cycle cycles = 2) {
    clock.set_reset_n(false);
    clock.run(cycles);
    clock.set_reset_n(true);
    if (program) driver.set_configuration(p);
  }

  // --- hashed by the contract ---
  std::uint64_t pixel_hash() {
    stimuli::VectorHash hash;
    for (const spec::geometric::Rgba8& pixel : driver.picture())
      for (const std::uint8_t byte : pixel) hash.byte(byte);
    return hash.value();
  }
  std::uint64_t weight_hash() const {
    std::vector<spec::geometric::Weights> weights(static_cast<std::size_t>(width * height));
    for (const spec::geometric::BlockRecord& block : blocks)
      for (int i = 0; i < 16; ++i) {
        const int x = block.x * 4 + i % 4, y = block.y * 4 + i / 4;
        if (x < width && y < height)
          weights[static_cast<std::size_t>(y * width + x)] =
              block.weights[static_cast<std::size_t>(i)];
      }
    stimuli::VectorHash hash;
    for (const spec::geometric::Weights& w : weights)
      for (const std::uint8_t byte : w) hash.byte(byte);
    return hash.value();
  }
  std::vector<std::uint64_t> accesses(const std::vector<std::uint64_t>& all,
                                      std::uint32_t base) const {
    std::uint64_t end = base + std::uint64_t{kRegionBytes};
    if (driver.regions().bytes() != 0) end = driver.regions().end_of(base);
    std::vector<std::uint64_t> found;
    std::copy_if(all.begin(), all.end(), std::back_inserter(found),
                 [&](std::uint64_t a) { return a >= base && a < end; });
    return found;
  }
  std::vector<std::uint64_t> reads(std::uint32_t base) const {
    return accesses(memory.lines_read(), base);
  }
  std::vector<std::uint64_t> writes(std::uint32_t base) const {
    return accesses(memory.lines_written(), base);
  }
  // Reads of weights in the edge phase come before those of the resolve.
  std::uint64_t traffic_hash() const {
    stimuli::VectorHash hash;
    const auto add = [&](const std::vector<std::uint64_t>& list) {
      for (const std::uint64_t address : list) hash.lowest_first(address, 4);
    };
    for (const std::uint32_t base : {bases.faces, bases.edges, bases.pairs, bases.vertices,
                                     bases.coarse, bases.depth, bases.weights})
      add(reads(base));
    add(writes(bases.weights));
    add(reads(p.frame_copy ? bases.copy : bases.colour));
    add(writes(bases.colour));
    if (p.frame_copy) {
      add(reads(bases.colour));
      add(writes(bases.copy));
    }
    return hash.value();
  }

  static platform::GeometricRegions contract_regions() {
    const Bases b;
    return platform::GeometricRegions(
        {b.faces, b.edges, b.vertices, b.depth, b.weights, b.colour, b.copy, b.pairs, b.coarse});
  }
  void place(const platform::GeometricRegions& regions) {
    using spec::geometric::Region;
    driver.place(regions);
    bases = {regions.base(Region::kEdges),  regions.base(Region::kVertices),
             regions.base(Region::kFaces),  regions.base(Region::kDepth),
             regions.base(Region::kColour), regions.base(Region::kWeights),
             regions.base(Region::kCopy),   regions.base(Region::kPairs),
             regions.base(Region::kCoarse)};
  }
  // Colours and depths of the whole frame, filled up if the scene has fewer.
  struct Pixels {
    explicit Pixels(const Scene& scene) : colours(scene.colours), depths(scene.depths) {
      const auto count = static_cast<std::size_t>(scene.width * scene.height);
      colours.resize(count);
      depths.resize(count);
    }
    std::vector<spec::geometric::Rgba8> colours;
    std::vector<std::uint32_t> depths;
  };

  const Parameters p;
  Bases bases;
  int width = 0, height = 0;
  ClockDomain clock;
  rtl::geometric::GeometricEngine engine;
  platform::MemoryModel memory;
  platform::RegisterHost bus{"bus"};
  platform::GeometricDriver driver;
  bool program;
  std::unique_ptr<Bench> bench;
  std::vector<spec::geometric::LineRecord> lines;
  std::vector<spec::geometric::Candidate> candidates;
  std::vector<spec::geometric::BlockRecord> blocks;
};

// The contract's vector of this name, and the parameters of its engine.
struct Configuration {
  Parameters p;
  std::uint64_t pixels, weights;
};
inline Configuration configuration(char name) {
  const spec::geometric::FrameVector v = geometric::frame_vector(name);
  Parameters p = preset_parameters(v.preset);
  apply_settings(p, v.settings);
  return {p, v.result.hashes.pixels, v.result.hashes.weights};
}

}  // namespace deburr::tb::geometric_rtl
