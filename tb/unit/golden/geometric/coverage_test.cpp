// SPDX-License-Identifier: MIT
// Can every bin of the functional coverage be reached, and does a bin count what it says?
#include <gmock/gmock.h>

#include <map>
#include <string>

#include "tb/stimuli/random.h"
#include "tb/unit/golden/geometric/support.h"

namespace deburr {
namespace {

using golden::geometric::CoverageBin;
using golden::geometric::EdgeCoverage;
using golden::geometric::GeometricGolden;
using spec::geometric::CacheLines;
using spec::geometric::Combine;
using spec::geometric::Crease;
using spec::geometric::Layout;
using spec::geometric::Parameters;
using spec::geometric::Select;
using tb::geometric::Drawing;

// Random edges of all lengths; coordinates often on centres and borders.
Drawing random_drawing(std::uint64_t seed) {
  tb::Random random(seed);
  Drawing d(70, 50);
  for (auto& pixel : d.colours) pixel = {static_cast<std::uint8_t>(random.below(256)), 0, 0, 255};
  constexpr std::uint32_t kDepths[] = {0, 4000000, 4001000, 8000000};
  for (auto& depth : d.depths) depth = kDepths[random.below(4)];
  for (std::uint32_t face = 0; face < 40; ++face) d.set_facing(face, random.chance(500));
  const auto coordinate = [&](int size) {
    const int v = random.between(-4 * 256, (size + 4) * 256);
    return random.chance(300) ? (v & ~255) + 128 : v;
  };
  for (int i = 0; i < 400; ++i) {
    const std::uint32_t reach = std::uint32_t{8} << random.below(12);
    const spec::geometric::Vertex p{coordinate(70), coordinate(50), random.below(1u << 24),
                                    !random.chance(10)};
    const auto near = [&](int v) {
      return v + random.between(-static_cast<int>(reach), static_cast<int>(reach));
    };
    spec::geometric::Vertex q{near(p.x), near(p.y), random.below(1u << 24), true};
    if (random.chance(50)) q.y = p.y;
    if (random.chance(50)) q.x = p.x;
    const auto v = static_cast<std::uint32_t>(d.vertices.size());
    d.vertices.push_back(p);
    d.vertices.push_back(q);
    d.edges.push_back({v, v + (random.chance(5) ? 1000000 : 1), random.below(40), random.below(40),
                       static_cast<std::uint8_t>(random.below(16))});
  }
  return d;
}

// A block at the start of a line of memory that is blended to the left, above and below.
Drawing most_lines() {
  Drawing d(70, 50);
  d.vertices = {{16 * 256 + 64, 2048, 1, true},      {16 * 256 + 64, 3072, 1, true},
                {17 * 256, 8 * 256 + 64, 1, true},   {20 * 256, 8 * 256 + 64, 1, true},
                {17 * 256, 11 * 256 + 192, 1, true}, {20 * 256, 11 * 256 + 192, 1, true}};
  d.set_facing(0, true);
  for (const std::uint32_t v : {0u, 2u, 4u})
    d.edges.push_back({v, v + 1, 0, 0, spec::geometric::flag::kBoundary});
  return d;
}

TEST(Coverage, EveryBinCanBeReached) {
  EdgeCoverage sum;
  Parameters raster;
  raster.layout = Layout::kRaster;
  GeometricGolden dense(raster);
  dense.process(most_lines().input());
  sum.merge(dense.coverage());
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    for (const Select select : {Select::kAll, Select::kEdges}) {
      for (const Crease crease : {Crease::kOff, Crease::kPaper, Crease::kShading}) {
        Parameters p;
        p.select = select;
        p.crease = crease;
        p.layout = seed % 2 == 0 ? Layout::kRaster : Layout::kTiled;
        p.combine = seed % 3 == 0 ? Combine::kLast : Combine::kMax;
        p.depth_lines = p.weight_blocks = p.vertex_lines = CacheLines::k16;
        GeometricGolden golden(p);
        golden.process(random_drawing(seed).input());
        sum.merge(golden.coverage());
      }
    }
  }
  std::string holes;
  for (const CoverageBin& bin : sum.bins())
    if (bin.hits == 0) holes += bin.name + '\n';
  EXPECT_EQ(holes, "");
  EXPECT_GT(sum.bins().size(), 90u);
}

TEST(Coverage, BinsCountWhatTheWorkCounts) {
  GeometricGolden golden(Parameters{});
  golden.process(tb::geometric::vector_drawing().input());
  std::map<std::string, std::uint64_t> hits;
  for (const CoverageBin& bin : golden.coverage().bins()) {
    EXPECT_EQ(hits.count(bin.name), 0u) << bin.name;
    hits[bin.name] = bin.hits;
  }
  const auto sum = [&](const std::string& group) {
    std::uint64_t total = 0;
    for (const auto& [name, count] : hits)
      if (name.rfind(group + '/', 0) == 0) total += count;
    return total;
  };
  const auto& work = golden.work();
  EXPECT_EQ(sum("class"), work.edges);
  EXPECT_EQ(hits.at("class/edges/shading/silhouette"), work.silhouette_edges);
  EXPECT_EQ(hits.at("class/edges/shading/crease"), work.crease_edges);
  EXPECT_EQ(sum("line"), work.lines);
  EXPECT_EQ(sum("columns"), work.lines);
  EXPECT_EQ(hits.at("fate/outside"), work.outside_edges);
  EXPECT_EQ(hits.at("fate/degenerate"), work.degenerate_edges);
  EXPECT_EQ(sum("fate"), work.outside_edges + work.degenerate_edges + work.empty_edges);
  EXPECT_EQ(sum("group"), work.groups);
  EXPECT_EQ(sum("depth"), work.candidates);
  EXPECT_EQ(sum("weight"), work.passed);
  EXPECT_EQ(sum("resolve"), work.blended_pixels);
  EXPECT_EQ(sum("lines"), work.blocks);
  EXPECT_EQ(
      hits.at("fetch/block/hit") + hits.at("fetch/block/miss") + hits.at("fetch/block/read-back"),
      work.passed);
  golden.clear_coverage();
  for (const CoverageBin& bin : golden.coverage().bins()) EXPECT_EQ(bin.hits, 0u);
}

}  // namespace
}  // namespace deburr
