// SPDX-License-Identifier: MIT
// Whole frames: order of edges, walkers, layouts, addresses, traffic and memory errors.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "spec/error.h"
#include "tb/base/random.h"
#include "tb/unit/golden/geometric/support.h"

namespace deburr::frames_test {
namespace {

using golden::geometric::FrameLayout;
using golden::geometric::GeometricGolden;
using golden::geometric::preset_parameters;
using spec::geometric::CacheLines;
using spec::geometric::Combine;
using spec::geometric::Lanes;
using spec::geometric::Layout;
using spec::geometric::Parameters;
using spec::geometric::Preset;
using spec::geometric::Region;
using spec::geometric::Rgba8;
using spec::geometric::Weights;
using tb::geometric::Drawing;
using tb::geometric::kVectorBases;
using tb::geometric::vector_drawing;

// A drawing of one line, in front of everything, over a black upper and a white lower half.
Drawing one_line(int x0, int y0, int x1, int y1, int width = 16, int height = 16) {
  Drawing d(width, height);
  std::fill(d.colours.begin(), d.colours.end(), Rgba8{255, 255, 255, 255});
  std::fill_n(d.colours.begin(), d.colours.size() / 2, Rgba8{0, 0, 0, 255});
  d.vertices = {{x0, y0, 0xFFFFFF, true}, {x1, y1, 0xFFFFFF, true}};
  d.set_facing(0, true);
  d.edges = {{0, 1, 0, 0, spec::geometric::flag::kBoundary}};
  return d;
}

TEST(Frame, LineBlendsByTheAreaItCutsOff) {
  // The line is 64/256 pixel above the border of rows 7 and 8, so it cuts off the lowest quarter of
  // row 7.
  const Drawing d = one_line(0, 8 * 256 - 64, 16 * 256, 8 * 256 - 64);
  Parameters p;
  p.linear_light = false;
  GeometricGolden golden(p);
  const auto& pixels = golden.process(d.input());
  for (int x = 0; x < 16; ++x) {
    EXPECT_EQ(golden.weights()[static_cast<std::size_t>(7 * 16 + x)], (Weights{0, 64, 0, 0}));
    EXPECT_EQ(pixels[static_cast<std::size_t>(7 * 16 + x)], (Rgba8{64, 64, 64, 255}));
    EXPECT_EQ(pixels[static_cast<std::size_t>(8 * 16 + x)], (Rgba8{255, 255, 255, 255}));
  }
  EXPECT_EQ(golden.work().blended_pixels, 16u);
}

TEST(Frame, PixelsOutsideTheFrameAreNotCandidates) {
  for (const auto& [y, direction] : {std::pair{64, 0}, {16 * 256 - 64, 1}}) {
    GeometricGolden golden(Parameters{});
    golden.process(one_line(0, y, 16 * 256, y).input());
    EXPECT_EQ(golden.work().columns, 16u);
    EXPECT_EQ(golden.work().candidates, 0u) << direction;
  }
}

TEST(Frame, EdgeOrderMattersOnlyWithLast) {
  Drawing d = vector_drawing();
  tb::Random random(8);
  for (const Combine combine : {Combine::kMax, Combine::kLast, Combine::kOutermost}) {
    Parameters p;
    p.combine = combine;
    GeometricGolden golden(p);
    golden.process(d.input());
    const auto pixels = golden.pixels();
    const auto weights = golden.weights();
    bool same = true;
    for (int trial = 0; trial < 5; ++trial) {
      for (std::size_t i = d.edges.size(); i > 1; --i)
        std::swap(d.edges[i - 1], d.edges[random.below(static_cast<std::uint32_t>(i))]);
      golden.process(d.input());
      same = same && golden.weights() == weights && golden.pixels() == pixels;
    }
    EXPECT_EQ(same, combine != Combine::kLast);
  }
}

TEST(Frame, RepeatedFrameGivesTheSameResult) {
  GeometricGolden once(preset_parameters(Preset::kDeburr)), twice = once;
  once.process(vector_drawing().input());
  for (int frame = 0; frame < 2; ++frame) twice.process(vector_drawing().input());
  EXPECT_EQ(twice.work(), once.work());
  EXPECT_EQ(twice.classes(), once.classes());
  EXPECT_EQ(twice.lines(), once.lines());
  EXPECT_EQ(twice.candidates(), once.candidates());
  EXPECT_EQ(twice.blocks(), once.blocks());
  EXPECT_EQ(twice.weights(), once.weights());
  EXPECT_EQ(twice.pixels(), once.pixels());
}

// A line over columns 1 to 12 enters the next row of blocks at column 5, 6 or 7. One group ends
// there, the groups before columns 4 and 8 end with their block, and columns 8 to 11 are a full
// group of four.
TEST(Frame, GroupsEndAtBlockBordersOrWhenFull) {
  for (const int crossing : {5, 6, 7}) {
    const int rise = 128 * (crossing - 1);  // half a row per column
    Parameters p;
    p.walkers = Lanes::kFour;
    GeometricGolden golden(p);
    golden.process(one_line(256, 1024 - rise, 13 * 256, 1024 - rise + 12 * 128).input());
    std::map<std::string, std::uint64_t> groups;
    for (const auto& bin : golden.coverage().bins())
      if (bin.name.starts_with("group/")) groups[bin.name] = bin.hits;
    EXPECT_EQ(groups,
              (std::map<std::string, std::uint64_t>{
                  {"group/across", 1}, {"group/along", 2}, {"group/length", 1}, {"group/line", 1}}))
        << crossing;
    EXPECT_EQ(golden.work().groups, 5u);
  }
}

// The resolve needs the original colour of the pixel above or to the left if that pixel is blended
// too. The expected counts are derived from the weights.
TEST(Frame, OriginalsAreBlendedNeighboursAboveOrLeft) {
  GeometricGolden golden(Parameters{});
  golden.process(vector_drawing().input());
  const auto& weights = golden.weights();
  std::map<std::string, std::uint64_t> expected;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const Weights& w = weights[i];
    if (w == Weights{}) continue;
    const bool sideways = w[2] + w[3] > w[0] + w[1];
    const bool takes = w[sideways ? 2 : 0] != 0;
    const bool original = takes && weights[i - (sideways ? 1 : 61)] != Weights{};
    ++expected[!original ? "original/none" : sideways ? "original/left" : "original/above"];
  }
  for (const auto& bin : golden.coverage().bins()) {
    if (!bin.name.starts_with("original/")) continue;
    EXPECT_EQ(bin.hits, expected[bin.name]) << bin.name;
    EXPECT_GT(bin.hits, 20u);
  }
}

TEST(Frame, FrameWithoutEdgesIsUnchanged) {
  Drawing d = vector_drawing();
  d.edges.clear();
  GeometricGolden golden(preset_parameters(Preset::kGpaaOptimised));
  EXPECT_EQ(golden.process(d.input(kVectorBases)), d.colours);
  EXPECT_EQ(golden.work(), spec::geometric::Work{});
  EXPECT_EQ(golden.traffic().read(Region::kFaces).size(), 1u);
  EXPECT_EQ(golden.traffic().read(Region::kEdges).size(), 0u);
  EXPECT_EQ(golden.traffic().read(Region::kColour).size(),
            golden.traffic().write(Region::kCopy).size());
  EXPECT_EQ(golden.traffic().read(Region::kColour).size(), 8u * 6u * 4u);
}

TEST(Frame, RejectsTooSmallViews) {
  const Drawing d = vector_drawing();
  GeometricGolden golden(Parameters{});
  golden::geometric::FrameInput input;
  using F = golden::geometric::FrameInput;
  for (void (*const change)(F&) : std::initializer_list<void (*)(F&)>{
           [](F& f) { f.depth = {}; },
           [](F& f) { f.depth.width = 60; },
           [](F& f) { f.depth.height = 44; },
           [](F& f) { f.image.height = 46; },
           [](F& f) { f.image.stride = 60; },
           [](F& f) { f.facing.count = 1000; },
           [](F& f) { f.bases.copy = 32; },
       }) {
    input = d.input();
    change(input);
    EXPECT_THROW(golden.process(input), spec::CheckFailed);
  }
  input = d.input();
  input.image.width = 0;
  EXPECT_THROW(golden.process(input), spec::ConfigError);
  for (const std::uint32_t faces : {1u, 8u, 9u, 16u, 17u}) {  // one bit per face
    const std::uint32_t bytes = faces <= 8 ? 1 : faces <= 16 ? 2 : 3;
    input = d.input();
    input.facing.count = faces;
    input.facing.bytes = input.facing.bytes.first(bytes);
    EXPECT_NO_THROW(golden.process(input)) << faces;
    input.facing.bytes = input.facing.bytes.first(bytes - 1);
    EXPECT_THROW(golden.process(input), spec::CheckFailed) << faces;
  }
  // Rows of 61 pixels with a stride of 64: the last row may lack its padding, but no pixel.
  const std::vector<Rgba8> wide(std::size_t{64} * 45);
  const std::vector<std::uint32_t> wide_depths(std::size_t{64} * 45);
  for (const std::size_t missing : {0u, 3u, 4u}) {
    for (const bool shorten_depth : {false, true}) {
      input = d.input();
      if (shorten_depth) {
        input.depth = {std::span(wide_depths).first(wide_depths.size() - missing), 61, 45, 64};
      } else {
        input.image = {std::span(wide).first(wide.size() - missing), 61, 45, 64};
      }
      if (missing < 4) {
        EXPECT_NO_THROW(golden.process(input));
      } else {
        EXPECT_THROW(golden.process(input), spec::CheckFailed);
      }
    }
  }
}

// ---- addresses ----------------------------------------------------------------------------------

// The address formulas of docs/reference/geometric/memory.md for every pixel.
TEST(Layouts, EveryPixelHasItsOwnAddress) {
  for (const auto& [width, height] : {std::pair{61, 45}, {64, 8}, {1, 1}, {17, 9}}) {
    const FrameLayout raster(Layout::kRaster, width, height), tiled(Layout::kTiled, width, height);
    const int stride = (4 * width + 63) / 64 * 64, tiles = (width + 7) / 8;
    std::set<std::uint32_t> raster_places, tiled_places;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        EXPECT_EQ(raster.offset_of(x, y), static_cast<std::uint32_t>(y * stride + 4 * x));
        const int bx = x / 4, by = y / 4;
        const int place = 256 * ((y / 8) * tiles + x / 8) + 64 * (2 * (by % 2) + bx % 2) +
                          4 * (4 * (y % 4) + x % 4);
        EXPECT_EQ(tiled.offset_of(x, y), static_cast<std::uint32_t>(place));
        for (const FrameLayout* layout : {&raster, &tiled}) {
          EXPECT_EQ(layout->offset_of(layout->line_of(x, y)), layout->offset_of(x, y) / 64 * 64);
          EXPECT_LT(layout->offset_of(x, y), layout->bytes());
        }
        raster_places.insert(raster.offset_of(x, y));
        tiled_places.insert(tiled.offset_of(x, y));
      }
    }
    for (const FrameLayout* layout : {&raster, &tiled}) {
      EXPECT_EQ(layout->block_columns(), (width - 1) / 4 + 1);
      EXPECT_EQ(layout->block_rows(), (height - 1) / 4 + 1);
    }
    EXPECT_EQ(raster_places.size(), static_cast<std::size_t>(width * height));
    EXPECT_EQ(tiled_places.size(), static_cast<std::size_t>(width * height));
    EXPECT_EQ(raster.bytes(), static_cast<std::uint32_t>(height * stride));
    EXPECT_EQ(tiled.bytes(), static_cast<std::uint32_t>(256 * tiles * ((height + 7) / 8)));
  }
}

