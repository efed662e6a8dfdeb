// SPDX-License-Identifier: MIT
// Records and registers that the driver of the geometric engine writes, compared with
// docs/reference/geometric/memory.md by hand, and the inputs that it rejects.
#include "rtl_model/platform/geometric_driver.h"

#include <cstdlib>
#include <memory>

#include "tb/unit/platform/fakes.h"

namespace deburr::tb::geometric_driver_test {
namespace {

using platform::GeometricDriver;
using platform::GeometricFrame;
using platform::GeometricRegions;
using platform::GeometricSizes;
using platform::PixelLayout;
using spec::geometric::Edge;
using spec::geometric::Layout;
using spec::geometric::Parameters;
using spec::geometric::Region;
using spec::geometric::Rgba8;
using spec::geometric::Vertex;
using testing::ElementsAre;
using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;
namespace reg = spec::geometric::reg;

// ---- Records -----------------------------------------------------------------------------------

TEST(GeometricRecords, EdgeIsFourWords) {
  const Edge edges[] = {{0x010203, 0x0A0B0C, 0x112233, 0x445566, 0x8F}, {1, 2, 3, 4, 0}};
  EXPECT_EQ(platform::edge_records(edges),
            (Bytes{0x03, 0x02, 0x01, 0,    0x0C, 0x0B, 0x0A, 0, 0x33, 0x22, 0x11,
                   0x8F, 0x66, 0x55, 0x44, 0,    1,    0,    0, 0,    2,    0,
                   0,    0,    3,    0,    0,    0,    4,    0, 0,    0}));
}

// f0 in bits 20..0, f1 in 41..21, flags in 45..42; ten per line.
TEST(GeometricRecords, SplitFacesAreSixBytes) {
  std::vector<Edge> edges = {{1, 2, 0x1ABCDE, 0x012345, 0xB}, {1, 2, 0x200000, 0xFFFFFF, 0x14}};
  const Bytes two = platform::face_records(edges);
  const std::uint64_t first = 0x1ABCDE | std::uint64_t{0x012345} << 21 | std::uint64_t{0xB} << 42;
  Bytes expected(64);
  for (std::size_t i = 0; i < 6; ++i) expected[i] = static_cast<std::uint8_t>(first >> 8 * i);
  // Faces beyond 21 bits are the last one; 0x14 has one of the four flags.
  const std::uint8_t second[] = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x13};
  std::copy_n(second, 6, &expected[6]);
  EXPECT_EQ(two, expected);
  edges.resize(10);
  EXPECT_EQ(platform::face_records(edges).size(), 64u);
  EXPECT_EQ(platform::pair_records(edges, false).size(), 64u);
  edges.resize(11);
  edges[10] = {0, 0, 7, 0, 0};
  const Bytes eleven = platform::face_records(edges);
  EXPECT_EQ(eleven.size(), 128u);
  EXPECT_EQ(eleven[64], 7);
  EXPECT_EQ(platform::face_records({}).size(), 0u);
}

TEST(GeometricRecords, PairsOfBoundariesAndOthersAreSeparate) {
  std::vector<Edge> edges;
  for (std::uint32_t i = 0; i < 25; ++i)
    edges.push_back({i, 0xABC000 + i, 0, 0, static_cast<std::uint8_t>(i % 2)});
  EXPECT_EQ(platform::boundaries_of(edges), 12u);
  const Bytes boundaries = platform::pair_records(edges, true),
              others = platform::pair_records(edges, false);
  EXPECT_EQ(boundaries.size(), 128u);
  EXPECT_EQ(others.size(), 128u);
  for (std::uint32_t n = 0; n < 12; ++n)
    for (const bool boundary : {true, false}) {
      const Bytes& bytes = boundary ? boundaries : others;
      const std::uint8_t v = static_cast<std::uint8_t>(2 * n + boundary);
      const Bytes record(bytes.begin() + n / 10 * 64 + n % 10 * 6,
                         bytes.begin() + n / 10 * 64 + n % 10 * 6 + 6);
      EXPECT_EQ(record, (Bytes{v, 0, 0, v, 0xC0, 0xAB})) << n;
    }
}

// The smallest depth of the pixels inside the frame, / 256.
TEST(GeometricRecords, CoarseDepthIsSmallestOfTile) {
  constexpr int kWidth = 70, kHeight = 35;
  std::vector<std::uint32_t> depths(kWidth * kHeight, 0xFFFFFF);
  const auto set = [&](int x, int y, std::uint32_t depth) {
    depths[static_cast<std::size_t>(y * kWidth + x)] = depth;
  };
  set(7, 7, 0x1234FF);                 // tile (0, 0)
  set(8, 7, 0x5600);                   // tile (1, 0)
  set(69, 0, 0x777777);                // tile (8, 0): the first of line 1
  set(0, 32, 0xFF);                    // tile (0, 4): the first of line 2
  set(69, 34, 0x01000000 + 0x030201);  // tile (8, 4); bits above 23 are ignored
  const Bytes bytes = platform::coarse_depth(kWidth, kHeight, depths);
  ASSERT_EQ(bytes.size(), 4u * 64);
  const auto entry = [&](std::size_t at) { return bytes[at] | bytes[at + 1] << 8; };
  EXPECT_EQ(entry(0), 0x1234);
  EXPECT_EQ(entry(2), 0x0056);
  EXPECT_EQ(entry(4), 0xFFFF);
  EXPECT_EQ(entry(16), 0xFFFF);  // tile (0, 1)
  EXPECT_EQ(entry(64), 0x7777);
  EXPECT_EQ(entry(128), 0);
  EXPECT_EQ(entry(192), 0x0302);
  // Rows of 64 pixels need just one line.
  const Bytes narrow =
      platform::coarse_depth(64, 33, std::vector<std::uint32_t>(std::size_t{64} * 33, 0x4200));
  ASSERT_EQ(narrow.size(), 128u);
  EXPECT_EQ(narrow[62] | narrow[63] << 8, 0x0042);  // tile (7, 3)
  EXPECT_EQ(narrow[64] | narrow[65] << 8, 0x0042);  // tile (0, 4)
}

TEST(GeometricRecords, VertexIsFourWords) {
  const Vertex vertices[] = {{-2, 0x00ABCDEF, 0x123456, true}, {1, -256, 7, false}};
  EXPECT_EQ(platform::vertex_records(vertices),
            (Bytes{0xFE, 0xFF, 0xFF, 0xFF, 0xEF, 0xCD, 0xAB, 0, 0x56, 0x34, 0x12, 0, 1, 0, 0, 0, 1,
                   0,    0,    0,    0,    0xFF, 0xFF, 0xFF, 7, 0,    0,    0,    0, 0, 0, 0}));
}

TEST(GeometricRecords, FaceIsOneBit) {
  EXPECT_EQ(platform::facing_bits({true, false, false, true, false, false, false, false, true}),
            (Bytes{0x09, 0x01}));
}

TEST(GeometricRecords, PixelsFollowTheContract) {
  const PixelLayout raster(Layout::kRaster, 17, 14), tiled(Layout::kTiled, 17, 14);
  EXPECT_EQ(raster.bytes(), 14u * 128);
  EXPECT_EQ(tiled.bytes(), 256u * 3 * 2);
  EXPECT_EQ(raster.offset_of(16, 2), 320u);
  EXPECT_EQ(tiled.offset_of(9, 13), 1172u);
  EXPECT_EQ(tiled.offset_of(7, 7), 252u);
  EXPECT_EQ(tiled.offset_of(4, 0), 64u);
  EXPECT_EQ(tiled.offset_of(0, 4), 128u);
  EXPECT_EQ(tiled.offset_of(16, 0), 512u);
  EXPECT_EQ(PixelLayout(Layout::kRaster, 16, 1).bytes(), 64u);
  EXPECT_EQ(PixelLayout(Layout::kTiled, 8, 8).bytes(), 256u);
}

TEST(GeometricRecords, BuffersHoldPixelsInPositionAndZerosBetween) {
  for (const Layout layout : {Layout::kRaster, Layout::kTiled}) {
    const PixelLayout where(layout, 5, 3);
    std::vector<std::uint32_t> depths;
    std::vector<Rgba8> colours;
    for (std::uint32_t i = 0; i < 15; ++i) {
      depths.push_back(0x11223300 + i);
      colours.push_back({static_cast<std::uint8_t>(i), 2, 3, 4});
    }
    const Bytes depth = platform::depth_buffer(where, depths),
                colour = platform::colour_buffer(where, colours);
    Bytes expected_depth(where.bytes()), expected_colour(where.bytes());
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 5; ++x) {
        const auto i = static_cast<std::uint8_t>(5 * y + x);
        const std::size_t at = where.offset_of(x, y);
        const std::uint8_t depth_bytes[] = {i, 0x33, 0x22, 0x11}, colour_bytes[] = {i, 2, 3, 4};
        std::copy_n(depth_bytes, 4, &expected_depth[at]);
        std::copy_n(colour_bytes, 4, &expected_colour[at]);
      }
    EXPECT_EQ(depth, expected_depth);
    EXPECT_EQ(colour, expected_colour);
    EXPECT_EQ(platform::colours_of(where, colour), colours);
  }
}

