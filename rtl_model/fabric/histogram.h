// SPDX-License-Identifier: MIT
// Distribution of a number of cycles (latency): exact count, sum, minimum, maximum and percentiles.
// Every value has its own bin: values below kDirect in one table, larger ones in pages allocated on
// demand. A measuring instrument without hardware cost.
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
  ~Histogram() override;
  const char* kind() const override { return "deburr_histogram"; }

  // Consecutive values are mostly equal: repeats are counted here, settle() moves them to their
  // bin.
  void record(std::uint64_t value) {
    if (value != last_) [[unlikely]] {
      settle();
      last_ = value;
    }
    ++repeats_;
  }
  void reset();

  std::uint64_t count() const { return settled().count; }
  std::uint64_t sum() const { return settled().sum; }
  std::uint64_t min() const { return settled().count ? kept_.min : 0; }
  std::uint64_t max() const { return settled().max; }
  // The smallest value v such that at least `percent` % of all values are <= v (nearest rank); 0 if
  // empty.
  std::uint64_t percentile(unsigned percent) const;
  // The bins that are not empty, in ascending order; with a limit, neighbours are merged into bins
  // of equal width (a power of two) until at most `at_most` remain.
  std::vector<Bin> bins(std::size_t at_most = 0) const;

  const std::string& unit() const { return unit_; }
  const std::string& meaning() const { return meaning_; }

 private:
  static constexpr std::uint64_t kPage = 64;  // values
  using Page = std::array<std::uint64_t, kPage>;

  struct Kept {
    std::vector<std::uint64_t> direct;
    std::map<std::uint64_t, Page> pages;  // by value / kPage
    Page* page = nullptr;                 // of the last large value, with its number
    std::uint64_t page_number = 0;
    std::uint64_t count = 0, sum = 0, min = ~std::uint64_t{0}, max = 0;
  };

  void settle() const;
  const Kept& settled() const {
    settle();
    return kept_;
  }
  // Calls visit(value, count) for every value recorded, ascending, until it returns false.
  template <class Visit>
  void each(Visit visit) const;

  std::uint64_t last_ = 0;
  mutable std::uint64_t repeats_ = 0;  // repeats of last_ that are not in kept_ yet
  mutable Kept kept_;
  std::string unit_, meaning_;
};

}  // namespace deburr::rtl
