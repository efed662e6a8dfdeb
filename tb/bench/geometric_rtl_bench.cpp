// SPDX-License-Identifier: MIT
// Cycles of the geometric engine's hardware model, and frames for counting its instructions.
//
//   geometric_rtl_bench --frames <n> [preset [walkers [edge_lanes [layout [passes [latency
//       [parameters]]]]]]]
//       n frames of 1280 x 720: 33 000 edges, a fifth of them kept, about 24 000 columns, <passes>
//       lines over each position (default 1), a memory latency of <latency> cycles (default 20),
//       and other parameters such as "fills=128 coverage=area". Prints cycles, cycles of both
//       phases and the minimum for the port, work, stalls, memories
//   geometric_rtl_bench --idle <n>      n cycles of an engine that waits for a frame
//   geometric_rtl_bench --dividers      JSON, one row per build and latency: dividers, memory
//       latency in cycles, blended pixels, cycles of the edges, of the resolve, in total
//   geometric_rtl_bench --ratio <n>     speed of the golden model relative to the hardware model
//       on the same frame; the two alternate, so the ratio is valid on a busy machine
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "golden/geometric/geometric_golden.h"
#include "rtl_model/geometric/geometric_engine.h"
#include "rtl_model/platform/geometric_driver.h"
#include "rtl_model/platform/memory_model.h"
#include "rtl_model/platform/register_host.h"
#include "tb/base/apply_settings.h"
#include "tb/base/forked.h"

namespace deburr::tb {
namespace {

namespace flag = spec::geometric::flag;
using spec::geometric::Parameters;

constexpr int kWidth = 1280, kHeight = 720;
constexpr std::uint32_t kEdges = 33'000, kKept = kEdges / 5, kFaces = 22'000;
// In the order of the regions: faces, edges, vertices, depth, weights, colour, copy, pairs, coarse.
constexpr std::array<std::uint32_t, 9> kBases = {0x180000, 0,        0x100000,  0x200000, 0xA00000,
                                                 0x600000, 0xE00000, 0x1200000, 0x1300000};
constexpr std::uint32_t kBytes = 0x1310000;

using spec::geometric::Edge;
using spec::geometric::Rgba8;
using spec::geometric::Vertex;

struct Scene {
  std::vector<Edge> edges;
  std::vector<Vertex> vertices;
  std::vector<std::uint8_t> facing = std::vector<std::uint8_t>(kFaces / 8, 0xFF);
  std::vector<Rgba8> image = std::vector<Rgba8>(std::size_t{kWidth} * kHeight);
  std::vector<std::uint32_t> depth = std::vector<std::uint32_t>(std::size_t{kWidth} * kHeight);
};

// Every fifth edge is a step on a curve that winds over the frame; the others are flat. `passes`:
// number of rings on top of each other.
Scene rings(std::uint32_t passes) {
  Scene scene;
  for (std::uint32_t i = 0; i < kEdges; ++i)
    scene.edges.push_back({i / 5, i / 5 + 1, i % kFaces, (i + 1) % kFaces,
                           static_cast<std::uint8_t>(i % 5 == 0 ? flag::kBoundary : 0)});
  for (std::uint32_t i = 0; i <= kKept; ++i) {
    // Rings of 60 to 220 steps of about 4 pixels, next to each other.
    const std::uint32_t ring = i / 220 / passes, row = ring / 6;
    const double angle = (i % 220) * 2 * 3.14159265358979 / 220, radius = 60 + ring % 5 * 20;
    const double x = 200 + ring % 6 * 170 + radius * std::cos(angle + ring),
                 y = 160 + row * 90 + radius * std::sin(angle + ring);
    scene.vertices.push_back({static_cast<std::int32_t>(std::floor(256 * x)),
                              static_cast<std::int32_t>(std::floor(256 * y)), 9'000'000, true});
  }
  for (std::size_t i = 0; i < scene.image.size(); ++i)
    for (std::size_t c = 0; c < 4; ++c)
      scene.image[i][c] = static_cast<std::uint8_t>((4 * i + c) * 2654435761u >> 16);
  return scene;
}

struct Frames {
  explicit Frames(const Parameters& p, std::uint32_t passes = 1, std::int32_t latency = 20)
      : engine("engine", clock, p, {latency, 1}),
        memory("memory", {4, sc_core::SC_NS}, memory_parameters(latency)),
        driver(bus, memory, p) {
    engine.memory()->bind(memory.ports);
    bus.bus.bind(engine.registers);
    const Scene scene = rings(passes);
    driver.place(platform::GeometricRegions(kBases));
    driver.load(
        {kWidth, kHeight, scene.edges, scene.vertices, kFaces, scene.facing, {}, scene.image});
    driver.program();
  }
  static platform::MemoryModelParameters memory_parameters(std::int32_t latency) {
    platform::MemoryModelParameters p;
    p.latency_min = p.latency_max = static_cast<std::uint32_t>(latency);
    p.bytes = kBytes;
    p.outstanding = 1024;
    p.record_reads = false;
    return p;
  }
  void run() {
    driver.start();
    if (!clock.run_until([this] { return engine.idle(); }, 10'000'000)) std::abort();
  }

