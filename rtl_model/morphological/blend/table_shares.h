// SPDX-License-Identifier: MIT
// Shares by SMAA's table of areas: by the distances of an edge to both ends of its line.
//
// Where: in the AreaUnit, behind its stage 3, with whose stages it moves. Latency 6, a beat a
// clock. Stages, counted as the AreaUnit's: 4 k - a, b - 1 - k, limits of the searches, shape that
// is left, sqrt_rom: address; 5 roots, area_rom: address; 6 entries, differences; 7, 8
// interpolation; 9 corner factor. The model does the arithmetic of 7 to 9 in stage 6. Where the
// ends of a line lie is found as it is stored, in a clock of its own. Formats: a, b S13, shares
// U0.8. Cost: AreaTable's; at the entrance of each axis and lane two multipliers 18 x 24; with
// corners two 10 x 8. Made for 250 MHz; longest path: 18 x 24 multiply. Source: SMAA (Jimenez et
// al. 2012); paper 003.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/pipe.h"
#include "rtl_model/morphological/blend/area_table.h"
#include "rtl_model/morphological/blend/area_walk.h"

namespace deburr::rtl::morphological {

class TableShares final : public sc_core::sc_module {
 public:
  TableShares(const sc_core::sc_module_name& name, spec::morphological::AreaSource layout,
              const ParameterStore& store);

  // As a line is stored: where its ends lie, as if a step were its whole length, rounded to whole
  // pixels.
  static void set_ends(AreaWalk& walk);

  // The stages move on: before stage 3 asks for its beat. `beat`: the shares of the AreaUnit's beat
  // in stage 6, if there is one.
  void move(Cycle cycle, BeatShares* beat) {
    if (!pipe_.empty()) move_on(cycle, beat);
  }
  // Stage 3: the edge of a beat that is pixel k of this record.
  void ask(std::size_t edge, const AreaWalk& walk, std::int32_t k, std::uint8_t near);
  void reset() { pipe_.reset(); }

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
  void move_on(Cycle cycle, BeatShares* shares);
  void cut(Cycle cycle, Beat& beat);

  const ParameterStore& store_;
  AreaTable table_;
  Pipe<Beat, 4> pipe_;  // stages 3 to 6
};

}  // namespace deburr::rtl::morphological
