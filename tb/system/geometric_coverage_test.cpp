// SPDX-License-Identifier: MIT
// Functional coverage of the geometric engine over frames that run through the hardware model:
// golden's bins (golden/geometric/edge_coverage.h), and those that the hardware alone can tell:
// look-ups, blocks, refusals, errors of memory, stalls. Every bin must be hit, with every frame
// identical to golden.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "spec/error.h"
#include "tb/harness/coverage.h"
#include "tb/harness/forked.h"
#include "tb/system/geometric_runs.h"

namespace deburr::tb::geometric_system {
namespace {

using spec::geometric::Crease;
using spec::geometric::Region;
using spec::geometric::Select;
namespace reg = spec::geometric::reg;

// Causes that a unit can lose a clock to, as docs/geometric_hardware.md has them.
const std::map<std::string, std::vector<std::string>> kStalls = {
    {"facing_store", {"downstream", "memory"}},
    {"edge_reader", {"downstream", "facing", "edges"}},
    {"edge_classifier", {"downstream"}},
    {"vertex_fetch", {"downstream", "vertices", "fills"}},
    {"line_setup", {"downstream", "divider"}},
    {"line_walker", {"downstream"}},
    {"coverage_unit", {"downstream"}},
    {"depth_test", {"downstream", "depth", "fills"}},
    {"weight_combiner", {"downstream", "weights", "fills", "spill"}},
    {"block_scanner", {"downstream"}},
    {"block_fetch", {"downstream", "weights", "colours"}},
    {"resolver", {"downstream", "colours"}},
    {"frame_copier", {"downstream", "memory"}},
    {"memory_arbiter", {"downstream"}}};

Coverage declared() {
  Coverage coverage;
  for (const auto& bin : golden::geometric::EdgeCoverage().bins()) coverage.declare(bin.name);
  for (int lines = 1; lines <= 8; ++lines)
    coverage.declare(fmt::format("group-lines/raster/{}", lines));
  for (int lines = 1; lines <= 2; ++lines)
    coverage.declare(fmt::format("group-lines/tiled/{}", lines));
  for (const char* const cache : {"vertex", "depth", "weight"})
    for (const char* const outcome : {"hit", "miss"})
      coverage.declare(fmt::format("look-up/{}/{}", cache, outcome));
  for (const char* const what : {"fresh", "cached", "replaced", "read-back", "waited-for"})
    coverage.declare(fmt::format("block/{}", what));
  for (std::size_t i = 1; i < spec::geometric::kRefusalNames.size(); ++i)
    coverage.declare(fmt::format("refusal/{}", spec::geometric::kRefusalNames[i]));
  for (const std::string_view region : spec::geometric::kRegionNames)
    coverage.declare(fmt::format("error/{}", region));
  for (const auto& [unit, causes] : kStalls)
    for (const std::string& cause : causes)
      coverage.declare(fmt::format("stall/{}/{}", unit, cause));
  return coverage;
}

// "bin hits" a line: it comes from another process.
class Hits {
 public:
  void hit(const std::string& bin, std::uint64_t times) {
    if (times != 0) text_ += fmt::format("{} {}\n", bin, times);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

void record(Coverage& coverage, const std::string& hits) {
  std::istringstream lines(hits);
  std::string bin;
  std::uint64_t times = 0;
  while (lines >> bin >> times) coverage.hit(bin, times);
}

std::string met(const rtl::geometric::GeometricEngine& e,
                const golden::geometric::EdgeCoverage& golden, const Parameters& p) {
  Hits hits;
  for (const auto& bin : golden.bins()) hits.hit(bin.name, bin.hits);
  const bool tiled = p.layout == Layout::kTiled;
  for (const auto& bin : e.depth_test.group_lines.bins())
    hits.hit(fmt::format("group-lines/{}/{}", tiled ? "tiled" : "raster", bin.low), bin.count);
  const auto looked = [&](const char* cache, const rtl::Counter& lookups,
                          const rtl::Counter& misses) {
    hits.hit(fmt::format("look-up/{}/hit", cache), lookups.value() - misses.value());
    hits.hit(fmt::format("look-up/{}/miss", cache), misses.value());
  };
  const auto& weights = e.weight_combiner;
  looked("vertex", e.vertex_fetch.lookups, e.vertex_fetch.misses);
  looked("depth", e.depth_test.lookups, e.depth_test.misses);
  looked("weight", weights.lookups, weights.misses);
  hits.hit("block/fresh", weights.misses.value() - weights.blocks_read.value());
  hits.hit("block/cached", weights.lookups.value() - weights.misses.value());
  hits.hit("block/replaced", weights.blocks_written.value());
  hits.hit("block/read-back", weights.blocks_read.value());
  for (const rtl::Unit* unit : e.units()) {
    const auto known = kStalls.find(unit->basename());
    if (known == kStalls.end()) continue;  // the sequencer never stalls; the port is the fabric's
    for (const auto& cause : unit->stalls()) {
      hits.hit(fmt::format("stall/{}/{}", unit->basename(), cause.name), cause.cycles);
      if (unit == &weights && cause.name == "spill") hits.hit("block/waited-for", cause.cycles);
    }
  }
  return hits.text();
}

std::string run(const std::vector<Frame>& frames, const GeometricRunOptions& options) {
  return forked_text([&] {
    Simulation simulation(options);
    GeometricEnvironment environment(simulation, frames, options);
    simulation.elaborate(environment);
    simulation.run();
    environment.check();
    return met(environment.engine(), environment.golden_model().coverage(), options.geometric);
  });
}

// Vertical lines through the sixteenth column, which have their neighbours in another line of
// memory: none, some or all of the four pixels of a group; and lines that fill a block.
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
      // The line is left of the pixels' centres in the first `across` rows.
      line(middle - slant * across, y, middle + slant * (rows - across), y + 256 * rows);
    }
  // A block at the start of a line of memory that is blended to the left, above and below.
  line(16 * 256 + 64, 2048, 16 * 256 + 64, 3072);
  line(17 * 256, 8 * 256 + 64, 20 * 256, 8 * 256 + 64);
  line(17 * 256, 11 * 256 + 192, 20 * 256, 11 * 256 + 192);
  return frame;
}

void run_frames(Coverage& coverage) {
  GeometricRunOptions raster;
  raster.geometric.layout = Layout::kRaster;
  record(coverage, run({columns()}, raster));
  for (std::uint64_t seed = 0; seed < 12; ++seed)
    for (const Select select : {Select::kAll, Select::kEdges}) {
      std::size_t number = 2 * seed + (select == Select::kAll);
      for (const Crease crease : {Crease::kOff, Crease::kPaper, Crease::kShading}) {
        GeometricRunOptions options;
        Parameters& p = options.geometric;
        p.select = select;
        p.crease = crease;
        p.layout = static_cast<Layout>(seed % 2);
        p.combine = static_cast<spec::geometric::Combine>(seed % 3 == 0);
        p.depth_lines = p.weight_blocks = p.vertex_lines = CacheLines::k16;
        p.frame_copy = seed % 5 == 1;
        // Little of everything, so that every unit waits now and then.
        p.fills = spec::geometric::kMinFills;
        p.resolve_lines = 16;
        p.line_fifo = 2;
        p.edge_lines = 4;
        p.pipelined = number % 4 == 0;
        options.memory.latency = 3 + static_cast<int>(number * 7 % 50);
        options.memory.latency_max = number % 3 == 0 ? 150 : 0;
        options.memory.bytes_per_clock = number % 2 == 0 ? 64 : 16;
        options.stall_permille = number % 3 == 1 ? 250 : 0;
        record(coverage, run({random_frame(70, 50, seed)}, options));
        ++number;
      }
    }
}

void run_errors(Coverage& coverage) {
  for (std::size_t region = 0; region < RegionMap::kRegions; ++region)
    record(coverage, forked_text([&] {
             GeometricRunOptions options;
             options.geometric.weight_blocks = CacheLines::k16;
             options.geometric.frame_copy = static_cast<Region>(region) == Region::kCopy;
             const std::vector<Frame> frames = {random_frame(90, 50, 20)};
             options.memory.error_address =
                 RegionMap(frames, options.geometric).base(static_cast<Region>(region));
             options.memory.error_bytes = 4096;
             Simulation simulation(options);
             GeometricEnvironment environment(simulation, frames, options);
             simulation.elaborate(environment);
             EXPECT_THROW(simulation.run(), spec::SimulationError);
             environment.check();
             Hits hits;
             hits.hit(fmt::format("error/{}", spec::geometric::kRegionNames[region]),
                      environment.host().read(reg::kMemoryErrors));
             return hits.text();
           }));
}

// A start with one value that the engine does not take.
void run_refusals(Coverage& coverage) {
  struct Row {
    std::uint32_t offset, value;
  };
  for (const Row& row :
       {Row{reg::kControl, reg::kControlStart}, Row{reg::kSize, 61}, Row{reg::kSize, 700 | 9 << 16},
        Row{reg::kSize, 500 | 401 << 16}, Row{reg::kEdgeCount, (1 << 24) + 1},
        Row{reg::kVertexCount, (1 << 24) + 1}, Row{reg::kFaceCount, 32769}})
    record(coverage, forked_text([&] {
             GeometricRunOptions options;
             options.geometric.line_pixels = 512;
             options.geometric.touched_words = 100;
             Simulation simulation(options);
             const std::vector<Frame> frames = {random_frame(61, 45, 2)};
             GeometricEnvironment environment(simulation, frames, options);
             simulation.elaborate(environment);
             simulation.run();
             environment.host().write(row.offset, row.value);
             if (row.offset != reg::kControl)
               environment.host().write(reg::kControl, reg::kControlEnable | reg::kControlStart);
             simulation.clock().run(2);
             Hits hits;
             hits.hit(fmt::format("refusal/{}", spec::geometric::kRefusalNames.at(
                                                    environment.host().read(reg::kRefusal))),
                      1);
             return hits.text();
           }));
}

TEST(GeometricCoverage, EveryBinIsHit) {
  Coverage coverage = declared();
  run_frames(coverage);
  run_errors(coverage);
  run_refusals(coverage);
  std::ofstream("geometric_coverage.json") << coverage.json();
  EXPECT_GT(coverage.size(), 150u);
  EXPECT_TRUE(coverage.holes().empty()) << testing::PrintToString(coverage.holes());
}

// A frame alone, in tiles: what it cannot show is listed by name.
TEST(GeometricCoverage, HolesAreListed) {
  Coverage coverage = declared();
  record(coverage, run({columns()}, {}));
  const std::vector<std::string> holes = coverage.holes();
  const std::set<std::string> empty(holes.begin(), holes.end());
  for (const char* const bin :
       {"group-lines/raster/8", "lines/raster/10", "refusal/width", "error/copy", "block/replaced",
        "stall/line_setup/divider", "class/all/off/unclassified", "line/left-up/below-pixel"})
    EXPECT_TRUE(empty.contains(bin)) << bin;
  for (const char* const bin : {"group-lines/tiled/1", "group-lines/tiled/2", "block/fresh",
                                "class/edges/shading/boundary", "look-up/depth/hit"})
    EXPECT_FALSE(empty.contains(bin)) << bin;
  EXPECT_THROW(coverage.hit("group-lines/tiled/3"), spec::CheckFailed);
}

}  // namespace
}  // namespace deburr::tb::geometric_system
