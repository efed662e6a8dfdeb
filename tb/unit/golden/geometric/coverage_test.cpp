// SPDX-License-Identifier: MIT
// Can every bin of the functional coverage be reached, and does a bin count what it says?
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "tb/base/random.h"
#include "tb/unit/golden/geometric/support.h"

namespace deburr::coverage_test {
namespace {

using golden::geometric::CoverageBin;
using golden::geometric::EdgeCoverage;
using golden::geometric::GeometricGolden;
using spec::geometric::CacheLines;
using spec::geometric::CoarseLines;
using spec::geometric::Combine;
using spec::geometric::Crease;
using spec::geometric::Layout;
using spec::geometric::Parameters;
using spec::geometric::Region;
using spec::geometric::Select;
using tb::geometric::Drawing;

// Random edges of all lengths; coordinates often on centres and borders.
Drawing random_drawing(std::uint64_t seed) {
  tb::Random random(seed);
  Drawing d(70, 50);
  for (auto& pixel : d.colours) pixel = {static_cast<std::uint8_t>(random.below(256)), 0, 0, 255};
  constexpr std::uint32_t kDepths[] = {0, 4000000, 4001000, 8000000};
  for (auto& depth : d.depths) depth = kDepths[random.below(4)];
  if (seed % 2 != 0) {  // tiles that hide what lies behind them
    for (std::size_t ty = 0; ty < 7; ++ty)
      for (std::size_t tx = 0; tx < 9; ++tx) {
        const std::uint32_t depth = kDepths[random.below(4)];
        for (std::size_t y = 8 * ty; y < std::min<std::size_t>(8 * ty + 8, 50); ++y)
          for (std::size_t x = 8 * tx; x < std::min<std::size_t>(8 * tx + 8, 70); ++x)
            d.depths[70 * y + x] = depth;
      }
  }
  for (std::uint32_t face = 0; face < 40; ++face) d.set_facing(face, random.chance(500));
  const auto coordinate = [&](int size) {
    const int v = random.between(-4 * 256, (size + 4) * 256);
    return random.chance(300) ? (v & ~255) + 128 : v;
  };
  for (int i = 0; i < 400; ++i) {
    const std::uint32_t reach = std::uint32_t{8} << random.below(12);
    // Some at the depth of what is drawn, or as far behind 4000000 as may be.
    const bool level = random.chance(300);
    const std::uint32_t depth = random.chance(500) ? 4100000 : 4000000 - 4000000 / 512;
    const auto depth_of_end = [&] { return level ? depth : random.below(1u << 24); };
    const spec::geometric::Vertex p{coordinate(70), coordinate(50), depth_of_end(),
                                    !random.chance(10)};
    const auto near = [&](int v) {
      return v + random.between(-static_cast<int>(reach), static_cast<int>(reach));
    };
    spec::geometric::Vertex q{near(p.x), near(p.y), depth_of_end(), true};
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
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    for (const Select select : {Select::kAll, Select::kEdges, Select::kMesh}) {
      for (const Crease crease : {Crease::kOff, Crease::kPaper, Crease::kShading}) {
        Parameters p;
        p.select = select;
        p.crease = crease;
        p.layout = seed % 2 == 0 ? Layout::kRaster : Layout::kTiled;
        constexpr std::array kCombines = {Combine::kLast, Combine::kMax, Combine::kOutermost};
        p.combine = kCombines[seed % 3];
        p.coverage = seed % 4 < 2 ? spec::geometric::CoverageRule::kDistance
                                  : spec::geometric::CoverageRule::kArea;
        p.cull = seed % 5 < 2 ? spec::geometric::Cull::kNone : spec::geometric::Cull::kBack;
        p.crease_depth = seed % 2 == 0 ? 0 : 4;
        p.depth_lines = p.weight_blocks = p.vertex_lines = CacheLines::k16;
        if (seed % 3 != 0) {
          p.records = spec::geometric::RecordsLayout::kSplit;
          p.colour_lines = seed % 3 == 1 ? 8 : 128;
          p.write_buffer = seed % 3 == 1 ? 8 : 128;
          p.coarse_lines = CoarseLines::k4;
        }
        GeometricGolden golden(p);
        const Drawing d = random_drawing(seed);
        golden::geometric::FrameInput input = d.input();
        if (seed % 6 == 1) input.boundary_count = 100;  // about a half
        golden.process(input);
        sum.merge(golden.coverage());
      }
    }
  }
  // A few blocks leave the cache, and stay in the buffer.
  Parameters few;
  few.weight_blocks = CacheLines::k16;
  few.write_buffer = 128;
  GeometricGolden sparse(few);
  Drawing row = most_lines();
  row.vertices[3].x = 70 * 256;
  sparse.process(row.input());
  sum.merge(sparse.coverage());
  std::string holes;
  for (const CoverageBin& bin : sum.bins())
    if (bin.hits == 0) holes += bin.name + '\n';
  EXPECT_EQ(holes, "");
  EXPECT_GT(sum.bins().size(), 170u);
}

// A test of depth looks up the line of the neighbour only if it is another one than the pixel's.
TEST(Coverage, TwoDepthsOfOneLineAreOneLookUp) {
  const auto lookups_of_eight = [](std::int32_t y) {
    Parameters p;
    p.layout = Layout::kTiled;
    p.coverage = spec::geometric::CoverageRule::kDistance;
    Drawing d(70, 50);
    d.vertices = {{16 * 256, y, 1, true}, {24 * 256, y, 1, true}};
    d.set_facing(0, true);
    d.edges.push_back({0, 1, 0, 0, spec::geometric::flag::kBoundary});
    GeometricGolden golden(p);
    golden.process(d.input());
    EXPECT_EQ(golden.candidates().size(), 8u);
    std::uint64_t lookups = 0;
    for (const CoverageBin& bin : golden.coverage().bins())
      if (bin.name.rfind("fetch/depth/", 0) == 0 && bin.name != "fetch/depth/replaced")
        lookups += bin.hits;
    return lookups;
  };
  EXPECT_EQ(lookups_of_eight(9 * 256 + 64), 8u);   // rows 9 and 8, both of a line
  EXPECT_EQ(lookups_of_eight(8 * 256 + 64), 16u);  // rows 8 and 7
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
  EXPECT_EQ(sum("depth") + sum("second"), work.candidates);
  EXPECT_EQ(sum("weight"), work.passed);
  EXPECT_EQ(sum("resolve"), work.blended_pixels);
  EXPECT_EQ(sum("lines"), work.blocks);
  EXPECT_EQ(
      hits.at("fetch/block/hit") + hits.at("fetch/block/miss") + hits.at("fetch/block/read-back"),
      work.passed);
  // An edge looks up the lines of its vertices, which may be one; what is not found is read.
  const auto drawing = tb::geometric::vector_drawing();
  std::uint64_t vertex_lines = 0, in_one_line = 0;
  for (std::size_t i = 0; i < drawing.edges.size(); ++i) {
    if (!golden::geometric::is_kept(golden.classes()[i])) continue;
    const auto& edge = drawing.edges[i];
    const bool one =
        edge.v0 / spec::geometric::kVerticesInLine == edge.v1 / spec::geometric::kVerticesInLine;
    in_one_line += one ? 1 : 0;
    vertex_lines += one ? 1 : 2;
  }
  EXPECT_GT(in_one_line, 0u);
  EXPECT_EQ(sum("fetch/vertex"), vertex_lines);
  for (const auto& [cache, region] :
       {std::pair{"vertex", Region::kVertices}, {"depth", Region::kDepth}}) {
    const std::string name = std::string("fetch/") + cache;
    EXPECT_EQ(hits.at(name + "/miss") + hits.at(name + "/replaced"),
              golden.traffic().read(region).size());
  }
  golden.clear_coverage();
  for (const CoverageBin& bin : golden.coverage().bins()) EXPECT_EQ(bin.hits, 0u);
}

template <class... Names>
std::map<std::string, std::uint64_t> once(Names... names) {
  return {{names, 1}...};
}

// What the choices that leave traffic out count, over their lists.
TEST(Coverage, BinsCountWhatIsLeftOut) {
  Parameters p;
  p.weight_blocks = CacheLines::k16;
  p.depth_lines = CacheLines::k1024;
  p.records = spec::geometric::RecordsLayout::kSplit;
  p.colour_lines = 20;
  p.write_buffer = 20;
  p.coarse_lines = CoarseLines::k4;
  GeometricGolden golden(p);
  const Drawing d = tb::geometric::vector_drawing();
  golden.process(d.input());
  std::map<std::string, std::uint64_t> hits;
  for (const CoverageBin& bin : golden.coverage().bins()) hits[bin.name] = bin.hits;
  const auto& traffic = golden.traffic();
  const auto& work = golden.work();
  EXPECT_EQ(hits.at("fetch/colour/miss"), 20u);
  EXPECT_EQ(hits.at("fetch/colour/miss") + hits.at("fetch/colour/replaced"),
            traffic.read(Region::kColour).size());
  std::uint64_t lines = 0;  // that blocks read
  for (std::uint64_t n = 1; n <= 5; ++n) lines += n * hits.at("lines/tiled/" + std::to_string(n));
  EXPECT_EQ(hits.at("fetch/colour/hit") + traffic.read(Region::kColour).size(), lines);
  EXPECT_EQ(hits.at("fetch/boundary-pair/miss") + hits.at("fetch/other-pair/miss"),
            traffic.read(Region::kPairs).size());
  EXPECT_EQ(hits.at("fetch/boundary-pair/hit") + hits.at("fetch/boundary-pair/miss"),
            work.boundary_edges);
  EXPECT_EQ(hits.at("fetch/other-pair/hit") + hits.at("fetch/other-pair/miss"),
            work.silhouette_edges + work.crease_edges);
  EXPECT_EQ(hits.at("fetch/pair-vertex/invalid"),
            work.boundary_edges + work.silhouette_edges + work.crease_edges - work.kept_edges);
  EXPECT_EQ(hits.at("fetch/pair-number/invalid"), 0u);
  EXPECT_EQ(hits.at("fetch/write-buffer/empty"), 20u);
  EXPECT_EQ(hits.at("fetch/write-buffer/leaves") + 20, traffic.write(Region::kWeights).size());
  EXPECT_EQ(hits.at("fetch/write-buffer/full-at-end"), 1u);
  EXPECT_EQ(hits.at("fetch/write-buffer/not-full-at-end"), 0u);
  EXPECT_GT(hits.at("fetch/write-buffer/hit"), 0u);
  EXPECT_EQ(hits.at("fetch/block/hit") + hits.at("fetch/block/miss") +
                hits.at("fetch/block/read-back") + hits.at("fetch/write-buffer/hit"),
            work.passed);
  EXPECT_EQ(hits.at("fetch/block/replaced"), hits.at("fetch/write-buffer/hit") +
                                                 hits.at("fetch/write-buffer/leaves") +
                                                 hits.at("fetch/write-buffer/empty"));
}

// One pixel in the last column of a tile, whose neighbour is in the next one.
TEST(Coverage, CoarseBinsAreOfTheLimitAndTheTiles) {
  const auto hits = [](std::uint32_t depth, std::uint32_t own, std::uint32_t other) {
    Drawing d(16, 1);
    d.vertices = {{7 * 256 + 192, -64, depth, true}, {7 * 256 + 192, 320, depth, true}};
    d.set_facing(0, true);
    d.edges = {{0, 1, 0, 0, spec::geometric::flag::kBoundary}};
    for (std::size_t x = 0; x < 16; ++x) d.depths[x] = x < 8 ? own : other;
    Parameters p;
    p.coarse_lines = CoarseLines::k4;
    GeometricGolden golden(p);
    golden.process(d.input());
    std::map<std::string, std::uint64_t> result;
    for (const CoverageBin& bin : golden.coverage().bins())
      if (bin.hits != 0 && bin.name.starts_with("coarse/")) result[bin.name] = bin.hits;
    return result;
  };
  // 25600 less its 512th.
  EXPECT_EQ(hits(25549, 25600, 25600), once("coarse/right/dropped"));
  EXPECT_EQ(hits(25550, 25600, 25600), once("coarse/equal"));
  EXPECT_TRUE(hits(25551, 25600, 25600).empty());
  EXPECT_TRUE(hits(0, 0, 0).empty());
  EXPECT_EQ(hits(25551, 25600, 25856), once("coarse/lesser/own"));
  EXPECT_EQ(hits(25551, 25856, 25600), once("coarse/lesser/other"));
  // Both in the same 256.
  EXPECT_TRUE(hits(25551, 25601, 25855).empty());
}

// ---- what each bin counts, one thing at a time --------------------------------------------------

std::map<std::string, std::uint64_t> hits_of(const EdgeCoverage& coverage) {
  std::map<std::string, std::uint64_t> hits;
  for (const CoverageBin& bin : coverage.bins())
    if (bin.hits != 0) hits[bin.name] = bin.hits;
  return hits;
}

// Holes in the list of bins itself would not show as bins that nobody hits. Of 7 classes, `all` can
// give three, `edges` five without creases and six with either rule, `mesh` three and four.
TEST(Coverage, ListsEveryBinOfEveryGroup) {
  std::map<std::string, std::size_t> sizes;
  for (const CoverageBin& bin : EdgeCoverage().bins())
    ++sizes[bin.name.substr(0, bin.name.find('/'))];
  EXPECT_EQ(sizes, (std::map<std::string, std::size_t>{{"class", 3 * 3 + 5 + 2 * 6 + 3 + 2 * 4},
                                                       {"line", 8 * 3},
                                                       {"fate", 5},
                                                       {"columns", 4},
                                                       {"rows", 5},
                                                       {"tie", 4},
                                                       {"border", 4},
                                                       {"turned-away", 3},
                                                       {"depth", 3 * 2 + 1},
                                                       {"crease", 4 * 2},
                                                       {"second", 4 * 2},
                                                       {"weight", 4 * 6},
                                                       {"group", 4},
                                                       {"fetch", 4 * 3 + 1 + 6 + 5},
                                                       {"coarse", 4 + 1 + 2},
                                                       {"resolve", 3},
                                                       {"original", 3},
                                                       {"lines", 10 + 5}}));
}

// In a frame of 20 x 10.
std::map<std::string, std::uint64_t> line_hits(int x0, int y0, int x1, int y1) {
  EdgeCoverage coverage;
  coverage.count_line({x0, y0, 0, true}, {x1, y1, 0, true}, 20, 10);
  return hits_of(coverage);
}

TEST(Coverage, LinesHaveTheOctantOfTheirDirection) {
  const auto octant = [](int dx, int dy) { return line_hits(1000, 1000, 1000 + dx, 1000 + dy); };
  const auto is = [](const std::string& name) {
    return once("line/" + name + "/below-four", std::string("columns/none"),
                std::string("rows/inside"));
  };
  EXPECT_EQ(octant(300, 299), is("right-down"));
  EXPECT_EQ(octant(300, 0), is("right-down"));
  EXPECT_EQ(octant(300, -1), is("right-up"));
  EXPECT_EQ(octant(300, -299), is("right-up"));
  EXPECT_EQ(octant(-300, 299), is("left-down"));
  EXPECT_EQ(octant(-300, 0), is("left-down"));
  EXPECT_EQ(octant(-300, -1), is("left-up"));
  // A diagonal goes along the rows.
  EXPECT_EQ(octant(300, 300), is("down-right"));
  EXPECT_EQ(octant(0, 300), is("down-right"));
  EXPECT_EQ(octant(-1, 300), is("down-left"));
  EXPECT_EQ(octant(-300, 300), is("down-left"));
  EXPECT_EQ(octant(300, -300), is("up-right"));
  EXPECT_EQ(octant(0, -300), is("up-right"));
  EXPECT_EQ(octant(-1, -300), is("up-left"));
}

TEST(Coverage, LinesEndBelowAPixelAndBelowFour) {
  const auto length = [](int dx) { return line_hits(100, 1000, 100 + dx, 1000); };
  const auto is = [](const std::string& name) {
    return once("line/right-down/" + name, std::string("columns/none"), std::string("rows/inside"));
  };
  EXPECT_EQ(length(1), is("below-pixel"));
  EXPECT_EQ(length(255), is("below-pixel"));
  EXPECT_EQ(length(256), is("below-four"));
  EXPECT_EQ(length(1023), is("below-four"));
  EXPECT_EQ(length(1024), is("longer"));
}

// The frame cuts off the columns whose centres it does not have: that at -1/2 and that half a pixel
// behind the last one's end.
TEST(Coverage, ColumnsAreCutAtTheCentresBesideTheFrame) {
  const auto cut = [](int from, int to, bool horizontal) {
    const auto hits = horizontal ? line_hits(from, 300, to, 300) : line_hits(300, from, 300, to);
    EXPECT_EQ(hits.size(), 3u);
    return hits.begin()->first;  // "columns/" is the first of them
  };
  for (const bool horizontal : {true, false}) {
    const int end = horizontal ? 20 * 256 : 10 * 256;
    EXPECT_EQ(cut(-127, end + 128, horizontal), "columns/none");
    EXPECT_EQ(cut(-128, end + 128, horizontal), "columns/start");
    EXPECT_EQ(cut(-127, end + 129, horizontal), "columns/end");
    EXPECT_EQ(cut(-128, end + 129, horizontal), "columns/both");
    EXPECT_EQ(cut(end + 128, -128, horizontal), "columns/start");
    EXPECT_EQ(cut(end + 129, -127, horizontal), "columns/end");
  }
}

TEST(Coverage, RowsAreEnteredAndLeftAtTheFramesBorders) {
  const auto rows = [](int from, int to, bool swapped) {
    auto hits = swapped ? line_hits(5000, to, 128, from) : line_hits(128, from, 5000, to);
    EXPECT_EQ(std::erase_if(hits, [](const auto& bin) { return bin.first[0] != 'r'; }), 2u);
    return hits;
  };
  constexpr int kEnd = 10 * 256;
  for (const bool swapped : {false, true}) {
    EXPECT_EQ(rows(0, kEnd - 1, swapped), once("rows/inside"));
    EXPECT_EQ(rows(kEnd - 1, 0, swapped), once("rows/inside"));
    EXPECT_EQ(rows(-1, 0, swapped), once("rows/enters-before"));
    EXPECT_EQ(rows(0, -1, swapped), once("rows/leaves-before"));
    EXPECT_EQ(rows(kEnd, 0, swapped), once("rows/enters-after"));
    EXPECT_EQ(rows(0, kEnd, swapped), once("rows/leaves-after"));
    EXPECT_EQ(rows(-1, kEnd, swapped), once("rows/enters-before", "rows/leaves-after"));
  }
}

TEST(Coverage, TiesAreOfTheAxisAndTheSlope) {
  const auto tie = [](spec::geometric::Axis axis, int slope) {
    EdgeCoverage coverage;
    spec::geometric::LineRecord line;
    line.axis = axis;
    line.slope = slope;
    coverage.count_tie(line);
    return hits_of(coverage);
  };
  using spec::geometric::Axis;
  EXPECT_EQ(tie(Axis::kHorizontal, -1), once("tie/horizontal-rising"));
  EXPECT_EQ(tie(Axis::kHorizontal, 0), once("tie/horizontal-level"));
  EXPECT_EQ(tie(Axis::kHorizontal, 1), once("tie/horizontal-falling"));
  for (const int slope : {-1, 0, 1}) EXPECT_EQ(tie(Axis::kVertical, slope), once("tie/vertical"));
}

TEST(Coverage, AColumnIsATieWhereItsLineMeetsAPixelsCentre) {
  const auto ties = [](std::int32_t y) {
    Drawing d(16, 16);
    d.vertices = {{0, y, 0xFFFFFF, true}, {16 * 256, y, 0xFFFFFF, true}};
    d.set_facing(0, true);
    d.edges = {{0, 1, 0, 0, spec::geometric::flag::kBoundary}};
    const Parameters p;
    GeometricGolden golden(p);
    golden.process(d.input());
    EXPECT_EQ(golden.candidates().size(), 16u);
    auto hits = hits_of(golden.coverage());
    std::erase_if(hits, [](const auto& bin) { return !bin.first.starts_with("tie/"); });
    return hits;
  };
  EXPECT_EQ(ties(8 * 256 + 128),
            (std::map<std::string, std::uint64_t>{{"tie/horizontal-level", 16}}));
  EXPECT_TRUE(ties(8 * 256 + 129).empty());
}

TEST(Coverage, DepthIsThatOfTheFartherPixel) {
  const auto depth = [](std::uint32_t own, std::uint32_t other, bool passed) {
    EdgeCoverage coverage;
    coverage.count_depth(own, other, passed);
    return hits_of(coverage);
  };
  EXPECT_EQ(depth(1, 2, false), once("depth/own/behind"));
  EXPECT_EQ(depth(1, 2, true), once("depth/own/passed"));
  EXPECT_EQ(depth(2, 1, false), once("depth/other/behind"));
  EXPECT_EQ(depth(2, 1, true), once("depth/other/passed"));
  EXPECT_EQ(depth(2, 2, false), once("depth/equal/behind"));
  EXPECT_EQ(depth(2, 2, true), once("depth/equal/passed"));
  EXPECT_EQ(depth(0, 2, true), once("depth/background/passed"));
  EXPECT_EQ(depth(2, 0, true), once("depth/background/passed"));
  EXPECT_EQ(depth(0, 0, true), once("depth/background/passed"));
}

TEST(Coverage, EdgesTurnedAwayAreDroppedOrClassified) {
  using spec::geometric::Cull;
  using spec::geometric::EdgeClass;
  const auto turned = [](Cull cull, EdgeClass c) {
    EdgeCoverage coverage;
    coverage.count_turned_away(cull, c);
    return hits_of(coverage);
  };
  EXPECT_EQ(turned(Cull::kBack, EdgeClass::kBack), once("turned-away/back/back"));
  EXPECT_EQ(turned(Cull::kNone, EdgeClass::kCrease), once("turned-away/none/crease"));
  EXPECT_EQ(turned(Cull::kNone, EdgeClass::kFlat), once("turned-away/none/flat"));
}

TEST(Coverage, SecondPixelsAndCreasesAreOfADirection) {
  const std::array<std::string, 4> names = {"top", "bottom", "left", "right"};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto direction = static_cast<spec::geometric::Direction>(i);
    for (const bool yes : {false, true}) {
      EdgeCoverage second, crease;
      second.count_second(direction, yes);
      crease.count_crease(direction, yes);
      EXPECT_EQ(hits_of(second), once("second/" + names[i] + (yes ? "/other" : "/same")));
      EXPECT_EQ(hits_of(crease), once("crease/" + names[i] + (yes ? "/near" : "/far")));
    }
  }
}

TEST(Coverage, WeightsAreRaisedKeptOverwrittenOrLowered) {
  using spec::geometric::Direction;
  using spec::geometric::Weights;
  const auto weight = [](Combine rule, const Weights& before, Direction to, int coverage,
                         bool nearer = false) {
    EdgeCoverage result;
    result.count_weight(rule, nearer, before, to, coverage);
    return hits_of(result);
  };
  const Weights before = {10, 20, 30, 40};
  const std::array<std::string, 4> names = {"top", "bottom", "left", "right"};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto to = static_cast<Direction>(i);
    const std::string name = "weight/" + names[i];
    EXPECT_EQ(weight(Combine::kMax, before, to, before[i] + 1), once(name + "/raised"));
    EXPECT_EQ(weight(Combine::kMax, before, to, before[i] - 1), once(name + "/kept"));
    EXPECT_EQ(weight(Combine::kMax, before, to, before[i]), once(name + "/equal"));
    // The last line overwrites all four, so that any of them counts.
    Weights one = {};
    one[(i + 1) % 4] = 1;
    EXPECT_EQ(weight(Combine::kLast, one, to, 5), once(name + "/overwritten"));
    EXPECT_TRUE(weight(Combine::kLast, {}, to, 5).empty());
    // The outermost one is the largest where the pixel is not nearer, or there is none yet.
    EXPECT_EQ(weight(Combine::kOutermost, before, to, before[i] + 1), once(name + "/raised"));
    EXPECT_EQ(weight(Combine::kOutermost, before, to, before[i] - 1), once(name + "/kept"));
    EXPECT_EQ(weight(Combine::kOutermost, {}, to, 1, true), once(name + "/raised"));
    EXPECT_EQ(weight(Combine::kOutermost, before, to, before[i] + 1, true), once(name + "/held"));
    EXPECT_EQ(weight(Combine::kOutermost, before, to, before[i] - 1, true),
              once(name + "/lowered"));
    EXPECT_EQ(weight(Combine::kOutermost, before, to, before[i], true), once(name + "/equal"));
    EXPECT_EQ(weight(Combine::kMax, before, to, before[i] - 1, true), once(name + "/kept"));
  }
}

