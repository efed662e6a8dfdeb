// SPDX-License-Identifier: MIT
// What the tests of the geometric engine's hardware model share: the engine with its memory and
// host, the contract's scene, and the hashes that the contract gives.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <systemc>
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
#include "tb/harness/bench.h"

namespace deburr::tb::geometric_rtl {

using rtl::ClockDomain;
using rtl::Cycle;
using spec::geometric::Parameters;
namespace reg = spec::geometric::reg;

inline sc_core::sc_time period() { return {10, sc_core::SC_NS}; }

// The contract's bases.
struct Bases {
  std::uint32_t edges = 0x10000, vertices = 0x20000, faces = 0x30000, depth = 0x40000,
                colour = 0x50000, weights = 0x60000, copy = 0x70000;
};
inline constexpr std::uint32_t kRegionBytes = 0x10000;

// A frame as it lies in memory.
struct Scene {
  int width = 0, height = 0;
  std::vector<std::array<std::uint8_t, 4>> colours;
  std::vector<std::uint32_t> depths;
  std::vector<spec::geometric::Vertex> vertices;
  std::vector<spec::geometric::Edge> edges;
  std::vector<bool> facing;
};

// Byte offset of a pixel, by the table of docs/geometric.md.
inline std::uint32_t pixel_offset(bool tiled, int width, int x, int y) {
  if (!tiled) return static_cast<std::uint32_t>(y * ((4 * width + 63) / 64 * 64) + 4 * x);
  const int bx = x / 4, by = y / 4, tiles = (width + 7) / 8;
  return static_cast<std::uint32_t>(256 * (by / 2 * tiles + bx / 2) + 64 * (2 * (by % 2) + bx % 2) +
                                    4 * (4 * (y % 4) + x % 4));
}

// The scene of the contract's vectors.
inline Scene contract_scene() {
  std::uint32_t s = 1;
  const auto r = [&s] { return s = 1664525u * s + 1013904223u; };
  Scene scene;
  scene.width = 61;
  scene.height = 45;
  const std::size_t pixels = 61 * 45;
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint32_t v = r();
    scene.colours.push_back({static_cast<std::uint8_t>(v >> 24),
                             static_cast<std::uint8_t>(v >> 16 & 255),
                             static_cast<std::uint8_t>(v >> 8 & 255), 255});
  }
  constexpr std::array<std::uint32_t, 8> kDepths = {0,       3000000, 3005000, 6000000,
                                                    6011000, 9000000, 9017000, 16777215};
  for (std::size_t i = 0; i < pixels; ++i) scene.depths.push_back(kDepths[r() >> 29]);
  for (int i = 0; i < 200; ++i) {
    spec::geometric::Vertex v;
    v.x = static_cast<std::int32_t>((r() >> 16) % 20480) - 2304;
    v.y = static_cast<std::int32_t>((r() >> 16) % 16384) - 2304;
    v.depth = r() >> 8;
    v.usable = i != 7;
    if (i < 10) {
      v.x &= ~127;
      v.y &= ~127;
    }
    if (i == 11) v.x = 1 << 22;
    scene.vertices.push_back(v);
  }
  for (int i = 0; i < 49; ++i) scene.facing.push_back(r() >> 31);
  for (int i = 0; i < 300; ++i) {
    spec::geometric::Edge e;
    e.v0 = (r() >> 16) % 201;
    e.v1 = (r() >> 16) % 200;
    e.f0 = (r() >> 16) % 50;
    e.f1 = (r() >> 16) % 50;
    e.flags = static_cast<std::uint8_t>((r() >> 16) % 16);
    scene.edges.push_back(e);
  }
  return scene;
}

struct Fnv {
  std::uint64_t value = 1469598103934665603u;
  void byte(std::uint8_t b) { value = (value ^ b) * 1099511628211u; }
  void word(std::uint64_t w) {
    for (int i = 0; i < 4; ++i) byte(static_cast<std::uint8_t>(w >> (8 * i)));
  }
};

