// SPDX-License-Identifier: MIT
// What must not change a bit: stalls on every link, memory that answers late and in any order, the
// order in which units are evaluated, the size of everything that is built, and but for combine =
// last the order of the edges.
#include "tb/base/random.h"
#include "tb/unit/rtl/geometric/parts.h"

namespace deburr::tb::geometric_rtl::stress_test {
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
  const Scene scene = contract_scene(geometric::frame_vector(t.configuration).frame);
  b.load(scene);
  for (int frame = 0; frame < 2; ++frame) {
    b.load_frame(scene);
    b.run();
    expect_page(b, c);
  }
}
INSTANTIATE_TEST_SUITE_P(
    Any, Stress,
    ::testing::Values(
        Trouble{'a', 300, 5, 0, std::nullopt, false, true},
        Trouble{'c', 0, 3, 90, std::nullopt, false, true}, Trouble{'d', 200, 1, 60, 7, true, true},
        Trouble{'e', 150, 10, 40, 3, true, true}, Trouble{'f', 0, 20, 200, 5, true, true},
        Trouble{'g', 400, 2, 10, 9, true, true}, Trouble{'h', 100, 1, 150, 11, true, true},
        Trouble{'l', 300, 5, 40, 6, true, true}, Trouble{'m', 200, 1, 90, 8, true, true},
        Trouble{'n', 150, 20, 60, 2, true, true}, Trouble{'u', 300, 3, 60, 4, true, true},
        Trouble{'u', 0, 1, 0, 1, true, true}, Trouble{'w', 300, 2, 90, 5, true, true},
        Trouble{'z', 150, 40, 20, 6, true, true}, Trouble{'c', 250, 40, 100, 4, true, false}));

struct Builds {
  Lanes edge_lanes, walkers, resolve_lanes;
  CacheLines vertices, depths, blocks;
  int fills, fifo, dividers, table;
  bool pipelined;
  int colour_lines = 0, write_buffer = 0;
};
class EveryBuild : public ::testing::TestWithParam<Builds> {};

TEST_P(EveryBuild, GivesTheSamePicture) {
  const Builds& v = GetParam();
  for (const char name : {'a', 'b', 'l'}) {
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
      c.p.colour_lines = v.colour_lines;
      c.p.write_buffer = v.write_buffer;
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
                             CacheLines::k16, CacheLines::k16, 8, 4, 1, 0, false},
                      Builds{Lanes::kFour, Lanes::kTwo, Lanes::kFour, CacheLines::k1024,
                             CacheLines::k1024, CacheLines::k1024, 128, 1024, 8, 11, false},
                      Builds{Lanes::kTwo, Lanes::kFour, Lanes::kOne, CacheLines::k32,
                             CacheLines::k64, CacheLines::k32, 16, 8, 3, 9, false},
                      Builds{Lanes::kFour, Lanes::kFour, Lanes::kFour, CacheLines::k16,
                             CacheLines::k32, CacheLines::k512, 8, 200, 1, 0, true},
                      Builds{Lanes::kTwo, Lanes::kFour, Lanes::kTwo, CacheLines::k64,
                             CacheLines::k64, CacheLines::k16, 8, 128, 1, 0, true, 1, 1},
                      Builds{Lanes::kTwo, Lanes::kOne, Lanes::kFour, CacheLines::k64,
                             CacheLines::k64, CacheLines::k16, 100, 4, 1, 0, true, 128, 2},
                      Builds{Lanes::kTwo, Lanes::kTwo, Lanes::kOne, CacheLines::k64,
                             CacheLines::k64, CacheLines::k32, 20, 30, 1, 0, true, 256, 128},
                      Builds{Lanes::kOne, Lanes::kFour, Lanes::kTwo, CacheLines::k128,
                             CacheLines::k256, CacheLines::k64, 100, 6, 5, 1, false}));