// With any write buffer, every block that is written is read again once, since the resolve reads
// the touched blocks that are not cached. More kept lines of colours need fewer reads.
TEST(Traffic, WeightBlocksAreReadAsOftenAsWritten) {
  Parameters p;
  p.weight_blocks = CacheLines::k16;
  std::size_t colours = ~std::size_t{0};
  for (const int places : {0, 1, 3, 16, 128}) {
    p.write_buffer = p.colour_lines = places;
    GeometricGolden golden(p);
    golden.process(vector_drawing().input(kVectorBases));
    auto written = golden.traffic().write(Region::kWeights),
         read = golden.traffic().read(Region::kWeights);
    std::sort(written.begin(), written.end());
    std::sort(read.begin(), read.end());
    EXPECT_EQ(read, written) << places;
    EXPECT_LT(golden.traffic().read(Region::kColour).size(), colours) << places;
    colours = golden.traffic().read(Region::kColour).size();
  }
}

// ---- errors -------------------------------------------------------------------------------------

GeometricGolden with_error(const Parameters& p, const Drawing& d, std::uint32_t address) {
  GeometricGolden golden(p);
  golden.set_memory_errors([=](std::uint32_t a) { return a == address; });
  golden.process(d.input(kVectorBases));
  EXPECT_GT(golden.memory_errors(), 0u) << std::hex << address;
  return golden;
}

