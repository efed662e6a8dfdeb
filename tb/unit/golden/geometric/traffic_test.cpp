// SPDX-License-Identifier: MIT
// The options that reduce traffic omit the accesses that docs/reference/geometric/memory.md says,
// keep the order of the others, and do not change the picture. Lists and counts are worked out by
// hand.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "golden/geometric/coarse.h"
#include "golden/geometric/pairs.h"
#include "spec/error.h"
#include "tb/base/random.h"
#include "tb/unit/golden/geometric/support.h"

namespace deburr::traffic_test {
namespace {

using golden::geometric::CoarseLayout;
using golden::geometric::FrameInput;
using golden::geometric::GeometricGolden;
using golden::geometric::KeptLines;
using golden::geometric::WriteBuffer;
using spec::geometric::CacheLines;
using spec::geometric::CoarseLines;
using spec::geometric::Combine;
using spec::geometric::DepthTest;
using spec::geometric::Edge;
using spec::geometric::EdgeClass;
using spec::geometric::Layout;
using spec::geometric::Parameters;
using spec::geometric::RecordsLayout;
using spec::geometric::Region;
using spec::geometric::Rgba8;
using spec::geometric::Select;
using spec::geometric::Weights;
using tb::geometric::Drawing;
using tb::geometric::kVectorBases;
using testing::ElementsAre;
using testing::IsEmpty;
namespace flag = spec::geometric::flag;

// Adds a boundary edge; with the default depth it is visible everywhere.
void add_line(Drawing& d, int x0, int y0, int x1, int y1, std::uint32_t depth = 0xFFFFFF) {
  const auto v = static_cast<std::uint32_t>(d.vertices.size());
  d.vertices.push_back({x0, y0, depth, true});
  d.vertices.push_back({x1, y1, depth, true});
  d.set_facing(0, true);
  d.edges.push_back({v, v + 1, 0, 0, flag::kBoundary});
}

// Addresses of lines, from the base of their region and their numbers.
std::vector<std::uint32_t> lines(std::uint32_t base, std::vector<std::uint32_t> numbers) {
  for (std::uint32_t& number : numbers) number = base + 64 * number;
  return numbers;
}

GeometricGolden golden_of(const Parameters& p, const Drawing& d) {
  GeometricGolden golden(p);
  golden.process(d.input(kVectorBases));
  return golden;
}

// ---- kept colours -------------------------------------------------------------------------------

TEST(KeptLines, ReplaceTheLineReadFirst) {
  KeptLines kept;
  kept.reset(10, 2);
  EXPECT_FALSE(kept.look_up(5));
  EXPECT_FALSE(kept.is_full());
  EXPECT_FALSE(kept.look_up(7));
  EXPECT_TRUE(kept.is_full());
  EXPECT_TRUE(kept.look_up(5));
  EXPECT_TRUE(kept.look_up(7));
  EXPECT_TRUE(kept.look_up(5));
  // 5 was used last but read first, so it is replaced.
  EXPECT_FALSE(kept.look_up(9));
  EXPECT_TRUE(kept.look_up(7));
  EXPECT_FALSE(kept.look_up(5));
  EXPECT_FALSE(kept.look_up(7));
  EXPECT_FALSE(kept.look_up(9));
  EXPECT_TRUE(kept.look_up(7));
  kept.reset(10, 1);
  EXPECT_FALSE(kept.is_full());
  EXPECT_FALSE(kept.look_up(0));
  EXPECT_TRUE(kept.look_up(0));
  EXPECT_FALSE(kept.look_up(1));
  EXPECT_FALSE(kept.look_up(0));
}

// A line that blends row 7 with row 8 in a frame of 64 x 16 pixels. Each of the sixteen blocks
// reads one line of each row, and four consecutive blocks read the same two lines.
Drawing row_of_blocks() {
  Drawing d(64, 16);
  std::fill(d.colours.begin(), d.colours.end(), Rgba8{200, 100, 50, 255});
  add_line(d, 0, 8 * 256 - 64, 64 * 256, 8 * 256 - 64);
  return d;
}
// Lines 28..31 hold row 7, lines 32..35 row 8.
const std::vector<std::uint32_t> kOnceEach = {28, 32, 29, 33, 30, 34, 31, 35};

Parameters raster(int colour_lines) {
  Parameters p;
  p.layout = Layout::kRaster;
  p.colour_lines = colour_lines;
  p.linear_light = false;
  return p;
}

TEST(KeptColours, KeptLinesAreNotReadAgain) {
  const Drawing d = row_of_blocks();
  std::vector<std::uint32_t> all;
  for (std::uint32_t block = 0; block < 16; ++block)
    for (const std::uint32_t row : {28u, 32u}) all.push_back(row + block / 4);
  const std::uint32_t base = kVectorBases.colour;
  for (const auto& [kept, expected] :
       {std::pair{0, all}, {1, all}, {2, kOnceEach}, {3, kOnceEach}, {256, kOnceEach}}) {
    GeometricGolden golden(raster(kept));
    for (const int frame : {0, 1}) {  // no line is kept from frame to frame
      golden.process(d.input(kVectorBases));
      EXPECT_EQ(golden.traffic().read(Region::kColour), lines(base, expected)) << kept << frame;
    }
    EXPECT_EQ(golden.traffic().write(Region::kColour).size(), 16u);
  }
}

TEST(KeptColours, FrameCopyKeepsLinesOfTheCopy) {
  Parameters p = raster(2);
  p.frame_copy = true;
  const GeometricGolden golden = golden_of(p, row_of_blocks());
  EXPECT_EQ(golden.traffic().read(Region::kCopy), lines(kVectorBases.copy, kOnceEach));
  std::vector<std::uint32_t> all(64);
  std::iota(all.begin(), all.end(), 0u);
  EXPECT_EQ(golden.traffic().read(Region::kColour), lines(kVectorBases.colour, all));
}

// An unreadable line is kept as zeros: one error affects four blocks.
TEST(KeptColours, UnreadableLinesAreKeptAsZeros) {
  const Drawing d = row_of_blocks();
  for (const int kept : {0, 2}) {
    GeometricGolden golden(raster(kept));
    golden.set_memory_errors([](std::uint32_t a) { return a == kVectorBases.colour + 64 * 32; });
    golden.process(d.input(kVectorBases));
    EXPECT_EQ(golden.memory_errors(), kept == 0 ? 4u : 1u);
    for (std::size_t x = 0; x < 64; ++x) {
      // A quarter of 0 and three quarters of 200.
      EXPECT_EQ(golden.pixels()[7 * 64 + x][0], x < 16 ? 150 : 200) << x;
    }
  }
}

// ---- write buffer -------------------------------------------------------------------------------

TEST(WriteBuffer, PushReturnsTheOldestEntry) {
  WriteBuffer ring;
  ring.reset(2);
  EXPECT_EQ(ring.push(10), WriteBuffer::kNothing);
  EXPECT_THAT(ring.remaining(), ElementsAre(10));
  EXPECT_EQ(ring.push(11), WriteBuffer::kNothing);
  EXPECT_EQ(ring.push(12), 10u);
  EXPECT_THAT(ring.remaining(), ElementsAre(11, 12));
  EXPECT_FALSE(ring.exchange(10, 13));
  // A hit replaces the value and keeps the order.
  EXPECT_TRUE(ring.exchange(12, 13));
  EXPECT_THAT(ring.remaining(), ElementsAre(11, 13));
  EXPECT_EQ(ring.push(14), 11u);
  EXPECT_EQ(ring.push(15), 13u);
  EXPECT_THAT(ring.remaining(), ElementsAre(14, 15));
  // Empty entries are skipped, and the used entries after them are still returned.
  ring.reset(3);
  ring.push(1);
  ring.push(2);
  EXPECT_TRUE(ring.exchange(1, 5));
  EXPECT_THAT(ring.remaining(), ElementsAre(5, 2));
  ring.reset(0);
  EXPECT_TRUE(ring.empty());
  EXPECT_FALSE(ring.exchange(1, 2));
  EXPECT_EQ(ring.push(3), 3u);
  EXPECT_THAT(ring.remaining(), IsEmpty());
}

// Two lines over the same row of sixteen blocks, first with weights of 96, then of 64. The cache
// holds four blocks of a row, so block x replaces block x - 4, or block x + 12 at the start of the
// second line.
Drawing twice_over_a_row() {
  Drawing d(64, 16);
  add_line(d, 0, 8 * 256 - 96, 64 * 256, 8 * 256 - 96);
  add_line(d, 0, 8 * 256 - 64, 64 * 256, 8 * 256 - 64);
  return d;
}

Parameters small_cache(int write_buffer) {
  Parameters p;
  p.weight_blocks = CacheLines::k16;
  p.write_buffer = write_buffer;
  p.combine = Combine::kMax;
  return p;
}

// A block that hits in the write buffer is not read from memory, so a memory error does not affect
// it. Block 15 is in the cache at the end.
TEST(WriteBuffer, HitsAreUnaffectedByMemoryErrors) {
  for (const int places : {0, 12}) {
    GeometricGolden golden(small_cache(places));
    golden.set_memory_errors(
        [](std::uint32_t a) { return a == kVectorBases.weights + 64 * (16 + 15); });
    golden.process(twice_over_a_row().input(kVectorBases));
    const auto weights = [&](std::size_t x) { return golden.weights()[7 * 64 + x]; };
    EXPECT_EQ(weights(59), (Weights{0, 96, 0, 0}));
    EXPECT_EQ(weights(60), (Weights{0, static_cast<std::uint8_t>(places == 0 ? 64 : 96), 0, 0}));
    EXPECT_EQ(golden.memory_errors(), places == 0 ? 2u : 0u);  // written and read back
  }
}

// ---- edge records in two arrays -----------------------------------------------------------------

Parameters split(Select select = Select::kEdges) {
  Parameters p;
  p.records = RecordsLayout::kSplit;
  p.select = select;
  return p;
}

// 25 edges. Every third one from 0 on is a boundary, nine in all, so their pairs take one line and
// the pairs of the others start at byte 64. The sixteen others are flat. Each edge has its own
// vertices.
Drawing mixed_edges() {
  Drawing d(64, 64);
  d.set_facing(0, true);
  for (std::uint32_t i = 0; i < 25; ++i) {
    const auto offset = static_cast<std::int32_t>(256 * i);
    d.vertices.push_back({offset, 300, 0xFFFFFF, true});
    d.vertices.push_back({offset + 100, 9000, 0xFFFFFF, true});
    d.edges.push_back({2 * i, 2 * i + 1, 0, 0, i % 3 == 0 ? flag::kBoundary : std::uint8_t{0}});
  }
  return d;
}
constexpr std::uint32_t kPairs = kVectorBases.pairs;

TEST(SplitRecords, LinesHoldTenRecords) {
  for (const std::size_t edges : {1u, 10u, 11u, 20u, 21u, 25u}) {
    Drawing d = mixed_edges();
    d.edges.resize(edges);
    const GeometricGolden golden = golden_of(split(), d);
    const std::vector<std::uint32_t> expected = lines(kVectorBases.edges, {0, 1, 2});
    EXPECT_EQ(golden.traffic().read(Region::kEdges),
              (std::vector(expected.begin(), expected.begin() + (edges <= 10   ? 1
                                                                 : edges <= 20 ? 2
                                                                               : 3))));
  }
  Drawing none = mixed_edges();
  none.edges.clear();
  EXPECT_THAT(golden_of(split(), none).traffic().read(Region::kEdges), IsEmpty());
  EXPECT_THAT(golden_of(split(), none).traffic().read(Region::kPairs), IsEmpty());
  EXPECT_THAT(golden_of(Parameters{}, mixed_edges()).traffic().read(Region::kPairs), IsEmpty());
}

TEST(SplitRecords, OtherPairsFollowBoundariesUnlessBaseIsSet) {
  Drawing d = mixed_edges();
  d.edges[1].flags = flag::kSeam;
  FrameInput input = d.input(kVectorBases);
  GeometricGolden golden(split());
  input.bases.other_pairs = 0xABC0;
  golden.process(input);
  EXPECT_THAT(golden.traffic().read(Region::kPairs), ElementsAre(kPairs, 0xABC0));
  input.bases.other_pairs = 0xABC8;
  EXPECT_THROW(golden.process(input), spec::CheckFailed);
  input.bases.other_pairs = {};
  input.bases.pairs = 32;
  EXPECT_THROW(golden.process(input), spec::CheckFailed);
}

// BOUNDARY_COUNT need not match the flags, which give nine boundaries and sixteen others.
TEST(SplitRecords, RecordsBeyondTheCountsAreInvalid) {
  Drawing d = mixed_edges();
  for (Edge& edge : d.edges)
    if (edge.flags == 0) edge.flags = flag::kSeam;
  FrameInput input = d.input(kVectorBases);
  GeometricGolden golden(split());
  const auto invalid = [&](std::uint32_t boundaries) {
    input.boundary_count = boundaries;
    golden.process(input);
    EXPECT_EQ(golden.work().boundary_edges, 9u);
    EXPECT_EQ(golden.work().crease_edges, 16u);
    EXPECT_EQ(golden.work().kept_edges + golden.work().invalid_edges, 25u);
    std::vector<std::size_t> edges;
    for (std::size_t i = 0; i < 25; ++i)
      if (golden.classes()[i] == EdgeClass::kInvalid) edges.push_back(i);
    EXPECT_EQ(golden.work().invalid_edges, edges.size());
    return edges;
  };
  const auto pairs = [&] { return golden.traffic().read(Region::kPairs); };
  EXPECT_THAT(invalid(9), IsEmpty());
  EXPECT_EQ(pairs(), lines(kPairs, {0, 1, 2}));
  EXPECT_THAT(invalid(8), ElementsAre(24));  // boundary number 8
  EXPECT_THAT(invalid(7), ElementsAre(21, 24));
  EXPECT_THAT(invalid(10), ElementsAre(23));  // other number 15 of 15
  EXPECT_EQ(pairs(), lines(kPairs, {0, 1, 2}));
  EXPECT_THAT(invalid(15), ElementsAre(16, 17, 19, 20, 22, 23));  // from number 10 on
  EXPECT_EQ(pairs(), lines(kPairs, {0, 2}));                      // others start at line 2
  // An edge without a valid number reads no pair.
  EXPECT_THAT(invalid(0), ElementsAre(0, 3, 6, 9, 12, 15, 18, 21, 24));
  EXPECT_EQ(pairs(), lines(kPairs, {0, 1}));
  EXPECT_EQ(invalid(25).size(), 16u);
  EXPECT_EQ(pairs(), lines(kPairs, {0}));
  input.boundary_count = 26;
  EXPECT_THROW(golden.process(input), spec::ConfigError);
  GeometricGolden joined(Parameters{});
  EXPECT_NO_THROW(joined.process(input));
}

// The line of the first ten edges is unreadable. They count as others, of faces 0, and shift the
// numbers of all edges that follow: boundaries 12, 15, 18, 21 and 24 have the numbers 0..4, others
// continue with 10, and 19, 20, 22 and 23 have invalid numbers from 16 on.
TEST(SplitRecords, UnreadableEdgeLineShiftsTheNumbers) {
  const Drawing d = mixed_edges();
  const std::array<std::uint32_t, 9> boundaries = {0, 3, 6, 9, 12, 15, 18, 21, 24};
  const std::array<std::uint32_t, 16> others = {1,  2,  4,  5,  7,  8,  10, 11,
                                                13, 14, 16, 17, 19, 20, 22, 23};
  // The equivalent joined table, without the edges whose numbers are invalid.
  Drawing same = d;
  same.edges.clear();
  std::uint32_t b = 0;
  for (std::uint32_t i = 0; i < 25; ++i) {
    const bool boundary = i >= 10 && i % 3 == 0;
    if (!boundary && i - b >= 16) continue;
    Edge edge = d.edges[boundary ? boundaries.at(b) : others.at(i - b)];
    edge.flags = boundary ? flag::kBoundary : std::uint8_t{0};
    same.edges.push_back(edge);
    b += boundary ? 1 : 0;
  }
  ASSERT_EQ(same.edges.size(), 21u);
  GeometricGolden golden(split(Select::kAll));
  golden.set_memory_errors([](std::uint32_t a) { return a == kVectorBases.edges; });
  golden.process(d.input(kVectorBases));
  EXPECT_EQ(golden.work().edges, 25u);
  EXPECT_EQ(golden.work().boundary_edges, 5u);
  EXPECT_EQ(golden.work().invalid_edges, 4u);
  EXPECT_EQ(golden.work().kept_edges, 21u);
  EXPECT_EQ(golden.memory_errors(), 1u);
  Parameters joined;
  joined.select = Select::kAll;
  EXPECT_EQ(golden.lines(), golden_of(joined, same).lines());
  EXPECT_EQ(golden.traffic().read(Region::kPairs), lines(kPairs, {1, 2, 0}));
}

// An unreadable pair has vertex 0 at both ends.
TEST(SplitRecords, UnreadablePairsAreZeros) {
  Drawing d = mixed_edges();
  const std::array<std::uint64_t, 3> records = {9, 10, 6};
  for (const std::uint32_t line : {0u, 1u, 2u}) {
    GeometricGolden golden(split(Select::kAll));
    golden.set_memory_errors([=](std::uint32_t a) { return a == kPairs + 64 * line; });
    golden.process(d.input(kVectorBases));
    EXPECT_EQ(golden.memory_errors(), 1u);
    EXPECT_EQ(golden.work().degenerate_edges, records[line]);
    EXPECT_EQ(golden.work().lines, 25 - records[line]);
    EXPECT_EQ(golden.work().invalid_edges, 0u);
  }
  d.vertices.clear();  // vertex 0 does not exist either
  GeometricGolden golden(split(Select::kAll));
  golden.process(d.input(kVectorBases));
  EXPECT_EQ(golden.work().invalid_edges, 25u);
}

// ---- coarse depth test --------------------------------------------------------------------------

TEST(CoarseDepth, EveryTileHasItsOwnEntry) {
  struct Size {
    int width, height;
    std::size_t tiles;
  };
  for (const Size& size : {Size{1, 1, 1},
                           {64, 32, 32},
                           {65, 33, 45},
                           {61, 45, 48},
                           {70, 50, 63},
                           {1280, 720, 14400}}) {
    const CoarseLayout layout(size.width, size.height);
    EXPECT_EQ(layout.tiles(), size.tiles);
    const int across = (size.width + 63) / 64;
    std::size_t lines_seen = 0;
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const auto tile = CoarseLayout::tile_of(x, y);
        EXPECT_EQ(tile.x, static_cast<std::uint32_t>(x / 8));
        EXPECT_EQ(tile.y, static_cast<std::uint32_t>(y / 8));
        EXPECT_EQ(layout.index_of(tile),
                  static_cast<std::size_t>((size.width + 7) / 8 * (y / 8) + x / 8));
        const std::uint32_t offset = layout.offset_of(CoarseLayout::line_of(tile));
        ASSERT_EQ(offset, static_cast<std::uint32_t>(64 * (y / 32 * across + x / 64)));
        lines_seen = std::max<std::size_t>(lines_seen, offset / 64 + 1);
      }
    }
    EXPECT_EQ(lines_seen,
              static_cast<std::size_t>(across) * static_cast<std::size_t>((size.height + 31) / 32));
  }
}

