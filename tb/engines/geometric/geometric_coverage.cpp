// SPDX-License-Identifier: MIT
#include "tb/engines/geometric/geometric_coverage.h"

#include <fmt/format.h>

#include <array>
#include <map>
#include <string>
#include <vector>

#include "spec/geometric/registers.h"

namespace deburr::tb {
namespace {

constexpr std::array kGroups = {
    CoverageGroup{"geometric/class",
                  "Edges by rules (select, crease) and class. Only in tests: invalid edges, which "
                  "name a missing vertex or face, and all with off, which no run uses."},
    CoverageGroup{"geometric/turned-away", "Edges of two back faces, by the effect of cull."},
    CoverageGroup{"geometric/line", "Lines by octant and length."},
    CoverageGroup{"geometric/fate", "Kept edges by outcome."},
    CoverageGroup{"geometric/columns", "Lines by the ends clipped by the frame."},
    CoverageGroup{"geometric/rows", "Lines by their position relative to the frame's rows."},
    CoverageGroup{"geometric/tie", "Lines exactly through a pixel's centre."},
    CoverageGroup{"geometric/border", "Candidates whose neighbour is outside the frame."},
    CoverageGroup{"geometric/depth",
                  "Depth tests against the farther pixel, by which pixel is farther and outcome."},
    CoverageGroup{"geometric/crease",
                  "Crease candidates that passed the other depth test: near enough, or too far "
                  "before the compared depth."},
    CoverageGroup{"geometric/second",
                  "Second candidates of a column: in the block of the first, or in another."},
    CoverageGroup{"geometric/weight",
                  "Weights by direction and what happened to the previous weight."},
    CoverageGroup{"geometric/group", "Groups of columns by what ended them."},
    CoverageGroup{"geometric/group-lines", "Groups by layout and number of depth lines looked up."},
    CoverageGroup{"geometric/fetch", "Lookups of the golden model, by cache and outcome."},
    CoverageGroup{"geometric/coarse",
                  "Coarse depth test of the golden model (coarse_lines): candidates dropped by "
                  "direction, candidates just not dropped, and which of two tiles hides less."},
    CoverageGroup{"geometric/screen", "The same for the hardware."},
    CoverageGroup{"geometric/lookup", "Lookups of the hardware, by cache and outcome."},
    CoverageGroup{"geometric/pair-lookup",
                  "Pair lookups of the hardware, by array and outcome (records = split). Only in "
                  "tests: a vertex out of range, and a number beyond the array."},
    CoverageGroup{"geometric/block", "Weight blocks by the state of their cache entry."},
    CoverageGroup{"geometric/write-buffer",
                  "Blocks by the state of the write buffer, and its fill level at the end."},
    CoverageGroup{"geometric/colour", "Colour lines by the state of the kept lines."},
    CoverageGroup{"geometric/resolve", "Blended pixels by the neighbours used."},
    CoverageGroup{"geometric/original", "Source of the colour before blending."},
    CoverageGroup{"geometric/lines", "Blocks by layout and number of colour lines read."},
    CoverageGroup{"geometric/stall", "Stall cycles of a unit, by cause."},
    CoverageGroup{"geometric/error",
                  "Lines with an error response, by region (memory.error_address). Such a run "
                  "fails, so only tests cover all regions."},
    CoverageGroup{"geometric/rejection",
                  "Rejected starts; only in tests, since a run is checked before it starts."}};

// Stall causes of each unit, as in docs/reference/geometric/hardware.md. The sequencer never
// stalls; the port belongs to the fabric.
const std::map<std::string, std::vector<std::string>>& stalls() {
  static const std::map<std::string, std::vector<std::string>> all = {
      {"facing_store", {"downstream", "memory"}},
      {"edge_reader", {"downstream", "facing", "edges"}},
      {"edge_classifier", {"downstream"}},
      {"pair_fetch", {"downstream", "pairs", "fills"}},
      {"vertex_fetch", {"downstream", "vertices", "fills"}},
      {"line_setup", {"downstream", "divider"}},
      {"line_walker", {"downstream"}},
      {"coverage_unit", {"downstream"}},
      {"depth_screen", {"downstream", "coarse", "fills"}},
      {"depth_test", {"downstream", "depth", "fills"}},
      {"weight_combiner", {"downstream", "weights", "fills", "spill"}},
      {"block_scanner", {"downstream"}},
      {"block_fetch", {"downstream", "weights", "colours"}},
      {"resolver", {"downstream", "colours"}},
      {"frame_copier", {"downstream", "memory"}},
      {"memory_arbiter", {"downstream"}}};
  return all;
}

constexpr std::array<std::string_view, 2> kPairsOutOfRange = {"vertex/invalid", "number/invalid"};

// Bins by index in the unit's histograms.
constexpr std::array<std::string_view, 4> kDroppedSides = {"dropped-up", "dropped-down",
                                                           "dropped-left", "dropped-right"};
constexpr std::array<std::string_view, 2> kLesserTiles = {"own-tile-lesser", "other-tile-lesser"};
constexpr std::string_view kAtBound = "kept-at-bound";

void cover_screen(Coverage& coverage, const rtl::geometric::GeometricEngine& e) {
  if (!e.depth_screen) return;
  const auto hit = [&](std::string_view bin, std::uint64_t count) {
    if (count != 0) coverage.hit(fmt::format("geometric/screen/{}", bin), count);
  };
  const auto hit_bins = [&](const auto& names, const rtl::Histogram& histogram) {
    for (const auto& bin : histogram.bins())
      if (bin.low < names.size()) hit(names[bin.low], bin.count);
  };
  hit_bins(kDroppedSides, e.depth_screen->dropped_sides);
  hit_bins(kLesserTiles, e.depth_screen->lesser_tiles);
  hit(kAtBound, e.depth_screen->kept_at_bound.value());
}

void cover_pairs(Coverage& coverage, const rtl::geometric::GeometricEngine& e) {
  if (!e.pair_fetch) return;
  const auto looked = [&](const char* array, std::uint64_t lookups, std::uint64_t lines) {
    coverage.hit(fmt::format("geometric/pair-lookup/{}/hit", array), lookups - lines);
    coverage.hit(fmt::format("geometric/pair-lookup/{}/miss", array), lines);
  };
  const auto& pairs = *e.pair_fetch;
  const std::uint64_t boundaries = pairs.boundary_lookups.value(),
                      lines = pairs.boundary_lines.value();
  looked("boundary", boundaries, lines);
  looked("other", pairs.lookups.value() - boundaries, pairs.lines_read.value() - lines);
  const std::array counts = {pairs.invalid_edges.value(), e.edge_classifier.unpaired_edges.value()};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    const std::string bin = fmt::format("geometric/pair-lookup/{}", kPairsOutOfRange[i]);
    coverage.declare(bin);
    coverage.hit(bin, counts[i]);
  }
}

// Whether only directed tests can hit this bin of the golden model. Edge tables of meshes contain
// no invalid references, and creases are not classified when all edges are drawn, except by
// presets.
bool is_directed(const std::string& bin) {
  return bin.ends_with("/invalid") || bin.starts_with("class/all/off/");
}

// Every block that enters an empty entry leaves one block in it at the end of the frame, itself or
// a later one.
void hit_write_buffer(Coverage& coverage, const rtl::geometric::WeightCombiner& weights,
                      const spec::geometric::Parameters& parameters) {
  const std::uint64_t at_end = weights.buffered_blocks.sum();
  coverage.hit("geometric/write-buffer/hit", weights.buffer_hits.value());
  coverage.hit("geometric/write-buffer/empty", at_end);
  coverage.hit("geometric/write-buffer/leaves", weights.blocks_written.value() - at_end);
  for (const auto& bin : weights.buffered_blocks.bins())
    coverage.hit(bin.low == static_cast<std::uint64_t>(parameters.write_buffer)
                     ? "geometric/write-buffer/full-at-end"
                     : "geometric/write-buffer/not-full-at-end",
                 bin.count);
}

}  // namespace

