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

// `max` of distances, creases of any depth, nothing that is turned away.
Parameters plain_configuration() {
  Parameters p;
  p.cull = spec::geometric::Cull::kBack;
  p.coverage = spec::geometric::CoverageRule::kDistance;
  p.crease_depth = 0;
  p.combine = Combine::kMax;
  return p;
}

// What costs more than that.
Parameters all_configuration() {
  Parameters p;
  p.cull = spec::geometric::Cull::kNone;
  p.coverage = spec::geometric::CoverageRule::kArea;
  p.crease_depth = 4;
  p.combine = Combine::kOutermost;
  return p;
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

// A line of slope 1/2 that is 1/8 below the centre of row 4's top half: in every other column it
// leaves its pixel, by 3/8 from its centre, and cuts a corner of the next.
TEST(Frame, ASteepLineBlendsTheSecondPixelOfAColumnToo) {
  const auto at = [](int x, int y) { return static_cast<std::size_t>(16 * y + x); };
  for (const bool swapped : {false, true}) {
    const int from = 4 * 256 + 32, to = from + 8 * 256;
    const Drawing d = swapped ? one_line(from, 0, to, 16 * 256) : one_line(0, from, 16 * 256, to);
    const auto weight = [&](const GeometricGolden& golden, int column, int row) {
      const Weights& w = golden.weights()[swapped ? at(row, column) : at(column, row)];
      return swapped ? Weights{w[2], w[3], w[0], w[1]} : w;  // before, behind
    };
    Parameters p = plain_configuration();
    GeometricGolden plain(p);
    plain.process(d.input());
    EXPECT_EQ(weight(plain, 1, 4), (Weights{0, 32, 0, 0}));
    EXPECT_EQ(weight(plain, 1, 5), (Weights{}));
    p.coverage = spec::geometric::CoverageRule::kArea;
    GeometricGolden area(p);
    area.process(d.input());
    for (const int period : {0, 1, 2, 5}) {  // a row further every two columns
      const int c = 2 * period, r = 4 + period;
      EXPECT_EQ(weight(area, c, r), (Weights{96, 0, 0, 0}));  // stays: 1/8 above the centre
      EXPECT_EQ(weight(area, c + 1, r), (Weights{0, 35, 0, 0}));
      EXPECT_EQ(weight(area, c + 1, r + 1), (Weights{4, 0, 0, 0}));
    }
    EXPECT_EQ(area.work().columns, 16u);
    EXPECT_EQ(area.work().groups, plain.work().groups);
    EXPECT_EQ(plain.work().candidates, 16u);
    EXPECT_EQ(area.work().candidates, 24u);
    EXPECT_EQ(area.work().passed, 24u);
    // The second follows the first, and has its depth.
    const auto& second = area.candidates()[2];
    EXPECT_EQ(second.x, swapped ? 5 : 1);
    EXPECT_EQ(second.y, swapped ? 1 : 5);
    EXPECT_EQ(second.direction,
              swapped ? spec::geometric::Direction::kLeft : spec::geometric::Direction::kUp);
    EXPECT_EQ(second.depth, 0xFFFFFFu);
    EXPECT_EQ(area.traffic().read(Region::kDepth), plain.traffic().read(Region::kDepth));
  }
}

// The pixel that a line cuts from outside of the frame has no neighbour to take from.
TEST(Frame, SecondPixelsAreOfLinesInTheFrame) {
  Parameters p;
  p.coverage = spec::geometric::CoverageRule::kArea;
  GeometricGolden golden(p);
  for (const int outside : {-300, 300}) {
    // Slope 1; its centres lie 44 / 256 outside of row 0 or row 15 on the diagonal.
    const Drawing d = one_line(0, 0, 16 * 256, 16 * 256);
    Drawing moved = d;
    for (auto& v : moved.vertices) v.y += outside;
    golden.process(moved.input());
    for (const auto& c : golden.candidates()) {
      EXPECT_LT(c.x, 16);
      EXPECT_LT(c.y, 16);
      const auto direction = static_cast<int>(c.direction);
      const int nx = c.x + (direction == 3) - (direction == 2);
      const int ny = c.y + (direction == 1) - (direction == 0);
      EXPECT_TRUE(nx >= 0 && nx < 16 && ny >= 0 && ny < 16) << c.x << ' ' << c.y;
    }
    EXPECT_GT(golden.work().candidates, 20u);
  }
}

// One test for both pixels of a column: with `own` that of the pixel in which the line's centre is.
TEST(Frame, SecondCandidatesShareTheTestOfTheFirst) {
  Drawing d = one_line(0, 4 * 256 + 32, 16 * 256, 12 * 256 + 32);
  for (auto& v : d.vertices) v.depth = 5000000;
  tb::Random random(3);
  for (auto& depth : d.depths) depth = random.chance(500) ? 4000000 : 6000000;
  for (const auto test : {spec::geometric::DepthTest::kOwn, spec::geometric::DepthTest::kFarther}) {
    Parameters p;
    p.coverage = spec::geometric::CoverageRule::kArea;
    p.depth_test = test;
    GeometricGolden golden(p);
    golden.process(d.input());
    int passed = 0, failed = 0;
    for (std::size_t i = 0; i + 1 < golden.candidates().size(); ++i) {
      const auto &first = golden.candidates()[i], &second = golden.candidates()[i + 1];
      if (second.x != first.x) continue;
      EXPECT_EQ(second.passed, first.passed);
      ++(first.passed ? passed : failed);
    }
    EXPECT_GT(passed, 0);
    EXPECT_GT(failed, 0);
    EXPECT_EQ(passed + failed, 8);
  }
}

// Two lines between the same two rows: the nearer pixel gives away no more than its outermost line
// cuts off, the farther one as much as the outermost one covers.
TEST(Frame, OutermostIsTheSmallestOfWhatIsNearer) {
  for (const bool own_nearer : {false, true}) {
    for (const bool turned : {false, true}) {
      Drawing d = one_line(0, 8 * 256 - 64, 16 * 256, 8 * 256 - 64);
      d.vertices.push_back({0, 8 * 256 - 96, 0xFFFFFF, true});
      d.vertices.push_back({16 * 256, 8 * 256 - 96, 0xFFFFFF, true});
      d.edges.push_back({2, 3, 0, 0, spec::geometric::flag::kBoundary});
      if (turned) std::swap(d.edges[0], d.edges[1]);
      for (std::size_t i = 0; i < d.depths.size(); ++i)
        d.depths[i] = (i < std::size_t{16} * 8) == own_nearer ? 9000 : 3000;
      Parameters p;
      p.combine = Combine::kOutermost;
      GeometricGolden golden(p);
      golden.process(d.input());
      for (std::size_t x = 0; x < 16; ++x) {
        EXPECT_EQ(golden.weights()[7 * 16 + x],
                  (Weights{0, static_cast<std::uint8_t>(own_nearer ? 64 : 96), 0, 0}));
      }
      for (const auto test : {spec::geometric::DepthTest::kOwn, spec::geometric::DepthTest::kOff}) {
        p.depth_test = test;
        GeometricGolden blind(p);
        blind.process(d.input());
        EXPECT_EQ(blind.weights()[7 * 16], (Weights{0, 96, 0, 0}));
      }
    }
  }
}

// A crease on the rim of what stands in front of something far is no edge of the far one.
TEST(Frame, CreasesAreLimitedInDepthAndOtherEdgesAreNot) {
  Drawing d = one_line(0, 8 * 256 - 64, 16 * 256, 8 * 256 - 64);
  for (auto& v : d.vertices) v.depth = 8000000;
  for (std::size_t i = 0; i < d.depths.size(); ++i)
    d.depths[i] = i < std::size_t{16} * 8 ? 8000000 : i % 16 < 8 ? 7500000 : 7499999;
  for (const bool crease : {false, true}) {
    d.edges[0].flags = crease ? spec::geometric::flag::kSeam : spec::geometric::flag::kBoundary;
    for (const int limit : {0, 4}) {
      Parameters p;
      p.crease_depth = limit;
      GeometricGolden golden(p);
      golden.process(d.input());
      EXPECT_EQ(golden.lines()[0].crease, crease);
      EXPECT_EQ(golden.work().candidates, 16u);
      EXPECT_EQ(golden.work().passed, crease && limit == 4 ? 8u : 16u);
    }
  }
}

TEST(Frame, WithoutCullingEdgesThatAreTurnedAwayAreClassified) {
  Drawing d = one_line(0, 8 * 256 - 64, 16 * 256, 8 * 256 - 64);
  d.set_facing(0, false);
  const auto turned_away = [](const GeometricGolden& golden) {
    std::string names;
    for (const auto& bin : golden.coverage().bins())
      if (bin.hits != 0 && bin.name.starts_with("turned-away/")) names += bin.name.substr(12);
    return names;
  };
  for (const auto& [flags, kept] :
       {std::pair{std::uint8_t{0}, false}, {spec::geometric::flag::kSeam, true}}) {
    d.edges[0].flags = flags;
    Parameters p = plain_configuration();
    GeometricGolden culled(p);
    culled.process(d.input());
    EXPECT_EQ(culled.work().back_edges, 1u);
    EXPECT_EQ(culled.work().kept_edges, 0u);
    EXPECT_EQ(turned_away(culled), "back/back");
    p.cull = spec::geometric::Cull::kNone;
    GeometricGolden golden(p);
    golden.process(d.input());
    EXPECT_EQ(golden.work().back_edges, 0u);
    EXPECT_EQ(golden.work().crease_edges, kept ? 1u : 0u);
    EXPECT_EQ(golden.work().flat_edges, kept ? 0u : 1u);
    EXPECT_EQ(turned_away(golden), kept ? "none/crease" : "none/flat");
    EXPECT_EQ(golden.work().passed, kept ? 16u : 0u);
  }
}

TEST(Frame, NeighboursOutsideAreNoCandidates) {
  for (const auto& [y, direction] : {std::pair{64, 0}, {16 * 256 - 64, 1}}) {
    GeometricGolden golden(Parameters{});
    golden.process(one_line(0, y, 16 * 256, y).input());
    EXPECT_EQ(golden.work().columns, 16u);
    EXPECT_EQ(golden.work().candidates, 0u) << direction;
  }
}

TEST(Frame, OnlyWithLastTheOrderOfEdgesMatters) {
  Drawing d = vector_drawing();
  tb::Random random(8);
  for (const Combine combine : {Combine::kMax, Combine::kLast, Combine::kOutermost}) {
    Parameters p = all_configuration();
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

// What is built changes traffic and groups, and nothing else.
TEST(Frame, PixelsDoNotDependOnTheBuild) {
  const Drawing d = vector_drawing();
  GeometricGolden reference(all_configuration());
  reference.process(d.input());
  for (const Layout layout : {Layout::kRaster, Layout::kTiled}) {
    for (const Lanes walkers : {Lanes::kOne, Lanes::kTwo, Lanes::kFour}) {
      for (const CacheLines lines : {CacheLines::k16, CacheLines::k1024}) {
        for (const bool copy : {false, true}) {
          Parameters p = all_configuration();
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

TEST(Frame, LeavesNothingInTheNextOne) {
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

TEST(Frame, RejectsViewsThatAreTooSmall) {
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

// A unit that takes a group of columns at a time looks the block of the first candidates up before
// that of the second ones: the same lines in the same order as column by column.
TEST(Traffic, GroupsHaveTwoBlocksAtMostTheFirstOnesFirst) {
  const Drawing d = vector_drawing();
  Parameters p = all_configuration();
  p.weight_blocks = CacheLines::k16;
  std::uint64_t pairs = 0;
  for (const auto test : {spec::geometric::DepthTest::kOwn, spec::geometric::DepthTest::kFarther}) {
    p.depth_test = test;
    if (test == spec::geometric::DepthTest::kOwn) p.combine = Combine::kMax;
    GeometricGolden golden(p);
    golden.process(d.input(kVectorBases));
    std::vector<std::uint32_t> expected;
    golden::geometric::DirectMapped cache;
    cache.reset(4, 2);
    std::set<std::uint32_t> touched;
    const auto look_up = [&](std::uint32_t bx, std::uint32_t by) {
      std::uint64_t replaced = 0;
      const std::uint32_t address = kVectorBases.weights + 64 * (by * 16 + bx);
      if (!cache.look_up(bx, by, replaced) && touched.contains(address))
        expected.push_back(address);
      touched.insert(address);
    };
    auto candidate = golden.candidates().begin();
    for (const auto& line : golden.lines()) {
      const bool horizontal = line.axis == spec::geometric::Axis::kHorizontal;
      std::int64_t position = line.position;
      // Columns of a group, and the blocks of what passed in it.
      int size = 0, group = 0;
      std::vector<std::pair<std::uint32_t, std::uint32_t>> first, second;
      const auto close = [&] {
        const std::set<std::pair<std::uint32_t, std::uint32_t>> own(first.begin(), first.end());
        std::set<std::pair<std::uint32_t, std::uint32_t>> other(second.begin(), second.end());
        ASSERT_LE(own.size(), 1u);
        for (const auto& block : own) other.erase(block);
        ASSERT_LE(other.size(), 1u);
        pairs += other.size();
        for (const auto& [bx, by] : own) look_up(bx, by);
        for (const auto& [bx, by] : other) look_up(bx, by);
        first.clear();
        second.clear();
        size = 0;
      };
      for (int c = line.first; c < line.first + line.count; ++c, position += line.slope) {
        const int row = static_cast<int>(position >> 24);
        if (size == 4 || c % 4 == 0 || (row >> 2) != group) close();
        group = row >> 2;
        ++size;
        bool is_second = false;
        for (; candidate != golden.candidates().end() &&
               (horizontal ? candidate->x : candidate->y) == c &&
               std::abs((horizontal ? candidate->y : candidate->x) - row) == (is_second ? 1 : 0);
             ++candidate) {
          auto& list = is_second ? second : first;
          if (candidate->passed) list.emplace_back(candidate->x / 4u, candidate->y / 4u);
          is_second = true;
        }
      }
      close();
    }
    ASSERT_TRUE(candidate == golden.candidates().end());
    const auto& reads = golden.traffic().read(Region::kWeights);
    ASSERT_GE(reads.size(), expected.size());
    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), reads.begin()));
    EXPECT_GT(expected.size(), 300u);
  }
  EXPECT_GT(pairs, 100u);
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
  // Pixels of a line of colours are zeros to the resolve, and it writes none of them.
  const auto in_block = [](std::size_t i) { return i / 4 * 61 + 8 + i % 4; };  // (2, 0)
  const auto blended_in_block = [](const GeometricGolden& golden) {
    const auto found = std::find_if(golden.blocks().begin(), golden.blocks().end(),
                                    [](const auto& b) { return b.x == 2 && b.y == 0; });
    EXPECT_NE(found, golden.blocks().end());
    EXPECT_NE(found->blended, 0);
    return *found;
  };
  with_error(kVectorBases.colour + 256, [&](const GeometricGolden& golden) {
    EXPECT_EQ(golden.weights(), clean.weights());
    EXPECT_NE(golden.pixels(), clean.pixels());
    const auto block = blended_in_block(golden);
    for (std::size_t i = 0; i < 16; ++i) {
      EXPECT_EQ(golden.pixels()[in_block(i)], d.colours[in_block(i)]);
      if (block.blended >> i & 1) {
        EXPECT_EQ(block.pixels[i][3], 0);
      }
    }
  });
  // Of a line of the copy they are zeros, too, and the frame's own line is written.
  p.frame_copy = true;
  with_error(kVectorBases.copy + 256, [&](const GeometricGolden& golden) {
    EXPECT_EQ(golden.weights(), clean.weights());
    const auto block = blended_in_block(golden);
    for (std::size_t i = 0; i < 16; ++i) {
      if (block.blended >> i & 1) {
        EXPECT_EQ(golden.pixels()[in_block(i)][3], 0);
        EXPECT_EQ(golden.pixels()[in_block(i)], block.pixels[i]);
      } else {
        EXPECT_EQ(golden.pixels()[in_block(i)], d.colours[in_block(i)]);
      }
    }
  });
  p.frame_copy = false;
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

// Whenever a block's weights are lost, those of all other blocks stay, and with `max` it has no
// larger ones.
TEST(MemoryErrors, LoseTheWeightsOfOneBlock) {
  const Drawing d = vector_drawing();
  Parameters p = plain_configuration();
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