// ---- Regions -----------------------------------------------------------------------------------

TEST(GeometricRegions, FollowEachOtherOnPages) {
  const GeometricSizes frames[] = {{61, 45, 300, 200, 49}, {16, 8, 3, 2000, 40000}};
  Parameters p;
  const GeometricRegions in_place = GeometricRegions::allocate(frames, p);
  p.frame_copy = true;
  const GeometricRegions copied = GeometricRegions::allocate(frames, p);
  // Faces 5056 bytes, edges 4800, vertices 32000, 8 x 6 tiles of 256, 16 x 12 blocks of 64.
  const std::uint32_t expected[] = {0, 8192, 16384, 49152, 61440, 73728, 86016};
  for (std::size_t i = 0; i < std::size(expected); ++i) {
    EXPECT_EQ(in_place.base(static_cast<Region>(i)), expected[i]) << i;
    EXPECT_EQ(copied.base(static_cast<Region>(i)), expected[i]) << i;
  }
  EXPECT_EQ(in_place.bytes(), 86016u);
  EXPECT_EQ(copied.bytes(), 98304u);
  EXPECT_EQ(copied.region_of(8191), 0u);
  EXPECT_EQ(copied.region_of(8192), 1u);
  EXPECT_EQ(copied.region_of(98303), 6u);
  EXPECT_EQ(copied.region_of(98304), GeometricRegions::kCount);
  EXPECT_EQ(copied.end_of(8192), 16384u);
  EXPECT_EQ(copied.end_of(86016), 98304u);
  EXPECT_EQ(GeometricRegions::needed(frames[1], p)[4], 64u * 4 * 2) << "16 x 8 pixels, no more";
}

