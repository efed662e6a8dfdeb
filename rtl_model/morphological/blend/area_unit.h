// SPDX-License-Identifier: MIT
// Gives the Blender the weights of the pixels across each edge, by its record's line: stores the
// records, walks along them with the raster, asks the units of weights, and brings two rows
// together.
//
//   lines -> DescriptorStore
//              |              +-> AnalyticWeights -+
//   slots -> DescriptorWalk ------+-> TableWeights ----+-> WeightRows -> weights
//             stages 1 to 3   +-> LearnedWeights --+    8 and 9
//                                   4 to 8 (7)    diagonals: 8
//
// Where: between the LineUnits and the Blender. In slot row s it evaluates row y = s - R - 4 as the
// raster passes: of each axis one edge a lane and clock. To the Blender go the weights of row y
// - 1. The parts inside are modules, and no units of the clock domain: all stages move together,
// theirs too, by one enable, so no beat waits between them, and nothing inside needs a link. An
// edge of no record (between head and tail of a long run) takes the learned weights of two ends out
// of sight: so the slot brings the edges of row y. Stalls: `downstream`; `diagonals` (those of a
// beat have not come: not in an engine whose rows begin as the RunExtractor lets them). Source:
// Reshetov 2009; paper 000, section 2; SMAA (Jimenez et al. 2012); paper 003.
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
  // From the DiagonalUnit, if it is built.
  std::optional<In<DiagonalWeightsToken>> diagonals_in;
  Out<WeightToken> weights_out{"weights_out"};
  Out<FinishToken> finished_out{"finished_out"};

  AreaUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
           const spec::morphological::Parameters& parameters);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter descriptors{"descriptors", "descriptors", "lines stored"};
  Counter horizontal_edges{"horizontal_edges", "edges",
                           "edges evaluated for horizontal run descriptors"};
  Counter vertical_edges{"vertical_edges", "edges", "edges evaluated for vertical run descriptors"};
  Counter bank_conflicts{"bank_conflicts", "clk",
                         "stores that waited for the write port of their bank"};

  // For checks: every line as it is stored.
  void observe_lines(std::function<void(const spec::morphological::LineDescriptor&)> observer) {
    descriptor_store_.observer = std::move(observer);
  }

  // By which the registers load the tables of learned weights; none in an engine without.
  std::optional<WeightsRom::LoadPort> weights_port() {
    return learned_ ? std::optional(learned_->rom.load_port()) : std::nullopt;
  }
  // For checks: these tables; nullptr in an engine without.
  WeightsRom* weights_rom() { return learned_ ? &learned_->rom : nullptr; }

  // Of slots; of lines: the DescriptorStore's. Its latency is the sum of its parts'.
  static Datasheet datasheet(const spec::morphological::Parameters& parameters);

 private:
  struct Beat {
    Slot slot;
    std::uint8_t left, top, next_left, next_top;
    bool takes_diagonals;
    DescriptorWalk::Beat walk;
    BeatWeights weights;

    bool works() const {
      return walk.row >= 0;
    }  // has weights of a row, or finds those of the next
  };

  // kSmaa, kLearned: as the DescriptorWalk's.
  template <bool kSmaa, bool kLearned>
  Activity work(Cycle cycle);
  // Once a clock each, from one place: inline.
  template <bool kSmaa>
  inline void enter(Cycle cycle, const FrameConfiguration& configuration,
                    const AreaSlotToken& token, Beat& beat);
  template <bool kSmaa, bool kLearned>
  [[gnu::noinline]] void ask(Cycle cycle, const FrameConfiguration& configuration, Beat& beat);
  void ask_gaps(const Beat& beat);
  template <bool kSmaa, bool kLearned>
  inline void ask_edge(const FrameConfiguration& configuration, Beat& beat, std::size_t number,
                       const StoredDescriptor& descriptor, const DescriptorWalk::Edge& edge);
  // The next move brings a beat to stage 8 whose diagonals are not there.
  bool waits_for_diagonals(Cycle cycle) {
    const Beat* const beat = pipe_.at(7);
    return beat && beat->takes_diagonals && !diagonals_in->can_pop(cycle);
  }
  void take_diagonals(Cycle cycle, Beat& beat);
  // Of the beat in this stage, for a unit inside; nullptr: a bubble.
  BeatWeights* weights_in(std::size_t stage) {
    Beat* const beat = pipe_.at(stage);
    return beat ? &beat->weights : nullptr;
  }
  void send(Cycle cycle, const FrameConfiguration& configuration, const Beat& beat);

  const std::size_t lanes_;
  const std::int32_t lag_;     // rows from a slot to the row that it blends
  const std::size_t columns_;  // of the longest row, in whole beats, of a pair at least
  const bool smaa_;            // built with any block of SMAA's

  // The parts, in the order of the stages.
  DescriptorStore descriptor_store_;
  DescriptorWalk descriptor_walk_;
  AnalyticWeights analytic_{"analytic"};
  std::unique_ptr<TableWeights> table_;
  std::unique_ptr<LearnedWeights> learned_;
  WeightRows weight_rows_;

  std::optional<Activity> diagonals_;  // waits for their weights
  Pipe<Beat, spec::morphological::kAreaLatency> pipe_;
};

}  // namespace deburr::rtl::morphological
