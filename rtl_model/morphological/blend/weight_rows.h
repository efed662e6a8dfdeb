// SPDX-License-Identifier: MIT
// Stores the weights of a row of edges and joins them with the next row's for the Blender.
//
// Position  Stages 8 (address) and 9 (read, write) of the AreaUnit. In stage 9 the weights of the
//           row above leave together with those of this row's top edges, so the pixels of row y - 1
//           get the weights of all edges around them.
// Memory    A read in the cycle of a write returns the new word, so rows of any length, even one
//           beat, need no stall. Of a top edge only the weight for the row below is stored.
// Source    Reshetov 2009.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/morphological/blend/edge_weights.h"
#include "rtl_model/morphological/common/tokens.h"

namespace deburr::rtl::morphological {

class WeightRows final : public sc_core::sc_module {
 public:
  // `columns`: as in DescriptorStore.
  WeightRows(const sc_core::sc_module_name& name, const spec::morphological::Parameters& parameters,
             std::size_t columns);

  // Reads the columns of the beat that begins at x, and the column to its right.
  void read(Cycle cycle, std::size_t x) {
    read_.read(cycle, x, std::min<std::size_t>(lanes_ + 1, columns_ - x));
  }
  // One cycle after read(): stores the weights of this row. Between the two, the words change only
  // by a write in the cycle of the read, and that read returns the new word.
  void write(Cycle cycle, std::size_t x, std::size_t beat, const BeatWeights& weights) {
    write_.write(cycle, x, lanes_);
    words_[beat] = weights;
  }
  // Before write(): weights for `count` pixels of the row above, in a frame of this width.
  inline void join(Cycle cycle, std::size_t width, std::size_t x, std::size_t count,
                   std::size_t beat, const BeatWeights& below, WeightToken& out) const;

  static Datasheet datasheet(const spec::morphological::Parameters& parameters = {});

 private:
  const std::size_t lanes_, columns_;
  Memory<void> memory_;
  ReadPort<void> read_{memory_, "row above"};
  WritePort<void> write_{memory_, "row"};
  std::vector<BeatWeights> words_;  // by beat; top.first is not stored in hardware
};

void WeightRows::join(Cycle cycle, std::size_t width, std::size_t x, std::size_t count,
                      std::size_t beat, const BeatWeights& below, WeightToken& out) const {
  read_.check(cycle, x);
  const BeatWeights* const above = &words_[beat];
  const auto right_of = [&](std::size_t i) {
    return i + 1 < lanes_      ? above[0][i + 1].left
           : x + i + 1 < width ? above[1][0].left
                               : EdgeWeights{};
  };
  out.any = false;
  for (std::size_t i = 0; i < count; ++i)
    out.any |= (above[0][i].top.second | below[i].top.first | above[0][i].left.second |
                right_of(i).first) != 0;
  if (!out.any) return;
  for (std::size_t i = 0; i < count; ++i) {
    const EdgeWeights up = above[0][i].top, down = below[i].top;
    const EdgeWeights left = above[0][i].left, right = right_of(i);
    out.weights[i] = {up.second, down.first, left.second, right.first,
                      up.span,   down.span,  left.span,   right.span};
  }
}

}  // namespace deburr::rtl::morphological
