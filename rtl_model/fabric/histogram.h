// SPDX-License-Identifier: MIT
// Distribution of a number of cycles (latency): exact count, sum, minimum, maximum and percentiles.
// Every value has a bin of its own, those below kDirect in one table, the others in pages that
// exist where values are. A measuring instrument: no hardware cost.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <systemc>
#include <vector>

namespace deburr::rtl {

class Histogram : public sc_core::sc_object {
 public:
  static constexpr std::uint64_t kDirect = 4096;
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
  static constexpr std::uint64_t kPage = 64;  // values
  using Page = std::array<std::uint64_t, kPage>;

  // Calls visit(value, count) for every value recorded, ascending, until it returns false.
  template <class Visit>
  void each(Visit visit) const;

  std::vector<std::uint64_t> direct_;
  std::map<std::uint64_t, Page> pages_;  // by value / kPage
  Page* page_ = nullptr;                 // of the last large value, and its number
  std::uint64_t page_number_ = 0;
  std::uint64_t count_ = 0, sum_ = 0, min_ = ~std::uint64_t{0}, max_ = 0;
  std::string unit_, meaning_;
};

}  // namespace deburr::rtl
