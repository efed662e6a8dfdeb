// SPDX-License-Identifier: MIT
// Learned weights of the edges whose record has no line, and of those that no record covers.
//
// Where: in the AreaUnit, behind its DescriptorWalk, with whose stages it moves; the tables are the
// WeightsRom's. An edge of no record (between head and tail of a long run) takes the weights of two
// ends out of sight. Source: ours (docs/reference/morphological/learned_weights.md).
#pragma once

#include <array>
#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/morphological/blend/edge_weights.h"
#include "rtl_model/morphological/blend/stored_descriptor.h"
#include "rtl_model/morphological/blend/weights_rom.h"

namespace deburr::rtl::morphological {

class LearnedWeights final : public sc_core::sc_module {
 public:
  LearnedWeights(const sc_core::sc_module_name& name, int lanes) : sc_module(name), rom(lanes) {}

  // The stages move on: before the walk asks for its beat. `beat`: the weights of the beat in the
  // last stage here, stage 7 of the AreaUnit, if there is one.
  void move(Cycle cycle, BeatWeights* beat);
  // The walk's last stage: the edge of a beat that is pixel `before` of this record, with `after`
  // pixels behind it.
  void ask(std::size_t edge, const StoredDescriptor& descriptor, std::int32_t before,
           std::int32_t after) {
    newest(edge) = WeightsRom::ask(
        {descriptor.shape, descriptor.start_class, descriptor.end_class, descriptor.part}, before,
        after);
  }
  // An edge of no record.
  void ask_gap(std::size_t edge) { newest(edge) = WeightsRom::ask_gap(); }
  void reset() { pipe_.reset(); }

  static Datasheet datasheet();

  // For the registers: words are loaded while no frame is inside.
  WeightsRom rom;

 private:
  struct Beat {
    std::uint8_t asks;  // bit: an edge that asks
    std::array<WeightsRom::Query, kBeatEdges> query;
  };
  // Of the beat in the walk's last stage.
  WeightsRom::Query& newest(std::size_t edge) {
    Beat* beat = pipe_.at(1);
    if (!beat) {
      beat = &pipe_.enter();
      beat->asks = 0;
    }
    beat->asks = static_cast<std::uint8_t>(beat->asks | 1u << edge);
    return beat->query[edge];
  }

  Pipe<Beat, 5> pipe_;  // the walk's last stage, and stages 1 to 4
};

}  // namespace deburr::rtl::morphological