std::span<const CoverageGroup> geometric_coverage_groups() { return kGroups; }

Coverage declared_geometric_coverage() {
  Coverage coverage;
  for (const auto& bin : golden::geometric::EdgeCoverage().bins())
    if (!is_directed(bin.name)) coverage.declare("geometric/" + bin.name);
  for (int lines = 1; lines <= 8; ++lines)
    coverage.declare(fmt::format("geometric/group-lines/raster/{}", lines));
  for (int lines = 1; lines <= 2; ++lines)
    coverage.declare(fmt::format("geometric/group-lines/tiled/{}", lines));
  for (const char* const cache : {"vertex", "depth", "weight"})
    for (const char* const outcome : {"hit", "miss"})
      coverage.declare(fmt::format("geometric/lookup/{}/{}", cache, outcome));
  for (const char* const array : {"boundary", "other"})
    for (const char* const outcome : {"hit", "miss"})
      coverage.declare(fmt::format("geometric/pair-lookup/{}/{}", array, outcome));
  for (const std::string_view what : kDroppedSides)
    coverage.declare(fmt::format("geometric/screen/{}", what));
  for (const std::string_view what : kLesserTiles)
    coverage.declare(fmt::format("geometric/screen/{}", what));
  coverage.declare(fmt::format("geometric/screen/{}", kAtBound));
  for (const char* const what : {"fresh", "cached", "replaced", "read-back", "waited-for"})
    coverage.declare(fmt::format("geometric/block/{}", what));
  for (const char* const what : {"hit", "empty", "leaves", "full-at-end", "not-full-at-end"})
    coverage.declare(fmt::format("geometric/write-buffer/{}", what));
  for (const char* const what : {"hit", "free", "replaces"})
    coverage.declare(fmt::format("geometric/colour/{}", what));
  for (const auto& [unit, causes] : stalls())
    for (const std::string& cause : causes)
      coverage.declare(fmt::format("geometric/stall/{}/{}", unit, cause));
  return coverage;
}