// After the copy: pairs of both arrays, whole lines each; 32 tiles of 8 x 8 pixels per line.
TEST(GeometricRegions, LowTrafficRegionsComeLast) {
  const GeometricSizes frames[] = {{61, 45, 301, 200, 49, 41}, {1280, 720, 3, 2, 40000, 3}};
  Parameters p;
  p.records = spec::geometric::RecordsLayout::kSplit;
  p.coarse_lines = spec::geometric::CoarseLines::k4;
  const auto needed = GeometricRegions::needed(frames[0], p);
  EXPECT_EQ(needed[1], 31u * 64);
  EXPECT_EQ(needed[7], (5u + 26) * 64);
  EXPECT_EQ(needed[8], 2u * 64);
  EXPECT_EQ(GeometricRegions::needed(frames[1], p)[7], 64u);
  EXPECT_EQ(GeometricRegions::needed({61, 45, 300, 200, 49, 41}, p)[7], (5u + 26) * 64)
      << "each array takes whole lines";
  EXPECT_EQ(GeometricRegions::needed(frames[1], p)[8], 460u * 64);
  for (const auto& [faces, bytes] :
       {std::pair{0u, 0u}, {1u, 64u}, {7u, 64u}, {512u, 64u}, {513u, 128u}})
    EXPECT_EQ(GeometricRegions::needed({61, 45, 300, 200, faces}, p)[0], bytes) << faces;
  const GeometricRegions all = GeometricRegions::allocate(frames, p);
  EXPECT_EQ(all.base(Region::kCopy), all.base(Region::kPairs)) << "without a frame copy";
  EXPECT_EQ(all.region_of(all.base(Region::kPairs)), 7u);
  EXPECT_EQ(all.base(Region::kCoarse), all.base(Region::kPairs) + 4096);
  EXPECT_EQ(all.bytes(), all.base(Region::kCoarse) + 32768u);
  EXPECT_EQ(all.other_pairs(41), all.base(Region::kPairs) + 5 * 64);
  EXPECT_EQ(all.other_pairs(0), all.base(Region::kPairs));
  EXPECT_EQ(all.other_pairs(40), all.base(Region::kPairs) + 4 * 64);
}

