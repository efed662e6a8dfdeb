// SPDX-License-Identifier: MIT
// The geometric engine as a whole: rejections and registers, invalid input, empty frames; the
// cycles of a frame lie between the bounds of docs/reference/geometric/hardware.md and near the
// largest lower bound.
#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "rtl_model/geometric/common/sizing.h"
#include "spec/error.h"
#include "tb/harness/statistics.h"
#include "tb/unit/rtl/geometric/bounds.h"
#include "tb/unit/rtl/geometric/parts.h"

namespace deburr::tb::geometric_rtl::engine_test {
namespace {

using spec::geometric::Rejection;
using spec::geometric::Vertex;
using testing::HasSubstr;

Scene blank(int width, int height) {
  Scene scene;
  scene.width = width;
  scene.height = height;
  scene.colours.assign(static_cast<std::size_t>(width * height), {10, 200, 30, 255});
  scene.depths.assign(scene.colours.size(), 0);
  scene.facing = {true};
  return scene;
}
void add_line(Scene& scene, int x0, int y0, int x1, int y1) {
  const auto v = static_cast<std::uint32_t>(scene.vertices.size());
  scene.vertices.push_back({x0, y0, 5, true});
  scene.vertices.push_back({x1, y1, 5, true});
  scene.edges.push_back({v, v + 1, 0, 0, flag::kBoundary});
}

// Short lines at random positions.
Scene short_lines(int width, int height, int lines, int length) {
  Scene scene = blank(width, height);
  std::uint32_t s = 7;
  const auto below = [&s](int bound) {
    s = 1664525u * s + 1013904223u;
    return static_cast<int>((s >> 16) % static_cast<std::uint32_t>(bound));
  };
  for (int i = 0; i < lines; ++i) {
    const int x = below(256 * width), y = below(256 * height);
    const int down = below(2 * length) - length, right = below(2 * length) - length;
    add_line(scene, x, y, x + right, y + down);
  }
  return scene;
}

// ---- registers

// parameter_store_test.cpp tests which frames are rejected.
TEST(Registers, RejectedStartReadsAndWritesNothing) {
  EngineBench b;
  b.load(contract_scene());
  b.bus.write(reg::kSize, 45u << 16);
  b.start();
  b.clock.run(1);
  EXPECT_EQ(b.bus.read(reg::kStatus), reg::kStatusIdle | reg::kStatusRejected);
  EXPECT_EQ(b.bus.read(reg::kRejection), static_cast<std::uint32_t>(Rejection::kSize));
  b.clock.run(200);
  EXPECT_EQ(b.memory.reads() + b.memory.writes(), 0u);
  EXPECT_EQ(b.engine.work(), spec::geometric::Work{});
}
TEST(Registers, StartWithoutEnableIsRejected) {
  EngineBench b;
  b.load(contract_scene());
  b.bus.write(reg::kControl, reg::kControlStart);
  b.clock.run(1);
  EXPECT_EQ(b.bus.read(reg::kRejection), static_cast<std::uint32_t>(Rejection::kDisabled));
  b.run();
  EXPECT_EQ(b.bus.read(reg::kRejection), 0u);
  EXPECT_EQ(b.pixel_hash(), configuration('a').pixels);
}
TEST(Registers, WritesDuringAFrameAreIgnored) {
  EngineBench b;
  b.load(contract_scene());
  b.start();
  EXPECT_EQ(b.bus.read(reg::kStatus) & reg::kStatusIdle, 0u);
  b.clock.run(1000);
  for (const spec::RegisterInfo& info : spec::geometric::kRegisters)
    if (info.written() != 0 && info.offset != reg::kControl) {
      const std::uint32_t value = b.bus.read(info.offset);
      b.bus.write(info.offset, ~value);
      EXPECT_EQ(b.bus.read(info.offset), value) << info.name;
    }
  b.bus.write(reg::kControl, reg::kControlStart);  // clears enable; the frame continues
  b.bench->run([&] { return b.engine.idle(); }, 20'000);
  EXPECT_EQ(b.bus.read(reg::kStatus), reg::kStatusIdle | reg::kStatusFrameDone |
                                          reg::kStatusWrittenWhileBusy | reg::kStatusInvalidEdge);
  EXPECT_EQ(b.pixel_hash(), configuration('a').pixels);
  EXPECT_EQ(b.bus.read(reg::kFrameCycles),
            b.bus.read(reg::kEdgeCycles) + b.bus.read(reg::kResolveCycles));
  b.bus.write(reg::kStatus, 0xFFFFFFFF);
  EXPECT_EQ(b.bus.read(reg::kStatus), reg::kStatusIdle);
}
TEST(Registers, FrameCyclesCountFromStartToIdle) {
  EngineBench b;
  b.load(contract_scene());
  const Cycle cycles = b.run();
  EXPECT_EQ(b.bus.read(reg::kFrameCycles), cycles);
  b.load(contract_scene());
  const Cycle again = b.run();
  EXPECT_EQ(b.bus.read(reg::kFrameCycles), again) << "of the last frame alone";
  EXPECT_EQ(b.bus.read(reg::kEdgeCycles) + b.bus.read(reg::kResolveCycles), again);
}
// One engine, reconfigured between frames.
TEST(Registers, ConfigurationAppliesToTheNextFrame) {
  EngineBench b;
  const std::uint32_t built = b.bus.read(reg::kConfiguration);
  for (const char name : {'f', 'a', 'g', 'e', 'b', 'h', 'a'}) {
    const Configuration c = configuration(name);
    b.driver.set_configuration(c.p);
    b.load(contract_scene());
    b.run();
    EXPECT_EQ(b.pixel_hash(), c.pixels) << name;
    EXPECT_EQ(b.weight_hash(), c.weights) << name;
    EXPECT_EQ(b.writes(b.bases.copy).empty(), !c.p.frame_copy) << name;
  }
  EXPECT_EQ(b.bus.read(reg::kConfiguration), built) << "the reset value is that of the parameters";
}
TEST(Registers, CountersAddUpUntilCleared) {
  EngineBench b;
  b.load(contract_scene());
  b.run();
  b.run();
  EXPECT_EQ(b.bus.read(reg::kEdges), 600u);
  EXPECT_EQ(b.bus.read(reg::kBlocks), 382u);
  b.bus.write(reg::kControl, reg::kControlEnable | reg::kControlClearCounters);
  EXPECT_EQ(b.bus.read(reg::kEdges), 0u);
  EXPECT_EQ(b.bus.read(reg::kFrameCycles), 0u);
}
TEST(Parameters, RejectsUnbuildableParameters) {
  EXPECT_THAT(in_child([] {
                Parameters p;
                p.reciprocal_table = 8;
                EngineBench b(p);
                return std::string("built");
              }),
              HasSubstr("reciprocal_table"));
}

// ---- memories of a default build ---

TEST(Memories, EveryMemoryIsImplementable) {
  for (const bool largest : {false, true}) {
    const std::string got = in_child([largest] {
      Parameters p;
      if (largest) {
        p.edge_lanes = p.walkers = p.resolve_lanes = Lanes::kFour;
        p.vertex_lines = p.depth_lines = p.weight_blocks = CacheLines::k1024;
        p.fills = p.edge_lines = p.line_fifo = p.copy_lines = 256;
        p.resolve_lines = 512;
        p.colour_lines = 256;
        p.write_buffer = 128;
        p.latency_fifo = 1024;
        p.memory_outstanding = 1024;
        p.line_pixels = 8192;
        p.touched_words = 65536;
        p.face_limit = 1 << 20;
      }
      EngineBench b(p);
      std::string not_implementable;
      for (const rtl::MemoryBase* memory : b.engine.memories())
        not_implementable += memory->not_implementable();
      return not_implementable;
    });
    EXPECT_EQ(got, "") << largest;
  }
}

// Memories in the format of docs/reference/statistics.md, without those of the port: kind, words x
// bits, ports, read latency, physical bits.
std::set<std::string> memories_of(const Parameters& p) {
  std::set<std::string> built;
  const std::string text = in_child([&p] {
    EngineBench b(p);
    std::string lines;
    for (const rtl::MemoryBase* memory : b.engine.memories()) {
      const std::string name = std::string(memory->name()).substr(std::string("engine.").size());
      if (!name.starts_with("memory_port."))
        lines +=
            fmt::format("{} {} {} x {} {} in {}, {}\n", name, rtl::name_of(memory->memory_kind()),
                        memory->words(), memory->word_bits(), memory->ports(),
                        memory->shape().latency, memory->physical_bits());
    }
    return lines;
  });
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) built.insert(line);
  return built;
}
TEST(Memories, MemoriesMatchThePage) {
  const std::set<std::string> built = memories_of({});
  EXPECT_EQ(built, (std::set<std::string>{
                       "block_fetch.latency_fifo sram 108 x 35 1R1W in 1, 3780",
                       "block_fetch.resolve_weights sram 108 x 512 1R1W in 1, 55296",
                       "block_fifo sram 54 x 586 1R1W in 1, 31644",
                       "block_scanner.touched_above flops 4 x 128 1R1W in 0, 512",
                       "coverage_unit.far_area_rom rom 1024 x 8 4R in 1, 16384",
                       "coverage_unit.near_area_rom rom 1024 x 8 4R in 1, 16384",
                       "depth_test.depth_data sram 128 x 384 2R1W in 1, 98304",
                       "depth_test.depth_fills sram 108 x 384 1R1W in 1, 41472",
                       "depth_test.depth_tags sram 128 x 23 2R1W in 1, 5888",
                       "depth_test.latency_fifo sram 128 x 361 1R1W in 1, 46208",
                       "edge_reader.edge_buffer sram 64 x 512 1R1W in 1, 32768",
                       "facing_store.facing sram 1024 x 32 4R1W of 16 words in 1, 131072",
                       "frame_copier.copy_buffer sram 54 x 512 1R1W in 1, 27648",
                       "line_fifo flops 16 x 173 1R1W in 0, 2768",
                       "resolve_colours sram 108 x 512 1R1W in 1, 55296",
                       "resolver.encode_rom rom 4096 x 8 6R in 1, 98304",
                       "resolver.linear_rom rom 256 x 12 18R in 1, 27648",
                       "resolver.originals sram 512 x 100 1R1W in 1, 51200",
                       "vertex_fetch.latency_fifo sram 128 x 29 1R1W in 1, 3712",
                       "vertex_fetch.vertex_data sram 64 x 284 2R1W in 1, 36352",
                       "vertex_fetch.vertex_fills sram 108 x 284 1R1W in 1, 30672",
                       "vertex_fetch.vertex_tags sram 64 x 23 2R1W in 1, 2944",
                       "weight_combiner.latency_fifo sram 128 x 168 1R1W in 1, 21504",
                       "weight_combiner.spill flops 108 x 23 108R2W in 0, 2484",
                       "weight_combiner.touched sram 1088 x 128 1R1W in 1, 139264",
                       "weight_combiner.weight_data sram 128 x 512 1R1W in 1, 65536",
                       "weight_combiner.weight_fills sram 108 x 512 1R1W in 1, 55296",
                       "weight_combiner.weight_tags sram 128 x 23 1R1W in 1, 2944"}));
  Parameters p;  // all optional memories
  p.colour_lines = 100;
  p.write_buffer = 40;
  p.pipelined = false;
  p.reciprocal_table = 10;
  p.records = spec::geometric::RecordsLayout::kSplit;
  p.coarse_lines = spec::geometric::CoarseLines::k64;
  std::set<std::string> others = memories_of(p);
  std::erase_if(others, [&](const std::string& line) { return built.contains(line); });
  EXPECT_EQ(others,
            (std::set<std::string>{"colour_order sram 108 x 9 1R1W in 1, 972",
                                   "depth_screen.coarse_fills sram 108 x 512 1R1W in 1, 55296",
                                   "depth_screen.coarse_lines sram 64 x 512 2R1W in 1, 65536",
                                   "depth_screen.coarse_tags flops 64 x 16 2R1W in 0, 1024",
                                   "depth_screen.latency_fifo sram 128 x 243 1R1W in 1, 31104",
                                   "depth_test.latency_fifo sram 128 x 365 1R1W in 1, 46720",
                                   "kept_colours sram 100 x 512 1R1W in 1, 51200",
                                   "kept_tags flops 100 x 23 100R1W in 0, 2300",
                                   "line_setup.reciprocal_rom rom 512 x 25 1R in 1, 12800",
                                   "pair_fetch.latency_fifo sram 128 x 9 1R1W in 1, 1152",
                                   "pair_fetch.pair_fills sram 108 x 480 1R1W in 1, 51840",
                                   "pair_fetch.pair_lines flops 2 x 480 1R1W in 0, 960",
                                   "pair_fetch.pair_tags flops 2 x 22 1R1W in 0, 44",
                                   "weight_combiner.latency_fifo sram 128 x 177 1R1W in 1, 22656",
                                   "weight_combiner.write_buffer sram 40 x 512 1R1W in 1, 20480",
                                   "weight_combiner.write_tags flops 40 x 23 40R1W in 0, 920"}));
}
// The page's copy_buffer: SRAM above 16 384 bits.
TEST(Memories, SmallCopyBufferUsesFlipFlops) {
  for (const auto& [lines, kind] : {std::pair{32, "flops"}, {33, "sram"}}) {
    const std::string got = in_child([lines = lines] {
      Parameters p;
      p.frame_copy = true;
      p.copy_lines = lines;
      EngineBench b(p);
      std::string found;
      for (const rtl::MemoryBase* memory : b.engine.memories())
        if (std::string(memory->basename()) == "copy_buffer")
          found += rtl::name_of(memory->memory_kind());
      return found;
    });
    EXPECT_EQ(got, kind) << lines;
  }
}
// The page's formulas for other builds: rows of any length are rounded up.
TEST(Memories, RowsOfAnyLengthFit) {
  for (const auto& [pixels, above, originals] : {std::tuple{64, 1u, 16u},
                                                 {512, 1u, 128u},
                                                 {513, 2u, 129u},
                                                 {1023, 2u, 256u},
                                                 {1025, 3u, 257u},
                                                 {8190, 16u, 2048u}}) {
    const std::string got = in_child([pixels = pixels] {
      Parameters p;
      p.line_pixels = pixels;
      EngineBench b(p);
      std::map<std::string, std::uint64_t> words;
      for (const rtl::MemoryBase* memory : b.engine.memories())
        words[memory->basename()] = memory->words();
      return std::to_string(words["touched_above"]) + " " + std::to_string(words["originals"]);
    });
    EXPECT_EQ(got, std::to_string(above) + " " + std::to_string(originals)) << pixels;
  }
}

// ---- buffers whose size follows from the memory latency

TEST(Sizes, BufferSizesMatchThePage) {
  const auto text = [](const Parameters& p, const rtl::MemoryCycles& memory) {
    const Parameters s = rtl::geometric::sized(p, memory);
    return std::to_string(s.fills) + " " + std::to_string(s.resolve_lines) + " " +
           std::to_string(s.copy_lines);
  };
  EXPECT_EQ(text({}, {}), "108 216 54");
  EXPECT_EQ(text({}, {20, 1}), "28 56 14");
  EXPECT_EQ(text({}, {21, 1}), "29 58 15");
  EXPECT_EQ(text({}, {20, 4}), "31 62 16");
  // The smallest size, the number of outstanding transactions of the port, the largest size.
  EXPECT_EQ(text({}, {1, 1}), "9 18 5");
  EXPECT_EQ(text({}, {121, 1}), "128 258 65");
  Parameters p;
  p.memory_outstanding = 1024;
  EXPECT_EQ(text(p, {1000, 1}), "256 512 256");
  p.fills = 8;
  p.resolve_lines = 16;
  p.copy_lines = 2;
  EXPECT_EQ(text(p, {1000, 1}), "8 16 2");
}

// At a latency of 100 cycles, the default sizes keep a frame near its bounds: larger ones gain at
// most 2 %, while a quarter of either size costs at least 10 %.
TEST(Sizes, DefaultsCoverTheLatency) {
  const auto cycles = [](std::int32_t fills, std::int32_t resolve_lines) {
    return std::stod(in_child([&] {
      Parameters p;
      p.fills = fills;
      p.resolve_lines = resolve_lines;
      p.weight_blocks = CacheLines::k1024;
      p.memory_outstanding = 256;
      EngineOptions options;
      options.latency = 100;
      options.memory_bytes = 1u << 22;
      EngineBench b(p, options);
      b.load(short_lines(400, 200, 3000, 2000));
      b.run();
      return std::to_string(b.bus.read(reg::kFrameCycles));
    }));
  };
  const double by_default = cycles(0, 0);
  EXPECT_LE(by_default, 1.02 * cycles(216, 432));
  EXPECT_GE(cycles(27, 216), 1.1 * by_default);
  EXPECT_GE(cycles(108, 54), 1.1 * by_default);
}

// ---- nearly empty frames ------

TEST(Frames, EmptyFrameReadsOnlyFacingBitsAndCopies) {
  Configuration c = configuration('e');
  EngineBench b(c.p);
  Scene scene = contract_scene();
  scene.edges.clear();
  b.load(scene);
  const auto before = b.memory.dump(b.bases.colour, 0x4000);
  b.run();
  const std::size_t lines = 4 * 8 * 6;
  EXPECT_EQ(b.memory.reads(), 1 + lines);
  EXPECT_EQ(b.memory.writes(), lines);
  EXPECT_EQ(b.memory.dump(b.bases.colour, 64 * lines), b.memory.dump(b.bases.copy, 64 * lines));
  EXPECT_EQ(b.memory.dump(b.bases.colour, 0x4000), before);
}
TEST(Frames, TinyFramesAreDrawn) {
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 1}, {1, 5}, {8192, 1}, {4, 9}}) {
    const std::string got = in_child([width = width, height = height] {
      Parameters p;
      p.line_pixels = 8192;
      EngineBench b(p);
      Scene scene = blank(width, height);
      add_line(scene, -500, 100, 256 * width + 500, 180);
      b.load(scene);
      b.run();
      return std::to_string(b.engine.work().columns) + " " +
             std::to_string(b.engine.work().blended_pixels == b.engine.work().passed);
    });
    EXPECT_EQ(got, std::to_string(width) + " 1");
  }
}

