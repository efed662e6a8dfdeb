// SPDX-License-Identifier: MIT
// Functional coverage of the geometric engine over frames that run through the hardware model:
// golden's bins (golden/geometric/edge_coverage.h), and bins that only the hardware can hit:
// lookups, blocks, rejected starts, memory errors, stalls. Every bin must be hit, with every frame
// identical to golden.
#include "tb/engines/geometric/geometric_coverage.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "spec/error.h"
#include "tb/base/forked.h"
#include "tb/system/coverage_text.h"
#include "tb/system/geometric_runs.h"

namespace deburr::tb::geometric_system::geometric_coverage_test {
namespace {

using spec::geometric::Crease;
using spec::geometric::Region;
using spec::geometric::Select;
namespace reg = spec::geometric::reg;

Coverage declared() {
  Coverage coverage = declared_geometric_coverage();
  declare_directed_geometric_coverage(coverage);
  return coverage;
}

std::string run(const std::vector<Frame>& frames, const GeometricRunOptions& options) {
  return forked_text([&] {
    Simulation simulation(options);
    GeometricEnvironment environment(simulation, frames, options);
    simulation.elaborate(environment);
    simulation.run();
    environment.check();
    return text_of(environment.coverage());
  });
}

// Vertical lines through the sixteenth column, whose neighbours are in another memory line, with
// none, some or all of the four pixels of a group; and lines that fill a block.
Frame columns() {
  Frame frame = random_frame(70, 50, 3, 1);
  ScreenEdges& screen = frame.screen;
  screen.vertices.clear();
  screen.edges.clear();
  std::fill(frame.depths.begin(), frame.depths.end(), 1000u);
  const auto line = [&](int x0, int y0, int x1, int y1) {
    const auto v = static_cast<std::uint32_t>(screen.vertices.size());
    screen.vertices.push_back({x0, y0, 1'000'000, true});
    screen.vertices.push_back({x1, y1, 1'000'000, true});
    screen.edges.push_back({v, v + 1, 0, 0, spec::geometric::flag::kBoundary});
  };
  for (int across = 0; across <= 4; ++across)  // of the rows of block 3
    for (int rows = across; rows <= 4; ++rows) {
      const int y = 256 * 12, middle = 16 * 256 + 128, slant = 20;
      // The line is to the left of the pixels' centres in the first `across` rows.
      line(middle - slant * across, y, middle + slant * (rows - across), y + 256 * rows);
    }
  // A block at the start of a memory line, blended with its left, upper and lower neighbours.
  line(16 * 256 + 64, 2048, 16 * 256 + 64, 3072);
  line(17 * 256, 8 * 256 + 64, 20 * 256, 8 * 256 + 64);
  line(17 * 256, 11 * 256 + 192, 20 * 256, 11 * 256 + 192);
  return frame;
}

// Lines along and across tile borders. Every other tile is farther, so that some lines are hidden
// by their bounds and others just miss being hidden.
Frame tiles() {
  Frame frame = random_frame(70, 50, 4, 1);
  ScreenEdges& screen = frame.screen;
  screen.vertices.clear();
  screen.edges.clear();
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 70; ++x)
      frame.depths[static_cast<std::size_t>(y * 70 + x)] =
          (x / 8 + y / 8) % 2 == 0 ? 1u << 20 : 1u << 21;
  const auto line = [&](int x0, int y0, int x1, int y1, std::uint32_t z) {
    const auto v = static_cast<std::uint32_t>(screen.vertices.size());
    screen.vertices.push_back({x0, y0, z, true});
    screen.vertices.push_back({x1, y1, z, true});
    screen.edges.push_back({v, v + 1, 0, 0, spec::geometric::flag::kBoundary});
  };
  constexpr std::uint32_t kHidden = 1000, kJustNot = (1u << 20) - (1u << 20 >> 9);
  for (const std::uint32_t z : {kHidden, kJustNot})
    for (int at = 300; at < 12'000; at += 850) {
      line(at, 300, at + 20, 12'000, z);
      line(300, at, 12'000, at + 20, z);
    }
  return frame;
}

// Short lines far apart, each of which needs another line of coarse depth; depth itself has been
// read when they recur.
Frame leaps() {
  Frame frame = random_frame(1024, 40, 5, 1);
  ScreenEdges& screen = frame.screen;
  screen.vertices.clear();
  screen.edges.clear();
  std::fill(frame.depths.begin(), frame.depths.end(), 1000u);
  for (std::uint32_t i = 0; i < 16; ++i) {
    const auto x = static_cast<std::int32_t>((i * 7 % 16 * 66 + 20) * 256);
    const auto y = static_cast<std::int32_t>((i % 2 * 32 + 4) * 256);
    screen.vertices.push_back({x, y, 1'000'000, true});
    screen.vertices.push_back({x + 600, y + 100, 1'000'000, true});
  }
  for (std::uint32_t i = 0; i < 256; ++i)
    screen.edges.push_back(
        {2 * (i % 16), 2 * (i % 16) + 1, 0, 0, spec::geometric::flag::kBoundary});
  return frame;
}

void run_frames(Coverage& coverage) {
  GeometricRunOptions coarse;
  coarse.geometric.coarse_lines = spec::geometric::CoarseLines::k4;
  coarse.geometric.fills = spec::geometric::kMinFills;
  coarse.memory.latency = 150;
  add_text(coverage, run({tiles()}, coarse));
  coarse.geometric.depth_lines = CacheLines::k1024;
  coarse.geometric.weight_blocks = CacheLines::k1024;
  coarse.geometric.latency_fifo = 1024;
  coarse.stall_permille = 250;
  add_text(coverage, run({leaps()}, coarse));
  GeometricRunOptions raster;
  raster.geometric.layout = Layout::kRaster;
  add_text(coverage, run({columns()}, raster));
  for (std::uint64_t seed = 0; seed < 12; ++seed)
    for (const Select select : {Select::kAll, Select::kEdges, Select::kMesh}) {
      std::size_t number = 2 * seed + (select != Select::kEdges);
      for (const Crease crease : {Crease::kOff, Crease::kPaper, Crease::kShading}) {
        GeometricRunOptions options;
        Parameters& p = options.geometric;
        p.select = select;
        p.crease = crease;
        p.layout = static_cast<Layout>(seed % 2);
        // Each option off and on, in several combinations.
        p.combine = static_cast<spec::geometric::Combine>(seed % 3);
        p.coverage = static_cast<spec::geometric::CoverageRule>(seed >> 1 & 1);
        p.cull = static_cast<spec::geometric::Cull>(seed >> 2 & 1);
        p.crease_depth = seed % 4 == 3 ? 0 : 4;
        p.depth_lines = p.weight_blocks = p.vertex_lines = CacheLines::k16;
        p.frame_copy = seed % 5 == 1;
        // Minimal sizes, so that every unit stalls sometimes.
        p.fills = spec::geometric::kMinFills;
        p.resolve_lines = 16;
        p.line_fifo = 2;
        p.edge_lines = 4;
        p.pipelined = number % 4 == 0;
        // Options that skip memory lines, in several combinations.
        p.records = static_cast<spec::geometric::RecordsLayout>(seed >> 1 & 1);
        p.colour_lines = seed % 3 == 0 ? 0 : seed % 3 == 1 ? 2 : 32;
        p.write_buffer = seed % 4 == 0 ? 0 : seed % 4 == 1 ? 2 : 128;
        if (seed % 4 == 3) p.weight_blocks = CacheLines::k128;  // the buffer is not full
        p.coarse_lines =
            seed % 5 < 2 ? spec::geometric::CoarseLines::kNone : spec::geometric::CoarseLines::k4;
        options.memory.latency = 3 + static_cast<int>(number * 7 % 50);
        options.memory.latency_max = number % 3 == 0 ? 150 : 0;
        options.memory.bytes_per_cycle = number % 2 == 0 ? 64 : 16;
        options.stall_permille = number % 3 == 1 ? 250 : 0;
        add_text(coverage, run({random_frame(70, 50, seed)}, options));
        ++number;
      }
    }
}

void run_errors(Coverage& coverage) {
  for (std::size_t region = 0; region < platform::GeometricRegions::kCount; ++region)
    add_text(coverage, forked_text([&] {
               GeometricRunOptions options;
               options.geometric.weight_blocks = CacheLines::k16;
               options.geometric.frame_copy = static_cast<Region>(region) == Region::kCopy;
               // Flags read as zeros shift the numbering of pairs.
               if (static_cast<Region>(region) == Region::kPairs ||
                   static_cast<Region>(region) == Region::kEdges)
                 options.geometric.records = spec::geometric::RecordsLayout::kSplit;
               if (static_cast<Region>(region) == Region::kEdges)
                 options.geometric.select = Select::kAll;  // kept in spite of the error
               if (static_cast<Region>(region) == Region::kCoarse)
                 options.geometric.coarse_lines = spec::geometric::CoarseLines::k4;
               const std::vector<Frame> frames = {random_frame(90, 50, 20)};
               options.memory.error_address =
                   regions_of(frames, options.geometric).base(static_cast<Region>(region));
               options.memory.error_bytes = 4096;
               Simulation simulation(options);
               GeometricEnvironment environment(simulation, frames, options);
               simulation.elaborate(environment);
               EXPECT_THROW(simulation.run(), spec::SimulationError);
               environment.check();
               return text_of(environment.coverage());
             }));
}

// Starts with one invalid value each.
void run_rejections(Coverage& coverage) {
  struct Row {
    std::uint32_t offset, value;
  };
  for (const Row& row : {Row{reg::kControl, reg::kControlStart}, Row{reg::kSize, 61},
                         Row{reg::kSize, 700 | 9 << 16}, Row{reg::kSize, 500 | 401 << 16},
                         Row{reg::kEdgeCount, (1 << 24) + 1}, Row{reg::kVertexCount, (1 << 24) + 1},
                         Row{reg::kFaceCount, 32769}, Row{reg::kBoundaryCount, 1 << 24}})
    add_text(coverage, forked_text([&] {
               GeometricRunOptions options;
               options.geometric.line_pixels = 512;
               options.geometric.touched_words = 100;
               options.geometric.records = spec::geometric::RecordsLayout::kSplit;
               Simulation simulation(options);
               const std::vector<Frame> frames = {random_frame(61, 45, 2)};
               GeometricEnvironment environment(simulation, frames, options);
               simulation.elaborate(environment);
               simulation.run();
               environment.host().write(row.offset, row.value);
               if (row.offset != reg::kControl)
                 environment.host().write(reg::kControl, reg::kControlEnable | reg::kControlStart);
               simulation.clock().run(2);
               return fmt::format(
                   "geometric/rejection/{} 1",
                   spec::geometric::kRejectionNames.at(environment.host().read(reg::kRejection)));
             }));
}

TEST(GeometricCoverage, EveryBinIsHit) {
  Coverage coverage = declared();
  run_frames(coverage);
  run_errors(coverage);
  run_rejections(coverage);
  EXPECT_GT(coverage.size(), 150u);
  EXPECT_TRUE(coverage.holes().empty()) << testing::PrintToString(coverage.holes());
}

// A single tiled frame: the bins it cannot hit are listed by name.
TEST(GeometricCoverage, MissedBinsAreListed) {
  Coverage coverage = declared();
  add_text(coverage, run({columns()}, {}));
  const std::vector<std::string> holes = coverage.holes();
  const std::set<std::string> empty(holes.begin(), holes.end());
  for (const char* const bin :
       {"geometric/group-lines/raster/8", "geometric/lines/raster/10", "geometric/rejection/width",
        "geometric/error/copy", "geometric/block/replaced", "geometric/stall/line_setup/divider",
        "geometric/class/all/off/unclassified", "geometric/line/left-up/below-pixel"})
    EXPECT_TRUE(empty.contains(bin)) << bin;
  for (const char* const bin :
       {"geometric/group-lines/tiled/1", "geometric/group-lines/tiled/2", "geometric/block/fresh",
        "geometric/class/edges/shading/boundary", "geometric/lookup/depth/hit"})
    EXPECT_FALSE(empty.contains(bin)) << bin;
  EXPECT_THROW(coverage.hit("geometric/group-lines/tiled/3"), spec::CheckFailed);
}

}  // namespace
}  // namespace deburr::tb::geometric_system::geometric_coverage_test
