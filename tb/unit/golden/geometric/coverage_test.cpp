// SPDX-License-Identifier: MIT
// Functional coverage of the golden model: every bin can be reached and counts its event.
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
using spec::geometric::EdgeClass;
using spec::geometric::Layout;
using spec::geometric::Parameters;
using spec::geometric::Region;
using spec::geometric::Select;
using tb::geometric::Drawing;

using Hits = std::map<std::string, std::uint64_t>;
// The bins that were hit, of one group or of all.
Hits hits_of(const EdgeCoverage& coverage, const std::string& group = "") {
  Hits hits;
  for (const CoverageBin& bin : coverage.bins())
    if (bin.hits != 0 && bin.name.starts_with(group)) hits[bin.name] = bin.hits;
  return hits;
}

// Random edges of many lengths. Vertices are often at pixel centres, some edges are horizontal or
// vertical.
Drawing random_drawing(std::uint64_t seed) {
  tb::Random random(seed);
  Drawing d(70, 50);
  for (auto& pixel : d.colours) pixel = {static_cast<std::uint8_t>(random.below(256)), 0, 0, 255};
  constexpr std::uint32_t kDepths[] = {0, 4000000, 4001000, 8000000};
  for (auto& depth : d.depths) depth = kDepths[random.below(4)];
  if (seed % 2 != 0) {  // whole tiles at one depth, for the coarse test
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
    const std::uint32_t range = std::uint32_t{8} << random.below(12);
    // Some lines have a constant depth: nearer than 4000000, or farther by exactly what the depth
    // test allows.
    const bool level = random.chance(300);
    const std::uint32_t depth = random.chance(500) ? 4100000 : 4000000 - 4000000 / 512;
    const auto depth_of_end = [&] { return level ? depth : random.below(1u << 24); };
    const spec::geometric::Vertex p{coordinate(70), coordinate(50), depth_of_end(),
                                    !random.chance(10)};
    const auto near = [&](int v) {
      return v + random.between(-static_cast<int>(range), static_cast<int>(range));
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

// A block at the start of a memory line that blends with pixels to the left, above and below, so it
// reads the largest number of lines.
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
        if (seed % 6 == 1) input.boundary_count = 100;  // about half of the boundaries
        golden.process(input);
        sum.merge(golden.coverage());
      }
    }
  }
  // A few blocks are evicted from the cache and stay in the write buffer.
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