class EdgeOrder : public ::testing::TestWithParam<char> {};
TEST_P(EdgeOrder, DoesNotMatter) {
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    const std::string got = in_child([&] {
      const Configuration c = configuration(GetParam());
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
// max; outermost; all rules.
INSTANTIATE_TEST_SUITE_P(Page, EdgeOrder, ::testing::Values('c', 'i', 'l', 'm'));

// Of a frame of any size and whatever lines, in place and from a copy, rows or tiles: one picture.
Scene random_scene(std::uint64_t seed) {
  Random random(seed, "scene");
  Scene scene;
  scene.width = random.between(1, 90);
  scene.height = random.between(1, 70);
  for (int i = 0; i < scene.width * scene.height; ++i) {
    const std::uint32_t v = random.word();
    scene.colours.push_back({static_cast<std::uint8_t>(v), static_cast<std::uint8_t>(v >> 8),
                             static_cast<std::uint8_t>(v >> 16),
                             static_cast<std::uint8_t>(v >> 24)});
    scene.depths.push_back(random.chance(500) ? 0 : random.word() >> 8);
  }
  const int vertices = random.between(2, 150), faces = random.between(1, 1200),
            edges = random.between(1, 250), spread = 256 << random.between(2, 8);
  const int x = random.between(0, 256 * scene.width), y = random.between(0, 256 * scene.height);
  for (int i = 0; i < vertices; ++i)
    scene.vertices.push_back({x + random.between(-spread, spread),
                              y + random.between(-spread, spread), random.word() >> 8,
                              !random.chance(20)});
  for (int i = 0; i < faces; ++i) scene.facing.push_back(random.chance(600));
  const auto below = [&](int bound) { return random.below(static_cast<std::uint32_t>(bound)); };
  for (int i = 0; i < edges; ++i)
    scene.edges.push_back({below(vertices), below(vertices), below(faces + 2), below(faces),
                           static_cast<std::uint8_t>(below(16))});
  return scene;
}
class RandomFrames : public ::testing::TestWithParam<int> {};
TEST_P(RandomFrames, InPlaceAndCopiedRowsAndTilesAreTheSame) {
  for (int i = 0; i < 6; ++i) {
    const auto seed = static_cast<std::uint64_t>(100 * GetParam() + i);
    const Scene scene = random_scene(seed);
    std::string first;
    for (int variant = 0; variant < 6; ++variant) {
      const std::string got = in_child([&] {
        Parameters p;
        p.combine = static_cast<spec::geometric::Combine>(GetParam() % 3);
        p.coverage = static_cast<spec::geometric::CoverageRule>(seed >> 1 & 1);
        p.cull = static_cast<spec::geometric::Cull>(seed & 1);
        p.crease_depth = static_cast<std::int32_t>(seed % 4) * 3;
        p.mark = GetParam() % 3 == 0;
        p.layout = static_cast<spec::geometric::Layout>(variant & 1);
        p.frame_copy = (variant & 2) != 0;
        p.walkers = p.resolve_lanes = static_cast<Lanes>(variant % 3);
        p.colour_lines = std::array{0, 2, 64, 0, 256, 7}[static_cast<std::size_t>(variant)];
        p.write_buffer = std::array{0, 0, 3, 128, 1, 9}[static_cast<std::size_t>(variant)];
        if (variant >= 3) p.weight_blocks = p.depth_lines = p.vertex_lines = CacheLines::k16;
        EngineOptions options;
        options.scatter = variant == 4 ? 50 : 0;
        options.bench.poison = variant == 5;
        EngineBench b(p, options);
        b.load(scene);
        b.run();
        return std::to_string(b.pixel_hash()) + " " + std::to_string(b.weight_hash()) + " " +
               std::to_string(b.engine.work().blended_pixels) + " " +
               std::to_string(b.engine.work().passed);
      });
      if (first.empty()) first = got;
      EXPECT_EQ(got, first) << "seed " << seed << ", variant " << variant;
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomFrames, ::testing::Range(0, 10));

}  // namespace
}  // namespace deburr::tb::geometric_rtl::stress_test