// Each row makes one line unreadable. The facing bits take three lines of 512 faces each.
TEST(MemoryErrors, UnreadableInputLinesAreZeros) {
  Drawing d = vector_drawing();
  tb::Random random(6);
  for (std::uint32_t face = 0; face < 1200; ++face) d.set_facing(face, random.chance(500));
  for (auto& edge : d.edges) {
    edge.f0 = random.below(1200);
    edge.f1 = random.below(1200);
  }
  struct Row {
    std::uint32_t address;
    void (*change)(Drawing&);
  };
  const auto golden_of = [&](const Drawing& drawing) {
    GeometricGolden golden(Parameters{});
    golden.process(drawing.input(kVectorBases));
    return golden;
  };
  for (const Row& row : {
           Row{kVectorBases.edges + 64,
               [](Drawing& c) { std::fill_n(&c.edges[4], 4, spec::geometric::Edge{}); }},
           Row{kVectorBases.vertices,
               [](Drawing& c) { std::fill_n(&c.vertices[0], 4, spec::geometric::Vertex{}); }},
           Row{kVectorBases.vertices + 128,
               [](Drawing& c) { std::fill_n(&c.vertices[8], 4, spec::geometric::Vertex{}); }},
           Row{kVectorBases.facing, [](Drawing& c) { std::fill_n(&c.facing[0], 64, 0); }},
           Row{kVectorBases.facing + 64, [](Drawing& c) { std::fill_n(&c.facing[64], 64, 0); }},
           Row{kVectorBases.facing + 128, [](Drawing& c) { std::fill_n(&c.facing[128], 22, 0); }},
           // Line 5 of the tiled buffer: block (3, 0).
           Row{kVectorBases.depth + 5 * 64,
               [](Drawing& c) {
                 for (std::size_t i = 0; i < 16; ++i) c.depths[i / 4 * 61 + 12 + i % 4] = 0;
               }},
       }) {
    Drawing changed = d;
    row.change(changed);
    const GeometricGolden golden = with_error(Parameters{}, d, row.address),
                          expected = golden_of(changed);
    EXPECT_EQ(golden.classes(), expected.classes()) << std::hex << row.address;
    EXPECT_EQ(golden.pixels(), expected.pixels()) << std::hex << row.address;
    EXPECT_EQ(golden.work(), expected.work()) << std::hex << row.address;
    EXPECT_NE(golden.work(), golden_of(d).work()) << std::hex << row.address;
  }
}