TEST(CoarseDepth, EntriesAreTheMinimumOfTheirTiles) {
  Drawing d(17, 9);
  std::fill(d.depths.begin(), d.depths.end(), 0xFF000000u | (1000 * 256 + 255));
  const auto at = [](std::size_t x, std::size_t y) { return 17 * y + x; };
  d.depths[at(7, 0)] = 0xAB000000u | (999 * 256 + 255);  // the last column of a tile
  d.depths[at(8, 7)] = 255;                              // the first one, in the last row
  d.depths[at(16, 0)] = 0xFFFFFF;                        // the rest of its tile is 1000
  d.depths[at(0, 8)] = 512;                              // the first column of the frame
  d.depths[at(15, 8)] = 256;
  d.depths[at(16, 8)] = 0xFFFFFF;  // the only pixel of its tile
  EXPECT_THAT(golden::geometric::coarse_entries(golden::geometric::DepthView(d.depths, 17, 9)),
              ElementsAre(999, 0, 1000, 2, 1, 0xFFFF));
}

TEST(CoarseDepth, DropsCandidatesBehindByMoreThanTheBias) {
  Parameters p;
  const auto limit = [&](std::uint16_t entry) {
    std::uint32_t d = 0;
    while (golden::geometric::is_dropped(p, d, entry)) ++d;
    return d;
  };
  p.depth_bias = 9;
  EXPECT_EQ(limit(100), 25600u - 50u);
  EXPECT_EQ(limit(1), 256u);
  EXPECT_EQ(limit(2), 511u);
  EXPECT_EQ(limit(0), 0u);
  EXPECT_EQ(limit(0xFFFF), 0xFFFF00u - 0x7FFFu);
  p.depth_bias = 1;
  EXPECT_EQ(limit(100), 12800u);
  p.depth_bias = 24;
  EXPECT_EQ(limit(100), 25600u);
}

