// SPDX-License-Identifier: MIT
#include "tb/engines/geometric/geometric_meter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "golden/geometric/configuration.h"
#include "rtl_model/platform/geometric_driver.h"
#include "tb/env/collect.h"

namespace deburr::tb {
namespace {

using spec::geometric::Parameters;
using spec::geometric::Region;

constexpr std::uint64_t kLine = spec::geometric::kLineBytes;
constexpr double kPortBound = 0.9;  // port utilisation from which on the port is the bottleneck
constexpr std::uint64_t kDividerCycles = 13;

constexpr std::size_t index_of(Region region) { return static_cast<std::size_t>(region); }

std::uint64_t lines_for(std::uint64_t records, std::uint64_t in_line) {
  return (records + in_line - 1) / in_line;
}

std::uint64_t words_of(spec::geometric::CacheLines lines) {
  return spec::geometric::kCacheLineCount[static_cast<std::size_t>(lines)];
}
std::uint64_t count_of(spec::geometric::Lanes lanes) {
  return spec::geometric::kLaneCount[static_cast<std::size_t>(lanes)];
}

}  // namespace

LinesMoved lines_moved(const rtl::geometric::GeometricEngine& engine, bool frame_copy) {
  LinesMoved lines;
  const auto read = [&](Region region) -> std::uint64_t& { return lines.read[index_of(region)]; };
  const auto written = [&](Region region) -> std::uint64_t& {
    return lines.written[index_of(region)];
  };
  read(Region::kFaces) = engine.facing_store.lines_read.value();
  read(Region::kEdges) = engine.edge_reader.lines_read.value();
  if (engine.pair_fetch) read(Region::kPairs) = engine.pair_fetch->lines_read.value();
  read(Region::kVertices) = engine.vertex_fetch.misses.value();
  read(Region::kDepth) = engine.depth_test.misses.value();
  if (engine.depth_screen) read(Region::kCoarse) = engine.depth_screen->misses.value();
  read(Region::kWeights) =
      engine.weight_combiner.blocks_read.value() + engine.block_fetch.weights_read.value();
  read(frame_copy ? Region::kCopy : Region::kColour) = engine.block_fetch.lines_read.value();
  read(Region::kColour) += engine.frame_copier.lines_copied.value();
  written(Region::kWeights) = engine.weight_combiner.blocks_written.value();
  written(Region::kColour) = engine.resolver.lines_written.value();
  written(Region::kCopy) = engine.frame_copier.lines_copied.value();
  return lines;
}

GeometricMeter::GeometricMeter(std::string name, const rtl::geometric::GeometricEngine& engine,
                               const platform::MemoryModel& memory,
                               std::span<const geometric::Frame> frames,
                               const GeometricSetup& setup)
    : Meter(std::move(name)), engine_(engine), memory_(memory), frames_(frames), setup_(setup) {}

void GeometricMeter::end() {
  ++frames_done_;
  edges_done_ += frames_[frame_].screen.edges.size();
  edge_cycles_ += engine_.frame_sequencer.edge_cycles.value();
  resolve_cycles_ += engine_.frame_sequencer.resolve_cycles.value();
}

// Computed from the engine's counts over frames of equal size.
std::uint64_t GeometricMeter::cycles_bound() const {
  const rtl::geometric::GeometricEngine& e = engine_;
  const geometric::Frame& frame = frames_[frame_];
  const Parameters& p = setup_.geometric;
  const spec::geometric::Work work = e.work();
  const LinesMoved lines = lines_moved(e, p.frame_copy);
  const auto read = [&](Region region) { return lines.read[index_of(region)]; };
  const auto written = [&](Region region) { return lines.written[index_of(region)]; };
  const auto words = static_cast<std::uint64_t>(
      golden::geometric::touched_words(frame.image.width, frame.image.height));
  std::uint64_t begin = std::max(
      {words, words_of(p.vertex_lines), words_of(p.depth_lines), words_of(p.weight_blocks)});
  if (p.select == spec::geometric::Select::kEdges) {
    auto latency = static_cast<std::uint64_t>(setup_.memory.latency);
    if (!setup_.memory.latency_file.empty()) {
      const std::vector<std::uint32_t> listed = read_latencies(setup_.memory.latency_file);
      latency = *std::min_element(listed.begin(), listed.end());
    }
    begin = std::max(begin, lines_for(frame.screen.faces, spec::geometric::kFacesInLine) + latency);
  }
  const std::uint64_t divided = work.lines - e.line_setup.table_lines.value();
  const std::uint64_t resolve_weights = e.block_fetch.weights_read.value(),
                      colours = e.block_fetch.lines_read.value(),
                      window = colours + e.block_fetch.lines_kept.value();
  // A group takes one cycle of the DepthScreen per line that it reads.
  const std::uint64_t screened =
      e.depth_screen ? e.depth_screen->groups.value() + e.depth_screen->both_missed.value() : 0;
  const std::uint64_t edges_phase = std::max(
      {lines_for(work.edges, count_of(p.edge_lanes)), e.edge_classifier.kept_edges.value(),
       read(Region::kVertices),
       p.pipelined ? work.lines : kDividerCycles * divided / static_cast<std::uint64_t>(p.dividers),
       work.groups, e.weight_combiner.lookups.value(), lines_for(e.depth_test.lookups.value(), 2),
       read(Region::kDepth), screened,
       read(Region::kEdges) + read(Region::kPairs) + read(Region::kCoarse) +
           read(Region::kVertices) + read(Region::kDepth) + read(Region::kWeights) -
           resolve_weights + written(Region::kWeights) + 2 * written(Region::kCopy)});
  const std::uint64_t resolve_phase =
      std::max({words * frames_done_, work.blocks, window,
                resolve_weights + colours + written(Region::kColour),
                lines_for(work.blended_pixels, count_of(p.resolve_lanes))});
  return begin * frames_done_ + edges_phase + resolve_phase;
}

void GeometricMeter::collect_traffic(Result& result) const {
  const rtl::geometric::GeometricEngine& e = engine_;
  const spec::geometric::Work work = e.work();
  const LinesMoved lines = lines_moved(e, setup_.geometric.frame_copy);
  constexpr const char* kBytes = "byte/pixel";
  std::uint64_t frame_bytes = e.memory_port.bytes_written.value();
  for (const Region region :
       {Region::kDepth, Region::kCoarse, Region::kWeights, Region::kColour, Region::kCopy})
    frame_bytes += kLine * lines.read[index_of(region)];
  add(result, "edge_cycles", e.frame_sequencer.edge_cycles.value(), "clk",
      "Cycles of the last frame, from its start until all edges are drawn.");
  add(result, "resolve_cycles", e.frame_sequencer.resolve_cycles.value(), "clk",
      "Remaining cycles of the last frame.");
  for (std::size_t i = 0; i < spec::geometric::kRegionNames.size(); ++i)
    add(result, fmt::format("lines_read_{}", spec::geometric::kRegionNames[i]), lines.read[i],
        "line", fmt::format("Lines of the region {} read.", spec::geometric::kRegionNames[i]));
  for (const Region region : {Region::kWeights, Region::kColour, Region::kCopy}) {
    const std::string_view name = spec::geometric::kRegionNames[index_of(region)];
    add(result, fmt::format("lines_written_{}", name), lines.written[index_of(region)], "line",
        fmt::format("Lines of the region {} written.", name));
  }
  add(result, "bytes_per_blended_pixel",
      ratio(e.memory_port.bytes_read.value() + e.memory_port.bytes_written.value(),
            work.blended_pixels),
      kBytes, "Bytes read and written, per blended pixel.");
  add(result, "frame_bytes_per_blended_pixel", ratio(frame_bytes, work.blended_pixels), kBytes,
      "The same for depth, weights, colours and copy only, without the mesh.");
}

void GeometricMeter::collect_hits(Result& result) const {
  const rtl::geometric::GeometricEngine& e = engine_;
  const spec::geometric::Work work = e.work();
  add(result, "columns_per_cycle", ratio(work.columns, work.groups), "column/clk",
      "Columns per cycle in which the walkers step.");
  const auto hits = [&](const char* name, const rtl::Counter& lookups, const rtl::Counter& misses,
                        const char* meaning) {
    add(result, name, 100 * ratio(lookups.value() - misses.value(), lookups.value()), "%", meaning);
  };
  hits("vertex_hits_percent", e.vertex_fetch.lookups, e.vertex_fetch.misses,
       "Lookups of vertex lines without a line request.");
  hits("depth_hits_percent", e.depth_test.lookups, e.depth_test.misses,
       "Lookups of depth lines without a line request.");
  if (e.depth_screen)
    add(result, "dropped_early", e.depth_screen->dropped.value(), "pixel",
        "Candidates that the coarse test of depth dropped before they looked depth up.");
  hits("weight_hits_percent", e.weight_combiner.lookups, e.weight_combiner.misses,
       "Lookups of weight blocks that hit the cache.");
  const auto kept = [&](const char* name, const rtl::Counter& found, const rtl::Counter& read,
                        const char* meaning) {
    add(result, name, 100 * ratio(found.value(), found.value() + read.value()), "%", meaning);
  };
  const Parameters& p = setup_.geometric;
  if (p.colour_lines > 0)
    kept("colour_hits_percent", e.block_fetch.lines_kept, e.block_fetch.lines_read,
         "Lookups of lines of colours by the resolve that were kept.");
  if (p.write_buffer > 0)
    kept("write_buffer_hits_percent", e.weight_combiner.buffer_hits, e.weight_combiner.blocks_read,
         "Misses of a block touched before that was in the write buffer.");
}

void GeometricMeter::collect(Result& result) const {
  const rtl::geometric::GeometricEngine& e = engine_;
  const Parameters& p = setup_.geometric;
  add_parts(result, e, frames_.empty() ? 0 : frames_[frame_].image.width);
  add(result, memory_);
  result.lines_filled += memory_.reads();

  collect_traffic(result);
  collect_hits(result);
  const std::uint64_t dividers =
      p.pipelined ? kDividerCycles : static_cast<std::uint64_t>(p.dividers);
  add(result, "divider_occupancy_percent",
      100 * ratio(e.line_setup.divider_cycles.value(), dividers * edge_cycles_), "%",
      "Occupied cycles of the dividers (of their stages, if pipelined) / cycles of the edge phase; "
      "at 100 % they are the limit.");
  add(result, "port_occupancy_percent",
      100 * ratio(e.memory_port.reads.value() + e.memory_port.writes.value(),
                  edge_cycles_ + resolve_cycles_),
      "%", "Memory requests per cycle; at 100 % the port is the limit.");
  add_counters(result, e);
}

void GeometricMeter::show_parts(Observer& observer) const {
  show(observer, engine_);
  observer.see({"Edges read", figure("edge_classifier_edges"), "edge/clk",
                number(count_of(setup_.geometric.edge_lanes))});
  observer.see({"Pixels blended", figure("resolver_blended_pixels"), "pixel/clk",
                number(count_of(setup_.geometric.resolve_lanes))});
}

std::vector<Figure> GeometricMeter::work_figures() const {
  return {{"Edges kept",
           key(engine_.pair_fetch ? "pair_fetch_kept_edges" : "edge_classifier_kept_edges"), "of",
           key("edge_classifier_edges")},
          {"Lines", key("line_setup_lines")},
          {"Pixels walked per cycle", key("columns_per_cycle"), "at most the walkers"},
          {"Vertices found in the cache", key("vertex_hits_percent")},
          {"Depths found in the cache", key("depth_hits_percent")},
          {"Weights found in the cache", key("weight_hits_percent")},
          {"Divider occupancy", key("divider_occupancy_percent")},
          {"Memory port occupancy", key("port_occupancy_percent")},
          {"Blended pixels", key("resolver_blended_pixels")},
          {"Traffic of frame buffers alone", key("frame_bytes_per_blended_pixel")}};
}

void GeometricMeter::collect_headline(Result& result, double clock_mhz) const {
  const rtl::geometric::GeometricEngine& e = engine_;
  const std::uint64_t edges = e.work().edges, frame_cycles = e.frame_sequencer.frame_cycles.value();
  result.latency = latency_of(e.edge_latency);

  result.throughput = ratio(edges, result.cycles);
  result.throughput_unit = "edge/clk";
  result.throughput_bound = ratio(edges, frames_done_ > 0 ? cycles_bound() : 0);
  result.throughput_bound_meaning =
      "Edges divided by the cycles of the start and of both phases, each as its slowest unit or "
      "the port needs.";

  add(result, "frame_cycles", frame_cycles, "clk", "Cycles of the last frame, from start to end.");
  add(result, "frame_cycles_bound", frame_cycles_bound(), "clk",
      "Bound of the throughput, as cycles per frame, from totals: at most the sum of the bounds on "
      "the engine's hardware page, which count each beat, block and lookup.");
  add(result, "frame_rate", frame_cycles ? clock_mhz * 1e6 / number(frame_cycles) : 0.0, "frame/s",
      "Frames like this one per second, at the given clock frequency.");
  add(result, "clock_for_60_frames",
      frame_cycles ? WorkValue(clock_for_60(frame_cycles)) : WorkValue(), "MHz",
      "Clock frequency for 60 frames like this one per second.");

  result.figures.clear();
  if (frame_cycles)
    result.figures = {{"Frame", "work.frame_cycles", "bound", "work.frame_cycles_bound", true},
                      {"Edges drawn", "work.edge_cycles"},
                      {"Pixels resolved", "work.resolve_cycles"},
                      {"Clock for 60 frame/s", "work.clock_for_60_frames", "", "", true},
                      {"Frames like this", "work.frame_rate"}};
  result.figures.push_back(
      {"Traffic per blended pixel", "work.bytes_per_blended_pixel", "", "", true});
  for (Figure& figure : work_figures()) result.figures.push_back(std::move(figure));

  result.bottleneck = bottleneck(result);
}

std::optional<Bottleneck> GeometricMeter::bottleneck(const Result& result) const {
  const rtl::geometric::GeometricEngine& e = engine_;
  // Units from input to output of the pipeline.
  std::vector<UnitCycles> pipe;
  const rtl::Unit* const units[] = {&e.edge_reader,     &e.edge_classifier,   e.pair_fetch.get(),
                                    &e.vertex_fetch,    &e.line_setup,        &e.line_walker,
                                    &e.coverage_unit,   e.depth_screen.get(), &e.depth_test,
                                    &e.weight_combiner, &e.frame_copier,      &e.block_scanner,
                                    &e.block_fetch,     &e.resolver};
  for (const rtl::Unit* unit : units)
    if (unit) pipe.push_back(unit_cycles(figure(name_within(e, *unit)), *unit));
  const std::uint64_t requests = e.memory_port.reads.value() + e.memory_port.writes.value();
  if (result.cycles > 0 && ratio(requests, result.cycles) >= kPortBound)
    return Bottleneck{figure("memory_port"), "busy",
                      "The port takes a request in nearly every cycle.", requests};
  return find_bottleneck(pipe, figure(e.resolver.basename()));
}

}  // namespace deburr::tb