// The resolve reads an unreadable line of colours as zeros and does not write it. An unreadable
// line of the copy also reads as zeros, but the line of the frame is written.
TEST(MemoryErrors, UnreadableColoursAreZeros) {
  const Drawing d = vector_drawing();
  GeometricGolden clean(Parameters{});
  clean.process(d.input(kVectorBases));
  for (const bool copy : {false, true}) {
    Parameters p;
    p.frame_copy = copy;
    const GeometricGolden golden =
        with_error(p, d, (copy ? kVectorBases.copy : kVectorBases.colour) + 256);
    EXPECT_EQ(golden.weights(), clean.weights());
    EXPECT_NE(golden.pixels(), clean.pixels());
    const auto block = std::find_if(golden.blocks().begin(), golden.blocks().end(),
                                    [](const auto& b) { return b.x == 2 && b.y == 0; });
    ASSERT_NE(block, golden.blocks().end());
    EXPECT_NE(block->blended, 0);
    for (std::size_t i = 0; i < 16; ++i) {
      const bool blended = (block->blended >> i & 1) != 0;
      const std::size_t place = i / 4 * 61 + 8 + i % 4;
      EXPECT_EQ(golden.pixels()[place], copy && blended ? block->pixels[i] : d.colours[place]);
      if (blended) {
        EXPECT_EQ(block->pixels[i][3], 0);
      }
    }
  }
}

