// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/geometric_engine.h"

#include <utility>

#include "rtl_model/geometric/common/sizing.h"
#include "rtl_model/geometric/datasheets.h"
#include "spec/geometric/check_build.h"

namespace deburr::rtl::geometric {
namespace {

namespace reg = spec::geometric::reg;

PayloadShape lanes(spec::geometric::Lanes code) {
  return {.lanes = spec::geometric::kLaneCount[static_cast<std::size_t>(code)]};
}

bool is_split(const spec::geometric::Parameters& p) {
  return p.records == spec::geometric::RecordsLayout::kSplit;
}

MemoryPortParameters port_of(const spec::geometric::Parameters& p) {
  MemoryPortParameters port;
  port.outstanding = static_cast<std::uint32_t>(p.memory_outstanding);
  return port;
}

}  // namespace

GeometricEngine::GeometricEngine(const sc_core::sc_module_name& name, ClockDomain& clock,
                                 const spec::geometric::Parameters& parameters,
                                 const MemoryCycles& memory)
    : Engine(name, clock, spec::geometric::kRegisters, control_layout()),
      parameters_(sized(check_build(parameters), memory)),
      walkers_(lanes(parameters_.walkers)),
      port_(port_of(parameters_)),
      parameter_store("parameter_store", clock, control, parameters_),
      frame_sequencer("frame_sequencer", clock),
      memory_arbiter("memory_arbiter", clock, port_, parameters_),
      facing_store("facing_store", clock, parameters_),
      edge_reader("edge_reader", clock, parameters_, latency_),
      edge_classifier("edge_classifier", clock, parameters_, facing_store.words, latency_),
      pair_fetch(is_split(parameters_)
                     ? std::make_unique<PairFetch>("pair_fetch", clock, parameters_, latency_)
                     : nullptr),
      vertex_fetch("vertex_fetch", clock, parameters_),
      line_setup("line_setup", clock, parameters_, latency_),
      line_walker("line_walker", clock, parameters_, latency_),
      coverage_unit("coverage_unit", clock, parameters_, latency_),
      depth_screen(parameters_.coarse_lines != spec::geometric::CoarseLines::kNone
                       ? std::make_unique<DepthScreen>("depth_screen", clock, parameters_)
                       : nullptr),
      depth_test("depth_test", clock, parameters_, latency_),
      weight_combiner("weight_combiner", clock, parameters_, latency_),
      frame_copier("frame_copier", clock, parameters_),
      block_scanner("block_scanner", clock, parameters_, weight_combiner.touched_port()),
      colour_store(parameters_),
      block_fetch("block_fetch", clock, parameters_, weight_combiner.tag_port(),
                  weight_combiner.data_port(), colour_store.filler()),
      resolver("resolver", clock, parameters_, colour_store.reader()),
      memory_port("memory_port", clock, port_),
      edges_("edges", 2, edge_beat_shape(parameters_)),
      kept_(pair_fetch ? "pairs" : "kept"),
      lines_("line_fifo", static_cast<std::uint32_t>(parameters_.line_fifo)),
      groups_("groups", 2, walkers_),
      candidates_("candidates", 2, candidates_shape(parameters_, false)),
      weights_("weights", 2, walkers_),
      blocks_("block_fifo", static_cast<std::uint32_t>(parameters_.resolve_lines) / 4),
      requests_("requests", 2, request_shape(port_, 32, request_tag_bits(parameters_))),
      responses_("responses", 2, response_shape(port_, 32, request_tag_bits(parameters_))) {
  edge_reader.edges_out(edges_);
  edge_classifier.edges_in(edges_);
  if (pair_fetch) {
    numbers_ = std::make_unique<Link<PairNumber>>("kept");
    invalid_pair_ = std::make_unique<Pulse>("invalid_pair");
    (*edge_classifier.numbers_out)(*numbers_);
    pair_fetch->numbers_in(*numbers_);
    pair_fetch->edges_out(kept_);
    memory_arbiter.connect(Client::kPairs, pair_fetch->memory);
    pair_fetch->invalid_pair_out(*invalid_pair_);
    (*parameter_store.invalid_pair_in)(*invalid_pair_);
    pair_fetch->configuration_in(configuration_);
    pair_fetch->phase_in(phase_);
  } else {
    (*edge_classifier.edges_out)(kept_);
  }
  vertex_fetch.edges_in(kept_);
  vertex_fetch.ends_out(ends_);
  line_setup.ends_in(ends_);
  line_setup.lines_out(lines_.link());
  line_walker.lines_in(lines_.link());
  line_walker.groups_out(groups_);
  coverage_unit.groups_in(groups_);
  coverage_unit.candidates_out(candidates_);
  if (depth_screen) {
    screened_ =
        std::make_unique<Link<CandidateToken>>("screened", 2, candidates_shape(parameters_, true));
    depth_screen->candidates_in(candidates_);
    depth_screen->screened_out(*screened_);
    depth_test.candidates_in(*screened_);
    memory_arbiter.connect(Client::kCoarse, depth_screen->memory);
    depth_screen->configuration_in(configuration_);
    depth_screen->phase_in(phase_);
  } else {
    depth_test.candidates_in(candidates_);
  }
  depth_test.weights_out(weights_);
  weight_combiner.weights_in(weights_);
  block_scanner.blocks_out(touched_blocks_);
  block_fetch.blocks_in(touched_blocks_);
  block_fetch.blocks_out(blocks_.link());
  resolver.blocks_in(blocks_.link());
  memory_arbiter.connect(Client::kFacing, facing_store.memory);
  memory_arbiter.connect(Client::kEdges, edge_reader.memory);
  memory_arbiter.connect(Client::kVertices, vertex_fetch.memory);
  memory_arbiter.connect(Client::kDepth, depth_test.memory);
  memory_arbiter.connect(Client::kWeights, weight_combiner.memory);
  memory_arbiter.connect(Client::kBlocks, block_fetch.memory);
  memory_arbiter.connect(Client::kResolve, resolver.memory);
  memory_arbiter.connect(Client::kCopy, frame_copier.memory);
  memory_arbiter.requests_out(requests_);
  memory_port.requests_in(requests_);
  memory_port.responses_out(responses_);
  memory_arbiter.responses_in(responses_);
  uses(memory_port);

  parameter_store.start_out(start_);
  frame_sequencer.start_in(start_);
  frame_sequencer.latch_out(latch_);
  parameter_store.latch_in(latch_);
  parameter_store.rejection_out(rejection_);
  frame_sequencer.rejection_in(rejection_);
  frame_sequencer.frame_done_out(frame_done_);
  parameter_store.frame_done_in(frame_done_);
  edge_classifier.invalid_edge_out(invalid_edge_);
  parameter_store.invalid_edge_in(invalid_edge_);
  memory_arbiter.memory_error_out(memory_error_);
  parameter_store.memory_error_in(memory_error_);

  parameter_store.configuration_out(configuration_);
  facing_store.configuration_in(configuration_);
  edge_reader.configuration_in(configuration_);
  edge_classifier.configuration_in(configuration_);
  vertex_fetch.configuration_in(configuration_);
  line_setup.configuration_in(configuration_);
  coverage_unit.configuration_in(configuration_);
  depth_test.configuration_in(configuration_);
  weight_combiner.configuration_in(configuration_);
  frame_copier.configuration_in(configuration_);
  block_scanner.configuration_in(configuration_);
  block_fetch.configuration_in(configuration_);
  resolver.configuration_in(configuration_);
  frame_sequencer.phase_out(phase_);
  facing_store.phase_in(phase_);
  edge_reader.phase_in(phase_);
  vertex_fetch.phase_in(phase_);
  depth_test.phase_in(phase_);
  weight_combiner.phase_in(phase_);
  frame_copier.phase_in(phase_);
  block_scanner.phase_in(phase_);
  block_fetch.phase_in(phase_);
  resolver.phase_in(phase_);
  facing_store.loaded_out(facing_loaded_);
  vertex_fetch.cleared_out(vertices_cleared_);
  depth_test.cleared_out(depth_cleared_);
  weight_combiner.cleared_out(weights_cleared_);
  weight_combiner.drawn_out(drawn_);
  frame_copier.copied_out(copied_);
  resolver.resolved_out(resolved_);
  frame_sequencer.facing_loaded_in(facing_loaded_);
  frame_sequencer.vertices_cleared_in(vertices_cleared_);
  frame_sequencer.depth_cleared_in(depth_cleared_);
  frame_sequencer.weights_cleared_in(weights_cleared_);
  frame_sequencer.drawn_in(drawn_);
  frame_sequencer.copied_in(copied_);
  frame_sequencer.resolved_in(resolved_);

  const std::pair<std::uint32_t, const Counter*> shown[] = {
      {reg::kEdges, &edge_classifier.edges},
      {reg::kBoundaryEdges, &edge_classifier.boundary_edges},
      {reg::kSilhouetteEdges, &edge_classifier.silhouette_edges},
      {reg::kBackEdges, &edge_classifier.back_edges},
      {reg::kCreaseEdges, &edge_classifier.crease_edges},
      {reg::kFlatEdges, &edge_classifier.flat_edges},
      {reg::kKeptEdges, pair_fetch ? &pair_fetch->kept_edges : &edge_classifier.kept_edges},
      {reg::kOutsideEdges, &line_setup.outside_edges},
      {reg::kDegenerateEdges, &line_setup.degenerate_edges},
      {reg::kEmptyEdges, &line_setup.empty_edges},
      {reg::kLines, &line_setup.lines},
      {reg::kColumns, &line_walker.columns},
      {reg::kGroups, &line_walker.groups},
      {reg::kCandidates, &coverage_unit.candidates},
      {reg::kPassed, &depth_test.passed},
      {reg::kBlocks, &resolver.blocks},
      {reg::kBlendedPixels, &resolver.blended_pixels},
      {reg::kMemoryErrors, &memory_arbiter.memory_errors},
      {reg::kFrameCycles, &frame_sequencer.frame_cycles},
      {reg::kEdgeCycles, &frame_sequencer.edge_cycles},
      {reg::kResolveCycles, &frame_sequencer.resolve_cycles}};
  for (const auto& [offset, counter] : shown) control.show(offset, *counter);
  if (pair_fetch)
    control.show_sum(reg::kInvalidEdges,
                     {&edge_classifier.invalid_edges, &pair_fetch->invalid_edges});
  else
    control.show(reg::kInvalidEdges, edge_classifier.invalid_edges);
}

spec::geometric::Work GeometricEngine::work() const {
  spec::geometric::Work work;
  work.edges = edge_classifier.edges.value();
  work.boundary_edges = edge_classifier.boundary_edges.value();
  work.silhouette_edges = edge_classifier.silhouette_edges.value();
  work.back_edges = edge_classifier.back_edges.value();
  work.crease_edges = edge_classifier.crease_edges.value();
  work.flat_edges = edge_classifier.flat_edges.value();
  work.invalid_edges = edge_classifier.invalid_edges.value();
  work.kept_edges = (pair_fetch ? pair_fetch->kept_edges : edge_classifier.kept_edges).value();
  if (pair_fetch) work.invalid_edges += pair_fetch->invalid_edges.value();
  work.outside_edges = line_setup.outside_edges.value();
  work.degenerate_edges = line_setup.degenerate_edges.value();
  work.empty_edges = line_setup.empty_edges.value();
  work.lines = line_setup.lines.value();
  work.columns = line_walker.columns.value();
  work.groups = line_walker.groups.value();
  work.candidates = coverage_unit.candidates.value();
  work.passed = depth_test.passed.value();
  work.blocks = resolver.blocks.value();
  work.blended_pixels = resolver.blended_pixels.value();
  return work;
}

std::vector<Datasheet> GeometricEngine::datasheets() const {
  std::vector<Datasheet> sheets = geometric::datasheets(parameters_);
  sheets.push_back(MemoryPort::datasheet(port_, request_tag_bits(parameters_)));
  return sheets;
}

}  // namespace deburr::rtl::geometric