// ---- cycle classes of each unit

// "busy 3, depth 20, idle 5" per unit, without zeros.
std::map<std::string, std::string> cycle_classes_of(const EngineBench& b) {
  std::map<std::string, std::string> accounts;
  const nlohmann::ordered_json units = statistics(b.clock, "engine")["units"];
  for (const auto& [name, unit] : units.items()) {
    std::string& text = accounts[name];
    const auto add = [&](const std::string& what, std::uint64_t cycles) {
      if (cycles != 0) text += (text.empty() ? "" : ", ") + what + " " + std::to_string(cycles);
    };
    add("busy", unit["busy"]);
    for (const auto& [cause, cycles] : unit["stalls"].items()) add(cause, cycles);
    add("idle", unit["idle"]);
  }
  return accounts;
}
// A line of eight pixels, M = 20; 303 cycles in total.
TEST(CycleClasses, CyclesOfOneLineMatch) {
  Parameters p;
  p.frame_copy = true;
  EngineBench b(p);
  Scene scene = blank(16, 8);
  add_line(scene, 0, 512 + 100, 8 * 256, 512 + 100);
  b.load(scene);
  EXPECT_EQ(b.run(), 303u);
  const std::map<std::string, std::string> wanted = {
      // The begin phase lasts for the caches' tags: 128 of depth and weights, 64 of vertices. Then
      // the edge and the end, or two groups and the end, pass the stages cycle by cycle.
      {"frame_sequencer", "busy 303"},
      {"facing_store", "busy 2, memory 24, idle 277"},  // one line requested, one received
      {"edge_reader", "busy 4, facing 127, idle 172"},  // the same for edges; one beat, the end
      {"edge_classifier", "busy 4, idle 299"},
      {"vertex_fetch", "busy 71, vertices 25, idle 207"},
      {"line_setup", "busy 23, idle 280"},
      {"line_walker", "busy 3, idle 300"},
      {"coverage_unit", "busy 5, idle 298"},
      {"depth_test", "busy 141, depth 22, idle 140"},
      {"weight_combiner", "busy 135, idle 168"},
      // Eight lines read and written: 32 beats, six of them in a cycle with another one.
      {"frame_copier", "busy 26, downstream 2, memory 34, idle 241"},
      // Two blocks, each with one line read and one written.
      {"block_scanner", "busy 5, idle 298"},
      {"block_fetch", "busy 9, idle 294"},
      {"resolver", "busy 6, colours 26, idle 271"},
      {"memory_arbiter", "busy 46, idle 257"},
      {"memory_port", "busy 48, memory 102, idle 153"}};
  EXPECT_EQ(cycle_classes_of(b), wanted);
  // Latencies of 3, 31, 22, 1, 3, 33 and 5 from unit to unit, and one cycle for the second group.
  EXPECT_EQ(b.engine.edge_latency.count(), 1u);
  EXPECT_EQ(b.engine.edge_latency.sum(), 99u);
}
// Only the begin, and the end passing through all units and the resolve: a unit without reads does
// not wait.
TEST(CycleClasses, CyclesOfEmptyFrameMatch) {
  EngineBench b;
  b.load(blank(16, 8));
  EXPECT_EQ(b.run(), 195u);
  const std::map<std::string, std::string> wanted = {
      {"frame_sequencer", "busy 195"},
      {"facing_store", "busy 2, memory 24, idle 169"},
      // Tags are cleared, and the end passes the stages cycle by cycle.
      {"edge_reader", "busy 1, idle 194"},
      {"edge_classifier", "busy 3, idle 192"},
      {"vertex_fetch", "busy 68, idle 127"},
      {"line_setup", "busy 22, idle 173"},
      {"line_walker", "busy 1, idle 194"},
      {"coverage_unit", "busy 3, idle 192"},
      {"depth_test", "busy 135, idle 60"},
      {"weight_combiner", "busy 132, idle 63"},
      {"frame_copier", "idle 195"},
      {"block_scanner", "busy 4, idle 191"},
      {"block_fetch", "busy 4, idle 191"},
      {"resolver", "busy 1, idle 194"},
      // One line of facing bits.
      {"memory_arbiter", "busy 2, idle 193"},
      {"memory_port", "busy 2, memory 20, idle 173"}};
  EXPECT_EQ(cycle_classes_of(b), wanted);
}
// The same line together with edges of every other kind.
Scene lines_among_others() {
  Scene scene = blank(16, 8);
  const auto add = [&](int y, std::uint32_t depth) {
    add_line(scene, 0, y, 8 * 256, y);
    for (std::size_t i = scene.vertices.size() - 2; i < scene.vertices.size(); ++i)
      scene.vertices[i].depth = depth;
  };
  scene.depths.assign(scene.depths.size(), 1000);
  scene.edges.push_back({0, 1, 0, 0, 0});                 // flat
  scene.edges.push_back({0, 99, 0, 0, flag::kBoundary});  // invalid
  add(100, 2000);                                         // no neighbour above
  add(512 + 100, 2000);
  scene.edges.push_back({2, 2, 0, 0, flag::kBoundary});  // degenerate
  add(512 + 100, 10);                                    // behind the surface
  add(20 * 256, 2000);                                   // empty
  add(3 * 256 + 180, 2000);
  return scene;
}
// Only the two lines with a passing pixel are measured.
TEST(CycleClasses, LatencyCountsOnlyLinesWithAPassingPixel) {
  EngineBench b;
  b.load(lines_among_others());
  b.run();
  EXPECT_EQ(b.engine.work().kept_edges, 6u);
  EXPECT_EQ(b.engine.work().lines, 4u);
  EXPECT_EQ(b.engine.work().passed, 16u);
  // As above, after one or two more edges.
  EXPECT_EQ(b.engine.edge_latency.count(), 2u);
  EXPECT_EQ(b.engine.edge_latency.min(), 101u);
  EXPECT_EQ(b.engine.edge_latency.max(), 103u);
}
// The same with split records, which drop the flat edge before its vertices are known and the
// invalid one after that. With one edge per cycle, two edges never leave together.
TEST(CycleClasses, SplitRecordsMeasureTheSameLines) {
  using spec::geometric::RecordsLayout;
  const auto latencies = [](RecordsLayout records) {
    return forked<std::array<Cycle, 3>>([&] {
      Parameters p;
      p.edge_lanes = spec::geometric::Lanes::kOne;
      p.records = records;
      EngineBench b(p);
      b.load(lines_among_others());
      b.run();
      EXPECT_EQ(b.engine.work().kept_edges, 6u);
      const rtl::Histogram& latency = b.engine.edge_latency;
      return std::array<Cycle, 3>{latency.count(), latency.min(), latency.max()};
    });
  };
  const std::array<Cycle, 3> joined = latencies(RecordsLayout::kJoined);
  EXPECT_EQ(joined[0], 2u);
  // One more unit on the path, which waits for its line as VertexFetch does.
  const Cycle more = rtl::geometric::PairFetch::datasheet().latency.cycles + 26;
  EXPECT_EQ(latencies(RecordsLayout::kSplit),
            (std::array<Cycle, 3>{2, joined[1] + more, joined[2] + more}));
}
// Small buffers everywhere and a single divider, so that units wait for each other, with every
// stall cause except `fills` and the Resolver's `downstream`.
TEST(CycleClasses, CyclesOfStalledFrameMatch) {
  Parameters p;
  p.coverage = spec::geometric::CoverageRule::kDistance;
  p.layout = spec::geometric::Layout::kRaster;
  p.pipelined = false;
  p.vertex_lines = p.depth_lines = p.weight_blocks = CacheLines::k16;
  p.fills = p.memory_outstanding = 8;
  p.latency_fifo = 4;
  p.line_fifo = 2;
  p.resolve_lines = 16;
  p.resolve_lanes = Lanes::kOne;
  EngineBench b(p);
  const Scene scene = short_lines(90, 40, 40, 3000);
  b.load(scene);
  b.run();
  const std::map<std::string, std::string> wanted = {
      {"frame_sequencer", "busy 2520"},
      {"facing_store", "busy 2, memory 24, idle 2494"},
      {"edge_reader", "busy 36, downstream 231, facing 16, idle 2237"},
      {"edge_classifier", "busy 57, downstream 422, idle 2041"},
      {"vertex_fetch", "busy 103, downstream 610, vertices 42, idle 1765"},
      {"line_setup", "busy 62, downstream 343, divider 468, idle 1647"},
      {"line_walker", "busy 122, downstream 726, idle 1672"},
      {"coverage_unit", "busy 128, downstream 790, idle 1602"},
      {"depth_test", "busy 596, downstream 23, depth 386, idle 1515"},
      {"weight_combiner", "busy 416, downstream 27, weights 320, spill 31, idle 1726"},
      {"frame_copier", "idle 2520"},
      {"block_scanner", "busy 88, downstream 1094, idle 1338"},
      {"block_fetch", "busy 456, downstream 666, weights 17, colours 171, idle 1210"},
      {"resolver", "busy 292, colours 1018, idle 1210"},
      {"memory_arbiter", "busy 1085, downstream 990, idle 445"},
      {"memory_port", "busy 1013, outstanding 1160, memory 326, idle 21"}};
  EXPECT_EQ(cycle_classes_of(b), wanted);
  EXPECT_EQ(b.engine.edge_latency.count(), 40u);
  EXPECT_EQ(b.engine.edge_latency.sum(), 20401u);
}