  rtl::ClockDomain clock{"clock", {4, sc_core::SC_NS}};
  rtl::geometric::GeometricEngine engine;
  platform::MemoryModel memory;
  platform::RegisterHost bus{"bus"};
  platform::GeometricDriver driver;
};

template <class Choice, std::size_t N>
Choice choice(std::string_view text, const std::array<std::string_view, N>& names) {
  for (std::size_t i = 0; i < N; ++i)
    if (text == names[i]) return static_cast<Choice>(i);
  std::cerr << text << ": unknown choice\n";
  std::exit(2);
}

void frames(int count, const std::vector<std::string>& arguments) {
  Parameters p;
  if (!arguments.empty())
    p = preset_parameters(
        choice<spec::geometric::Preset>(arguments[0], spec::geometric::kPresetNames));
  using spec::geometric::kLanesNames;
  using spec::geometric::Lanes;
  if (arguments.size() > 1) p.walkers = choice<Lanes>(arguments[1], kLanesNames);
  if (arguments.size() > 2) p.edge_lanes = choice<Lanes>(arguments[2], kLanesNames);
  if (arguments.size() > 3)
    p.layout = choice<spec::geometric::Layout>(arguments[3], spec::geometric::kLayoutNames);
  if (arguments.size() > 6) apply_settings(p, arguments[6]);
  Frames f(p, arguments.size() > 4 ? static_cast<std::uint32_t>(std::stoi(arguments[4])) : 1,
           arguments.size() > 5 ? std::stoi(arguments[5]) : 20);
  for (int i = 0; i < count; ++i) f.run();
  std::cout << fmt::format("{} cycles\n", f.clock.cycle());
  std::cout << fmt::format("last frame: {} cycles, edges {}, resolve {}\n", f.driver.cycles().frame,
                           f.driver.cycles().edges, f.driver.cycles().resolve);
  const std::uint64_t frames = static_cast<std::uint64_t>(count),
                      all =
                          f.engine.memory_port.reads.value() + f.engine.memory_port.writes.value(),
                      resolve = f.engine.block_fetch.weights_read.value() +
                                f.engine.block_fetch.lines_read.value() +
                                f.engine.resolver.lines_written.value();
  std::cout << fmt::format("memory lines per frame: edges {}, resolve {}\n",
                           (all - resolve) / frames, resolve / frames);
  for (const auto& row : spec::geometric::kWorkCounts)
    for (const spec::RegisterInfo& info : spec::geometric::kRegisters)
      if (info.offset == row.offset)
        std::cout << fmt::format("{} {}  ", info.name, f.engine.work().*row.count);
  std::cout << "\n";
  for (const rtl::Unit* unit : f.engine.units()) {
    std::cout << fmt::format("{:16} busy {}", unit->basename(), unit->busy_cycles());
    for (const auto& stall : unit->stalls())
      if (stall.cycles) std::cout << fmt::format(", {} {}", stall.name, stall.cycles);
    std::cout << "\n";
  }
  std::uint64_t logical = 0, physical = 0;
  for (const rtl::MemoryBase* memory : f.engine.memories()) {
    std::cout << fmt::format("{:40} {:6} x {:4} {:6} {:18} {} bits, {} physical\n", memory->name(),
                             memory->words(), memory->word_bits(), name_of(memory->memory_kind()),
                             memory->built_as(), memory->logical_bits(), memory->physical_bits());
    logical += memory->logical_bits();
    physical += memory->physical_bits();
  }
  std::cout << fmt::format("memory bits {}, physical {}\n", logical, physical);
}

void dividers() {
  struct Setup {
    const char* name;
    int units, table;
    bool pipelined;
  };
  constexpr std::array<Setup, 7> kSetups = {{{"1", 1, 0, false},
                                             {"2", 2, 0, false},
                                             {"3", 3, 0, false},
                                             {"4", 4, 0, false},
                                             {"5", 5, 0, false},
                                             {"1, and the table", 1, 10, false},
                                             {"pipelined", 1, 0, true}}};
  const auto drawn = [](const Setup& setup, std::int32_t latency) {
    Parameters p;
    p.dividers = setup.units;
    p.reciprocal_table = setup.table;
    p.pipelined = setup.pipelined;
    Frames f(p, 1, latency);
    f.run();
    const auto cycles = f.driver.cycles();
    return fmt::format("[\"{}\", {}, {}, {}, {}, {}]", setup.name, latency,
                       f.engine.work().blended_pixels, cycles.edges, cycles.resolve, cycles.frame);
  };
  std::vector<std::string> rows;
  for (const std::int32_t latency : {100, 20})
    for (const Setup& setup : kSetups)
      rows.push_back(forked_text([&] { return drawn(setup, latency); }));
  std::cout << fmt::format("[{}]\n", fmt::join(rows, ",\n"));
}

void ratio(int count) {
  using golden::geometric::GeometricGolden;
  const Parameters p;
  const Scene scene = rings(3);
  const golden::geometric::FrameInput input{{scene.image, kWidth, kHeight},
                                            {scene.depth, kWidth, kHeight},
                                            scene.edges,
                                            scene.vertices,
                                            {scene.facing, kFaces}};
  Frames hardware(p, 3);
  GeometricGolden pixels(p, GeometricGolden::Detail::kPixels), everything(p);
  std::array<std::clock_t, 3> spent{};
  const auto timed = [&](std::size_t which, auto&& work) {
    const std::clock_t begin = std::clock();
    work();
    spent[which] += std::clock() - begin;
  };
  for (int i = 0; i < count; ++i) {
    timed(0, [&] { hardware.run(); });
    timed(1, [&] { pixels.process(input); });
    timed(2, [&] { everything.process(input); });
  }
  const auto seconds = [&](std::size_t which) {
    return static_cast<double>(spent[which]) / CLOCKS_PER_SEC;
  };
  std::cout << fmt::format("hardware: {:.2f} Mcycle/s\n",
                           static_cast<double>(hardware.clock.cycle()) / seconds(0) / 1e6);
  std::cout << fmt::format("golden/rtl: {:.1f} for pixels only, {:.1f} for all outputs\n",
                           seconds(0) / seconds(1), seconds(0) / seconds(2));
}

}  // namespace
}  // namespace deburr::tb

// NOLINTNEXTLINE(bugprone-exception-escape): an exception ends the program with its message.
int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.size() >= 2 && arguments[0] == "--frames")
    deburr::tb::frames(std::atoi(arguments[1].c_str()), {arguments.begin() + 2, arguments.end()});
  else if (arguments.size() == 2 && arguments[0] == "--idle")
    deburr::tb::Frames({}).clock.run(std::stoull(arguments[1]));
  else if (arguments.size() == 1 && arguments[0] == "--dividers")
    deburr::tb::dividers();
  else if (arguments.size() == 2 && arguments[0] == "--ratio")
    deburr::tb::ratio(std::atoi(arguments[1].c_str()));
  else
    return 2;
  return 0;
}
