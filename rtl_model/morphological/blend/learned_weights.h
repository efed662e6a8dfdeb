// SPDX-License-Identifier: MIT
// Learned weights for edges whose descriptor has no line, and for edges without a descriptor.
//
// Position  In the AreaUnit after the DescriptorWalk, with whose stages it advances; the tables are
//           in WeightsRom. An edge without a descriptor (between head and tail of a long run) takes
//           the weights of two ends out of range.
// Source    Ours (docs/reference/morphological/learned_weights.md).
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

  // Advances the stages. Call before the walk's ask() of the same cycle. `beat`: weights of the
  // beat in the last stage here (stage 7 of the AreaUnit), or nullptr.
  void move(Cycle cycle, BeatWeights* beat);
  // Last stage of the walk: the edge is pixel `before` of this descriptor, with `after` pixels
  // after it.
  void ask(std::size_t edge, const StoredDescriptor& descriptor, std::int32_t before,
           std::int32_t after) {
    newest(edge) = WeightsRom::ask(
        {descriptor.shape, descriptor.start_class, descriptor.end_class, descriptor.part}, before,
        after);
  }
  // An edge without a descriptor.
  void ask_gap(std::size_t edge) { newest(edge) = WeightsRom::ask_gap(); }
  void reset() { pipe_.reset(); }

  static Datasheet datasheet(const spec::morphological::Parameters& parameters = {});

  // For the registers, which load words while no frame is inside.
  WeightsRom rom;

 private:
  struct Beat {
    std::uint8_t asks;  // bit mask of edges with a query
    std::array<WeightsRom::Query, kBeatEdges> query;
  };
  // Query slot in the beat of the walk's last stage.
  WeightsRom::Query& newest(std::size_t edge) {
    Beat* beat = pipe_.at(1);
    if (!beat) {
      beat = &pipe_.enter();
      beat->asks = 0;
    }
    beat->asks = static_cast<std::uint8_t>(beat->asks | 1u << edge);
    return beat->query[edge];
  }

  Pipe<Beat, 5> pipe_;  // last stage of the walk, then stages 1 to 4
};

}  // namespace deburr::rtl::morphological
