// SPDX-License-Identifier: MIT
// The edges of the last rows, both planes, as bit masks that runs and corners are read from.
//
// Where: written by the RunExtractor, a beat of one row a clock; read by it and by the
// EndpointPredictors. Holds window_rows + 1 rows: R rows on either side of the row whose runs are
// being predicted, one row for the records that are still under way when the next slot row has
// begun, and the row that is being written. Edges outside the frame read as 0. Cost: (window_rows
// + 1) x 2 bits a column; ports: 1 write, 4 reads of the extractor (its row and the row before, the
// end of a column's run, the row being blended) and 2 reads a predictor of either axis.
//
// The model keeps a row of a plane as 64-bit words; bit 0 of a row stands for the column left of
// the frame, so that a corner's two edges along a row are neighbouring bits.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "rtl_model/morphological/line_memory.h"
#include "rtl_model/morphological/parameter_store.h"

namespace deburr::rtl::morphological {

class EdgeWindow final : public ColumnStorage {
 public:
  // A row of one plane.
  class Row {
   public:
    Row() = default;
    explicit Row(const std::uint64_t* words) : words_(words) {}
    // x = -1..width
    bool operator[](std::int32_t x) const {
      const auto bit = static_cast<std::uint32_t>(x + 1);
      return words_[bit / 64] >> (bit % 64) & 1;
    }
    // The 64 bits from x on.
    std::uint64_t from(std::int32_t x) const {
      const auto bit = static_cast<std::uint32_t>(x + 1);
      const std::uint64_t low = words_[bit / 64] >> (bit % 64);
      return bit % 64 ? low | words_[bit / 64 + 1] << (64 - bit % 64) : low;
    }

   private:
    const std::uint64_t* words_ = nullptr;
  };

  EdgeWindow(const char* name, const spec::MorphologicalParameters& parameters,
             const ParameterStore& store);

  // The columns of a beat; a row is written from left to right.
  void write(std::int32_t y, std::int32_t x, std::uint8_t left, std::uint8_t top, int lanes);

  Row left(std::int32_t y) const { return Row(in_frame(y) ? words(y) : none_.data()); }
  Row top(std::int32_t y) const { return Row(in_frame(y) ? words(y) + plane_ : none_.data()); }

 private:
  bool in_frame(std::int32_t y) const {
    return static_cast<std::uint32_t>(y) < static_cast<std::uint32_t>(store_.rules().height);
  }
  const std::uint64_t* words(std::int32_t y) const {
    return bits_.data() + row_at_[static_cast<std::size_t>(y)];
  }

  const ParameterStore& store_;
  std::size_t plane_;                  // words of a row of one plane
  std::vector<std::uint32_t> row_at_;  // of each row of the frame: row mod rows, in words
  std::vector<std::uint64_t> bits_, none_;
};

}  // namespace deburr::rtl::morphological