TEST(Coverage, BinsAgreeWithWorkCounters) {
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
  // An edge looks up the lines of its two vertices, which may be the same line. A line that misses
  // is read.
  const auto drawing = tb::geometric::vector_drawing();
  std::uint64_t vertex_lines = 0, in_one_line = 0, turned_away = 0;
  for (std::size_t i = 0; i < drawing.edges.size(); ++i) {
    const auto& edge = drawing.edges[i];
    const auto c = golden.classes()[i];
    if (c == EdgeClass::kCrease || c == EdgeClass::kFlat)  // both faces have the same facing
      turned_away += (drawing.facing[edge.f0 / 8] >> (edge.f0 % 8) & 1) == 0 ? 1 : 0;
    if (!golden::geometric::is_kept(c)) continue;
    const bool one =
        edge.v0 / spec::geometric::kVerticesInLine == edge.v1 / spec::geometric::kVerticesInLine;
    in_one_line += one ? 1 : 0;
    vertex_lines += one ? 1 : 2;
  }
  EXPECT_GT(in_one_line, 0u);
  EXPECT_EQ(sum("turned-away"), turned_away);
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

// Bins of the options that reduce traffic, against the lists of traffic.
TEST(Coverage, BinsAgreeWithReducedTraffic) {
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
  EXPECT_EQ(hits.at("fetch/depth/miss"),
            traffic.read(Region::kDepth).size());  // all fit
  EXPECT_EQ(hits.at("fetch/colour/miss"), 20u);
  EXPECT_EQ(hits.at("fetch/colour/miss") + hits.at("fetch/colour/replaced"),
            traffic.read(Region::kColour).size());
  std::uint64_t lines = 0;  // looked up for blocks
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

// One pixel in the last column of a tile; its neighbour is in the next tile.
TEST(Coverage, CoarseBinsSeparateTheLimitAndTheTiles) {
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
    return hits_of(golden.coverage(), "coarse/");
  };
  // The limit is 25600 - 25600 / 512.
  EXPECT_EQ(hits(25549, 25600, 25600), (Hits{{"coarse/right/dropped", 1}}));
  EXPECT_EQ(hits(25550, 25600, 25600), (Hits{{"coarse/equal", 1}}));
  EXPECT_EQ(hits(25551, 25600, 25600), Hits{});
  EXPECT_EQ(hits(0, 0, 0), Hits{});
  EXPECT_EQ(hits(25551, 25600, 25856), (Hits{{"coarse/lesser/own", 1}}));
  EXPECT_EQ(hits(25551, 25856, 25600), (Hits{{"coarse/lesser/other", 1}}));
  EXPECT_EQ(hits(25551, 25601, 25855), Hits{});  // both have the coarse entry 100
}

// ---- each bin by itself -------------------------------------------------------------------------

// A bin that is missing from the list would not show up as an unhit bin. There are 7 classes: `all`
// can give three, `edges` five without creases and six with either crease rule, `mesh` three
// without creases and four with them.
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

// The names of the bins that a call hits, in alphabetical order; each must be hit once.
template <class Count>
std::string bins_hit_by(Count&& count) {
  EdgeCoverage coverage;
  count(coverage);
  std::string names;
  for (const auto& [name, hits] : hits_of(coverage)) {
    EXPECT_EQ(hits, 1u) << name;
    names += (names.empty() ? "" : " ") + name;
  }
  return names;
}

// Lines in a frame of 20 x 10 pixels, on both sides of the limits between bins: one pixel, four
// pixels, the diagonal.
TEST(Coverage, LinesCountOctantLengthAndClipping) {
  constexpr int kRight = 20 * 256, kBottom = 10 * 256;
  struct Row {
    int x0, y0, x1, y1;
    const char* bins;
  };
  const auto octant = [](int dx, int dy, const char* bins) {
    return Row{1000, 1000, 1000 + dx, 1000 + dy, bins};
  };
  for (const Row& row : {
           octant(300, 299, "columns/none line/right-down/below-four rows/inside"),
           octant(300, 0, "columns/none line/right-down/below-four rows/inside"),
           octant(300, -1, "columns/none line/right-up/below-four rows/inside"),
           octant(-300, 299, "columns/none line/left-down/below-four rows/inside"),
           octant(-300, 0, "columns/none line/left-down/below-four rows/inside"),
           octant(-300, -299, "columns/none line/left-up/below-four rows/inside"),
           octant(300, 300, "columns/none line/down-right/below-four rows/inside"),
           octant(0, 300, "columns/none line/down-right/below-four rows/inside"),
           octant(-300, 300, "columns/none line/down-left/below-four rows/inside"),
           octant(300, -300, "columns/none line/up-right/below-four rows/inside"),
           octant(0, -300, "columns/none line/up-right/below-four rows/inside"),
           octant(-1, -300, "columns/none line/up-left/below-four rows/inside"),
           octant(255, 0, "columns/none line/right-down/below-pixel rows/inside"),
           octant(256, 0, "columns/none line/right-down/below-four rows/inside"),
           octant(1023, 0, "columns/none line/right-down/below-four rows/inside"),
           octant(1024, 0, "columns/none line/right-down/longer rows/inside"),
           // The frame clips columns whose centre is outside: the one with centre -1/2, and the
           // first one after the last column.
           {-127, 300, kRight + 128, 300, "columns/none line/right-down/longer rows/inside"},
           {-128, 300, kRight + 128, 300, "columns/start line/right-down/longer rows/inside"},
           {-127, 300, kRight + 129, 300, "columns/end line/right-down/longer rows/inside"},
           {kRight + 129, 300, -128, 300, "columns/both line/left-down/longer rows/inside"},
           {300, -127, 300, kBottom + 128, "columns/none line/down-right/longer rows/inside"},
           {300, kBottom + 129, 300, -127, "columns/end line/up-right/longer rows/inside"},
           // Rows are counted across the line.
           {128, 0, 5000, kBottom - 1, "columns/none line/right-down/longer rows/inside"},
           {128, -1, 5000, 0, "columns/none line/right-down/longer rows/enters-before"},
           {5000, 0, 128, -1, "columns/none line/left-up/longer rows/enters-before"},
           {128, 0, 5000, -1, "columns/none line/right-up/longer rows/leaves-before"},
           {128, kBottom, 5000, 0, "columns/none line/right-up/longer rows/enters-after"},
           {5000, kBottom, 128, 0, "columns/none line/left-up/longer rows/leaves-after"},
       }) {
    EXPECT_EQ(bins_hit_by([&](EdgeCoverage& c) {
                c.count_line({row.x0, row.y0, 0, true}, {row.x1, row.y1, 0, true}, 20, 10);
              }),
              row.bins)
        << row.x0 << ' ' << row.y0 << " to " << row.x1 << ' ' << row.y1;
  }
}

TEST(Coverage, EachEventHasItsBin) {
  using golden::geometric::Buffered;
  using golden::geometric::CacheKind;
  using golden::geometric::Fetch;
  using golden::geometric::GroupEnd;
  using golden::geometric::LineFate;
  using golden::geometric::Original;
  using golden::geometric::PairFetch;
  using golden::geometric::TwoTiles;
  using spec::geometric::Axis;
  using spec::geometric::Cull;
  using spec::geometric::LineRecord;
  struct Row {
    const char* bin;
    void (*count)(EdgeCoverage&);
  };
  using C = EdgeCoverage;
  for (const Row& row : {
           Row{"", [](C& c) { c.count_fate(LineFate::kLine); }},
           Row{"fate/outside", [](C& c) { c.count_fate(LineFate::kOutside); }},
           Row{"fate/degenerate", [](C& c) { c.count_fate(LineFate::kDegenerate); }},
           Row{"fate/empty-columns", [](C& c) { c.count_fate(LineFate::kEmptyColumns); }},
           Row{"fate/empty-before", [](C& c) { c.count_fate(LineFate::kEmptyBefore); }},
           Row{"fate/empty-after", [](C& c) { c.count_fate(LineFate::kEmptyAfter); }},
           Row{"group/length", [](C& c) { c.count_group(GroupEnd::kLength); }},
           Row{"group/across", [](C& c) { c.count_group(GroupEnd::kAcross); }},
           Row{"group/along", [](C& c) { c.count_group(GroupEnd::kAlong); }},
           Row{"group/line", [](C& c) { c.count_group(GroupEnd::kLine); }},
           Row{"original/none", [](C& c) { c.count_original(Original::kNone); }},
           Row{"original/above", [](C& c) { c.count_original(Original::kAbove); }},
           Row{"original/left", [](C& c) { c.count_original(Original::kLeft); }},
           Row{"coarse/equal", [](C& c) { c.count_coarse_equal(); }},
           Row{"coarse/lesser/own", [](C& c) { c.count_two_tiles(TwoTiles::kOwnLess); }},
           Row{"coarse/lesser/other", [](C& c) { c.count_two_tiles(TwoTiles::kOtherLess); }},
           Row{"depth/own/behind", [](C& c) { c.count_depth(1, 2, false); }},
           Row{"depth/own/passed", [](C& c) { c.count_depth(1, 2, true); }},
           Row{"depth/other/behind", [](C& c) { c.count_depth(2, 1, false); }},
           Row{"depth/other/passed", [](C& c) { c.count_depth(2, 1, true); }},
           Row{"depth/equal/behind", [](C& c) { c.count_depth(2, 2, false); }},
           Row{"depth/equal/passed", [](C& c) { c.count_depth(2, 2, true); }},
           Row{"depth/background/passed", [](C& c) { c.count_depth(0, 2, true); }},
           Row{"depth/background/passed", [](C& c) { c.count_depth(2, 0, true); }},
           Row{"turned-away/back/back",
               [](C& c) { c.count_turned_away(Cull::kBack, EdgeClass::kBack); }},
           Row{"turned-away/none/crease",
               [](C& c) { c.count_turned_away(Cull::kNone, EdgeClass::kCrease); }},
           Row{"turned-away/none/flat",
               [](C& c) { c.count_turned_away(Cull::kNone, EdgeClass::kFlat); }},
           // Compares the sums of weights of the two axes.
           Row{"resolve/up-down",
               [](C& c) {
                 c.count_probe({10, 20, 15, 14});
               }},
           Row{"resolve/tie",
               [](C& c) {
                 c.count_probe({10, 20, 15, 15});
               }},
           Row{"resolve/left-right",
               [](C& c) {
                 c.count_probe({10, 20, 15, 16});
               }},
           Row{"resolve/up-down",
               [](C& c) {
                 c.count_probe({0, 1, 0, 0});
               }},
           Row{"resolve/left-right",
               [](C& c) {
                 c.count_probe({0, 0, 1, 0});
               }},
       })
    EXPECT_EQ(bins_hit_by(row.count), row.bin);
  for (const int slope : {-1, 0, 1}) {
    LineRecord line;
    line.slope = slope;
    const auto tie = [&](EdgeCoverage& c) { c.count_tie(line); };
    line.axis = Axis::kHorizontal;
    EXPECT_EQ(bins_hit_by(tie), slope < 0    ? "tie/horizontal-rising"
                                : slope == 0 ? "tie/horizontal-level"
                                             : "tie/horizontal-falling");
    line.axis = Axis::kVertical;
    EXPECT_EQ(bins_hit_by(tie), "tie/vertical");
  }
  const std::array<std::string, 4> caches = {"vertex", "depth", "block", "colour"};
  const std::array<std::string, 4> fetches = {"hit", "miss", "replaced", "read-back"};
  for (std::size_t cache = 0; cache < caches.size(); ++cache) {
    for (std::size_t fetch = 0; fetch < fetches.size(); ++fetch) {
      if (fetches[fetch] == "read-back" && caches[cache] != "block") continue;
      EXPECT_EQ(bins_hit_by([&](EdgeCoverage& c) {
                  c.count_fetch(static_cast<CacheKind>(cache), static_cast<Fetch>(fetch));
                }),
                "fetch/" + caches[cache] + '/' + fetches[fetch]);
    }
  }
  const std::array<std::string, 6> pairs = {"boundary-pair/hit",   "boundary-pair/miss",
                                            "other-pair/hit",      "other-pair/miss",
                                            "pair-number/invalid", "pair-vertex/invalid"};
  for (std::size_t i = 0; i < pairs.size(); ++i)
    EXPECT_EQ(bins_hit_by([&](EdgeCoverage& c) { c.count_pair(static_cast<PairFetch>(i)); }),
              "fetch/" + pairs[i]);
  const std::array<std::string, 5> buffered = {"hit", "empty", "leaves", "full-at-end",
                                               "not-full-at-end"};
  for (std::size_t i = 0; i < buffered.size(); ++i)
    EXPECT_EQ(bins_hit_by([&](EdgeCoverage& c) { c.count_buffered(static_cast<Buffered>(i)); }),
              "fetch/write-buffer/" + buffered[i]);
  for (std::size_t lines = 1; lines <= 10; ++lines) {
    for (const Layout layout : {Layout::kRaster, Layout::kTiled}) {
      if (layout == Layout::kTiled && lines > 5) continue;
      EXPECT_EQ(
          bins_hit_by([&](EdgeCoverage& c) { c.count_block_lines(layout, lines); }),
          (layout == Layout::kRaster ? "lines/raster/" : "lines/tiled/") + std::to_string(lines));
    }
  }
}

// The weight of a direction is 10, 20, 30 or 40; another line adds its own.
TEST(Coverage, EachEventOfADirectionHasItsBin) {
  using spec::geometric::Direction;
  using spec::geometric::Weights;
  const std::array<std::string, 4> names = {"top", "bottom", "left", "right"};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto to = static_cast<Direction>(i);
    const auto expect = [&](const std::string& group, const std::string& what, auto&& count) {
      EXPECT_EQ(bins_hit_by(count), group + '/' + names[i] + what);
    };
    expect("coarse", "/dropped", [&](EdgeCoverage& c) { c.count_dropped(to); });
    expect("border", "", [&](EdgeCoverage& c) { c.count_outside(to); });
    for (const bool yes : {false, true}) {
      expect("second", yes ? "/other" : "/same", [&](EdgeCoverage& c) { c.count_second(to, yes); });
      expect("crease", yes ? "/near" : "/far", [&](EdgeCoverage& c) { c.count_crease(to, yes); });
    }
    const Weights before = {10, 20, 30, 40};
    const auto weight = [&](Combine rule, bool nearer, int more, const char* what) {
      expect("weight", what,
             [&](EdgeCoverage& c) { c.count_weight(rule, nearer, before, to, before[i] + more); });
    };
    for (const bool nearer : {false, true}) {
      weight(Combine::kMax, nearer, 1, "/raised");
      weight(Combine::kMax, nearer, -1, "/kept");
      weight(Combine::kMax, nearer, 0, "/equal");
      // With `outermost` the larger weight wins if the pixel is not nearer, or if its weight is
      // still 0.
      weight(Combine::kOutermost, nearer, 1, nearer ? "/held" : "/raised");
      weight(Combine::kOutermost, nearer, -1, nearer ? "/lowered" : "/kept");
      weight(Combine::kOutermost, nearer, 0, "/equal");
    }
    expect("weight", "/raised",
           [&](EdgeCoverage& c) { c.count_weight(Combine::kOutermost, true, {}, to, 1); });
    // With `last` a line overwrites all four weights, so a weight of any direction counts.
    Weights one = {};
    one[(i + 1) % 4] = 1;
    expect("weight", "/overwritten",
           [&](EdgeCoverage& c) { c.count_weight(Combine::kLast, false, one, to, 5); });
    EXPECT_EQ(
        bins_hit_by([&](EdgeCoverage& c) { c.count_weight(Combine::kLast, false, {}, to, 5); }),
        "");
  }
}

TEST(Coverage, LineThroughAPixelCentreIsATie) {
  const auto ties = [](std::int32_t y) {
    Drawing d(16, 16);
    d.vertices = {{0, y, 0xFFFFFF, true}, {16 * 256, y, 0xFFFFFF, true}};
    d.set_facing(0, true);
    d.edges = {{0, 1, 0, 0, spec::geometric::flag::kBoundary}};
    const Parameters p;
    GeometricGolden golden(p);
    golden.process(d.input());
    EXPECT_EQ(golden.candidates().size(), 16u);
    return hits_of(golden.coverage(), "tie/");
  };
  EXPECT_EQ(ties(8 * 256 + 128), (Hits{{"tie/horizontal-level", 16}}));
  EXPECT_TRUE(ties(8 * 256 + 129).empty());
}

TEST(Coverage, MergeAddsBinByBin) {
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
