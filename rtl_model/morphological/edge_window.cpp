// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/edge_window.h"

#include <string>

namespace deburr::rtl::morphological {
namespace {

std::string port_list(const spec::MorphologicalParameters& p) {
  const int lanes = spec::kLaneCount[static_cast<std::size_t>(p.lanes)];
  return std::to_string(4 + 2 * 2 * p.predictor_units * lanes) + "R1W";
}

}  // namespace

EdgeWindow::EdgeWindow(const char* name, const spec::MorphologicalParameters& p,
                       const ParameterStore& store)
    : ColumnStorage(name, p.line_pixels, static_cast<std::uint32_t>(2 * (p.window_rows + 1)),
                    port_list(p)),
      store_(store),
      // One bit before and one after the frame, and a word that Row::from() may touch.
      plane_((static_cast<std::size_t>(p.line_pixels) + 2 + 63) / 64 + 1),
      row_at_(spec::kMaxFrameSize),
      bits_(2 * plane_ * static_cast<std::size_t>(p.window_rows + 1)),
      none_(plane_) {
  const auto rows = static_cast<std::size_t>(p.window_rows + 1);
  for (std::size_t y = 0; y < row_at_.size(); ++y)
    row_at_[y] = static_cast<std::uint32_t>(y % rows * 2 * plane_);
}

void EdgeWindow::write(std::int32_t y, std::int32_t x, std::uint8_t left, std::uint8_t top,
                       int lanes) {
  std::uint64_t* const row = bits_.data() + row_at_[static_cast<std::size_t>(y)];
  const auto put = [&](std::uint64_t* words, std::uint8_t value) {
    const auto bit = static_cast<std::uint32_t>(x + 1);
    std::uint64_t& word = words[bit / 64];
    // Columns not yet written hold an old row: cleared to the end of the word.
    const std::uint64_t before = (std::uint64_t{1} << bit % 64) - 1;
    word = (x == 0 ? 0 : word & before) | std::uint64_t{value} << bit % 64;
    const bool crosses = bit % 64 + static_cast<std::uint32_t>(lanes) >= 64;
    if (crosses) words[bit / 64 + 1] = bit % 64 ? std::uint64_t{value} >> (64 - bit % 64) : 0;
  };
  put(row, left);
  put(row + plane_, top);
}

}  // namespace deburr::rtl::morphological