void declare_directed_geometric_coverage(Coverage& coverage) {
  for (const auto& bin : golden::geometric::EdgeCoverage().bins())
    if (is_directed(bin.name)) coverage.declare("geometric/" + bin.name);
  for (const std::string_view what : kPairsOutOfRange)
    coverage.declare(fmt::format("geometric/pair-lookup/{}", what));
  for (const std::string_view region : spec::geometric::kRegionNames)
    coverage.declare(fmt::format("geometric/error/{}", region));
  for (std::size_t i = 1; i < spec::geometric::kRejectionNames.size(); ++i)
    coverage.declare(fmt::format("geometric/rejection/{}", spec::geometric::kRejectionNames[i]));
}

Coverage geometric_coverage(const rtl::geometric::GeometricEngine& e,
                            const golden::geometric::EdgeCoverage& golden,
                            const spec::geometric::Parameters& parameters) {
  Coverage coverage = declared_geometric_coverage();
  for (const auto& bin : golden.bins()) {
    if (is_directed(bin.name) && bin.hits == 0) continue;
    coverage.declare("geometric/" + bin.name);
    coverage.hit("geometric/" + bin.name, bin.hits);
  }
  const bool tiled = parameters.layout == spec::geometric::Layout::kTiled;
  for (const auto& bin : e.depth_test.group_lines.bins())
    if (bin.count != 0)
      coverage.hit(fmt::format("geometric/group-lines/{}/{}", tiled ? "tiled" : "raster", bin.low),
                   bin.count);
  const auto looked = [&](const char* cache, const rtl::Counter& lookups,
                          const rtl::Counter& misses) {
    coverage.hit(fmt::format("geometric/lookup/{}/hit", cache), lookups.value() - misses.value());
    coverage.hit(fmt::format("geometric/lookup/{}/miss", cache), misses.value());
  };
  const auto& weights = e.weight_combiner;
  looked("vertex", e.vertex_fetch.lookups, e.vertex_fetch.misses);
  looked("depth", e.depth_test.lookups, e.depth_test.misses);
  looked("weight", weights.lookups, weights.misses);
  cover_pairs(coverage, e);
  cover_screen(coverage, e);
  coverage.hit("geometric/block/fresh", weights.misses.value() - weights.blocks_read.value());
  coverage.hit("geometric/block/cached", weights.lookups.value() - weights.misses.value());
  coverage.hit("geometric/block/replaced", weights.blocks_written.value());
  coverage.hit("geometric/block/read-back", weights.blocks_read.value());
  if (parameters.write_buffer > 0) hit_write_buffer(coverage, weights, parameters);
  if (parameters.colour_lines > 0) {
    const auto& fetch = e.block_fetch;
    coverage.hit("geometric/colour/hit", fetch.lines_kept.value());
    coverage.hit("geometric/colour/free", fetch.lines_read.value() - fetch.lines_replaced.value());
    coverage.hit("geometric/colour/replaces", fetch.lines_replaced.value());
  }
  for (const rtl::Unit* unit : e.units()) {
    if (!stalls().contains(unit->basename())) continue;
    for (const auto& cause : unit->stalls()) {
      if (cause.cycles == 0) continue;
      coverage.hit(fmt::format("geometric/stall/{}/{}", unit->basename(), cause.name),
                   cause.cycles);
      if (unit == &weights && cause.name == "spill")
        coverage.hit("geometric/block/waited-for", cause.cycles);
    }
  }
  return coverage;
}

}  // namespace deburr::tb
