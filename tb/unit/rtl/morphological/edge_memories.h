// SPDX-License-Identifier: MIT
// The memories of edges for tests of what reads them: filled as the extractor leaves them.
#pragma once

#include <algorithm>

#include "rtl_model/morphological/runs/edge_rows.h"
#include "rtl_model/morphological/runs/edge_window.h"

namespace deburr::tb::morphological_rtl {

struct EdgeMemories {
  EdgeMemories(const spec::morphological::Parameters& p,
               const rtl::morphological::ParameterStore& from)
      : store(from), window("edge_window", p, from), rows(p, from) {}

  // When the runs of row y have been found. left(x, y), top(x, y): is there an edge?
  template <class Left, class Top>
  void show(int y, Left&& left, Top&& top) {
    const rtl::morphological::FrameRules& rules = store.rules();
    const int lanes = store.lanes(), newest = y + store.reach_rows() + 1;
    const auto beat = [&](int row, int first) {
      rtl::morphological::EdgeBits bits;
      if (row < 0 || row >= rules.height) return bits;
      for (int x = first; x < std::min(first + lanes, rules.width); ++x) {
        bits.left = static_cast<std::uint8_t>(bits.left | int{left(x, row)} << (x - first));
        bits.top = static_cast<std::uint8_t>(bits.top | int{top(x, row)} << (x - first));
      }
      return bits;
    };
    for (int row = -1; row <= newest; ++row)
      for (int first = 0; first < rules.width; first += lanes) {
        window.read_beat(clock_++, first);
        window.write_beat(clock_++, first, row + 1, beat(row, first));
      }
    for (int row = std::max(0, y - rows.ahead()); row < std::min(rules.height, y + rows.ahead());
         ++row)
      for (int first = 0; first < rules.width; first += lanes) {
        const rtl::morphological::EdgeBits bits = beat(row, first);
        rows.write(clock_++, row, first, bits.left, bits.top);
      }
  }

  const rtl::morphological::ParameterStore& store;
  rtl::morphological::EdgeWindow window;
  rtl::morphological::EdgeRows rows;

 private:
  rtl::Cycle clock_ = rtl::Cycle{1} << 40;  // outside of time
};

}  // namespace deburr::tb::morphological_rtl
