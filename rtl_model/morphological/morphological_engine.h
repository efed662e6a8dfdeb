// SPDX-License-Identifier: MIT
// Morphological anti-aliasing engine: smooths jagged edges of a finished frame. Contract:
// docs/reference/morphological/index.md; timing and memories: hardware.md there.
//
//                                                                                      pixels_out
//                                                                                           ^
//   pixels_in -> SlotSequencer -> LumaUnit -> EdgeDetector -> RunExtractor -> AreaUnit -> Blender
//                    |                                         |  |  |  |      ^   ^        ^
//                    |            EdgeWindow, EdgeRows <-------+  |  |  |      |   |        |
//                    |                |                           |  |  |      |   |        |
//                    |                v                           |  |  |      |   |        |
//                    |            EndpointPredictor h, v <--------+  |  |      |   |        |
//                    |                |                              |  |      |   |        |
//                    |                v                              |  |      |   |        |
//                    |            LineUnit h, v ------------ lines --|--|------+   |        |
//                    |                                               |  |          |        |
//                    |            DiagonalUnit <------ columns ------+  |          |        |
//                    |                +------------------ weights -------|----------+        |
//                    |                                                  |                   |
//                    +- guard slots --> TextGuard ------- guards -------|-------------------+
//                    |                                                  |                   |
//                    +- beats --> PixelStore <-------- fetches ---------+                   |
//                                   |   +--------------------- pixels ----------------------+
//      registers (TLM-2.0 target)   |
//          |          |             v
//   ParameterStore  WeightsLoader  MemoryPort: memory (TLM-2.0 initiator)
//                       |
//                       +- words --> tables of the AreaUnit
//
//   wires: ParameterStore -- configuration --> units of the pipeline
//          SlotSequencer -- first_beat, latch, framing, frame_done,
//          PixelStore -- memory_error --> ParameterStore
//          ParameterStore -- enabled, latched --> SlotSequencer
//
// DiagonalUnit, TextGuard, MemoryPort and WeightsLoader exist only with diagonals, text_guard,
// storage = memory and learned weights.
//
// Latency   A beat popped in cycle c is pushed in cycle c + (R + 5) x BPR + kPipelineLatency if
//           nothing stalls.
// Interval  1 beat (1, 2 or 4 pixels) per cycle; one slot per cycle.
// Stalls    `descriptors` (RunExtractor), `upstream` (SlotSequencer), `memory` and `rows`
//           (PixelStore), `downstream`.
// Source    Reshetov 2009; paper 000.
#pragma once

#include <functional>
#include <memory>
#include <systemc>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/engine.h"
#include "rtl_model/fabric/histogram.h"
#include "rtl_model/fabric/latency_probe.h"
#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/morphological/blend/area_unit.h"
#include "rtl_model/morphological/blend/blender.h"
#include "rtl_model/morphological/blend/diagonal_unit.h"
#include "rtl_model/morphological/blend/pixel_store.h"
#include "rtl_model/morphological/blend/weights_loader.h"
#include "rtl_model/morphological/common/parameter_store.h"
#include "rtl_model/morphological/front/edge_detector.h"
#include "rtl_model/morphological/front/luma_unit.h"
#include "rtl_model/morphological/front/slot_sequencer.h"
#include "rtl_model/morphological/front/text_guard.h"
#include "rtl_model/morphological/runs/edge_rows.h"
#include "rtl_model/morphological/runs/edge_window.h"
#include "rtl_model/morphological/runs/endpoint_predictor.h"
#include "rtl_model/morphological/runs/line_unit.h"
#include "rtl_model/morphological/runs/run_extractor.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"

namespace deburr::rtl::morphological {

class MorphologicalEngine final : public Engine {
 public:
  In<spec::morphological::PixelBeat> pixels_in{"pixels_in"};
  Out<spec::morphological::BlendedBeat> pixels_out{"pixels_out"};