// ---- cycles

// Blocks that spill wait for the responses to their writes, so their edges have no upper bound.
class PageCycles : public ::testing::TestWithParam<char> {};
TEST_P(PageCycles, FramesOfThePageLieAboveTheBounds) {
  EngineBench b(configuration(GetParam()).p);
  const Scene scene = contract_scene();
  b.load(scene);
  b.run();
  expect_bounds(b, scene, false);
}
INSTANTIATE_TEST_SUITE_P(Page, PageCycles, ::testing::Range('a', 'o'));

class Cycles : public ::testing::TestWithParam<Lanes> {};
TEST_P(Cycles, ShortLinesAreNearTheBound) {
  Parameters p;
  p.walkers = GetParam();
  p.weight_blocks = CacheLines::k1024;
  EngineBench b(p);
  const Scene scene = short_lines(120, 100, 800, 3000);
  b.load(scene);
  b.run();
  EXPECT_EQ(b.engine.weight_combiner.blocks_written.value(), 0u);
  expect_bounds(b, scene);
}
INSTANTIATE_TEST_SUITE_P(Walkers, Cycles,
                         ::testing::Values(Lanes::kOne, Lanes::kTwo, Lanes::kFour));

// Random edges and builds. Blocks that spill and small buffers have no upper bound.
class RandomCycles : public ::testing::TestWithParam<int> {};
TEST_P(RandomCycles, RandomFramesLieBetweenTheBounds) {
  std::uint32_t s = static_cast<std::uint32_t>(GetParam()) * 2654435761u + 1;
  const auto below = [&s](int bound) {
    s = 1664525u * s + 1013904223u;
    return static_cast<int>((s >> 16) % static_cast<std::uint32_t>(bound));
  };
  const int length = 100 << below(6), lines = 100 + below(900), height = 20 + below(120);
  Scene scene = short_lines(60 + below(400), height, lines, length);
  scene.facing.assign(static_cast<std::size_t>(1 + below(5000)), false);
  for (std::size_t f = 0; f < scene.facing.size(); ++f) scene.facing[f] = below(3) != 0;
  for (Edge& e : scene.edges) {
    e.f0 = static_cast<std::uint32_t>(below(static_cast<int>(scene.facing.size())));
    e.f1 = static_cast<std::uint32_t>(below(static_cast<int>(scene.facing.size())));
    e.flags = static_cast<std::uint8_t>(below(16));
    if (below(4) == 0) e.v1 = static_cast<std::uint32_t>(below(static_cast<int>(e.v1) + 1));
  }
  Parameters p;
  p.edge_lanes = static_cast<Lanes>(below(3));
  p.walkers = static_cast<Lanes>(below(3));
  p.resolve_lanes = static_cast<Lanes>(below(3));
  p.layout = static_cast<spec::geometric::Layout>(below(2));
  p.weight_blocks = below(4) == 0 ? CacheLines::k64 : CacheLines::k1024;
  p.depth_lines = p.vertex_lines = CacheLines::k256;
  p.pipelined = below(3) != 0;
  p.dividers = 1 + below(8);
  p.reciprocal_table = p.pipelined ? 0 : below(12);
  p.crease = static_cast<spec::geometric::Crease>(below(3));
  EngineBench b(p, {.memory_bytes = 1u << 20});
  b.load(scene);
  b.run();
  EXPECT_GT(b.engine.work().lines, 10u);
  expect_bounds(b, scene, b.engine.weight_combiner.blocks_written.value() == 0);
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomCycles, ::testing::Range(0, 40));