// A block whose weights cannot be read stays touched, but none of its pixels is blended; other
// blocks do not change.
TEST(MemoryErrors, UnreadableWeightsAreZeros) {
  const Drawing d = vector_drawing();
  Parameters p;
  p.weight_blocks = CacheLines::k16;
  GeometricGolden clean(p);
  clean.process(d.input(kVectorBases));
  for (const std::size_t which : {std::size_t{0}, clean.blocks().size() - 1}) {
    const auto& block = clean.blocks()[which];
    const GeometricGolden golden =
        with_error(p, d, kVectorBases.weights + 64 * (16u * block.y + block.x));
    EXPECT_EQ(golden.work().blocks, clean.work().blocks);
    EXPECT_EQ(golden.blocks()[which].blended, 0);
    for (int y = 0; y < 45; ++y) {
      for (int x = 0; x < 61; ++x) {
        const auto i = static_cast<std::size_t>(61 * y + x);
        const bool unreadable_line = x / 4 == block.x && y / 4 == block.y;
        EXPECT_EQ(golden.weights()[i], unreadable_line ? Weights{} : clean.weights()[i])
            << x << ' ' << y;
      }
    }
  }
}

// Detail::kPixels models memory errors as well, but records nothing else.
TEST(MemoryErrors, FastModeModelsMemoryErrors) {
  GeometricGolden golden(Parameters{}, GeometricGolden::Detail::kPixels), all(Parameters{});
  for (GeometricGolden* g : {&golden, &all}) {
    g->set_memory_errors([](std::uint32_t a) { return a % 1024 == 64; });
    g->process(vector_drawing().input(kVectorBases));
  }
  EXPECT_EQ(golden.pixels(), all.pixels());
  EXPECT_EQ(golden.work(), all.work());
  EXPECT_GT(golden.memory_errors(), 10u);
  EXPECT_EQ(golden.memory_errors(), all.memory_errors());
  EXPECT_TRUE(golden.classes().empty() && golden.lines().empty());
  EXPECT_TRUE(golden.candidates().empty() && golden.blocks().empty());
  for (const auto& bin : golden.coverage().bins()) EXPECT_EQ(bin.hits, 0u) << bin.name;
}

// Unreadable depth counts as the farthest, so a line farther than everything else is visible there,
// in every row and column of the unreadable line.
TEST(MemoryErrors, UnreadableDepthHidesNothing) {
  for (const Layout layout : {Layout::kRaster, Layout::kTiled}) {
    Drawing d = one_line(192, 0, 192, 16 * 256);  // 3/4 of column 0
    std::fill(d.depths.begin(), d.depths.end(), 8000000);
    d.vertices[0].depth = d.vertices[1].depth = 1;
    Parameters p;
    p.layout = layout;
    p.depth_test = spec::geometric::DepthTest::kOwn;  // the neighbour is in the same line
    GeometricGolden golden(p);
    golden.process(d.input(kVectorBases));
    EXPECT_EQ(golden.work().candidates, 16u);
    EXPECT_EQ(golden.work().passed, 0u);
    const FrameLayout frame(layout, 16, 16);
    const std::uint32_t unreadable_line = frame.offset_of(frame.line_of(0, 5));
    golden.set_memory_errors(
        [=](std::uint32_t a) { return a == kVectorBases.depth + unreadable_line; });
    golden.process(d.input(kVectorBases));
    for (int y = 0; y < 16; ++y) {
      const bool unreadable = frame.offset_of(frame.line_of(0, y)) == unreadable_line;
      EXPECT_EQ(golden.weights()[static_cast<std::size_t>(16 * y)] != Weights{}, unreadable) << y;
    }
    EXPECT_EQ(golden.work().passed, layout == Layout::kTiled ? 4u : 1u);
  }
}

TEST(MemoryErrors, EachFailedResponseIsCountedOnce) {
  GeometricGolden golden(preset_parameters(Preset::kGpaaOptimised));
  golden.set_memory_errors([](std::uint32_t) { return true; });
  golden.process(vector_drawing().input(kVectorBases));
  std::uint64_t accesses = 0;
  for (const auto& list : golden.traffic().reads) accesses += list.size();
  for (const auto& list : golden.traffic().writes) accesses += list.size();
  EXPECT_EQ(golden.memory_errors(), accesses);
  EXPECT_EQ(golden.work().edges, 300u);
  EXPECT_EQ(golden.work().outside_edges, golden.work().kept_edges);
}

}  // namespace
}  // namespace deburr::frames_test
