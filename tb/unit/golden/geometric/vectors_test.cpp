// SPDX-License-Identifier: MIT
// Does the golden give the contract's numbers? The eight frames, the seven lines, and every entry
// of the ROM (docs/geometric.md, "Vectors"; docs/number_formats_geometric.md).
#include <gmock/gmock.h>

#include <ostream>

#include "golden/geometric/line.h"
#include "spec/geometric/tables.h"
#include "tb/unit/golden/geometric/support.h"

namespace deburr::vectors_test {
namespace {

using golden::geometric::GeometricGolden;
using golden::geometric::LineFate;
using golden::geometric::preset_parameters;
using golden::geometric::set_up_line;
using spec::geometric::Axis;
using spec::geometric::CacheLines;
using spec::geometric::Crease;
using spec::geometric::DepthTest;
using spec::geometric::Lanes;
using spec::geometric::Layout;
using spec::geometric::LineRecord;
using spec::geometric::Parameters;
using spec::geometric::Preset;
using spec::geometric::Region;
using spec::geometric::Select;
using spec::geometric::Vertex;
using spec::geometric::Work;

void small_caches(Parameters& p) {
  p.depth_lines = p.weight_blocks = p.vertex_lines = CacheLines::k16;
}
void as_built(Parameters&) {}
void raster(Parameters& p) { p.layout = Layout::kRaster; }
void one_walker(Parameters& p) {
  p.walkers = Lanes::kOne;
  small_caches(p);
}
void raster_two_walkers(Parameters& p) {
  p.layout = Layout::kRaster;
  p.walkers = Lanes::kTwo;
  small_caches(p);
}
void other_rules(Parameters& p) {
  p.crease = Crease::kOff;
  p.depth_test = DepthTest::kOwn;
  p.depth_bias = 4;
  p.linear_light = false;
  p.mark = true;
  p.layout = Layout::kRaster;
  p.walkers = Lanes::kTwo;
}
void everything_drawn(Parameters& p) {
  p.select = Select::kAll;
  p.depth_test = DepthTest::kOff;
  p.layout = Layout::kRaster;
  p.weight_blocks = CacheLines::k16;
}

struct FrameVector {
  char name;
  Preset preset;
  void (*change)(Parameters&);
  std::uint64_t pixels, weights, traffic;
  Work work;
  std::size_t vertex_reads, depth_reads, weight_reads, weight_writes, colour_reads, colour_writes;
};

void PrintTo(const FrameVector& v, std::ostream* out) { *out << v.name; }

// edges, boundary, silhouette, back, crease, flat, invalid, kept, outside, degenerate, empty,
// lines, columns, groups, candidates, passed, blocks, blended
const FrameVector kFrames[] = {
    {'a',
     Preset::kDeburr,
     as_built,
     0xbfce4abe8f3b22f8,
     0x6cc78624e74c2575,
     0x05d525abe62406ac,
     {300, 164, 63, 29, 20, 12, 12, 247, 5, 1, 15, 226, 6686, 2332, 5953, 4779, 191, 2148},
     50,
     722,
     438,
     438,
     579,
     191},
    {'b',
     Preset::kDeburr,
     raster,
     0xbfce4abe8f3b22f8,
     0x6cc78624e74c2575,
     0x1cca5c4cd350ef99,
     {300, 164, 63, 29, 20, 12, 12, 247, 5, 1, 15, 226, 6686, 2332, 5953, 4779, 191, 2148},
     50,
     1086,
     438,
     438,
     989,
     686},
    {'c',
     Preset::kDeburr,
     one_walker,
     0xbfce4abe8f3b22f8,
     0x6cc78624e74c2575,
     0x3d300c73436d0324,
     {300, 164, 63, 29, 20, 12, 12, 247, 5, 1, 15, 226, 6686, 6686, 5953, 4779, 191, 2148},
     351,
     2347,
     1763,
     1763,
     579,
     191},
    {'d',
     Preset::kDeburr,
     raster_two_walkers,
     0xbfce4abe8f3b22f8,
     0x6cc78624e74c2575,
     0x0290086e5caa5d65,
     {300, 164, 63, 29, 20, 12, 12, 247, 5, 1, 15, 226, 6686, 3777, 5953, 4779, 191, 2148},
     351,
     3949,
     1763,
     1763,
     989,
     686},
    {'e',
     Preset::kGpaaOptimised,
     as_built,
     0x31c35ac184f4e760,
     0xbadcaac952dfc9ed,
     0x9273c837cbb2c537,
     {300, 164, 63, 29, 16, 16, 12, 243, 5, 1, 15, 222, 6607, 2311, 5861, 4683, 191, 2126},
     50,
     707,
     421,
     421,
     535,
     191},
    {'f',
     Preset::kGpaa,
     as_built,
     0x9e2d94b3be2f9be4,
     0x9d0d9b07b9151d21,
     0xe27e145fd8e2b753,
     {300, 166, 0, 0, 0, 0, 4, 296, 5, 1, 18, 272, 8105, 2864, 7264, 5815, 191, 2302},
     50,
     871,
     539,
     539,
     574,
     191},
    {'g',
     Preset::kDeburr,
     other_rules,
     0x812d11a355250433,
     0xea5cdef281327420,
     0xd29f2a365f31ea07,
     {300, 164, 63, 29, 0, 32, 12, 227, 5, 1, 15, 206, 6087, 3446, 5390, 3512, 187, 1746},
     50,
     912,
     330,
     330,
     941,
     664},
    {'h',
     Preset::kDeburr,
     everything_drawn,
     0x095774cc41e669b3,
     0x721dca7bb6a8d77f,
     0xd81315c6f0a3ee49,
     {300, 166, 0, 0, 0, 0, 4, 296, 5, 1, 18, 272, 8105, 2864, 7264, 7264, 191, 2461},
     50,
     0,
     2372,
     2372,
     1069,
     701},
};

class Frames : public testing::TestWithParam<FrameVector> {};

TEST_P(Frames, AreTheContracts) {
  const FrameVector& v = GetParam();
  Parameters p = preset_parameters(v.preset);
  v.change(p);
  GeometricGolden golden(p);
  golden.process(tb::geometric::vector_drawing().input(tb::geometric::kVectorBases));
  for (const spec::geometric::WorkCount& count : spec::geometric::kWorkCounts)
    EXPECT_EQ(golden.work().*count.count, v.work.*count.count) << std::hex << count.offset;
  const auto& t = golden.traffic();
  EXPECT_EQ(t.read(Region::kVertices).size(), v.vertex_reads);
  EXPECT_EQ(t.read(Region::kDepth).size(), v.depth_reads);
  EXPECT_EQ(t.read(Region::kWeights).size(), v.weight_reads);
  EXPECT_EQ(t.write(Region::kWeights).size(), v.weight_writes);
  EXPECT_EQ(t.read(p.frame_copy ? Region::kCopy : Region::kColour).size(), v.colour_reads);
  EXPECT_EQ(t.write(Region::kColour).size(), v.colour_writes);
  EXPECT_EQ(tb::geometric::hash_of(golden.pixels()), v.pixels);
  EXPECT_EQ(tb::geometric::hash_of(golden.weights()), v.weights);
  EXPECT_EQ(tb::geometric::hash_of(t, p.frame_copy), v.traffic);
}

// The fast way gives the same pixels, weights and work.
TEST_P(Frames, NeedNoDetail) {
  const FrameVector& v = GetParam();
  Parameters p = preset_parameters(v.preset);
  v.change(p);
  GeometricGolden golden(p, GeometricGolden::Detail::kPixels);
  golden.process(tb::geometric::vector_drawing().input(tb::geometric::kVectorBases));
  EXPECT_EQ(tb::geometric::hash_of(golden.pixels()), v.pixels);
  EXPECT_EQ(tb::geometric::hash_of(golden.weights()), v.weights);
  EXPECT_EQ(golden.work(), v.work);
  EXPECT_TRUE(golden.candidates().empty());
}

INSTANTIATE_TEST_SUITE_P(All, Frames, testing::ValuesIn(kFrames),
                         [](const auto& test) { return std::string(1, test.param.name); });

// ---- lines --------------------------------------------------------------------------------------

struct LineVector {
  std::int32_t major0, minor0;
  std::uint32_t depth0;
  std::int32_t major1, minor1;
  std::uint32_t depth1;
  bool horizontal;
  int first, count;
  std::int64_t position;
  std::int32_t slope;
  std::int64_t depth, step;
};

void PrintTo(const LineVector& v, std::ostream* out) { *out << v.major0 << ", " << v.minor0; }

const LineVector kLines[] = {
    {2624, 128, 1000000, 5184, 1408, 2000000, true, 10, 10, 10485888, 8388608, 4198399902,
     409599975},
    {7000, 100, 16777215, 200000, -30000, 5, false, 27, 693, 6144893, -2616550, 68705230854,
     -91151183},
    {-4194304, -1000, 3000000, 4194303, 150000, 9000000, true, 0, 1280, 4882583128, 302000,
     24576376464, 750000},
    {128, 1000, 77777, 129, 1000, 77777, true, 0, 1, 65536128, 0, 318574592, 0},
    {1000, 1000, 500, 1700, 700, 90000, true, 4, 3, 61266926, -7190235, 81650820, 134067929},
    {1000, 1000, 500, 1301, 1300, 400, false, 4, 1, 75464505, 16721478, 1841159, -348364},
    {4000, 300, 5, 180000, 300, 16000000, false, 16, 687, 19660928, 0, 83426703, 95325058},
};

class Lines : public testing::TestWithParam<LineVector> {};

TEST_P(Lines, AreTheContracts) {
  const LineVector& v = GetParam();
  const auto vertex = [&](std::int32_t major, std::int32_t minor, std::uint32_t depth) {
    return v.horizontal ? Vertex{major, minor, depth, true} : Vertex{minor, major, depth, true};
  };
  const Vertex a = vertex(v.major0, v.minor0, v.depth0), b = vertex(v.major1, v.minor1, v.depth1);
  for (const bool swapped : {false, true}) {
    LineRecord line;
    ASSERT_EQ(set_up_line(swapped ? b : a, swapped ? a : b, 1280, 720, line), LineFate::kLine);
    EXPECT_EQ(line.axis, v.horizontal ? Axis::kHorizontal : Axis::kVertical);
    EXPECT_EQ(line.first, v.first);
    EXPECT_EQ(line.count, v.count);
    EXPECT_EQ(line.position, v.position);
    EXPECT_EQ(line.slope, v.slope);
    EXPECT_EQ(line.depth, v.depth);
    EXPECT_EQ(line.depth_step, v.step);
    EXPECT_EQ(line.tie_forward, v.horizontal && v.minor1 > v.minor0);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Lines, testing::ValuesIn(kLines));

// ---- tables -------------------------------------------------------------------------------------

TEST(Tables, DeficitsAreWhatTheFormulaSays) {
  for (std::uint64_t i = 0; i < 1024; ++i) {
    const std::uint64_t deficit = spec::geometric::kReciprocalDeficit[i];
    EXPECT_EQ(deficit, (std::uint64_t{1} << 26) - (std::uint64_t{1} << 36) / (1024 + i));
    EXPECT_LT(deficit, 1u << 25);
    // A length whose low twelve bits are 0 takes the same reciprocal from the division.
    EXPECT_EQ((1u << 26) - deficit,
              golden::geometric::reciprocal(static_cast<std::uint32_t>((1024 + i) << 12)));
  }
}

}  // namespace
}  // namespace deburr::vectors_test
