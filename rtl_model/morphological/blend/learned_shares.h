// SPDX-License-Identifier: MIT
// Learned shares of the edges whose record has no line, and of those that no record covers.
//
// Where: in the AreaUnit, behind its stage 3, with whose stages it moves. Latency 4, a beat a
// clock. Stages, counted as the AreaUnit's: 4 distances to both ends, the nearer one, addresses of
// three tables; 5 words; 6 their sum, address of share_rom; 7 shares. An edge of no record (between
// head and tail of a long run) takes that of two ends out of sight. Format: shares U0.8. Cost an
// axis and lane: a 12-bit subtract and SharesRom's. Made for 250 MHz; longest path: SharesRom's.
// Source: ours (docs/morphological_shares.md).
#pragma once

#include <array>
#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/pipe.h"
#include "rtl_model/morphological/blend/area_walk.h"
#include "rtl_model/morphological/blend/shares_rom.h"

namespace deburr::rtl::morphological {

class LearnedShares final : public sc_core::sc_module {
 public:
  LearnedShares(const sc_core::sc_module_name& name, int lanes) : sc_module(name), rom(lanes) {}

  // The stages move on: before stage 3 asks for its beat. `beat`: the shares of the AreaUnit's beat
  // in stage 7, if there is one.
  void move(Cycle cycle, BeatShares* beat);
  // Stage 3: the edge of a beat that is pixel `before` of this record, with `after` pixels behind
  // it.
  void ask(std::size_t edge, const AreaWalk& walk, std::int32_t before, std::int32_t after) {
    newest(edge) =
        SharesRom::ask({walk.shape, walk.start_class, walk.end_class, walk.part}, before, after);
  }
  // An edge of no record.
  void ask_gap(std::size_t edge) { newest(edge) = SharesRom::ask_gap(); }
  void reset() { pipe_.reset(); }

  // For the registers: words are loaded while no frame is inside.
  SharesRom rom;

 private:
  struct Beat {
    std::uint8_t asks;  // bit: an edge that asks
    std::array<SharesRom::Query, kBeatEdges> query;
  };
  // Of the beat in stage 3.
  SharesRom::Query& newest(std::size_t edge) {
    Beat* beat = pipe_.at(1);
    if (!beat) {
      beat = &pipe_.enter();
      beat->asks = 0;
    }
    beat->asks = static_cast<std::uint8_t>(beat->asks | 1u << edge);
    return beat->query[edge];
  }

  Pipe<Beat, 5> pipe_;  // stages 3 to 7
};

}  // namespace deburr::rtl::morphological
