// SPDX-License-Identifier: MIT
// What must not change a bit: stalls on every link, memory that answers late and in any order, the
// order in which units are evaluated, the size of everything that is built, and with combine = max
// the order of the edges.
#include "tb/stimuli/random.h"
#include "tb/unit/rtl/geometric/parts.h"

namespace deburr::tb::geometric_rtl {
namespace {

using spec::geometric::CacheLines;
using spec::geometric::Lanes;

void expect_page(EngineBench& b, const Configuration& c) {
  EXPECT_EQ(b.weight_hash(), c.weights);
  EXPECT_EQ(b.pixel_hash(), c.pixels);
  if (c.traffic != 0) {
    EXPECT_EQ(b.traffic_hash(), c.traffic);
  }
}

struct Trouble {
  char configuration;
  std::uint32_t stalls, latency, scatter;
  std::optional<std::uint64_t> shuffle;
  bool poison, fast;
};
class Stress : public ::testing::TestWithParam<Trouble> {};

TEST_P(Stress, ChangesNothing) {
  const Trouble& t = GetParam();
  const Configuration c = configuration(t.configuration);
  EngineOptions options;
  options.latency = t.latency;
  options.scatter = t.scatter;
  options.bench.stall_permille = t.stalls;
  options.bench.shuffle = t.shuffle;
  options.bench.poison = t.poison;
  options.bench.fast_path = t.fast;
  options.bench.seed = t.latency + t.stalls;
  EngineBench b(c.p, options);
  b.load(contract_scene());
  for (int frame = 0; frame < 2; ++frame) {
    b.load_frame(contract_scene());
    b.run();
    expect_page(b, c);
  }
}
INSTANTIATE_TEST_SUITE_P(Any, Stress,
                         ::testing::Values(Trouble{'a', 300, 5, 0, std::nullopt, false, true},
                                           Trouble{'c', 0, 3, 90, std::nullopt, false, true},
                                           Trouble{'d', 200, 1, 60, 7, true, true},
                                           Trouble{'e', 150, 10, 40, 3, true, true},
                                           Trouble{'f', 0, 20, 200, 5, true, true},
                                           Trouble{'g', 400, 2, 10, 9, true, true},
                                           Trouble{'h', 100, 1, 150, 11, true, true},
                                           Trouble{'c', 250, 40, 100, 4, true, false}));

// Evaluated in another order, every clock is the same.
TEST(Evaluation, OrderDoesNotMatter) {
  std::vector<std::uint64_t> clocks;
  const auto run = [&](std::optional<std::uint64_t> seed) {
    EngineOptions options;
    options.scatter = 30;
    options.bench.shuffle = seed;
    EngineBench b(configuration('c').p, options);
    b.load(contract_scene());
    b.run();
    return std::to_string(b.bus.read(reg::kEdgeCycles)) + " " +
           std::to_string(b.bus.read(reg::kResolveCycles));
  };
  const std::string in_order = in_child([&] { return run(std::nullopt); });
  for (std::uint64_t seed = 1; seed <= 4; ++seed)
    EXPECT_EQ(in_child([&] { return run(seed); }), in_order);
}

struct Builds {
  Lanes edge_lanes, walkers, resolve_lanes;
  CacheLines vertices, depths, blocks;
  int fills, fifo, dividers, table;
  bool pipelined;
};
class EveryBuild : public ::testing::TestWithParam<Builds> {};

TEST_P(EveryBuild, GivesTheSamePicture) {
  const Builds& v = GetParam();
  for (const char name : {'a', 'b'}) {
    const std::string got = in_child([&] {
      Configuration c = configuration(name);
      c.p.edge_lanes = v.edge_lanes;
      c.p.walkers = v.walkers;
      c.p.resolve_lanes = v.resolve_lanes;
      c.p.vertex_lines = v.vertices;
      c.p.depth_lines = v.depths;
      c.p.weight_blocks = v.blocks;
      c.p.fills = v.fills;
      c.p.latency_fifo = v.fifo;
      c.p.dividers = v.dividers;
      c.p.reciprocal_table = v.table;
      c.p.pipelined = v.pipelined;
      c.p.edge_lines = v.fills;
      c.p.resolve_lines = v.fills < 16 ? 16 : v.fills;
      c.p.line_fifo = std::min(v.fifo / 2, 256);
      EngineBench b(c.p);
      b.load(contract_scene());
      b.run();
      return std::string(b.weight_hash() == c.weights && b.pixel_hash() == c.pixels ? "same"
                                                                                    : "other");
    });
    EXPECT_EQ(got, "same") << name;
  }
}
INSTANTIATE_TEST_SUITE_P(
    Table, EveryBuild,
    ::testing::Values(Builds{Lanes::kOne, Lanes::kOne, Lanes::kOne, CacheLines::k16,
                             CacheLines::k16, CacheLines::k16, 4, 4, 1, 0, false},
                      Builds{Lanes::kFour, Lanes::kTwo, Lanes::kFour, CacheLines::k1024,
                             CacheLines::k1024, CacheLines::k1024, 128, 1024, 8, 11, false},
                      Builds{Lanes::kTwo, Lanes::kFour, Lanes::kOne, CacheLines::k32,
                             CacheLines::k64, CacheLines::k32, 16, 8, 3, 9, false},
                      Builds{Lanes::kFour, Lanes::kFour, Lanes::kFour, CacheLines::k16,
                             CacheLines::k32, CacheLines::k512, 8, 200, 1, 0, true},
                      Builds{Lanes::kOne, Lanes::kFour, Lanes::kTwo, CacheLines::k128,
                             CacheLines::k256, CacheLines::k64, 100, 6, 5, 1, false}));

TEST(EdgeOrder, DoesNotMatterWithMax) {
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    const std::string got = in_child([&] {
      const Configuration c = configuration('c');
      Scene scene = contract_scene();
      std::uint32_t s = seed;
      for (std::size_t i = scene.edges.size() - 1; i > 0; --i) {
        s = 1664525u * s + 1013904223u;
        std::swap(scene.edges[i], scene.edges[(s >> 16) % (i + 1)]);
      }
      EngineBench b(c.p);
      b.load(scene);
      b.run();
      return std::string(b.weight_hash() == c.weights && b.pixel_hash() == c.pixels ? "same"
                                                                                    : "other");
    });
    EXPECT_EQ(got, "same");
  }
}

}  // namespace
}  // namespace deburr::tb::geometric_rtl
