// SPDX-License-Identifier: MIT
// Figures, maps and expectations of runs of several frames that differ in size, mesh and traffic.
#include <array>
#include <cmath>
#include <numeric>

#include "spec/error.h"
#include "tb/engines/geometric/geometric_frames.h"
#include "tb/system/geometric_runs.h"
#include "tb/unit/engines/run_figures.h"

namespace deburr::tb::figures_test {
namespace {

using geometric::Frame;
using spec::geometric::CacheLines;
using spec::geometric::Region;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kMhz = 200;

const std::vector<Frame>& frames() {
  static const std::vector<Frame> all = {
      geometric_system::scene_frame("wheelcover", 90, 61),
      geometric_system::random_frame(33, 58, 7, 150),
      geometric_system::scene_frame("cylinders", 52, 40),
  };
  return all;
}

// Builds that together contain every part with counters.
GeometricSetup plain() {
  GeometricSetup setup;
  setup.geometric.depth_lines = setup.geometric.vertex_lines = setup.geometric.weight_blocks =
      CacheLines::k16;
  setup.geometric.pipelined = false;
  setup.geometric.dividers = 2;
  setup.memory.latency = 30;
  return setup;
}
GeometricSetup saving() {
  GeometricSetup setup = plain();
  setup.geometric.pipelined = true;
  setup.geometric.dividers = 1;
  setup.geometric.records = spec::geometric::RecordsLayout::kSplit;
  setup.geometric.coarse_lines = spec::geometric::CoarseLines::k4;
  setup.geometric.colour_lines = 8;
  setup.geometric.write_buffer = 8;
  return setup;
}

GeometricSetup copying() {
  GeometricSetup setup = saving();
  setup.geometric.frame_copy = true;
  return setup;
}
const std::vector<GeometricSetup>& setups() {
  static const std::vector<GeometricSetup> all = {plain(), saving(), copying()};
  return all;
}
// The arbiter's turn carries over from frame to frame: cycles by which each frame with a copy may
// differ.
double arbitration_cycles(const GeometricSetup& setup) {
  return setup.geometric.frame_copy ? 2 : 0;
}

struct Options : SimulationOptions {
  Options() {
    clock_mhz = kMhz;
    coverage = true;
  }
};

// Figures, maps, and the data that the environment reports.
Json run(const std::vector<Frame>& sequence, const GeometricSetup& setup,
         const SimulationOptions& options = Options()) {
  return Json::parse(forked_text([&] {
    Simulation simulation(options);
    GeometricEnvironment environment(simulation, sequence, setup);
    simulation.elaborate(environment);
    std::string error;
    try {
      simulation.run();
    } catch (const spec::Error& ended) {
      error = ended.what();
    }
    if (error.empty() || error.starts_with("memory answered")) environment.check();
    Json json = json_of(simulation);
    json["error"] = error;
    json["maps"] = json_of(environment.maps());
    const Amount amount = environment.amount();
    json["amount"] = {amount.delivered, amount.taken, amount.total, std::string(amount.unit)};
    json["hash"] = environment.pixel_hash();
    json["bound"] = environment.meter().frame_cycles_bound();
    // Memory lines by region that the golden model requested in the last frame.
    const golden::geometric::Traffic& traffic = environment.golden_model().traffic();
    for (std::size_t i = 0; i < traffic.reads.size(); ++i) {
      json["golden_reads"][std::string(spec::geometric::kRegionNames[i])] = traffic.reads[i].size();
      json["golden_writes"][std::string(spec::geometric::kRegionNames[i])] =
          traffic.writes[i].size();
    }
    json["blocks"] = environment.blocks().size();
    return json.dump();
  }));
}

std::vector<Json> each_alone(const GeometricSetup& setup) {
  std::vector<Json> alone;
  for (const Frame& frame : frames()) alone.push_back(run({frame}, setup));
  return alone;
}

const SeveralFrames kFigures = {
    .from_last = {"edge_cycles", "resolve_cycles", "frame_cycles", "frame_sequencer_frame_cycles",
                  "frame_sequencer_edge_cycles", "frame_sequencer_resolve_cycles"},
    .largest = {"memory_port_max_outstanding"},
    .by_formula = {"bytes_per_blended_pixel", "frame_bytes_per_blended_pixel", "columns_per_cycle",
                   "vertex_hits_percent", "depth_hits_percent", "weight_hits_percent",
                   "colour_hits_percent", "write_buffer_hits_percent", "divider_occupancy_percent",
                   "port_occupancy_percent", "frame_cycles_bound", "frame_rate",
                   "clock_for_60_frames"}};

void expect_formulas(const Json& r, const std::vector<Json>& alone, double dividers) {
  const auto w = [&](const char* name) { return work(r, name); };
  const auto hits = [&](const char* lookups, const char* misses) {
    return 100 * (w(lookups) - w(misses)) / w(lookups);
  };
  EXPECT_DOUBLE_EQ(w("vertex_hits_percent"), hits("vertex_fetch_lookups", "vertex_fetch_misses"));
  EXPECT_DOUBLE_EQ(w("depth_hits_percent"), hits("depth_test_lookups", "depth_test_misses"));
  EXPECT_DOUBLE_EQ(w("weight_hits_percent"),
                   hits("weight_combiner_lookups", "weight_combiner_misses"));
  EXPECT_DOUBLE_EQ(w("columns_per_cycle"), w("line_walker_columns") / w("line_walker_groups"));
  EXPECT_DOUBLE_EQ(w("bytes_per_blended_pixel"),
                   (number_at(r, "/memory/bytes_read") + number_at(r, "/memory/bytes_written")) /
                       w("resolver_blended_pixels"));
  EXPECT_DOUBLE_EQ(w("frame_bytes_per_blended_pixel"),
                   (64 * (w("lines_read_depth") + w("lines_read_coarse") + w("lines_read_weights") +
                          w("lines_read_colour") + w("lines_read_copy")) +
                    number_at(r, "/memory/bytes_written")) /
                       w("resolver_blended_pixels"));
  // The cycles of this run; the sum of separate runs differs from them by arbitration.
  const double cycles = number_at(r, "/cycles"),
               edge_cycles = cycles - sum_of(alone, "/work/resolve_cycles");
  EXPECT_DOUBLE_EQ(w("divider_occupancy_percent"),
                   100 * w("line_setup_divider_cycles") / (dividers * edge_cycles));
  EXPECT_DOUBLE_EQ(w("port_occupancy_percent"),
                   100 * (w("memory_port_reads") + w("memory_port_writes")) / cycles);
  const double last = w("frame_cycles");
  EXPECT_EQ(w("frame_cycles"), w("edge_cycles") + w("resolve_cycles"));
  EXPECT_DOUBLE_EQ(w("frame_rate"), kMhz * 1e6 / last);
  EXPECT_DOUBLE_EQ(w("clock_for_60_frames"), last * 60 / 1e6);
  EXPECT_DOUBLE_EQ(number_at(r, "/throughput/value"),
                   w("edge_classifier_edges") / number_at(r, "/cycles"));
  EXPECT_NEAR(number_at(r, "/throughput/bound"),
              w("edge_classifier_edges") / (3 * w("frame_cycles_bound")), 1e-3);
  EXPECT_LE(w("frame_cycles_bound"), cycles / 3);
}

TEST(GeometricFigures, ThreeFramesGiveSumsRatiosOrLastValues) {
  for (const GeometricSetup& setup : setups()) {
    const std::vector<Json> alone = each_alone(setup);
    const Json all = run(frames(), setup);
    expect_sums(all, alone, kFigures, arbitration_cycles(setup));
    expect_formulas(all, alone, setup.geometric.pipelined ? 13 : 2);
    EXPECT_EQ(all["latency"]["min"],
              std::min({number_at(alone[0], "/latency/min"), number_at(alone[1], "/latency/min"),
                        number_at(alone[2], "/latency/min")}));
    for (const auto& [name, memory] : all["memories"].items())
      EXPECT_EQ(memory["logical_bits_at_frame_width"],
                alone.back()["memories"][name]["logical_bits_at_frame_width"])
          << name;
    EXPECT_EQ(all["blocks"], alone.back()["blocks"]);
    EXPECT_EQ(all["blocks"], work(alone.back(), "resolver_blocks"));
    double edges = 0;
    for (const Frame& frame : frames()) edges += static_cast<double>(frame.screen.edges.size());
    EXPECT_EQ(all["amount"], Json({edges, edges, edges, "edge"}));
    OutputHash hash;
    for (const Frame& frame : frames()) {
      golden::geometric::GeometricGolden golden(setup.geometric);
      golden.process(frame.input());
      for (const Rgba8& p : golden.pixels())
        hash.add(p[0] | std::uint64_t{p[1]} << 8 | std::uint64_t{p[2]} << 16 |
                 std::uint64_t{p[3]} << 24);
    }
    EXPECT_EQ(all["hash"], hash.value());
    if (setup.geometric.records == spec::geometric::RecordsLayout::kSplit) {
      EXPECT_DOUBLE_EQ(work(all, "colour_hits_percent"), 100 * work(all, "block_fetch_lines_kept") /
                                                             (work(all, "block_fetch_lines_kept") +
                                                              work(all, "block_fetch_lines_read")));
      EXPECT_DOUBLE_EQ(work(all, "write_buffer_hits_percent"),
                       100 * work(all, "weight_combiner_buffer_hits") /
                           (work(all, "weight_combiner_buffer_hits") +
                            work(all, "weight_combiner_blocks_read")));
      EXPECT_EQ(work(all, "dropped_early"), work(all, "depth_screen_dropped"));
    }
  }
}

// docs/reference/coverage.md: hardware bins equal the counters of the units, and no bin of an
// unbuilt part is hit.
void expect_bins(const Json& r, const GeometricSetup& setup) {
  const auto w = [&](const std::string& name) {
    return r["work"].contains(name) ? work(r, name) : 0;
  };
  const auto bin = [&](const std::string& name) { return hits(r, "geometric/" + name); };
  const auto expect_lookups = [&](const std::string& cache, double lookups, double misses) {
    EXPECT_EQ(bin(cache + "/hit"), lookups - misses) << cache;
    EXPECT_EQ(bin(cache + "/miss"), misses) << cache;
  };
  const double weights = w("weight_combiner_lookups"), missed = w("weight_combiner_misses"),
               read_back = w("weight_combiner_blocks_read");
  expect_lookups("lookup/vertex", w("vertex_fetch_lookups"), w("vertex_fetch_misses"));
  expect_lookups("lookup/depth", w("depth_test_lookups"), w("depth_test_misses"));
  expect_lookups("lookup/weight", weights, missed);
  const double boundaries = w("pair_fetch_boundary_lookups"),
               boundary_lines = w("pair_fetch_boundary_lines");
  expect_lookups("pair-lookup/boundary", boundaries, boundary_lines);
  expect_lookups("pair-lookup/other", w("pair_fetch_lookups") - boundaries,
                 w("pair_fetch_lines_read") - boundary_lines);
  EXPECT_EQ(bin("block/fresh"), missed - read_back);
  EXPECT_EQ(bin("block/cached"), weights - missed);
  EXPECT_EQ(bin("block/replaced"), w("weight_combiner_blocks_written"));
  EXPECT_EQ(bin("block/read-back"), read_back);
  EXPECT_EQ(bin("block/waited-for"), r["units"]["weight_combiner"]["stalls"]["spill"]);
  // Each frame ends with the buffer full or not. A block put into an empty entry is still there or
  // has left.
  const bool buffered = setup.geometric.write_buffer > 0;
  EXPECT_EQ(bin("write-buffer/hit"), w("weight_combiner_buffer_hits"));
  EXPECT_EQ(bin("write-buffer/empty") + bin("write-buffer/leaves"),
            buffered ? w("weight_combiner_blocks_written") : 0);
  EXPECT_EQ(bin("write-buffer/full-at-end") + bin("write-buffer/not-full-at-end"),
            buffered ? frames().size() : 0);
  EXPECT_GE(bin("write-buffer/empty"),
            setup.geometric.write_buffer * bin("write-buffer/full-at-end"));
  const bool kept = setup.geometric.colour_lines > 0;
  EXPECT_EQ(bin("colour/hit"), kept ? w("block_fetch_lines_kept") : 0);
  EXPECT_EQ(bin("colour/free") + bin("colour/replaces"), kept ? w("block_fetch_lines_read") : 0);
  EXPECT_EQ(bin("colour/replaces"), kept ? w("block_fetch_lines_replaced") : 0);
  double groups = 0, lines = 0;
  for (int n = 1; n <= 2; ++n) {
    groups += bin("group-lines/tiled/" + std::to_string(n));
    lines += n * bin("group-lines/tiled/" + std::to_string(n));
  }
  EXPECT_EQ(lines, w("depth_test_lookups"));
  EXPECT_GT(groups, 0);
  EXPECT_EQ(bin("group-lines/raster/"), 0);
  // The DepthScreen drops the same candidates as the golden model.
  constexpr std::pair<const char*, const char*> kScreens[] = {
      {"dropped-up", "top/dropped"},        {"dropped-down", "bottom/dropped"},
      {"dropped-left", "left/dropped"},     {"dropped-right", "right/dropped"},
      {"kept-at-bound", "equal"},           {"own-tile-lesser", "lesser/own"},
      {"other-tile-lesser", "lesser/other"}};
  for (const auto& [hardware, golden] : kScreens)
    EXPECT_EQ(bin(std::string("screen/") + hardware), bin(std::string("coarse/") + golden))
        << golden;
  for (const auto& [unit, figures] : r["units"].items())
    for (const auto& [cause, cycles] : figures["stalls"].items()) {
      if (cycles == 0) continue;
      EXPECT_EQ(bin("stall/" + unit + '/' + cause), cycles) << unit << cause;
    }
}

TEST(GeometricFigures, HardwareBinsEqualTheCounters) {
  std::vector<GeometricSetup> all = setups();
  for (const int blocks : {2, 128}) {
    all.push_back(saving());
    all.back().geometric.write_buffer = blocks;
  }
  for (const GeometricSetup& setup : all) expect_bins(run(frames(), setup), setup);
}

// A buffer that holds exactly the blocks of a frame is full at the end; one with another entry is
// not.
TEST(GeometricFigures, WriteBufferIsFullAtTheEndWithoutFreeEntry) {
  const Frame& frame = frames()[2];
  const auto bin = [&](int blocks, const std::string& name) {
    GeometricSetup setup = saving();
    setup.geometric.write_buffer = blocks;
    return hits(run({frame}, setup), "geometric/write-buffer/" + name);
  };
  const auto all = static_cast<int>(bin(spec::geometric::kMaxWriteBuffer, "empty"));
  ASSERT_GT(all, 1);
  ASSERT_LT(all, spec::geometric::kMaxWriteBuffer);
  for (const int more : {0, 1}) {
    EXPECT_EQ(bin(all + more, "full-at-end"), more == 0 ? 1 : 0);
    EXPECT_EQ(bin(all + more, "not-full-at-end"), more);
  }
}

// The units' counters against the addresses that the golden model requested.
TEST(GeometricFigures, LinesPerRegionMatchGolden) {
  for (const GeometricSetup& setup : setups())
    for (const Json& one : each_alone(setup)) {
      double reads = 0;
      for (const auto& [region, count] : one["golden_reads"].items()) {
        EXPECT_EQ(work(one, "lines_read_" + region), count) << region;
        reads += count.get<double>();
      }
      EXPECT_EQ(number_at(one, "/memory/lines_filled"), reads);
      EXPECT_EQ(number_at(one, "/memory/bytes_read"), 64 * reads);
      for (const auto& [region, count] : one["golden_writes"].items()) {
        if (region == "weights" || region == "colour" || region == "copy")
          EXPECT_EQ(work(one, "lines_written_" + region), count) << region;
        else
          EXPECT_EQ(count, 0) << region;
      }
    }
}

// docs/reference/geometric/hardware.md: minimum cycles of each part; the slowest part gives the
// bound.
double bound_of(const Json& r, const Frame& frame, const GeometricSetup& setup, double times) {
  const auto w = [&](const std::string& name) {
    return r["work"].contains(name) ? work(r, name) : 0;
  };
  const auto halves = [](double n) { return std::ceil(n / 2); };  // two lanes each
  const auto read = [&](const char* region) { return w(std::string("lines_read_") + region); };
  const double words = std::ceil(frame.image.width / 512.0) * std::ceil(frame.image.height / 4.0);
  double begin = std::max(words, 16.0);
  if (setup.geometric.select == spec::geometric::Select::kEdges)
    begin = std::max(begin, std::ceil(frame.screen.faces / 512.0) + setup.memory.latency);
  const double lines = w("line_setup_lines");
  const double kept = w("edge_classifier_kept_edges");
  const double moved = read("edges") + read("pairs") + read("coarse") + read("vertices") +
                       read("depth") + w("weight_combiner_blocks_read") +
                       w("weight_combiner_blocks_written") + 2 * w("frame_copier_lines_copied");
  const double edges = std::max(
      {halves(w("edge_classifier_edges")), kept, w("vertex_fetch_misses"),
       setup.geometric.pipelined ? lines
                                 : std::floor(13 * (lines - w("line_setup_table_lines")) / 2),
       w("line_walker_groups"), w("weight_combiner_lookups"), halves(w("depth_test_lookups")),
       w("depth_test_misses"), w("depth_screen_groups") + w("depth_screen_both_missed"), moved});
  const double resolve = std::max(
      {words * times, w("resolver_blocks"),
       w("block_fetch_lines_read") + w("block_fetch_lines_kept"),
       w("block_fetch_weights_read") + w("block_fetch_lines_read") + w("resolver_lines_written"),
       halves(w("resolver_blended_pixels"))});
  return std::floor((begin * times + edges + resolve) / times);
}

TEST(GeometricFigures, BoundFollowsTheSlowestPartOfEachPhase) {
  // A tall frame with one invisible edge: one line of edges and one of vertices.
  Frame empty = frames()[2];
  empty.image = Image(8, 400);
  empty.depths.assign(8 * 400, 0);
  empty.screen.edges.resize(1);
  empty.screen.edges[0].v1 = empty.screen.edges[0].v0;
  Frame many = empty;  // edges that are not drawn
  many.screen.edges.assign(3001, empty.screen.edges[0]);
  GeometricSetup edges_alone = plain();
  edges_alone.geometric.select = spec::geometric::Select::kAll;
  EXPECT_EQ(number_at(run({empty}, edges_alone), "/bound"), 100 + 2 + 100);
  EXPECT_EQ(number_at(run({empty, empty, empty}, edges_alone), "/bound"), 100 + 2 + 100);
  std::vector<Frame> all = frames();
  all.push_back(empty);
  all.push_back(many);
  for (GeometricSetup setup : setups())
    for (const auto select : {spec::geometric::Select::kAll, spec::geometric::Select::kEdges})
      for (const Frame& frame : all) {
        setup.geometric.select = select;
        setup.memory.latency = 150;
        const Json one = run({frame}, setup);
        EXPECT_EQ(work(one, "frame_cycles_bound"), bound_of(one, frame, setup, 1));
        EXPECT_LE(work(one, "frame_cycles_bound"), work(one, "frame_cycles"));
      }
}

// The bound holds per frame, for any number of repetitions.
TEST(GeometricFigures, RepeatedFrameKeepsItsFigures) {
  for (GeometricSetup setup : setups())
    for (const auto select : {spec::geometric::Select::kAll, spec::geometric::Select::kEdges}) {
      setup.geometric.select = select;
      const Json one = run({frames()[0]}, setup);
      const Json three = run({frames()[0], frames()[0], frames()[0]}, setup);
      EXPECT_NEAR(number_at(three, "/bound"), number_at(one, "/bound"), 1);
      for (const std::string& name : kFigures.by_formula) {
        if (!one["work"].contains(name)) continue;
        EXPECT_NEAR(work(three, name) / work(one, name), 1, 1e-3) << name;
      }
      EXPECT_NEAR(number_at(three, "/throughput/bound") / number_at(one, "/throughput/bound"), 1,
                  1e-3);
      EXPECT_NEAR(number_at(three, "/throughput/value") / number_at(one, "/throughput/value"), 1,
                  1e-3);
      EXPECT_NEAR(number_at(three, "/cycles"), 3 * number_at(one, "/cycles"),
                  3 * arbitration_cycles(setup));
    }
}

// Maps of one frame must add up to its counters; those of several frames show the last.
TEST(GeometricFigures, MapsAndHistoryShowLastFrame) {
  Options options;
  options.maps = true;
  options.pixel = PixelAddress{26, 20};
  for (const std::size_t last : {0, 2}) {
    const std::vector<Frame> several = {frames()[1], frames()[last]};
    const Json alone = run({several.back()}, plain(), options),
               all = run(several, plain(), options);
    ASSERT_EQ(alone["maps"].size(), 4u);
    expect_maps_of_the_last(all, alone, several.back().image.width, several.back().image.height);
    EXPECT_EQ(without_cycles(all["pixel"]), without_cycles(alone["pixel"]));
  }
}

// An aborted frame takes nothing from the previous one.
TEST(GeometricFigures, HistoryOfAbortedFrameIsItsOwn) {
  Options options;
  options.pixel = PixelAddress{26, 20};
  const std::vector<Frame> two = {frames()[1], frames()[0]};
  const auto before = static_cast<rtl::Cycle>(number_at(run({two[0]}, plain()), "/cycles"));
  options.max_cycles = 200;
  const Json alone = run({two[1]}, plain(), options);
  options.max_cycles += before;
  EXPECT_EQ(without_cycles(run(two, plain(), options)["pixel"]), without_cycles(alone["pixel"]));
}

TEST(GeometricFigures, ResetInFirstFrameChangesNoFigure) {
  const std::vector<Frame> two = {frames()[2], frames()[0]};
  for (const GeometricSetup& setup : setups()) {
    Options options;
    options.maps = true;
    const Json whole = run(two, setup, options);
    for (const rtl::Cycle at : {70u, 900u}) {
      options.reset_after = at;
      Json again = run(two, setup, options);
      for (const char* const key : {"checks", "scoreboards"}) again[key] = whole[key];
      for (const auto& [name, unit] : whole["units"].items())
        again["units"][name]["idle"] = unit["idle"];  // includes draining memory
      EXPECT_EQ(Json::diff(whole, again), Json::array()) << at;
    }
  }
}

std::uint64_t errors_of(const std::vector<Frame>& sequence, GeometricSetup setup, std::int64_t from,
                        std::int64_t bytes) {
  setup.memory.error_address = from;
  setup.memory.error_bytes = bytes;
  const Json r = run(sequence, setup);
  EXPECT_EQ(number_at(r, "/checks/mismatches"), 0);
  const std::string error = r["error"];
  EXPECT_TRUE(error.empty() || error.starts_with("memory answered ")) << error;
  EXPECT_EQ(work(r, "memory_arbiter_memory_errors"), work(r, "memory_port_errors"));
  const double errors = work(r, "memory_port_errors");
  if (errors > 0) {
    EXPECT_EQ(hits(r, "geometric/error/depth"), errors);
  }
  return error.empty() ? 0 : std::stoull(error.substr(sizeof "memory answered " - 1));
}

// Lines at the end of a region belong only to the largest frame: it has the errors, at any position
// among the others, and STATUS and MEMORY_ERRORS keep them to the end.
TEST(GeometricFigures, ExpectsErrorsInOnlyOneOfThreeFrames) {
  for (const GeometricSetup& setup : setups()) {
    const Frame &large = frames()[0], &small = frames()[2];
    const std::vector<Frame> both = {large, small};
    const platform::GeometricRegions regions = regions_of(both, setup.geometric);
    // 12 x 8 tiles in the large frame, 7 x 5 in the small one.
    const auto middle = static_cast<std::int64_t>(regions.base(Region::kDepth)) + 64 * 256;
    const std::uint64_t once = errors_of(both, setup, middle, 2048);
    EXPECT_GT(once, 2u);
    for (const std::vector<Frame>& order :
         {std::vector{large, small, small}, std::vector{small, large, small},
          std::vector{small, small, large}})
      EXPECT_EQ(errors_of(order, setup, middle, 2048), once);
    EXPECT_EQ(errors_of({large, small, large}, setup, middle, 2048), 2 * once);
    // An error in one byte of a line fails the whole line.
    golden::geometric::GeometricGolden golden(setup.geometric);
    golden.process(large.input());
    const std::int64_t line =
        regions.base(Region::kDepth) + std::int64_t{golden.traffic().read(Region::kDepth).front()};
    EXPECT_GT(errors_of(both, setup, line, 64), 0u);
    for (const std::int64_t byte : {0, 63})
      EXPECT_EQ(errors_of(both, setup, line + byte, 1), errors_of(both, setup, line, 64));
  }
}

// STATUS reports that one of the frames had an invalid edge, at any position. Each frame's edges
// are checked against its own face and vertex counts.
TEST(GeometricFigures, InvalidEdgesOfOneFrameOfThreeAreExpected) {
  Frame invalid = frames()[2];
  invalid.screen.edges[5].f0 = invalid.screen.faces;
  const Frame& valid = frames()[2];
  for (const GeometricSetup& setup : setups())
    for (const std::vector<Frame>& order :
         {std::vector{invalid, valid, valid}, std::vector{valid, invalid, valid},
          std::vector{valid, valid, invalid}}) {
      const Json r = run(order, setup);
      EXPECT_EQ(number_at(r, "/checks/mismatches"), 0);
      EXPECT_EQ(work(r, "edge_classifier_invalid_edges"), 1);
    }
}

}  // namespace
}  // namespace deburr::tb::figures_test
