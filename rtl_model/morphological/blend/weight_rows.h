// SPDX-License-Identifier: MIT
// Keeps the weights of a row of edges for the next one, and brings those of both to the Blender.
//
// Where: the end of the AreaUnit: a beat's columns are addressed in its stage 8 and written in 9,
// in which the weights of the row above leave with those of the top edges as they come from the
// units of weights. So a pixel gets the weights of the edges about it, of row y - 1. A read sees
// what is written in its clock, so that rows of any length, of one beat as well, need no stall. Of
// top edges only what the row below takes is kept. Source: Reshetov 2009.
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
  // `columns`: as the DescriptorStore's.
  WeightRows(const sc_core::sc_module_name& name, const spec::morphological::Parameters& parameters,
             std::size_t columns);

  // The columns of a beat, which begins at x, and the one beside it.
  void read(Cycle cycle, std::size_t x) {
    read_.read(cycle, x, std::min<std::size_t>(lanes_ + 1, columns_ - x));
  }
  // In the clock after: the weights of this row take their place. The words have not changed since
  // but by what was written in the clock of the read, which that sees.
  void write(Cycle cycle, std::size_t x, std::size_t beat, const BeatWeights& weights) {
    write_.write(cycle, x, lanes_);
    words_[beat] = weights;
  }
  // Before that: what the `count` pixels of the row above get, in a frame of this width.
  inline void join(Cycle cycle, std::size_t width, std::size_t x, std::size_t count,
                   std::size_t beat, const BeatWeights& below, WeightToken& out) const;

  static Datasheet datasheet();

 private:
  const std::size_t lanes_, columns_;
  Memory<void> memory_;
  ReadPort<void> read_{memory_, "row above"};
  WritePort<void> write_{memory_, "row"};
  std::vector<BeatWeights> words_;  // by beat; of top, `first` is used as it is evaluated
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