struct EngineOptions {
  std::uint32_t latency = 20, scatter = 0;
  std::uint32_t memory_bytes = 1u << 20;
  BenchOptions bench = {};
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
        engine("engine", clock, parameters),
        memory("memory", period(), memory_parameters(options)),
        driver(bus, memory, parameters) {
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

  // Writes a scene to memory and its sizes and bases to the registers: at the contract's bases if
  // every region fits between them.
  void load(const Scene& scene) {
    width = scene.width;
    height = scene.height;
    const platform::GeometricSizes sizes = {width, height, scene.edges.size(),
                                            scene.vertices.size(), scene.facing.size()};
    const auto bytes = platform::GeometricRegions::needed(sizes, driver.rules());
    const bool fits = std::all_of(bytes.begin(), bytes.end(),
                                  [](std::uint64_t size) { return size <= kRegionBytes; });
    place(fits ? contract_regions()
               : platform::GeometricRegions::allocate({&sizes, 1}, driver.rules()));
    Pixels pixels(scene);
    const std::vector<std::uint8_t> facing = platform::facing_bits(scene.facing);
    driver.load({width, height, scene.edges, scene.vertices, scene.facing.size(), facing,
                 pixels.depths, pixels.colours});
    driver.program();
  }
  void load_frame(const Scene& scene) {
    Pixels pixels(scene);
    driver.load_depths(pixels.depths);
    driver.load_colours(pixels.colours);
  }
  bool tiled() const { return driver.rules().layout == spec::geometric::Layout::kTiled; }
  void start() { driver.start(); }
  // A whole frame; gives its clocks.
  Cycle run(Cycle limit = 2'000'000) {
    lines.clear();
    candidates.clear();
    blocks.clear();
    memory.clear_statistics();
    start();
    return bench->run([this] { return engine.idle(); }, limit);
  }
  void reset(Cycle cycles = 2) {
    clock.set_reset_n(false);
    clock.run(cycles);
    clock.set_reset_n(true);
  }

  // --- What the contract hashes ---
  std::uint64_t pixel_hash() {
    Fnv hash;
    for (const spec::geometric::Rgba8& pixel : driver.picture())
      for (const std::uint8_t byte : pixel) hash.byte(byte);
    return hash.value;
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
    Fnv hash;
    for (const spec::geometric::Weights& w : weights)
      for (const std::uint8_t byte : w) hash.byte(byte);
    return hash.value;
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
  // Reads of weights while edges are drawn come before those of the resolve.
  std::uint64_t traffic_hash() const {
    Fnv hash;
    const auto add = [&](const std::vector<std::uint64_t>& list) {
      for (const std::uint64_t address : list) hash.word(address);
    };
    for (const std::uint32_t base :
         {bases.faces, bases.edges, bases.vertices, bases.depth, bases.weights})
      add(reads(base));
    add(writes(bases.weights));
    add(reads(p.frame_copy ? bases.copy : bases.colour));
    add(writes(bases.colour));
    if (p.frame_copy) {
      add(reads(bases.colour));
      add(writes(bases.copy));
    }
    return hash.value;
  }

  static platform::GeometricRegions contract_regions() {
    const Bases b;
    return platform::GeometricRegions(
        std::array{b.faces, b.edges, b.vertices, b.depth, b.weights, b.colour, b.copy});
  }
  void place(const platform::GeometricRegions& regions) {
    using spec::geometric::Region;
    driver.place(regions);
    bases = {regions.base(Region::kEdges),  regions.base(Region::kVertices),
             regions.base(Region::kFaces),  regions.base(Region::kDepth),
             regions.base(Region::kColour), regions.base(Region::kWeights),
             regions.base(Region::kCopy)};
  }
  // Of the whole frame, whatever the scene has of them.
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
  ClockDomain clock{"clock", period()};
  rtl::geometric::GeometricEngine engine;
  platform::MemoryModel memory;
  platform::RegisterHost bus{"bus"};
  platform::GeometricDriver driver;
  std::unique_ptr<Bench> bench;
  std::vector<spec::geometric::LineRecord> lines;
  std::vector<spec::geometric::Candidate> candidates;
  std::vector<spec::geometric::BlockRecord> blocks;
};

// The contract's configurations.
struct Configuration {
  char name;
  Parameters p;
  std::uint64_t pixels, weights, traffic;
};
inline Configuration configuration(char name) {
  using spec::geometric::CacheLines;
  using spec::geometric::Lanes;
  using spec::geometric::Layout;
  using spec::geometric::Preset;
  Configuration c{name, preset_parameters(Preset::kDeburr), 0xbfce4abe8f3b22f8, 0x6cc78624e74c2575,
                  0};
  Parameters& p = c.p;
  const auto small = [&] { p.depth_lines = p.weight_blocks = p.vertex_lines = CacheLines::k16; };
  switch (name) {
    case 'a':
      c.traffic = 0x05d525abe62406ac;
      break;
    case 'b':
      p.layout = Layout::kRaster;
      c.traffic = 0x1cca5c4cd350ef99;
      break;
    case 'c':
      p.walkers = Lanes::kOne;
      small();
      c.traffic = 0x3d300c73436d0324;
      break;
    case 'd':
      p.layout = Layout::kRaster;
      p.walkers = Lanes::kTwo;
      small();
      c.traffic = 0x0290086e5caa5d65;
      break;
    case 'e':
      p = preset_parameters(Preset::kGpaaOptimised);
      c.pixels = 0x31c35ac184f4e760;
      c.weights = 0xbadcaac952dfc9ed;
      c.traffic = 0x9273c837cbb2c537;
      break;
    case 'f':
      p = preset_parameters(Preset::kGpaa);
      c.pixels = 0x9e2d94b3be2f9be4;
      c.weights = 0x9d0d9b07b9151d21;
      c.traffic = 0xe27e145fd8e2b753;
      break;
    case 'g':
      p.crease = spec::geometric::Crease::kOff;
      p.depth_test = spec::geometric::DepthTest::kOwn;
      p.depth_bias = 4;
      p.linear_light = false;
      p.mark = true;
      p.layout = Layout::kRaster;
      p.walkers = Lanes::kTwo;
      c.pixels = 0x812d11a355250433;
      c.weights = 0xea5cdef281327420;
      c.traffic = 0xd29f2a365f31ea07;
      break;
    default:
      p.select = spec::geometric::Select::kAll;
      p.depth_test = spec::geometric::DepthTest::kOff;
      p.layout = Layout::kRaster;
      p.weight_blocks = CacheLines::k16;
      c.pixels = 0x095774cc41e669b3;
      c.weights = 0x721dca7bb6a8d77f;
      c.traffic = 0xd81315c6f0a3ee49;
  }
  return c;
}

}  // namespace deburr::tb::geometric_rtl
