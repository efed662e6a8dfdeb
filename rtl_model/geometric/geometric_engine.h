// SPDX-License-Identifier: MIT
// The geometric engine: smooths the jagged edges of a finished frame along the edges of its mesh
// (docs/reference/geometric/index.md; phases, latencies, memories:
// docs/reference/geometric/hardware.md).
//
//   registers (TLM-2.0 target)                       memory (TLM-2.0 initiator)
//       |                                                |
//   ParameterStore                                   MemoryPort
//       | ^                                              |
//       v |                                          MemoryArbiter -- all units that access memory
//   FrameSequencer
//                   FacingStore
//                       | facing bits
//                       v
//   EdgeReader -> EdgeClassifier -> PairFetch -> VertexFetch -> LineSetup -> line FIFO
//                                                                                |
//       +----------------------------------------------------------- LineWalker <-+
//       v
//   CoverageUnit -> DepthScreen -> DepthTest -> WeightCombiner       FrameCopier (with frame_copy)
//                                      |
//       +------------------------------+ when all edges are drawn
//       v
//   BlockScanner -> BlockFetch -> block FIFO -> Resolver
//                       |                          ^
//                       +- lines -> ColourStore ---+
//
//   wires: ParameterStore -- configuration, FrameSequencer -- phase --> units of the pipe
//          ParameterStore -- start, rejection --> FrameSequencer
//          FrameSequencer -- latch, frame_done --> ParameterStore
//          EdgeClassifier -- invalid_edge, PairFetch -- invalid_pair,
//          MemoryArbiter -- memory_error --> ParameterStore
//          FacingStore -- facing_loaded, VertexFetch -- vertices_cleared,
//          DepthTest -- depth_cleared, WeightCombiner -- weights_cleared, drawn,
//          FrameCopier -- copied, Resolver -- resolved --> FrameSequencer
//
// PairFetch exists only with records = split, DepthScreen only with coarse_lines.
//
// All tokens stay in order; only memory may respond out of order. Source: Persson, GPAA; paper 002.
#pragma once

#include <functional>
#include <memory>
#include <systemc>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/engine.h"
#include "rtl_model/fabric/fifo.h"
#include "rtl_model/fabric/memory_cycles.h"
#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/geometric/common/edge_latency.h"
#include "rtl_model/geometric/common/memory_arbiter.h"
#include "rtl_model/geometric/common/parameter_store.h"
#include "rtl_model/geometric/edges/edge_classifier.h"
#include "rtl_model/geometric/edges/edge_reader.h"
#include "rtl_model/geometric/edges/facing_store.h"
#include "rtl_model/geometric/edges/pair_fetch.h"
#include "rtl_model/geometric/edges/vertex_fetch.h"
#include "rtl_model/geometric/frame_sequencer.h"
#include "rtl_model/geometric/lines/coverage_unit.h"
#include "rtl_model/geometric/lines/depth_screen.h"
#include "rtl_model/geometric/lines/depth_test.h"
#include "rtl_model/geometric/lines/line_setup.h"
#include "rtl_model/geometric/lines/line_walker.h"
#include "rtl_model/geometric/resolve/block_fetch.h"
#include "rtl_model/geometric/resolve/block_scanner.h"
#include "rtl_model/geometric/resolve/colour_store.h"
#include "rtl_model/geometric/resolve/frame_copier.h"
#include "rtl_model/geometric/resolve/resolver.h"
#include "rtl_model/geometric/weights/weight_combiner.h"
#include "spec/geometric/packets.h"
#include "spec/geometric/parameters.h"

namespace deburr::rtl::geometric {

class GeometricEngine final : public Engine {
 public:
  // ConfigError for parameters that cannot be built (spec/geometric/check_build.h). `memory` sizes
  // the entries that are set to 0 (common/sizing.h).
  GeometricEngine(const sc_core::sc_module_name& name, ClockDomain& clock,
                  const spec::geometric::Parameters& parameters, const MemoryCycles& memory = {});
  const char* kind() const override { return "deburr_geometric_engine"; }

 private:
  const spec::geometric::Parameters parameters_;
  const PayloadShape walkers_;
  const MemoryPortParameters port_;
  EdgeLatency latency_;

 public:
  // --- Units, in the order of the figure ---
  ParameterStore parameter_store;
  FrameSequencer frame_sequencer;
  MemoryArbiter memory_arbiter;
  FacingStore facing_store;
  EdgeReader edge_reader;
  EdgeClassifier edge_classifier;
  std::unique_ptr<PairFetch> pair_fetch;  // only with records = split
  VertexFetch vertex_fetch;
  LineSetup line_setup;
  LineWalker line_walker;
  CoverageUnit coverage_unit;
  std::unique_ptr<DepthScreen> depth_screen;  // only with coarse_lines
  DepthTest depth_test;
  WeightCombiner weight_combiner;
  FrameCopier frame_copier;
  BlockScanner block_scanner;
  ColourStore colour_store;
  BlockFetch block_fetch;
  Resolver resolver;
  MemoryPort memory_port;

  // Of edges that are lines with at least one pixel that passes the depth test.
  const Histogram& edge_latency = weight_combiner.edge_latency;

  // True if no frame is in progress. Call between edges.
  bool idle() const override { return !parameter_store.starting() && frame_sequencer.idle(); }
  std::vector<Datasheet> datasheets() const override;
  // Counts since the counters were cleared.
  spec::geometric::Work work() const;

 private:
  // From the registers to the units, and the pulses that set sticky bits.
  Wire<FrameConfiguration> configuration_{"configuration", FrameConfiguration{},
                                          configuration_shape(parameters_)};
  Pulse start_{"start"}, latch_{"latch"};
  CombinationalWire<spec::geometric::Rejection> rejection_{"rejection", rejection_shape()};
  Pulse frame_done_{"frame_done"}, invalid_edge_{"invalid_edge"}, memory_error_{"memory_error"};
  std::unique_ptr<Pulse> invalid_pair_;
  // From the FrameSequencer to the units, and their done wires.
  Wire<Phase> phase_{"phase", Phase::kIdle, phase_shape()};
  Wire<bool> facing_loaded_{"facing_loaded", false}, vertices_cleared_{"vertices_cleared", false},
      depth_cleared_{"depth_cleared", false}, weights_cleared_{"weights_cleared", false},
      drawn_{"drawn", false}, copied_{"copied", false}, resolved_{"resolved", false};
  Link<EdgeBeat> edges_;
  std::unique_ptr<Link<PairNumber>> numbers_;
  Link<KeptEdge> kept_;
  Link<EdgeEnds> ends_{"ends"};
  Fifo<LineToken> lines_;
  Link<GroupToken> groups_;
  Link<CandidateToken> candidates_;
  std::unique_ptr<Link<CandidateToken>> screened_;
  Link<WeightToken> weights_;
  Link<TouchedBlock> touched_blocks_{"touched_blocks"};
  Fifo<BlockToken> blocks_;
  Link<MemoryRequest> requests_;
  Link<MemoryResponse> responses_;
};

}  // namespace deburr::rtl::geometric