TEST(Coverage, TapsAreOfTheHeavierAxis) {
  const auto probe = [](const spec::geometric::Weights& weights) {
    EdgeCoverage coverage;
    coverage.count_probe(weights);
    return hits_of(coverage);
  };
  for (const bool swapped : {false, true}) {
    const auto w = [&](int a, int b, int c, int d) {
      const auto byte = [](int value) { return static_cast<std::uint8_t>(value); };
      return swapped ? spec::geometric::Weights{byte(b), byte(a), byte(d), byte(c)}
                     : spec::geometric::Weights{byte(a), byte(b), byte(c), byte(d)};
    };
    EXPECT_EQ(probe(w(10, 20, 15, 14)), once("resolve/up-down"));
    EXPECT_EQ(probe(w(10, 20, 15, 15)), once("resolve/tie"));
    EXPECT_EQ(probe(w(10, 20, 15, 16)), once("resolve/left-right"));
    EXPECT_EQ(probe(w(1, 0, 0, 0)), once("resolve/up-down"));
    EXPECT_EQ(probe(w(0, 0, 1, 0)), once("resolve/left-right"));
  }
}

// Each counter by itself: the bin's name, and no other bin.
TEST(Coverage, EnumerationsHaveABinEach) {
  using golden::geometric::Buffered;
  using golden::geometric::CacheKind;
  using golden::geometric::Fetch;
  using golden::geometric::GroupEnd;
  using golden::geometric::LineFate;
  using golden::geometric::Original;
  using golden::geometric::PairFetch;
  using golden::geometric::TwoTiles;
  const auto after = [](auto&& count) {
    EdgeCoverage coverage;
    count(coverage);
    return hits_of(coverage);
  };
  const auto fate = [&](LineFate f) { return after([&](EdgeCoverage& c) { c.count_fate(f); }); };
  EXPECT_TRUE(fate(LineFate::kLine).empty());
  EXPECT_EQ(fate(LineFate::kOutside), once("fate/outside"));
  EXPECT_EQ(fate(LineFate::kDegenerate), once("fate/degenerate"));
  EXPECT_EQ(fate(LineFate::kEmptyColumns), once("fate/empty-columns"));
  EXPECT_EQ(fate(LineFate::kEmptyBefore), once("fate/empty-before"));
  EXPECT_EQ(fate(LineFate::kEmptyAfter), once("fate/empty-after"));
  const auto group = [&](GroupEnd end) {
    return after([&](EdgeCoverage& c) { c.count_group(end); });
  };
  EXPECT_EQ(group(GroupEnd::kLength), once("group/length"));
  EXPECT_EQ(group(GroupEnd::kAcross), once("group/across"));
  EXPECT_EQ(group(GroupEnd::kAlong), once("group/along"));
  EXPECT_EQ(group(GroupEnd::kLine), once("group/line"));
  const auto original = [&](Original where) {
    return after([&](EdgeCoverage& c) { c.count_original(where); });
  };
  EXPECT_EQ(original(Original::kNone), once("original/none"));
  EXPECT_EQ(original(Original::kAbove), once("original/above"));
  EXPECT_EQ(original(Original::kLeft), once("original/left"));
  const std::array<std::string, 4> caches = {"vertex", "depth", "block", "colour"};
  const std::array<std::string, 4> fetches = {"hit", "miss", "replaced", "read-back"};
  for (std::size_t cache = 0; cache < caches.size(); ++cache) {
    for (std::size_t fetch = 0; fetch < fetches.size(); ++fetch) {
      if (fetches[fetch] == "read-back" && caches[cache] != "block") continue;
      EXPECT_EQ(after([&](EdgeCoverage& c) {
                  c.count_fetch(static_cast<CacheKind>(cache), static_cast<Fetch>(fetch));
                }),
                once("fetch/" + caches[cache] + '/' + fetches[fetch]));
    }
  }
  const std::array<std::string, 6> pairs = {"boundary-pair/hit",   "boundary-pair/miss",
                                            "other-pair/hit",      "other-pair/miss",
                                            "pair-number/invalid", "pair-vertex/invalid"};
  for (std::size_t i = 0; i < pairs.size(); ++i)
    EXPECT_EQ(after([&](EdgeCoverage& c) { c.count_pair(static_cast<PairFetch>(i)); }),
              once("fetch/" + pairs[i]));
  const std::array<std::string, 5> buffered = {"hit", "empty", "leaves", "full-at-end",
                                               "not-full-at-end"};
  for (std::size_t i = 0; i < buffered.size(); ++i)
    EXPECT_EQ(after([&](EdgeCoverage& c) { c.count_buffered(static_cast<Buffered>(i)); }),
              once("fetch/write-buffer/" + buffered[i]));
  const std::array<std::string, 4> borders = {"top", "bottom", "left", "right"};
  for (std::size_t i = 0; i < borders.size(); ++i) {
    const auto direction = static_cast<spec::geometric::Direction>(i);
    EXPECT_EQ(after([&](EdgeCoverage& c) { c.count_dropped(direction); }),
              once("coarse/" + borders[i] + "/dropped"));
    EXPECT_EQ(after([&](EdgeCoverage& c) { c.count_outside(direction); }),
              once("border/" + borders[i]));
  }
  EXPECT_EQ(after([](EdgeCoverage& c) { c.count_coarse_equal(); }), once("coarse/equal"));
  EXPECT_EQ(after([](EdgeCoverage& c) { c.count_two_tiles(TwoTiles::kOwnLess); }),
            once("coarse/lesser/own"));
  EXPECT_EQ(after([](EdgeCoverage& c) { c.count_two_tiles(TwoTiles::kOtherLess); }),
            once("coarse/lesser/other"));
  for (std::size_t lines = 1; lines <= 10; ++lines) {
    const std::string n = std::to_string(lines);
    const auto block = [&](Layout layout) {
      return after([&](EdgeCoverage& c) { c.count_block_lines(layout, lines); });
    };
    EXPECT_EQ(block(Layout::kRaster), once("lines/raster/" + n));
    if (lines <= 5) {
      EXPECT_EQ(block(Layout::kTiled), once("lines/tiled/" + n));
    }
  }
}

// What one engine counted is added to what another did, bin by bin.
TEST(Coverage, MergesAreSums) {
  GeometricGolden a(Parameters{}), b(Parameters{});
  a.process(tb::geometric::vector_drawing().input());
  b.process(random_drawing(1).input());
  EdgeCoverage sum = a.coverage();
  sum.merge(b.coverage());
  const auto bins = sum.bins(), first = a.coverage().bins(), second = b.coverage().bins();
  std::size_t both = 0;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    EXPECT_EQ(bins[i].hits, first[i].hits + second[i].hits) << bins[i].name;
    both += first[i].hits != 0 && second[i].hits != 0;
  }
  EXPECT_GT(both, 40u);
}

}  // namespace
}  // namespace deburr::coverage_test
