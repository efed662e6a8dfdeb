// SPDX-License-Identifier: MIT
// Distribution of a number of cycles (latency) with exact count, sum, minimum and maximum.
// Values below kExact have a bin each, so their percentiles are exact; above, 64 bins for each
// power of two, so a percentile is at most 1/64 too large. A measuring instrument: no hardware
// cost.
#pragma once

#include <cstdint>
#include <string>
#include <systemc>
#include <vector>

namespace deburr::rtl {

class Histogram : public sc_core::sc_object {
 public:
  static constexpr std::uint64_t kExact = 4096;
  struct Bin {
    std::uint64_t low, high;  // inclusive
    std::uint64_t count;
  };

  Histogram(const char* name, const char* unit, const char* meaning);
  const char* kind() const override { return "deburr_histogram"; }

  void record(std::uint64_t value);
  void reset();

  std::uint64_t count() const { return count_; }
  std::uint64_t sum() const { return sum_; }
  std::uint64_t min() const { return count_ ? min_ : 0; }
  std::uint64_t max() const { return max_; }
  // The smallest value v such that at least `percent` % of all are <= v (nearest rank); 0 if empty.
  std::uint64_t percentile(unsigned percent) const;
  // The bins that are not empty, ascending; with a limit, neighbours are merged into bins of equal
  // width (a power of two) until there are at most that many.
  std::vector<Bin> bins(std::size_t at_most = 0) const;

  const std::string& unit() const { return unit_; }
  const std::string& meaning() const { return meaning_; }

 private:
  static std::size_t index_of(std::uint64_t value);
  static Bin range_of(std::size_t index);
  std::vector<std::uint64_t> bins_;
  std::uint64_t count_ = 0, sum_ = 0, min_ = ~std::uint64_t{0}, max_ = 0;
  std::string unit_, meaning_;
};

}  // namespace deburr::rtl