TEST(GeometricRegions, RejectAddressesBeyond32Bits) {
  const GeometricSizes frames[] = {{8192, 8192, 1 << 24, std::uint64_t{1} << 28, 0}};
  EXPECT_THAT(error_of<spec::ConfigError>([&] { GeometricRegions::allocate(frames, {}); }),
              HasSubstr("32-bit addresses cover 4294967296: use a smaller frame or mesh"));
}

// ---- Driver ------------------------------------------------------------------------------------

// A frame of 17 x 2 pixels with a mesh, in memory of 1 MiB.
struct Bed {
  explicit Bed(const Parameters& p = raster(), std::size_t bytes = 1 << 20)
      : memory(bytes), driver(registers, memory, p) {
    registers.values[reg::kId] = 0xDEB00005;
    registers.values[reg::kStatus] = 1;
    driver.place(
        GeometricRegions({0x1000, 0x2000, 0x3000, 0x4000, 0x5000, 0x6000, 0x7000, 0x8000, 0x9000}));
  }
  static Parameters raster() {
    Parameters p;
    p.layout = Layout::kRaster;
    return p;
  }
  GeometricFrame frame() const { return {17, 2, edges, vertices, 9, facing, depths, colours}; }
  std::vector<Edge> edges = {{0, 1, 2, 3, 4}};
  std::vector<Vertex> vertices = {{5, 6, 7, true}, {8, 9, 10, true}};
  Bytes facing = {0x5A, 0x01};
  std::vector<std::uint32_t> depths = std::vector<std::uint32_t>(34, 77);
  std::vector<Rgba8> colours = std::vector<Rgba8>(34, Rgba8{1, 2, 3, 4});
  FakeRegisters registers;
  FakeMemory memory;
  GeometricDriver driver;
};

