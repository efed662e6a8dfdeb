// SPDX-License-Identifier: MIT
// Computes the weights of the pixels on both sides of each edge, from its descriptor's line: stores
// the descriptors, walks along them in raster order, queries the weight units, and combines the
// weights of two rows for the Blender.
//
//   lines -> DescriptorStore
//              |              +-> AnalyticWeights -+
//   slots -> DescriptorWalk ------+-> TableWeights ----+-> WeightRows -> weights
//             stages 1 to 3   +-> LearnedWeights --+    8 and 9
//                                   4 to 8 (7)    diagonals: 8
//
// Position  LineUnits -> AreaUnit -> Blender. Slot row s evaluates row y = s - R - 4, one edge per
//           axis, lane and cycle, and outputs the weights of row y - 1.
// Structure The parts are modules, not units of the clock domain: one enable advances all stages
//           together, so no link is needed inside.
// Stalls    downstream
//           diagonals   The diagonals of a beat are missing. Cannot occur when the RunExtractor
//                       delays short rows.
// Note      An edge without a descriptor (between head and tail of a long run) takes the learned
//           weights of two ends out of range. The slot brings the edges of row y so that such an
//           edge is seen.
// Source    Reshetov 2009; paper 000, section 2; SMAA (Jimenez et al. 2012); paper 003.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <systemc>
#include <utility>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/morphological/blend/analytic_weights.h"
#include "rtl_model/morphological/blend/descriptor_store.h"
#include "rtl_model/morphological/blend/descriptor_walk.h"
#include "rtl_model/morphological/blend/edge_weights.h"
#include "rtl_model/morphological/blend/learned_weights.h"
#include "rtl_model/morphological/blend/table_weights.h"
#include "rtl_model/morphological/blend/weight_rows.h"
#include "rtl_model/morphological/common/frame_configuration.h"
#include "rtl_model/morphological/common/tokens.h"

namespace deburr::rtl::morphological {

class AreaUnit final : public Unit {
 public:
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  In<AreaSlotToken> slots_in{"slots_in"};
  LanePorts<In<LineToken>> lines_h_in, lines_v_in;
  // Only with diagonals.
  std::optional<In<DiagonalWeightsToken>> diagonals_in;
  Out<WeightToken> weights_out{"weights_out"};
  Out<FinishToken> finished_out{"finished_out"};

  AreaUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
           const spec::morphological::Parameters& parameters);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter descriptors{"descriptors", "descriptors", "lines stored"};
  Counter horizontal_edges{"horizontal_edges", "edges",
                           "edges evaluated in horizontal descriptors"};
  Counter vertical_edges{"vertical_edges", "edges", "edges evaluated in vertical descriptors"};
  Counter bank_conflicts{"bank_conflicts", "clk",
                         "cycles in which lines waited for the write port of their bank, summed"};

  // For checks: called with every line when it is stored.
  void observe_lines(std::function<void(const spec::morphological::LineDescriptor&)> observer) {
    descriptor_store_.observer = std::move(observer);
  }

  // Port through which the registers load the tables; empty without learned weights.
  std::optional<WeightsRom::LoadPort> weights_port() {
    return learned_ ? std::optional(learned_->rom.load_port()) : std::nullopt;
  }
  // For checks: the tables; nullptr without learned weights.
  WeightsRom* weights_rom() { return learned_ ? &learned_->rom : nullptr; }

  // For slots; for lines see DescriptorStore. The latency is the sum of the parts'.
  static Datasheet datasheet(const spec::morphological::Parameters& parameters);

 private:
  struct Beat {
    Slot slot;
    std::uint8_t left, top, next_left, next_top;
    bool takes_diagonals;
    DescriptorWalk::Beat walk;
    BeatWeights weights;

    // Outputs weights of a row, or computes those of the next row.
    bool works() const { return walk.row >= 0; }
  };

  // kSmaa, kLearned: see DescriptorWalk.
  template <bool kSmaa, bool kLearned>
  Activity work(Cycle cycle);
  // Each is called once per cycle from one place, hence inline.
  template <bool kSmaa>
  inline void enter(Cycle cycle, const FrameConfiguration& configuration,
                    const AreaSlotToken& token, Beat& beat);
  template <bool kSmaa, bool kLearned>
  [[gnu::noinline]] void ask(Cycle cycle, const FrameConfiguration& configuration, Beat& beat);
  void ask_gaps(const Beat& beat);
  template <bool kSmaa, bool kLearned>
  inline void ask_edge(const FrameConfiguration& configuration, Beat& beat, std::size_t number,
                       const StoredDescriptor& descriptor, const DescriptorWalk::Edge& edge);
  // Would the next move bring a beat to stage 8 whose diagonals are missing?
  bool waits_for_diagonals(Cycle cycle) {
    const Beat* const beat = pipe_.at(7);
    return beat && beat->takes_diagonals && !diagonals_in->can_pop(cycle);
  }
  void take_diagonals(Cycle cycle, Beat& beat);
  // Weights of the beat in this stage; nullptr for a bubble.
  BeatWeights* weights_in(std::size_t stage) {
    Beat* const beat = pipe_.at(stage);
    return beat ? &beat->weights : nullptr;
  }
  void send(Cycle cycle, const FrameConfiguration& configuration, const Beat& beat);

  const std::size_t lanes_;
  const std::int32_t lag_;     // rows from a slot to the row that it blends
  const std::size_t columns_;  // of the longest row, rounded up to whole beats and pairs
  const bool smaa_;            // built with any SMAA block

  // Parts in stage order.
  DescriptorStore descriptor_store_;
  DescriptorWalk descriptor_walk_;
  AnalyticWeights analytic_{"analytic"};
  std::unique_ptr<TableWeights> table_;
  std::unique_ptr<LearnedWeights> learned_;
  WeightRows weight_rows_;

  std::optional<Activity> diagonals_;  // stall: waits for their weights
  Pipe<Beat, spec::morphological::kAreaLatency> pipe_;
};

}  // namespace deburr::rtl::morphological
