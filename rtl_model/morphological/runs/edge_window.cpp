// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/runs/edge_window.h"

#include <string>

namespace deburr::rtl::morphological {
namespace {

constexpr int kSides = 2;  // of a predictor: the two ends of its run

int predictors(const spec::morphological::Parameters& p) {  // an axis
  return p.predictor_units * spec::morphological::kLaneCount[static_cast<std::size_t>(p.lanes)];
}

int column_reads(const spec::morphological::Parameters& p) {
  const int horizontal = p.contiguous ? 2 : 1, vertical = 1;
  return 1 + kSides * predictors(p) * (horizontal + vertical);
}

int row_reads(const spec::morphological::Parameters& p) { return kSides * predictors(p); }

std::string port_list(int reads) { return std::to_string(reads) + "R1W"; }

}  // namespace

EdgeRows::EdgeRows(const char* name, const spec::morphological::Parameters& p)
    : ColumnStorage(name, p.line_pixels, static_cast<std::uint32_t>(p.window_rows + 1),
                    port_list(row_reads(p))),
      stretch_((p.reach_columns + 1) / 2),
      reads_(*this, row_reads(p)) {}

EdgeWindow::EdgeWindow(const char* name, const spec::morphological::Parameters& p,
                       const ParameterStore& store)
    : ColumnStorage(name, p.line_pixels, static_cast<std::uint32_t>(2 * (p.window_rows + 1)),
                    port_list(column_reads(p))),
      store_(store),
      reads_(*this, column_reads(p)),
      rows_(p.contiguous ? std::make_unique<EdgeRows>("edge_rows", p) : nullptr),
      // One bit before and one after the frame, and a word that Row::from() may touch.
      plane_((static_cast<std::size_t>(p.line_pixels) + 2 + 63) / 64 + 1),
      row_at_(spec::morphological::kMaxFrameSize),
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

bool EdgeWindow::unbroken(std::int32_t x, std::int32_t y, std::int32_t count) const {
  DEBURR_CHECK(count <= rows_->stretch(),
               std::string(rows_->name()) + ": a port gives " + std::to_string(rows_->stretch()) +
                   " edges of a row, " + std::to_string(count) + " were asked for");
  if (x < 0) return false;
  const Row row = top(y);
  for (const std::int32_t end = x + count; x < end; x += 64) {
    const std::int32_t left = end - x;
    const std::uint64_t mask = left >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << left) - 1;
    if ((row.from(x) & mask) != mask) return false;
  }
  return true;
}

void EdgeWindow::fail(std::int32_t x) const {
  throw spec::CheckFailed(std::string(name()) + ": column " + std::to_string(x) +
                          " is not among those that the port reads");
}

}  // namespace deburr::rtl::morphological