TEST(GeometricDriver, WritesEachRecordToItsRegion) {
  Bed b;
  b.driver.load(b.frame());
  EXPECT_THAT(b.memory.read(0x1000, 3), ElementsAre(0x5A, 0x01, 0xEE));
  EXPECT_EQ(b.memory.read(0x2000, 17),
            (Bytes{0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 4, 3, 0, 0, 0, 0xEE}));
  EXPECT_EQ(b.memory.read(0x3000, 33), (Bytes{5, 0, 0, 0, 6, 0, 0, 0,  7, 0, 0, 0, 1, 0, 0, 0,   8,
                                              0, 0, 0, 9, 0, 0, 0, 10, 0, 0, 0, 1, 0, 0, 0, 0xEE}));
  EXPECT_EQ(b.memory.read(0x4000 + 128 + 64, 5), (Bytes{77, 0, 0, 0, 0}));
  EXPECT_EQ(b.memory.read(0x5000, 4), (Bytes{0xEE, 0xEE, 0xEE, 0xEE}))
      << "weights are the engine's";
  EXPECT_EQ(b.memory.read(0x6000 + 128 + 64, 5), (Bytes{1, 2, 3, 4, 0}));
  EXPECT_EQ(b.driver.picture(), b.colours);
  b.driver.put(16, 1, {9, 8, 7, 6});
  EXPECT_EQ(b.driver.pixel(16, 1), (Rgba8{9, 8, 7, 6}));
  EXPECT_EQ(b.memory.read(0x60C0, 4), (Bytes{9, 8, 7, 6}));
  EXPECT_EQ(b.driver.colour_address(16, 1), 0x60C0u);
  EXPECT_TRUE(b.registers.written.empty());
}

TEST(GeometricDriver, MissingFrameDataLeavesMemoryUnchanged) {
  Bed b;
  b.depths.clear();
  b.colours.clear();
  b.driver.load(b.frame());
  EXPECT_EQ(b.memory.contents[0x4000], 0xEE);
  EXPECT_EQ(b.memory.contents[0x6000], 0xEE);
  b.driver.load_depths(std::vector<std::uint32_t>(34, 5));
  EXPECT_EQ(b.memory.contents[0x4000], 5);
  GeometricFrame frame = b.frame();
  b.facing = {1, 2, 3, 4};
  frame.facing = b.facing;
  frame.faces = 14;
  b.driver.load(frame);
  EXPECT_THAT(b.memory.read(0x1000, 3), ElementsAre(1, 2, 0xEE)) << "face 16 does not exist";
}

TEST(GeometricDriver, ProgramsSizesAndBasesThenStarts) {
  Bed b;
  b.driver.load(b.frame());
  b.driver.draw();
  using Write = std::pair<std::uint32_t, std::uint32_t>;
  EXPECT_THAT(b.registers.written,
              ElementsAre(Write{0x0C, 17 | 2 << 16}, Write{0x14, 1}, Write{0x18, 2}, Write{0x1C, 9},
                          Write{0x20, 0x2000}, Write{0x24, 0x3000}, Write{0x28, 0x1000},
                          Write{0x2C, 0x4000}, Write{0x30, 0x6000}, Write{0x34, 0x5000},
                          Write{0x38, 0x7000}, Write{0x98, 0}, Write{0x9C, 0x8000},
                          Write{0xA0, 0x8000}, Write{0xA4, 0x9000}, Write{0x04, 5}));
}

// Faces of all edges, then pairs of the boundaries and of the others; coarse depth with the depths.
TEST(GeometricDriver, WritesSplitRecordsAndCoarseDepth) {
  Parameters p = Bed::raster();
  p.records = spec::geometric::RecordsLayout::kSplit;
  p.coarse_lines = spec::geometric::CoarseLines::k4;
  Bed b(p);
  b.edges = {{0, 1, 2, 3, 4}, {1, 0, 5, 6, 1}, {1, 1, 7, 8, 8}};
  b.depths[0] = 0x123456;
  b.driver.load(b.frame());
  EXPECT_EQ(b.memory.read(0x2000, 12), (Bytes{2, 0, 0x60, 0, 0, 0x10, 5, 0, 0xC0, 0, 0, 0x04}));
  EXPECT_EQ(b.memory.read(0x2000 + 64, 1), (Bytes{0xEE}));
  EXPECT_EQ(b.memory.read(0x8000, 6), (Bytes{1, 0, 0, 0, 0, 0}));
  EXPECT_EQ(b.memory.read(0x8040, 12), (Bytes{0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}));
  EXPECT_EQ(b.memory.read(0x9000, 4), (Bytes{0, 0, 0, 0}));
  b.depths.assign(34, 0xABCDEF);
  b.depths[16] = 0x010203;  // pixel (16, 0)
  b.driver.load_depths(b.depths);
  EXPECT_EQ(b.memory.read(0x9000, 6), (Bytes{0xCD, 0xAB, 0xCD, 0xAB, 0x02, 0x01}));
  b.driver.program();
  EXPECT_EQ(b.registers.values[reg::kBoundaryCount], 1u);
  EXPECT_EQ(b.registers.values[reg::kPairBase], 0x8000u);
  EXPECT_EQ(b.registers.values[reg::kOtherPairBase], 0x8040u);
  EXPECT_EQ(b.registers.values[reg::kCoarseBase], 0x9000u);
}

