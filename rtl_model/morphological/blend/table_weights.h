// SPDX-License-Identifier: MIT
// Weights by SMAA's table of areas: by the distances of an edge to both ends of its line.
//
// Where: in the AreaUnit, behind its DescriptorWalk, with whose stages it moves; the tables are the
// AreaTable's. The model does the arithmetic of its stages 4 and 5, and the corner factor behind
// them, in stage 3. Where the ends of a line lie is found as it is stored (DescriptorStore), in a
// clock of its own. Source: SMAA (Jimenez et al. 2012); paper 003.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/morphological/blend/area_table.h"
#include "rtl_model/morphological/blend/edge_weights.h"
#include "rtl_model/morphological/blend/stored_descriptor.h"
#include "rtl_model/morphological/common/frame_configuration.h"

namespace deburr::rtl::morphological {

class TableWeights final : public sc_core::sc_module {
 public:
  TableWeights(const sc_core::sc_module_name& name,
               const spec::morphological::Parameters& parameters);

  // As a line is stored: where its ends lie, as if a step were its whole length, rounded to whole
  // pixels; an endless one as far away as there is. `endless`: bit 0 the start, bit 1 the end.
  static void set_ends(StoredDescriptor& descriptor, std::uint8_t endless);

  // The stages move on: before the walk asks for its beat. `beat`: the weights of the beat in stage
  // 3 here, stage 6 of the AreaUnit, if there is one.
  void move(Cycle cycle, const FrameConfiguration& configuration, BeatWeights* beat) {
    if (!pipe_.empty()) move_on(cycle, configuration, beat);
  }
  // The walk's last stage: the edge of a beat that is pixel k of this record.
  void ask(std::size_t edge, const StoredDescriptor& descriptor, std::int32_t k);
  void reset() { pipe_.reset(); }

  static Datasheet datasheet();

 private:
  // An edge on its way through the table.
  struct Search {
    std::int32_t left = 0, right = 0;  // S14, pixels before and behind
    AreaTable::Query query;
    std::uint8_t far = 0, near = 0;
    std::uint16_t span = 0;
  };
  struct Beat {
    std::uint8_t asks;  // bit: an edge that asks
    std::array<Search, kBeatEdges> search;
  };
  template <class Visit>
  static void for_each(Beat& beat, Visit&& visit) {
    for (unsigned left = beat.asks; left != 0; left &= left - 1) {
      const auto edge = static_cast<std::size_t>(std::countr_zero(left));
      visit(edge, beat.search[edge]);
    }
  }
  void move_on(Cycle cycle, const FrameConfiguration& configuration, BeatWeights* weights);
  void cut(Cycle cycle, std::int32_t search_steps, Beat& beat);

  AreaTable table_;
  Pipe<Beat, 4> pipe_;  // the walk's last stage, and stages 1 to 3
};

}  // namespace deburr::rtl::morphological