  // Throws ConfigError if the parameters cannot be built (spec/morphological/check_build.h).
  MorphologicalEngine(const sc_core::sc_module_name& name, ClockDomain& clock,
                      const spec::morphological::Parameters& parameters);
  const char* kind() const override { return "deburr_morphological_engine"; }

 private:
  spec::morphological::Parameters parameters_;
  LatencyProbe probe_;

 public:
  // In pipeline order.
  ParameterStore parameter_store;
  EdgeWindow window;
  EdgeRows rows;
  SlotSequencer sequencer;
  LumaUnit luma;
  EdgeDetector edges;
  RunExtractor extractor;
  EndpointPredictor endpoint_predictor_h, endpoint_predictor_v;
  LineUnit line_unit_h, line_unit_v;
  AreaUnit area;
  std::unique_ptr<WeightsLoader> weights_loader;  // only with learned weights
  std::unique_ptr<DiagonalUnit> diagonals;        // only with diagonals
  std::unique_ptr<TextGuard> text_guard;          // only with text_guard
  PixelStore pixel_store;
  Blender blender;
  std::unique_ptr<MemoryPort> memory_port;  // only with storage = memory

  // No frame is inside and no beat waits at the input. Call between clock edges.
  bool idle() const override;
  std::vector<Datasheet> datasheets() const override;
  // Counts since the last reset or clear command: those of one frame if only one was processed.
  spec::morphological::Work work() const;
  // Cycles from popping a beat to pushing it.
  const Histogram& beat_latency = blender.beat_latency;

  // For checks: called for each run when it is found and for each line when it is stored. The
  // caller sorts into canonical order. Only descriptors with a side, or with learned weights, get a
  // line.
  void observe_runs(std::function<void(const spec::morphological::RunDescriptor&)> observer);
  void observe_lines(std::function<void(const spec::morphological::LineDescriptor&)> observer);

  const spec::morphological::Parameters& parameters() const { return parameters_; }

 private:
  // Configuration from the registers to the units, and the events that set sticky bits.
  Wire<FrameConfiguration> configuration_{"configuration", FrameConfiguration{},
                                          configuration_shape(parameters_)};
  Pulse first_beat_{"first_beat"}, latch_{"latch"};
  CombinationalWire<bool> enabled_{"enabled"};
  CombinationalWire<Decoded> latched_{"latched",
                                      configuration_shape(parameters_, "configuration.")};
  Pulse frame_done_{"frame_done"}, framing_{"framing"};
  std::unique_ptr<Pulse> memory_error_;
  const PayloadShape built_lanes_{.lanes = static_cast<std::uint32_t>(built_lanes(parameters_))};
  Link<SlotToken> slots_{"slots", 2, built_lanes_};
  Link<BeatToken> beats_{"beats", 2, built_lanes_};
  Link<LumaToken> lumas_{"lumas", 2, built_lanes_};
  Link<EdgeToken> edge_bits_{"edge_bits", 2, built_lanes_};
  Link<AreaSlotToken> area_slots_{"area_slots", 2,
                                  area_slot_shape(parameters_, built_lanes(parameters_))};
  Link<FetchToken> fetches_{"fetches"};
  Link<WeightToken> weights_{"weights", 2, built_lanes_};
  // Deep enough to hold a slot's pixels until its weights are ready.
  Link<PixelToken> pixels_{
      "pixels", spec::morphological::kAreaLatency - spec::morphological::kPixelStoreLatency + 2,
      built_lanes_};
  Link<FinishToken> finished_{"finished"};
  Link<FrameDoneToken> frames_done_{"frames_done"};
  LaneLinks<SumsToken> sums_h_, sums_v_;
  LaneLinks<LineToken> lines_h_, lines_v_;
  std::unique_ptr<Link<DiagonalColumnsToken>> columns_;
  std::unique_ptr<Link<GuardSlotToken>> guard_slots_;
  std::unique_ptr<Link<MemoryRequest>> requests_;
  std::unique_ptr<Link<MemoryResponse>> responses_;
};

}  // namespace deburr::rtl::morphological