// The configuration of the preset without later options.
Parameters of_nearest_lines() {
  Parameters p;
  p.cull = spec::geometric::Cull::kBack;
  p.coverage = spec::geometric::CoverageRule::kDistance;
  p.crease_depth = 0;
  p.combine = spec::geometric::Combine::kMax;
  return p;
}

TEST(GeometricDriver, WritesConfigurationAsRegisterFields) {
  Bed b;
  const auto written = [&](const Parameters& configuration) {
    b.driver.set_configuration(configuration);
    return b.registers.values[reg::kConfiguration];
  };
  // edges 1, linear light, shading 2, farther 2, max 0, bias 9, tiled, cull back
  Parameters p = of_nearest_lines();
  EXPECT_EQ(written(p), 0x824929u);
  p.select = spec::geometric::Select::kAll;
  EXPECT_EQ(written(p), 0x824928u);
  p.crease = spec::geometric::Crease::kPaper;
  EXPECT_EQ(written(p), 0x824924u);
  p.depth_test = spec::geometric::DepthTest::kOwn;
  EXPECT_EQ(written(p), 0x824914u);
  p.combine = spec::geometric::Combine::kLast;
  EXPECT_EQ(written(p), 0x824954u);
  p.linear_light = false;
  EXPECT_EQ(written(p), 0x24954u);
  p.depth_bias = 24;
  EXPECT_EQ(written(p), 0x25854u);
  p.mark = true;
  EXPECT_EQ(written(p), 0x27854u);
  p.layout = Layout::kRaster;
  EXPECT_EQ(written(p), 0x23854u);
  p.frame_copy = true;
  EXPECT_EQ(written(p), 0x2B854u);
  p.coverage = spec::geometric::CoverageRule::kArea;
  EXPECT_EQ(written(p), 0x3B854u);
  p.cull = spec::geometric::Cull::kNone;
  EXPECT_EQ(written(p), 0x1B854u);
  p.crease_depth = 24;
  EXPECT_EQ(written(p), 0x61B854u);
  p.combine = spec::geometric::Combine::kOutermost;
  EXPECT_EQ(written(p), 0x61B894u);
}

TEST(GeometricDriver, ReadsEngineState) {
  Bed b;
  b.driver.identify();
  b.registers.values[reg::kEdges] = 300;
  b.registers.values[reg::kBlendedPixels] = 7;
  b.registers.values[reg::kFrameCycles] = 1000;
  b.registers.values[reg::kEdgeCycles] = 600;
  b.registers.values[reg::kResolveCycles] = 400;
  b.registers.values[reg::kMemoryErrors] = 3;
  EXPECT_EQ(b.driver.work().edges, 300u);
  EXPECT_EQ(b.driver.work().blended_pixels, 7u);
  EXPECT_EQ(b.driver.cycles().frame, 1000u);
  EXPECT_EQ(b.driver.cycles().edges, 600u);
  EXPECT_EQ(b.driver.cycles().resolve, 400u);
  EXPECT_EQ(b.driver.memory_errors(), 3u);
  b.registers.values[reg::kControl] = 1;
  b.driver.clear_counters();
  EXPECT_EQ(b.registers.values[reg::kControl], 3u);
  b.driver.clear_status(2);
  EXPECT_EQ(b.registers.written.back(), (std::pair{0x08u, 2u}));
}

