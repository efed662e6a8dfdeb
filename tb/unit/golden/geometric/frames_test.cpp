// SPDX-License-Identifier: MIT
// Does a whole frame keep its promises: order, walkers, layouts, addresses, traffic, errors?
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

using golden::geometric::Bases;
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

// A drawing of one line over black and white halves, everything in front.
Drawing one_line(int x0, int y0, int x1, int y1, int width = 16, int height = 16) {
  Drawing d(width, height);
  std::fill(d.colours.begin(), d.colours.end(), Rgba8{255, 255, 255, 255});
  std::fill_n(d.colours.begin(), d.colours.size() / 2, Rgba8{0, 0, 0, 255});
  d.vertices = {{x0, y0, 0xFFFFFF, true}, {x1, y1, 0xFFFFFF, true}};
  d.set_facing(0, true);
  d.edges = {{0, 1, 0, 0, spec::geometric::flag::kBoundary}};
  return d;
}

TEST(Frame, ALineBetweenTwoRowsBlendsByHalfOfWhatItCuts) {
  // 64 / 256 above the border between rows 7 and 8: row 7 is cut a quarter from below.
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

TEST(Frame, NeighboursOutsideAreNoCandidates) {
  for (const auto& [y, direction] : {std::pair{64, 0}, {16 * 256 - 64, 1}}) {
    GeometricGolden golden(Parameters{});
    golden.process(one_line(0, y, 16 * 256, y).input());
    EXPECT_EQ(golden.work().columns, 16u);
    EXPECT_EQ(golden.work().candidates, 0u) << direction;
  }
}

TEST(Frame, WithMaxTheOrderOfEdgesDoesNotMatter) {
  Drawing d = vector_drawing();
  tb::Random random(8);
  for (const Combine combine : {Combine::kMax, Combine::kLast}) {
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
    EXPECT_EQ(same, combine == Combine::kMax);
  }
}

// What is built changes traffic and groups, and nothing else.
TEST(Frame, PixelsDoNotDependOnTheBuild) {
  const Drawing d = vector_drawing();
  GeometricGolden reference(Parameters{});
  reference.process(d.input());
  for (const Layout layout : {Layout::kRaster, Layout::kTiled}) {
    for (const Lanes walkers : {Lanes::kOne, Lanes::kTwo, Lanes::kFour}) {
      for (const CacheLines lines : {CacheLines::k16, CacheLines::k1024}) {
        for (const bool copy : {false, true}) {
          Parameters p;
          p.layout = layout;
          p.walkers = walkers;
          p.depth_lines = p.weight_blocks = p.vertex_lines = lines;
          p.frame_copy = copy;
          GeometricGolden golden(p);
          golden.process(d.input());
          EXPECT_EQ(golden.pixels(), reference.pixels());
          EXPECT_EQ(golden.weights(), reference.weights());
          EXPECT_EQ(golden.candidates(), reference.candidates());
          EXPECT_EQ(golden.lines(), reference.lines());
          EXPECT_EQ(golden.blocks(), reference.blocks());
          spec::geometric::Work work = golden.work();
          if (walkers == Lanes::kOne) {
            EXPECT_EQ(work.groups, work.columns);
          }
          EXPECT_LE(work.groups, work.columns);
          work.groups = reference.work().groups;
          EXPECT_EQ(work, reference.work());
        }
      }
    }
  }
}

TEST(Frame, CountsAddUp) {
  for (const Preset preset : {Preset::kGpaa, Preset::kGpaaOptimised, Preset::kDeburr}) {
    GeometricGolden golden(preset_parameters(preset));
    golden.process(vector_drawing().input());
    const auto& w = golden.work();
    EXPECT_EQ(w.kept_edges, w.outside_edges + w.degenerate_edges + w.empty_edges + w.lines);
    EXPECT_EQ(golden.classes().size(), w.edges);
    EXPECT_EQ(golden.lines().size(), w.lines);
    EXPECT_EQ(golden.candidates().size(), w.candidates);
    EXPECT_EQ(golden.blocks().size(), w.blocks);
    const auto& pixels = golden.weights();
    EXPECT_EQ(static_cast<std::uint64_t>(std::count_if(
                  pixels.begin(), pixels.end(), [](const Weights& x) { return x != Weights{}; })),
              w.blended_pixels);
  }
}

// Of a line over columns 1 to 12 that enters the next row of blocks at column 5, 6 or 7: the group
// before ends there, those before columns 4 and 8 with their block, and 8 to 11 are four.
TEST(Frame, GroupsEndWithBlocksAndWalkers) {
  for (const int crossing : {5, 6, 7}) {
    const int rise = 128 * (crossing - 1);  // half a row a column
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

// Whose colour as it was a pixel is given: that of the pixel above or to the left, if that one is
// blended too. Counted again from the weights.
TEST(Frame, OriginalsAreNeighboursThatAreBlendedToo) {
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

TEST(Frame, WithoutEdgesNothingChanges) {
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

TEST(Frame, RefusesViewsThatAreTooSmall) {
  const Drawing d = vector_drawing();
  GeometricGolden golden(Parameters{});
  auto input = d.input();
  input.depth = {};
  EXPECT_THROW(golden.process(input), spec::CheckFailed);
  input = d.input();
  input.image.height = 46;
  EXPECT_THROW(golden.process(input), spec::CheckFailed);
  input = d.input();
  input.facing.count = 1000;
  EXPECT_THROW(golden.process(input), spec::CheckFailed);
  for (const std::uint32_t faces : {1u, 7u, 8u, 9u, 16u, 17u}) {  // a bit each
    const std::uint32_t bytes = faces <= 8 ? 1 : faces <= 16 ? 2 : 3;
    input = d.input();
    input.facing.count = faces;
    input.facing.bytes = input.facing.bytes.first(bytes);
    EXPECT_NO_THROW(golden.process(input)) << faces;
    input.facing.bytes = input.facing.bytes.first(bytes - 1);
    EXPECT_THROW(golden.process(input), spec::CheckFailed) << faces;
  }
  // Rows of 61 pixels at a distance of 64: the last one may end before its gap, not earlier.
  std::vector<Rgba8> wide(std::size_t{64} * 45);
  std::vector<std::uint32_t> wide_depths(std::size_t{64} * 45);
  for (const std::size_t missing : {0u, 3u, 4u}) {
    input = d.input();
    input.image = {std::span(wide).first(wide.size() - missing), 61, 45, 64};
    const auto both = [&] { golden.process(input); };
    if (missing < 4) {
      EXPECT_NO_THROW(both());
    } else {
      EXPECT_THROW(both(), spec::CheckFailed);
    }
    input = d.input();
    input.depth = {std::span(wide_depths).first(wide_depths.size() - missing), 61, 45, 64};
    if (missing < 4) {
      EXPECT_NO_THROW(both());
    } else {
      EXPECT_THROW(both(), spec::CheckFailed);
    }
  }
  input = d.input();
  input.depth.width = 60;
  EXPECT_THROW(golden.process(input), spec::CheckFailed);
  input = d.input();
  input.depth.height = 44;
  EXPECT_THROW(golden.process(input), spec::CheckFailed);
  input = d.input();
  input.image.stride = 60;
  EXPECT_THROW(golden.process(input), spec::CheckFailed);
  input = d.input();
  input.bases.copy = 32;
  EXPECT_THROW(golden.process(input), spec::CheckFailed);
  input = d.input();
  input.image.width = 0;
  EXPECT_THROW(golden.process(input), spec::ConfigError);
}

// ---- addresses ----------------------------------------------------------------------------------

// The tables of the page against a walk over memory.
TEST(Layouts, EveryPixelHasAPlaceOfItsOwn) {
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

// Blocks that are replaced come back once each, and every touched block is read or cached at last.
TEST(Traffic, WeightsComeBackAsOftenAsTheyWent) {
  Parameters p;
  p.weight_blocks = CacheLines::k16;
  GeometricGolden golden(p);
  golden.process(vector_drawing().input(kVectorBases));
  std::map<std::uint32_t, int> away;
  for (const std::uint32_t a : golden.traffic().write(Region::kWeights)) ++away[a];
  for (const std::uint32_t a : golden.traffic().read(Region::kWeights)) --away[a];
  for (const auto& [address, times] : away) EXPECT_EQ(times, 0) << address;
}

// Traffic of the resolve from weights alone: what is read and written of colours.
TEST(Traffic, ColoursFollowFromTheWeights) {
  for (const Layout layout : {Layout::kRaster, Layout::kTiled}) {
    Parameters p;
    p.layout = layout;
    GeometricGolden golden(p);
    golden.process(vector_drawing().input(kVectorBases));
    const FrameLayout frame(layout, 61, 45);
    std::vector<std::uint32_t> reads, writes;
    for (const auto& block : golden.blocks()) {
      using Key = std::pair<int, int>;  // v, u
      std::set<Key> read, written;
      const auto line = [&](int x, int y) {
        return layout == Layout::kTiled ? Key{y / 4, x / 4} : Key{y, x / 16};
      };
      for (int i = 0; i < 16; ++i) {
        if ((block.blended >> i & 1) == 0) continue;
        const int x = 4 * block.x + i % 4, y = 4 * block.y + i / 4;
        const auto& w = block.weights[static_cast<std::size_t>(i)];
        const bool sideways = w[2] + w[3] > w[0] + w[1];
        read.insert(line(x, y));
        written.insert(line(x, y));
        if (sideways && w[2] != 0) read.insert(line(x - 1, y));
        if (sideways && w[3] != 0) read.insert(line(x + 1, y));
        if (!sideways && w[0] != 0) read.insert(line(x, y - 1));
        if (!sideways && w[1] != 0) read.insert(line(x, y + 1));
      }
      const auto append = [&](const std::set<Key>& lines, std::vector<std::uint32_t>& list) {
        for (const auto& [v, u] : lines)
          list.push_back(kVectorBases.colour + frame.offset_of({static_cast<std::uint32_t>(u),
                                                                static_cast<std::uint32_t>(v)}));
      };
      append(read, reads);
      append(written, writes);
    }
    EXPECT_EQ(golden.traffic().read(Region::kColour), reads);
    EXPECT_EQ(golden.traffic().write(Region::kColour), writes);
  }
}

// ---- errors -------------------------------------------------------------------------------------

// One line of each region after the other cannot be read.
TEST(MemoryErrors, ReadAsZeros) {
  const Drawing d = vector_drawing();
  Parameters p;
  p.weight_blocks = CacheLines::k16;
  const auto with_error = [&](std::uint32_t address, auto&& check) {
    GeometricGolden golden(p);
    golden.set_memory_errors([=](std::uint32_t a) { return a == address; });
    golden.process(d.input(kVectorBases));
    EXPECT_GT(golden.memory_errors(), 0u) << std::hex << address;
    check(golden);
  };
  const auto expect_same_as = [&](const Drawing& changed) {
    return [&](const GeometricGolden& golden) {
      GeometricGolden clean(p);
      clean.process(changed.input(kVectorBases));
      EXPECT_EQ(golden.pixels(), clean.pixels());
      EXPECT_EQ(golden.work(), clean.work());
    };
  };
  Drawing changed = d;
  for (std::size_t i = 4; i < 8; ++i) changed.edges[i] = {};
  with_error(kVectorBases.edges + 64, expect_same_as(changed));
  for (const std::uint32_t line : {0u, 2u}) {
    changed = d;
    for (std::size_t i = 4 * line; i < 4 * line + 4; ++i) changed.vertices[i] = {};
    with_error(kVectorBases.vertices + 64 * line, expect_same_as(changed));
  }
  changed = d;
  std::fill(changed.facing.begin(), changed.facing.end(), 0);
  with_error(kVectorBases.facing, expect_same_as(changed));
  changed = d;
  for (std::size_t i = 0; i < 16; ++i)  // line 5 of the tiled buffer: block (3, 0)
    changed.depths[i / 4 * 61 + 12 + i % 4] = 0;
  with_error(kVectorBases.depth + 256 + 64, expect_same_as(changed));
  GeometricGolden clean(p);
  clean.process(d.input(kVectorBases));
  // Pixels of a line of colours are black where they are blended, untouched where not.
  with_error(kVectorBases.colour + 256, [&](const GeometricGolden& golden) {
    EXPECT_EQ(golden.weights(), clean.weights());
    EXPECT_NE(golden.pixels(), clean.pixels());
    for (std::size_t i = 0; i < 16; ++i) {
      const std::size_t k = i / 4 * 61 + 8 + i % 4;
      if (golden.weights()[k] == Weights{}) {
        EXPECT_EQ(golden.pixels()[k], d.colours[k]);
      } else {
        EXPECT_EQ(golden.pixels()[k][3], 0);
      }
    }
  });
  // A block whose weights are lost is touched and has no blended pixel.
  const std::uint32_t lost = clean.traffic().read(Region::kWeights).back();
  with_error(lost, [&](const GeometricGolden& golden) {
    EXPECT_EQ(golden.work().blocks, clean.work().blocks);
    EXPECT_LT(golden.work().blended_pixels, clean.work().blended_pixels);
    const auto block = (lost - kVectorBases.weights) / 64;
    const auto found = std::find_if(golden.blocks().begin(), golden.blocks().end(),
                                    [&](const auto& b) { return b.y * 16u + b.x == block; });
    ASSERT_NE(found, golden.blocks().end());
    EXPECT_EQ(found->blended, 0);
  });
}

// Faces of the second line of facing bits, 512 and on, apart from those of the first.
TEST(MemoryErrors, FacingBitsReadAsZerosALineAtATime) {
  Drawing d = vector_drawing();
  tb::Random random(6);
  for (std::uint32_t face = 0; face < 1200; ++face) d.set_facing(face, random.chance(500));
  for (auto& edge : d.edges) {
    edge.f0 = random.below(1200);
    edge.f1 = random.below(1200);
  }
  GeometricGolden clean(Parameters{});
  std::set<std::uint64_t> outcomes;
  for (const std::uint32_t line : {0u, 1u, 2u}) {
    GeometricGolden golden(Parameters{});
    golden.set_memory_errors([=](std::uint32_t a) { return a == kVectorBases.facing + 64 * line; });
    golden.process(d.input(kVectorBases));
    EXPECT_EQ(golden.memory_errors(), 1u);
    Drawing changed = d;
    const std::size_t first = std::size_t{64} * line;
    for (std::size_t i = first; i < first + 64 && i < changed.facing.size(); ++i)
      changed.facing[i] = 0;
    clean.process(changed.input(kVectorBases));
    EXPECT_EQ(golden.classes(), clean.classes());
    EXPECT_EQ(golden.pixels(), clean.pixels());
    outcomes.insert(golden.work().silhouette_edges);
  }
  EXPECT_EQ(outcomes.size(), 3u);
}

// Lost lines must be followed without any detail, too; nothing else comes of it.
TEST(MemoryErrors, NeedNoDetail) {
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

// Whenever a block's weights are lost, those of all other blocks stay, and it has no larger ones.
TEST(MemoryErrors, LoseTheWeightsOfOneBlock) {
  const Drawing d = vector_drawing();
  Parameters p;
  p.weight_blocks = CacheLines::k16;
  GeometricGolden clean(p);
  clean.process(d.input(kVectorBases));
  const auto& reads = clean.traffic().read(Region::kWeights);
  const std::set<std::uint32_t> addresses(reads.begin(), reads.end());
  // The resolve reads last, in ascending order.
  const std::set<std::uint32_t> resolved(
      std::is_sorted_until(reads.rbegin(), reads.rend(), std::greater<>()).base(), reads.end());
  int changed = 0;
  for (const std::uint32_t lost : addresses) {
    GeometricGolden golden(p, GeometricGolden::Detail::kPixels);
    golden.set_memory_errors([=](std::uint32_t a) { return a == lost; });
    golden.process(d.input(kVectorBases));
    const int block = static_cast<int>((lost - kVectorBases.weights) / 64);
    for (int y = 0; y < 45; ++y) {
      for (int x = 0; x < 61; ++x) {
        const auto i = static_cast<std::size_t>(61 * y + x);
        const Weights& all = clean.weights()[i];
        const Weights& left = golden.weights()[i];
        if (y / 4 * 16 + x / 4 != block) {
          ASSERT_EQ(left, all) << x << ' ' << y << " of block " << block;
        } else {
          for (std::size_t k = 0; k < 4; ++k) EXPECT_LE(left[k], all[k]);
          changed += left != all;
          if (resolved.contains(lost)) {
            EXPECT_EQ(left, Weights{});
          }
        }
      }
    }
  }
  EXPECT_GT(addresses.size(), 50u);
  EXPECT_GT(resolved.size(), 50u);
  EXPECT_GT(changed, 100);
}

// What cannot be read is as far as can be, so that a line behind everything else is seen there, in
// every row and column of it.
TEST(MemoryErrors, DepthThatCannotBeReadHidesNothing) {
  for (const Layout layout : {Layout::kRaster, Layout::kTiled}) {
    Drawing d = one_line(192, 0, 192, 16 * 256);  // 3/4 of column 0
    std::fill(d.depths.begin(), d.depths.end(), 8000000);
    d.vertices[0].depth = d.vertices[1].depth = 1;
    Parameters p;
    p.layout = layout;
    p.depth_test = spec::geometric::DepthTest::kOwn;  // the neighbour is lost with the pixel
    GeometricGolden golden(p);
    golden.process(d.input(kVectorBases));
    EXPECT_EQ(golden.work().candidates, 16u);
    EXPECT_EQ(golden.work().passed, 0u);
    const FrameLayout frame(layout, 16, 16);
    const std::uint32_t lost = frame.offset_of(frame.line_of(0, 5));
    golden.set_memory_errors([=](std::uint32_t a) { return a == kVectorBases.depth + lost; });
    golden.process(d.input(kVectorBases));
    for (int y = 0; y < 16; ++y) {
      const bool there = frame.offset_of(frame.line_of(0, y)) == lost;
      EXPECT_EQ(golden.weights()[static_cast<std::size_t>(16 * y)] != Weights{}, there) << y;
    }
    EXPECT_EQ(golden.work().passed, layout == Layout::kTiled ? 4u : 1u);
  }
}

TEST(MemoryErrors, AreCountedOnceAResponse) {
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