TEST(CyclesOf, FlatEdgesTakeOneCyclePerBeat) {
  for (const auto& [lanes, count] :
       {std::pair{Lanes::kOne, 1u}, {Lanes::kTwo, 2u}, {Lanes::kFour, 4u}}) {
    const std::string got = in_child([lanes = lanes, count = count] {
      Parameters p;
      p.edge_lanes = lanes;
      EngineBench b(p);
      Scene scene = blank(64, 64);
      scene.vertices.resize(2);
      scene.edges.assign(4000, Edge{0, 1, 0, 0, 0});
      b.load(scene);
      b.run();
      // In addition to the beats: 128 tags are cleared, and the end takes 50 cycles through all
      // units.
      return std::to_string(b.bus.read(reg::kEdgeCycles) - 4000 / count);
    });
    EXPECT_EQ(got, "178") << count;
  }
}
// The begin clears one word of touched bits per cycle, or waits for the last facing bits.
TEST(CyclesOf, BeginClearsOneWordPerCycle) {
  for (const auto& [height, faces, cycles] :
       {std::tuple{512, 1, 128}, {516, 1, 129}, {1200, 1, 300}, {64, 512 * 64, 128}}) {
    const std::string got = in_child([height = height, faces = faces] {
      Parameters p;
      p.face_limit = 1 << 18;
      EngineBench b(p);
      Scene scene = blank(64, 64);
      scene.height = height;
      scene.facing.assign(static_cast<std::size_t>(faces), true);
      b.load(scene);
      b.run();
      return std::to_string(b.bus.read(reg::kEdgeCycles));
    });
    EXPECT_EQ(got, std::to_string(cycles + 50)) << height << " " << faces;
  }
}
TEST(CyclesOf, LongLineTakesOneCyclePerGroup) {
  Parameters p;
  p.line_pixels = 8192;
  p.walkers = Lanes::kOne;
  p.weight_blocks = CacheLines::k1024;
  EngineOptions options;
  options.memory_bytes = 1u << 22;
  EngineBench b(p, options);
  Scene scene = blank(2000, 4);
  add_line(scene, 0, 512 + 60, 256 * 2000, 512 + 60);
  b.load(scene);
  b.run();
  EXPECT_EQ(b.engine.work().groups, 2000u);
  // 1024 tags; the path of the end, one vertex, one line of depth and the response to the last
  // write.
  EXPECT_EQ(b.bus.read(reg::kEdgeCycles), 2000u + 1024 + 122);
}
TEST(CyclesOf, DividedLinesStayWithinBounds) {
  for (const int dividers : {1, 3}) {
    const std::string got = in_child([dividers] {
      Parameters p;
      p.pipelined = false;
      p.dividers = dividers;
      EngineBench b(p);
      Scene scene = blank(64, 64);
      for (int i = 0; i < 130 * dividers; ++i)
        add_line(scene, 1000, 1000 + 9 * i % 700, 1600, 1100);
      b.load(scene);
      b.run();
      expect_bounds(b, scene);
      return std::to_string(b.bus.read(reg::kLines));
    });
    EXPECT_EQ(got, std::to_string(130 * dividers));
  }
}

}  // namespace
}  // namespace deburr::tb::geometric_rtl::engine_test