// ---- Misuse ------------------------------------------------------------------------------------

TEST(GeometricDriver, RejectsOtherEngine) {
  Bed b;
  b.registers.values[reg::kId] = 0xDEB00002;
  EXPECT_EQ(error_of<spec::SimulationError>([&] { b.driver.identify(); }),
            "the ID register reads 0xdeb00002, expected 0xdeb00005");
}

TEST(GeometricDriver, WritesNothingToBusyEngine) {
  Bed b;
  b.driver.load(b.frame());
  b.registers.values[reg::kStatus] = 0;
  EXPECT_EQ(error_of<spec::SimulationError>([&] { b.driver.start(); }),
            "driver of the geometric engine: START while it is busy: wait until STATUS says idle");
  EXPECT_THAT(error_of<spec::SimulationError>([&] { b.driver.program(); }),
              HasSubstr("sizes and bases while it is busy"));
  EXPECT_THAT(error_of<spec::SimulationError>([&] { b.driver.set_configuration({}); }),
              HasSubstr("a new configuration while it is busy"));
  EXPECT_TRUE(b.registers.written.empty());
}

TEST(GeometricDriver, RejectedStartReportsReason) {
  Bed b;
  EXPECT_NO_THROW(b.driver.require_accepted());
  b.registers.values[reg::kRejection] = 4;
  EXPECT_EQ(error_of<spec::SimulationError>([&] { b.driver.require_accepted(); }),
            "the geometric engine rejected the start: touched_words");
  // The first code without a name, and the last.
  for (const std::size_t code : {spec::geometric::kRejectionNames.size(), std::size_t{15}}) {
    b.registers.values[reg::kRejection] = static_cast<std::uint32_t>(code);
    EXPECT_EQ(error_of<spec::SimulationError>([&] { b.driver.require_accepted(); }),
              "the geometric engine rejected the start: ?");
  }
}

std::string rejection(Bed& b, const GeometricFrame& frame) {
  return error_of<spec::ConfigError>([&] { b.driver.load(frame); });
}

