// SPDX-License-Identifier: MIT
// The edge memories with the content that the extractor writes, for tests of the units that read
// them.
#pragma once

#include <algorithm>

#include "rtl_model/morphological/runs/edge_rows.h"
#include "rtl_model/morphological/runs/edge_window.h"

namespace deburr::tb::morphological_rtl {

struct EdgeMemories {
  explicit EdgeMemories(const spec::morphological::Parameters& p)
      : window("edge_window", p),
        rows(p),
        lanes_(rtl::morphological::built_lanes(p)),
        search_range_(rtl::morphological::search_range_rows_of(p)) {}

  // Fills the memories as they are when the runs of row y have been found. left(x, y), top(x, y):
  // edge present?
  template <class Left, class Top>
  void show(const rtl::morphological::FrameConfiguration& configuration, int y, Left&& left,
            Top&& top) {
    const int newest = y + search_range_ + 1;
    const auto beat = [&](int row, int first) {
      rtl::morphological::EdgeBits bits;
      if (row < 0 || row >= configuration.height) return bits;
      for (int x = first; x < std::min<int>(first + lanes_, configuration.width); ++x) {
        bits.left = static_cast<std::uint8_t>(bits.left | int{left(x, row)} << (x - first));
        bits.top = static_cast<std::uint8_t>(bits.top | int{top(x, row)} << (x - first));
      }
      return bits;
    };
    for (int row = -1; row <= newest; ++row)
      for (int first = 0; first < configuration.width; first += lanes_) {
        window.read_beat(clock_++, configuration, first);
        window.write_beat(clock_++, configuration, first, row + 1, beat(row, first));
      }
    for (int row = std::max(0, y - rows.ahead());
         row < std::min<int>(configuration.height, y + rows.ahead()); ++row)
      for (int first = 0; first < configuration.width; first += lanes_) {
        const rtl::morphological::EdgeBits bits = beat(row, first);
        rows.write(clock_++, configuration, row, first, bits.left, bits.top);
      }
  }

  rtl::morphological::EdgeWindow window;
  rtl::morphological::EdgeRows rows;

 private:
  const int lanes_, search_range_;
  rtl::Cycle clock_ = rtl::Cycle{1} << 40;  // later than any cycle of a test
};

}  // namespace deburr::tb::morphological_rtl
