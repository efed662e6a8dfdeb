// SPDX-License-Identifier: MIT
// The geometric engine as a whole: refusals and registers, bad input, empty frames; the clocks of a
// frame between the bounds of docs/geometric_hardware.md, and near the one that is the largest.
#include <map>

#include "spec/error.h"
#include "tb/unit/rtl/geometric/parts.h"

namespace deburr::tb::geometric_rtl {
namespace {

using spec::geometric::CacheLines;
using spec::geometric::Edge;
using spec::geometric::Lanes;
using spec::geometric::Refusal;
using spec::geometric::Vertex;
using testing::HasSubstr;
namespace flag = spec::geometric::flag;

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

// ---- registers

struct RefusedStart {
  std::uint32_t offset, value;
  Refusal why;
};
class Refused : public ::testing::TestWithParam<RefusedStart> {};
TEST_P(Refused, ReadsAndWritesNothing) {
  Parameters p;
  p.line_pixels = 512;
  p.touched_words = 100;
  EngineBench b(p);
  b.load(contract_scene());
  b.bus.write(GetParam().offset, GetParam().value);
  b.start();
  b.clock.run(1);
  EXPECT_EQ(b.bus.read(reg::kStatus), reg::kStatusIdle | reg::kStatusRefused);
  EXPECT_EQ(b.bus.read(reg::kRefusal), static_cast<std::uint32_t>(GetParam().why));
  b.clock.run(200);
  EXPECT_EQ(b.memory.reads() + b.memory.writes(), 0u);
  EXPECT_EQ(b.engine.work(), spec::geometric::Work{});
}
constexpr std::uint32_t size_of(std::uint32_t w, std::uint32_t h) { return w | h << 16; }
INSTANTIATE_TEST_SUITE_P(
    Starts, Refused,
    ::testing::Values(RefusedStart{reg::kSize, size_of(0, 45), Refusal::kSize},
                      RefusedStart{reg::kSize, size_of(61, 0), Refusal::kSize},
                      RefusedStart{reg::kSize, size_of(8193, 9), Refusal::kSize},
                      RefusedStart{reg::kSize, size_of(61, 8193), Refusal::kSize},
                      RefusedStart{reg::kSize, size_of(513, 45), Refusal::kWidth},
                      RefusedStart{reg::kSize, size_of(512, 401), Refusal::kTouchedWords},
                      RefusedStart{reg::kEdgeCount, (1u << 24) + 1, Refusal::kEdgeCount},
                      RefusedStart{reg::kVertexCount, (1u << 24) + 1, Refusal::kVertexCount},
                      RefusedStart{reg::kFaceCount, 32769, Refusal::kFaceCount}));

TEST(Registers, StartWithoutEnableIsRefused) {
  EngineBench b;
  b.load(contract_scene());
  b.bus.write(reg::kControl, reg::kControlStart);
  b.clock.run(1);
  EXPECT_EQ(b.bus.read(reg::kRefusal), static_cast<std::uint32_t>(Refusal::kDisabled));
  b.run();
  EXPECT_EQ(b.bus.read(reg::kRefusal), 0u);
  EXPECT_EQ(b.pixel_hash(), configuration('a').pixels);
}
TEST(Registers, WritesOfAFrameUnderWayAreIgnored) {
  EngineBench b;
  b.load(contract_scene());
  b.start();
  EXPECT_EQ(b.bus.read(reg::kStatus) & reg::kStatusIdle, 0u);
  b.clock.run(1000);
  b.bus.write(reg::kRules, 0);
  b.bus.write(reg::kColourBase, 0);
  b.bus.write(reg::kControl, reg::kControlStart);  // enable goes, the frame goes on
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
  const Cycle clocks = b.run();
  EXPECT_EQ(b.bus.read(reg::kFrameCycles), clocks);
}
TEST(Registers, CodesThatNoChoiceHasCountAsTheFirst) {
  EngineBench b(configuration('g').p);
  b.load(contract_scene());
  // crease 3, depth_test 3, depth_bias 0: off, off, 1.
  const std::uint32_t others = b.bus.read(reg::kRules) & ~(3u << 2 | 3u << 4 | 31u << 8);
  b.bus.write(reg::kRules, others | 3u << 2 | 3u << 4);
  b.run();
  EXPECT_EQ(b.engine.work().crease_edges, 0u);
  EXPECT_EQ(b.engine.work().passed, b.engine.work().candidates);
  EXPECT_EQ(b.reads(b.bases.depth).size(), 0u);
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
TEST(Parameters, ThatCannotBeBuiltAreRefused) {
  const auto refusal = [](const auto& change) {
    return in_child([&] {
      Parameters p;
      change(p);
      EngineBench b(p);
      return std::string("built");
    });
  };
  EXPECT_THAT(refusal([](Parameters& p) { p.reciprocal_table = 8; }),
              HasSubstr("reciprocal_table"));
  EXPECT_THAT(refusal([](Parameters& p) { p.face_limit = 10000; }), HasSubstr("face_limit"));
  EXPECT_THAT(refusal([](Parameters& p) { p.memory_outstanding = 16; }), HasSubstr("fills"));
  EXPECT_THAT(refusal([](Parameters& p) { p.line_pixels = 63; }), HasSubstr("line_pixels"));
  EXPECT_EQ(refusal([](Parameters& p) { p.pipelined = false; }), "built");
}

// ---- what a default build is made of

TEST(Memories, NoneIsIdealised) {
  for (const bool largest : {false, true}) {
    const std::string got = in_child([largest] {
      Parameters p;
      if (largest) {
        p.edge_lanes = p.walkers = p.resolve_lanes = Lanes::kFour;
        p.vertex_lines = p.depth_lines = p.weight_blocks = CacheLines::k1024;
        p.fills = p.edge_lines = p.resolve_lines = p.line_fifo = 256;
        p.latency_fifo = 1024;
        p.memory_outstanding = 1024;
        p.line_pixels = 8192;
        p.touched_words = 65536;
        p.face_limit = 1 << 20;
      }
      EngineBench b(p);
      std::string idealised;
      for (const rtl::MemoryBase* memory : b.engine.memories()) idealised += memory->idealised();
      return idealised;
    });
    EXPECT_EQ(got, "") << largest;
  }
}

// ---- frames with little in them

TEST(Frames, WithoutEdgesReadFacingBitsAndCopyAlone) {
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
TEST(Frames, OfAPixelOrTwo) {
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

// ---- errors of memory

TEST(MemoryErrors, ReadAsZerosAndAreCounted) {
  struct Row {
    std::uint32_t base;
    const char* region;
  };
  const Bases bases;
  for (const Row& row :
       {Row{bases.edges, "edges"}, Row{bases.vertices, "vertices"}, Row{bases.faces, "faces"},
        Row{bases.depth, "depth"}, Row{bases.weights, "weights"}, Row{bases.colour, "colour"}}) {
    const std::string got = in_child([&row] {
      EngineBench b;
      b.load(contract_scene());
      b.memory.fail_range(row.base, row.base + kRegionBytes);
      b.run();
      const spec::geometric::Work w = b.engine.work();
      const std::size_t accesses = b.reads(row.base).size() + b.writes(row.base).size();
      std::string text = b.bus.read(reg::kMemoryErrors) == accesses && accesses > 0 ? "" : "count ";
      if (!(b.bus.read(reg::kStatus) & reg::kStatusMemoryError)) text += "status ";
      const std::string region = row.region;
      if (region == "edges" && w.boundary_edges + w.silhouette_edges + w.crease_edges != 0)
        text += "edges ";
      if (region == "vertices" && w.outside_edges != w.kept_edges) text += "vertices ";
      if (region == "faces" && w.silhouette_edges + w.crease_edges + w.flat_edges != 0)
        text += "faces ";
      if (region == "depth" && w.passed != w.candidates) text += "depth ";
      return text;
    });
    EXPECT_EQ(got, "") << row.region;
  }
}

// ---- clocks

// The bounds of the page, from what was drawn and what went over the port.
class Bounds {
 public:
  explicit Bounds(const EngineBench& b) : b_(b), w_(b.engine.work()) {
    for (const spec::geometric::LineRecord& line : b.lines) walk(line);
  }
  std::uint64_t begin() const {
    const std::uint64_t words =
        static_cast<std::uint64_t>(((b_.width + 3) / 4 + 127) / 128 * ((b_.height + 3) / 4));
    const std::uint64_t tags =
        std::max({lines(b_.p.vertex_lines), lines(b_.p.depth_lines), lines(b_.p.weight_blocks)});
    const std::uint64_t faces = b_.reads(b_.bases.faces).size();
    return std::max({words, tags, faces ? faces + 20 : 0});
  }
  std::uint64_t edges() const {
    const std::uint64_t lanes =
        spec::geometric::kLaneCount[static_cast<std::size_t>(b_.p.edge_lanes)];
    const std::uint64_t port =
        b_.reads(b_.bases.edges).size() + b_.reads(b_.bases.vertices).size() +
        b_.reads(b_.bases.depth).size() + b_.engine.weight_combiner.blocks_read.value() +
        b_.writes(b_.bases.weights).size() + 2 * b_.writes(b_.bases.copy).size();
    const std::uint64_t setup = b_.p.pipelined
                                    ? w_.lines
                                    : 13 * (w_.lines - b_.engine.line_setup.table_lines.value()) /
                                          static_cast<std::uint64_t>(b_.p.dividers);
    return std::max(
        {(w_.edges + lanes - 1) / lanes, w_.kept_edges, setup, w_.groups, depth_, port});
  }
  std::uint64_t resolve() const {
    std::map<std::pair<int, int>, std::uint64_t> in_word;
    std::uint64_t blend = 0;
    for (const spec::geometric::BlockRecord& block : b_.blocks) {
      ++in_word[{block.x / 128, block.y}];
      blend += static_cast<std::uint64_t>(
          std::max(1, (std::popcount(block.blended) + 1) / 2));  // two lanes
    }
    std::uint64_t scan =
        static_cast<std::uint64_t>(((b_.width + 3) / 4 + 127) / 128 * ((b_.height + 3) / 4));
    for (const auto& word : in_word) scan += word.second - 1;
    const std::uint64_t port = b_.engine.block_fetch.weights_read.value() +
                               b_.engine.block_fetch.lines_read.value() +
                               b_.engine.resolver.lines_written.value();
    return std::max({scan, blend, port});
  }
  // What the page allows above a bound.
  static std::uint64_t most(std::uint64_t bound) { return bound + bound / 20 + 8 * 20 + 150; }

 private:
  static std::uint64_t lines(CacheLines code) {
    return spec::geometric::kCacheLineCount[static_cast<std::size_t>(code)];
  }
  // Groups, their lines of depth in pairs, and which of these miss.
  void walk(const spec::geometric::LineRecord& l) {
    const bool vertical = l.axis == spec::geometric::Axis::kVertical;
    const int walkers = spec::geometric::kLaneCount[static_cast<std::size_t>(b_.p.walkers)];
    const int rows = vertical ? b_.width : b_.height;
    for (int i = 0; i < l.count;) {
      const auto at = [&](int k) { return (l.position + k * std::int64_t{l.slope}) >> 8; };
      const auto block = [&](int k) { return std::pair{(l.first + k) >> 2, at(k) >> 18}; };
      int n = 1;
      while (n < walkers && i + n < l.count && block(i + n) == block(i)) ++n;
      std::vector<std::pair<int, int>> wanted;
      for (int k = i; k < i + n; ++k) {
        const int row = static_cast<int>(at(k) >> 16),
                  distance = static_cast<int>(at(k) & 65535) - 32768;
        const int other = distance > 0 || (distance == 0 && l.tie_forward) ? row + 1 : row - 1;
        if (row < 0 || row >= rows || other < 0 || other >= rows || std::abs(distance) > 32640)
          continue;
        for (const int m : {row, other}) {
          const int x = vertical ? m : l.first + k, y = vertical ? l.first + k : m;
          const std::pair place = b_.tiled() ? std::pair{x / 4, y / 4} : std::pair{x / 16, y};
          if (std::find(wanted.begin(), wanted.end(), place) == wanted.end())
            wanted.push_back(place);
        }
      }
      for (std::size_t pair = 0; pair < wanted.size(); pair += 2) {
        std::uint64_t misses = 0;
        for (std::size_t k = pair; k < std::min(pair + 2, wanted.size()); ++k)
          misses += look_up(wanted[k]);
        depth_ += std::max<std::uint64_t>(1, misses);
      }
      i += n;
    }
  }
  std::uint64_t look_up(std::pair<int, int> place) {
    const int bits = spec::geometric::kCacheLineBits[static_cast<std::size_t>(b_.p.depth_lines)];
    const int low = b_.tiled() ? (bits + 1) / 2 : std::max(1, (bits + 1) / 2 - 2);
    const int index = place.first % (1 << low) + (place.second % (1 << (bits - low)) << low);
    const auto found = cache_.find(index);
    if (found != cache_.end() && found->second == place) return 0;
    cache_[index] = place;
    return 1;
  }

  const EngineBench& b_;
  const spec::geometric::Work w_;
  std::uint64_t depth_ = 0;
  std::map<int, std::pair<int, int>> cache_;
};

void expect_bounds(const EngineBench& b, bool edges_too = true) {
  const Bounds bounds(b);
  const std::uint64_t edge_cycles = b.engine.frame_sequencer.edge_cycles.value(),
                      resolve_cycles = b.engine.frame_sequencer.resolve_cycles.value();
  const std::uint64_t least = bounds.begin() + bounds.edges();
  EXPECT_GE(edge_cycles, least);
  if (edges_too) {
    EXPECT_LE(edge_cycles, Bounds::most(least));
  }
  EXPECT_GE(resolve_cycles, bounds.resolve());
  EXPECT_LE(resolve_cycles, Bounds::most(bounds.resolve()));
  std::printf("edges: %lu, %lu at least; resolve: %lu, %lu at least\n",
              static_cast<unsigned long>(edge_cycles), static_cast<unsigned long>(least),
              static_cast<unsigned long>(resolve_cycles),
              static_cast<unsigned long>(bounds.resolve()));
}

// Blocks that spill wait for the answers of their writes: no bound from above for their edges.
class PageClocks : public ::testing::TestWithParam<char> {};
TEST_P(PageClocks, LieAboveTheBounds) {
  EngineBench b(configuration(GetParam()).p);
  b.load(contract_scene());
  b.run();
  expect_bounds(b, false);
}
INSTANTIATE_TEST_SUITE_P(Page, PageClocks,
                         ::testing::Values('a', 'b', 'c', 'd', 'e', 'f', 'g', 'h'));

// Short lines everywhere, all blocks in the cache.
Scene short_lines(int width, int height, int lines, int length) {
  Scene scene = blank(width, height);
  std::uint32_t s = 7;
  const auto below = [&s](int bound) {
    s = 1664525u * s + 1013904223u;
    return static_cast<int>((s >> 16) % static_cast<std::uint32_t>(bound));
  };
  for (int i = 0; i < lines; ++i) {
    const int x = below(256 * width), y = below(256 * height);
    add_line(scene, x, y, x + below(2 * length) - length, y + below(2 * length) - length);
  }
  return scene;
}
class Clocks : public ::testing::TestWithParam<Lanes> {};
TEST_P(Clocks, OfShortLinesAreNearTheBound) {
  Parameters p;
  p.walkers = GetParam();
  p.weight_blocks = CacheLines::k1024;
  EngineBench b(p);
  b.load(short_lines(120, 100, 800, 3000));
  b.run();
  EXPECT_EQ(b.engine.weight_combiner.blocks_written.value(), 0u);
  expect_bounds(b);
}
INSTANTIATE_TEST_SUITE_P(Walkers, Clocks,
                         ::testing::Values(Lanes::kOne, Lanes::kTwo, Lanes::kFour));

TEST(ClocksOf, FlatEdges) {
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
      // Beside the beats: 128 tags are cleared, and the end takes 48 clocks through all units.
      return std::to_string(b.bus.read(reg::kEdgeCycles) - 4000 / count);
    });
    EXPECT_EQ(got, "176") << count;
  }
}
TEST(ClocksOf, OneLongLine) {
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
  // 1024 tags; the end's way, a vertex, a line of depth and the answer of the last write.
  EXPECT_EQ(b.bus.read(reg::kEdgeCycles), 2000u + 1024 + 120);
}
TEST(ClocksOf, Dividers) {
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
      expect_bounds(b);
      return std::to_string(b.bus.read(reg::kLines));
    });
    EXPECT_EQ(got, std::to_string(130 * dividers));
  }
}
TEST(ClocksOf, FramesBehindEachOtherAreTheSame) {
  EngineBench b;
  b.load(contract_scene());
  std::vector<std::uint32_t> clocks;
  for (int i = 0; i < 3; ++i) {
    b.load_frame(contract_scene());
    b.run();
    clocks.push_back(b.bus.read(reg::kFrameCycles));
  }
  EXPECT_EQ(clocks[0], clocks[1]);
  EXPECT_EQ(clocks[0], clocks[2]);
  EXPECT_EQ(b.pixel_hash(), configuration('a').pixels);
}

}  // namespace
}  // namespace deburr::tb::geometric_rtl