// A vertical line through column `x`; the neighbours are to its right.
Drawing column(int x, int width, int height, std::uint32_t depth) {
  Drawing d(width, height);
  add_line(d, 256 * x + 192, 0, 256 * x + 192, 256 * height, depth);
  return d;
}

Parameters coarse(DepthTest test = DepthTest::kFarther, CoarseLines lines = CoarseLines::k4) {
  Parameters p;
  p.coarse_lines = lines;
  p.depth_test = test;
  if (test != DepthTest::kFarther) p.combine = Combine::kMax;
  return p;
}

// Columns 63 and 64 of 128 x 96 pixels: the neighbour is in another tile and another line of
// entries. The line crosses three rows of lines of entries; in a cache of four lines the third row
// replaces the first.
TEST(CoarseDepth, OwnLineIsReadBeforeTheNeighbours) {
  Drawing d = column(63, 128, 96, 0xFFFFFF);
  d.edges.push_back(d.edges[0]);
  const auto reads = [](const Parameters& p, const Drawing& drawing) {
    return golden_of(p, drawing).traffic().read(Region::kCoarse);
  };
  const std::uint32_t base = kVectorBases.coarse;
  EXPECT_EQ(reads(coarse(), d), lines(base, {0, 1, 2, 3, 4, 5, 0, 1, 4, 5}));
  // A cache of eight lines is four across and two down, one of sixteen four across and four down.
  EXPECT_EQ(reads(coarse(DepthTest::kFarther, CoarseLines::k8), d),
            lines(base, {0, 1, 2, 3, 4, 5, 0, 1, 4, 5}));
  EXPECT_EQ(reads(coarse(DepthTest::kFarther, CoarseLines::k16), d),
            lines(base, {0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(reads(coarse(DepthTest::kOwn), d), lines(base, {0, 2, 4, 0, 4}));
  // The neighbour's tile is in the same line.
  EXPECT_EQ(reads(coarse(), column(55, 128, 96, 0xFFFFFF)), lines(base, {0, 2, 4}));
  // Without candidates nothing is looked up.
  Drawing outside(70, 50);
  add_line(outside, 0, 64, 70 * 256, 64);
  EXPECT_THAT(reads(coarse(), outside), IsEmpty());
  // Rows 31 and 32. The cache is empty when a frame starts.
  Drawing down(70, 50);
  add_line(down, 0, 32 * 256 - 64, 70 * 256, 32 * 256 - 64);
  GeometricGolden golden(coarse());
  for (const int frame : {0, 1}) {
    golden.process(down.input(kVectorBases));
    EXPECT_EQ(golden.traffic().read(Region::kCoarse), lines(base, {0, 2, 1, 3})) << frame;
  }
}

// The engine does not compare entries with the depths.
TEST(CoarseDepth, TooLargeEntryDropsVisibleCandidates) {
  const Drawing d = column(3, 8, 24, 1000);  // in front of depths of 0
  for (const auto detail :
       {GeometricGolden::Detail::kPixels, GeometricGolden::Detail::kEverything}) {
    GeometricGolden golden(coarse(), detail);
    FrameInput input = d.input(kVectorBases);
    std::vector<std::uint16_t> entries = {0, 0, 0};
    input.coarse = entries;
    golden.process(input);
    EXPECT_EQ(golden.work().passed, 24u);
    entries[1] = 4;  // limit 1024 - 2
    golden.process(input);
    EXPECT_EQ(golden.work().passed, 16u);
    EXPECT_EQ(golden.weights()[8 * 7 + 3], (Weights{0, 0, 0, 64}));
    EXPECT_EQ(golden.weights()[8 * 8 + 3], Weights{});
    EXPECT_EQ(golden.weights()[8 * 15 + 3], Weights{});
    EXPECT_EQ(golden.weights()[8 * 16 + 3], (Weights{0, 0, 0, 64}));
    entries.pop_back();
    input.coarse = entries;
    EXPECT_THROW(golden.process(input), spec::CheckFailed);
    input.coarse = {};
    input.bases.coarse = 4;
    EXPECT_THROW(golden.process(input), spec::CheckFailed);
  }
}

// Rows from 32 on have their own line of entries. If it is unreadable, their depths are read.
TEST(CoarseDepth, UnreadableEntriesDropNothing) {
  Drawing d = column(3, 8, 64, 0);
  std::fill(d.depths.begin(), d.depths.end(), 1u << 20);
  GeometricGolden golden(coarse());
  golden.process(d.input(kVectorBases));
  EXPECT_THAT(golden.traffic().read(Region::kDepth), IsEmpty());
  golden.set_memory_errors([](std::uint32_t a) { return a == kVectorBases.coarse + 64; });
  golden.process(d.input(kVectorBases));
  EXPECT_EQ(golden.memory_errors(), 1u);
  EXPECT_EQ(golden.work().passed, 0u);
  // Own blocks (0, 8) to (0, 15) and their neighbours (1, ..).
  ASSERT_EQ(golden.traffic().read(Region::kDepth).size(), 16u);
  EXPECT_EQ(golden.traffic().read(Region::kDepth)[0], kVectorBases.depth + 256 * 4);
  // Unreadable depths hide nothing, but the entries computed from these depths still drop
  // candidates.
  golden.set_memory_errors([](std::uint32_t a) { return a == kVectorBases.depth; });
  golden.process(d.input(kVectorBases));
  EXPECT_EQ(golden.work().passed, 0u);
  EXPECT_EQ(golden.memory_errors(), 0u);
}

// ---- select = mesh ------------------------------------------------------------------------------

// Facing bits need not exist.
TEST(SelectMesh, ReadsNoFacingBits) {
  Drawing d = mixed_edges();
  d.edges[1].flags = flag::kSeam;
  d.edges[1].f0 = 77;
  d.facing.clear();
  d.faces = 0;
  for (const RecordsLayout records : {RecordsLayout::kJoined, RecordsLayout::kSplit}) {
    Parameters p;
    p.records = records;
    p.select = Select::kMesh;
    const GeometricGolden golden = golden_of(p, d);
    EXPECT_EQ(golden.work().boundary_edges, 9u);
    EXPECT_EQ(golden.work().crease_edges, 1u);
    EXPECT_EQ(golden.work().kept_edges, 10u);
    EXPECT_EQ(golden.work().invalid_edges, 0u);
    EXPECT_THAT(golden.traffic().read(Region::kFaces), IsEmpty());
  }
}

// ---- all options --------------------------------------------------------------------------------

struct Option {
  const char* name;
  void (*make)(Parameters&);
};
constexpr Option kOptions[] = {
    {"colours", [](Parameters& p) { p.colour_lines = 5; }},
    {"records", [](Parameters& p) { p.records = RecordsLayout::kSplit; }},
    {"buffer", [](Parameters& p) { p.write_buffer = 7; }},
    {"coarse", [](Parameters& p) { p.coarse_lines = CoarseLines::k4; }},
    {"all", [](Parameters& p) {
       p.colour_lines = 128;
       p.records = RecordsLayout::kSplit;
       p.write_buffer = 128;
       p.coarse_lines = CoarseLines::k64;
     }}};

// Random lines in the frame, at many depths.
Drawing random_drawing(std::uint64_t seed) {
  tb::Random random(seed);
  const int width = random.between(1, 150), height = random.between(1, 100);
  Drawing d(width, height);
  for (auto& pixel : d.colours)
    for (auto& c : pixel) c = static_cast<std::uint8_t>(random.below(256));
  const std::uint32_t stripe_depth = random.below(1u << 24);
  for (std::size_t i = 0; i < d.depths.size(); ++i) {
    const std::uint32_t depth = i / 7 % 5 == 0 ? stripe_depth : 12000000 + random.below(1000);
    d.depths[i] = depth | (random.below(256) << 24);
  }
  for (std::uint32_t face = 0; face < 40; ++face) d.set_facing(face, random.chance(500));
  for (int i = 0; i < 120; ++i)
    d.vertices.push_back(
        {random.between(-512, 256 * width + 512), random.between(-512, 256 * height + 512),
         random.chance(500) ? 11990000 + random.below(20000) : random.below(1u << 24),
         !random.chance(20)});
  for (int i = 0; i < 300; ++i)
    d.edges.push_back({random.below(121), random.below(121), random.below(41), random.below(41),
                       static_cast<std::uint8_t>(random.below(16))});
  return d;
}

Parameters random_configuration(tb::Random& random) {
  Parameters p;
  p.select = static_cast<Select>(random.below(3));
  p.crease = static_cast<spec::geometric::Crease>(random.below(3));
  p.cull = static_cast<spec::geometric::Cull>(random.below(2));
  p.coverage = static_cast<spec::geometric::CoverageRule>(random.below(2));
  p.depth_test = static_cast<DepthTest>(1 + random.below(2));
  p.depth_bias = random.between(1, 24);
  p.crease_depth = random.between(0, 24);
  p.combine = static_cast<Combine>(random.below(3));
  p.layout = static_cast<Layout>(random.below(2));
  p.frame_copy = random.chance(300);
  p.depth_lines = p.weight_blocks = CacheLines::k16;
  return p;
}

// The counts without the edge classes: with split records an invalid edge may count in another
// class, or in two.
spec::geometric::Work without_classes(spec::geometric::Work work) {
  for (auto count :
       {&spec::geometric::Work::boundary_edges, &spec::geometric::Work::silhouette_edges,
        &spec::geometric::Work::back_edges, &spec::geometric::Work::crease_edges,
        &spec::geometric::Work::flat_edges, &spec::geometric::Work::invalid_edges})
    work.*count = 0;
  return work;
}

TEST(LessTraffic, OptionsChangeNoPixelAndNoCount) {
  tb::Random random(11);
  std::uint64_t invalid_joined = 0, invalid_split = 0;
  std::array<std::size_t, std::size(kOptions)> reduced{};
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Drawing d = random_drawing(seed);
    const Parameters plain = random_configuration(random);
    const GeometricGolden reference = golden_of(plain, d);
    const auto reads = [](const GeometricGolden& golden) {
      std::size_t sum = 0;
      for (const auto& list : golden.traffic().reads) sum += list.size();
      for (const auto& list : golden.traffic().writes) sum += list.size();
      return sum;
    };
    for (std::size_t i = 0; i < std::size(kOptions); ++i) {
      Parameters p = plain;
      kOptions[i].make(p);
      const GeometricGolden golden = golden_of(p, d);
      const auto what = std::string(kOptions[i].name) + ' ' + std::to_string(seed);
      ASSERT_EQ(golden.pixels(), reference.pixels()) << what;
      ASSERT_EQ(golden.weights(), reference.weights()) << what;
      ASSERT_EQ(golden.lines(), reference.lines()) << what;
      ASSERT_EQ(golden.candidates(), reference.candidates()) << what;
      ASSERT_EQ(golden.blocks(), reference.blocks()) << what;
      const auto& work = golden.work();
      if (p.records == RecordsLayout::kSplit) {
        EXPECT_EQ(without_classes(work), without_classes(reference.work())) << what;
        invalid_joined += reference.work().invalid_edges;
        invalid_split += work.invalid_edges;
      } else {
        EXPECT_EQ(work, reference.work()) << what;
        EXPECT_EQ(golden.classes(), reference.classes()) << what;
      }
      EXPECT_EQ(work.kept_edges,
                work.outside_edges + work.degenerate_edges + work.empty_edges + work.lines);
      reduced[i] += reads(golden) < reads(reference) ? 1 : 0;
      // The fast mode gives the same result.
      GeometricGolden fast(p, GeometricGolden::Detail::kPixels);
      EXPECT_EQ(fast.process(d.input()), reference.pixels()) << what;
      EXPECT_EQ(fast.work(), work) << what;
    }
  }
  EXPECT_GT(invalid_split, 100u);
  EXPECT_GT(invalid_joined, invalid_split);
  for (std::size_t i = 0; i < std::size(kOptions); ++i)
    EXPECT_GT(reduced[i], 10u) << kOptions[i].name;
}

// Expected classes of split records, from the rules in docs/reference/geometric/memory.md.
TEST(LessTraffic, SplitRecordsCountInvalidEdgesInTheirClass) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Drawing d = random_drawing(seed);
    for (const Select select : {Select::kAll, Select::kEdges, Select::kMesh}) {
      const GeometricGolden golden = golden_of(split(select), d);
      spec::geometric::Work expected;
      for (const Edge& edge : d.edges) {
        const bool boundary = (edge.flags & 1) != 0;
        const bool by_view = select == Select::kEdges;
        ++expected.edges;
        if (by_view && (edge.f0 >= d.faces || (!boundary && edge.f1 >= d.faces))) {
          ++expected.invalid_edges;
          continue;
        }
        const auto front = [&](std::uint32_t f) { return (d.facing[f / 8] >> (f % 8) & 1) != 0; };
        const bool crease = (edge.flags & 6) == 6 || (edge.flags & 8) != 0;
        bool kept = true;
        if (boundary) {
          ++expected.boundary_edges;
        } else if (by_view && front(edge.f0) != front(edge.f1)) {
          ++expected.silhouette_edges;
        } else if (select != Select::kAll && crease) {
          ++expected.crease_edges;
        } else if (select != Select::kAll) {
          ++expected.flat_edges;
          kept = false;
        }
        if (kept && (edge.v0 >= 120 || edge.v1 >= 120)) {
          ++expected.invalid_edges;
        } else if (kept) {
          ++expected.kept_edges;
        }
      }
      const auto& work = golden.work();
      EXPECT_EQ(work.edges, expected.edges);
      EXPECT_EQ(work.boundary_edges, expected.boundary_edges);
      EXPECT_EQ(work.silhouette_edges, expected.silhouette_edges);
      EXPECT_EQ(work.crease_edges, expected.crease_edges);
      EXPECT_EQ(work.flat_edges, expected.flat_edges);
      EXPECT_EQ(work.invalid_edges, expected.invalid_edges);
      EXPECT_EQ(work.kept_edges, expected.kept_edges);
    }
  }
}

}  // namespace
}  // namespace deburr::traffic_test
