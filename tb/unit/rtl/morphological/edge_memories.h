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
    for (int first = 0; first < rules.width; first += lanes) {
      window.read_beat(clock_++, first);
      rtl::morphological::EdgeColumn* const columns =
          window.write_beat(clock_++, first, newest + 1);
      for (int x = first; x < std::min(first + lanes, rules.width); ++x) {
        rtl::morphological::EdgeColumn& column = columns[x - first];
        column = {};
        for (int row = 0; row <= newest; ++row) {
          const bool inside = row < rules.height;
          column.left.move_on(inside && left(x, row), window.rows());
          column.top.move_on(inside && top(x, row), window.rows());
        }
      }
    }
    for (int row = std::max(0, y - rows.ahead()); row < std::min(rules.height, y + rows.ahead());
         ++row)
      for (int first = 0; first < rules.width; first += lanes) {
        unsigned lefts = 0, tops = 0;
        for (int x = first; x < std::min(first + lanes, rules.width); ++x) {
          lefts |= unsigned{left(x, row)} << (x - first);
          tops |= unsigned{top(x, row)} << (x - first);
        }
        rows.write(clock_++, row, first, static_cast<std::uint8_t>(lefts),
                   static_cast<std::uint8_t>(tops));
      }
  }

  const rtl::morphological::ParameterStore& store;
  rtl::morphological::EdgeWindow window;
  rtl::morphological::EdgeRows rows;

 private:
  rtl::Cycle clock_ = rtl::Cycle{1} << 40;  // outside of time
};

}  // namespace deburr::tb::morphological_rtl