TEST(GeometricDriver, RejectsSizesOutOfRange) {
  Bed b;
  const auto with = [&](auto&& change) {
    GeometricFrame frame = b.frame();
    change(frame);
    return rejection(b, frame);
  };
  EXPECT_EQ(with([](GeometricFrame& f) { f.width = 0; }),
            "driver of the geometric engine: width of the frame: expected 1..8192, got 0");
  EXPECT_THAT(with([](GeometricFrame& f) { f.width = 8193; }), HasSubstr("1..8192, got 8193"));
  EXPECT_THAT(with([](GeometricFrame& f) { f.height = -1; }), HasSubstr("height of the frame"));
  EXPECT_THAT(with([](GeometricFrame& f) { f.faces = (1 << 20) + 1; }), HasSubstr("faces"));
  Parameters every = Bed::raster();
  every.select = spec::geometric::Select::kAll;
  b.driver.set_configuration(every);
  EXPECT_THAT(with([](GeometricFrame& f) { f.faces = (1 << 20) + 1; }), HasSubstr("too few for"));
  EXPECT_THAT(with([](GeometricFrame& f) { f.faces = (1 << 24) + 1; }),
              HasSubstr("faces: expected 0..16777216"));
  EXPECT_THAT(with([](GeometricFrame& f) { f.faces = 17; }),
              HasSubstr("2 bytes of facing bits are too few for 17 faces"));
  EXPECT_THAT(with([](GeometricFrame& f) { f.depths = f.depths.first(33); }),
              HasSubstr("33 depths for a frame of 17 x 2 pixels"));
  EXPECT_THAT(with([](GeometricFrame& f) { f.height = 3; }),
              HasSubstr("34 depths for a frame of 17 x 3 pixels"));
  // Untouched zeros, so that they use no physical memory.
  constexpr std::size_t kMany = (1 << 24) + 1;
  const std::unique_ptr<void, decltype(&std::free)> zeros(std::calloc(kMany, sizeof(Edge)),
                                                          &std::free);
  static_assert(sizeof(Vertex) <= sizeof(Edge));
  EXPECT_THAT(with([&](GeometricFrame& f) {
                f.edges = {static_cast<Edge*>(zeros.get()), kMany};
              }),
              HasSubstr("edges: expected 0..16777216, got 16777217"));
  EXPECT_THAT(with([&](GeometricFrame& f) {
                f.vertices = {static_cast<Vertex*>(zeros.get()), kMany};
              }),
              HasSubstr("vertices: expected 0..16777216, got 16777217"));
  EXPECT_EQ(b.memory.contents, Bytes(1 << 20, 0xEE)) << "nothing was written";
  EXPECT_EQ(with([](GeometricFrame&) {}), "");
  EXPECT_THAT(error_of<spec::ConfigError>([&] { b.driver.load_colours({}); }),
              HasSubstr("0 colours for a frame of 17 x 2 pixels"));
}

TEST(GeometricDriver, RejectsOverlappingOrOversizedRegions) {
  Bed b;
  const auto at = [&](std::array<std::uint32_t, GeometricRegions::kCount> bases) {
    b.driver.place(GeometricRegions(bases));
    return rejection(b, b.frame());
  };
  // Depth: two rows of 128 bytes. Weights: five blocks of 64.
  EXPECT_EQ(at({0x1000, 0x2000, 0x3000, 0x4000, 0x40C0, 0x6000, 0x7000}),
            "driver of the geometric engine: region depth (0x4000 to 0x40ff) overlaps region "
            "weights (0x40c0 to 0x41ff)");
  EXPECT_EQ(at({0x1000, 0x2000, 0x3000, 0x4000, 0x4100, 0x4240, 0}), "");
  EXPECT_EQ(
      at({0x1000, 0x2000, 0x3000, 0x4000, 0x4100, 0x6020, 0x7000}),
      "driver of the geometric engine: region colour begins at 0x6020, which is not a multiple "
      "of 64");
  EXPECT_EQ(at({0x1000, 0x2000, 0x3000, 0x4000, 0x5000, 0xFFF40, 0x7000}),
            "driver of the geometric engine: region colour (0xfff40 to 0x10003f) ends past the "
            "memory of 1048576 bytes: make it larger, or the input smaller");
  EXPECT_EQ(at({0x1000, 0x2000, 0x3000, 0x4000, 0x5000, 0xFFF00, 0x7000}), "");
  EXPECT_THAT(at({0x1000, 0x2000, 0x3000, 0x4000, 0x5000, 0x200000, 0x7000}),
              HasSubstr("ends past the memory"));
}

TEST(GeometricDriver, CopyNeedsRoomOnlyIfFramesAreCopied) {
  Parameters p = Bed::raster();
  p.frame_copy = true;
  Bed b(p);
  b.driver.place(GeometricRegions({0x1000, 0x2000, 0x3000, 0x4000, 0x5000, 0x6000, 0x6000}));
  EXPECT_THAT(rejection(b, b.frame()), HasSubstr("overlaps"));
  b.driver.set_configuration(Bed::raster());
  EXPECT_EQ(b.registers.written.back(), (std::pair{0x10u, 0x8D09A9u}));
  EXPECT_EQ(rejection(b, b.frame()), "");
}

}  // namespace
}  // namespace deburr::tb::geometric_driver_test
