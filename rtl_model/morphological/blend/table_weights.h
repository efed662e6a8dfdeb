// SPDX-License-Identifier: MIT
// Computes weights from SMAA's area table, by the distances of an edge to both ends of its line.
//
// Position  In the AreaUnit after the DescriptorWalk, with whose stages it advances; the tables are
//           in AreaTable. The model computes stages 4 and 5 and the corner factor in stage 3. The
//           ends of a line are computed when it is stored (DescriptorStore), in a separate cycle.
// Source    SMAA (Jimenez et al. 2012); paper 003.
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

  // Called when a line is stored: positions of its ends, as if a step took its whole length,
  // rounded to whole pixels; an endless end is as far away as the format allows. `endless`: bit 0
  // start, bit 1 end.
  static void set_ends(StoredDescriptor& descriptor, std::uint8_t endless);

  // Advances the stages. Call before the walk's ask() of the same cycle. `beat`: weights of the
  // beat in stage 3 here (stage 6 of the AreaUnit), or nullptr.
  void move(Cycle cycle, const FrameConfiguration& configuration, BeatWeights* beat) {
    if (!pipe_.empty()) move_on(cycle, configuration, beat);
  }
  // Last stage of the walk: the edge is pixel k of this descriptor.
  void ask(std::size_t edge, const StoredDescriptor& descriptor, std::int32_t k);
  void reset() { pipe_.reset(); }

  static Datasheet datasheet(const spec::morphological::Parameters& parameters = {});

 private:
  // An edge in flight.
  struct Search {
    std::int32_t left = 0, right = 0;  // S14, pixels before and after
    AreaTable::Query query;
    std::uint8_t far = 0, near = 0;
    std::uint16_t span = 0;
  };
  struct Beat {
    std::uint8_t asks;  // bit mask of edges with a query
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
  Pipe<Beat, 4> pipe_;  // last stage of the walk, then stages 1 to 3
};

}  // namespace deburr::rtl::morphological
