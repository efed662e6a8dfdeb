// SPDX-License-Identifier: MIT
#include "rtl_model/fabric/histogram.h"

#include <fmt/format.h>

#include <algorithm>

#include "spec/error.h"

namespace deburr::rtl {

Histogram::Histogram(const char* name, const char* unit, const char* meaning)
    : sc_object(name), unit_(unit), meaning_(meaning) {
  DEBURR_CHECK(!unit_.empty() && !meaning_.empty(),
               fmt::format("{}: a histogram needs a unit and a meaning", this->name()));
}

void Histogram::record(std::uint64_t value) {
  if (value < kDirect) {
    if (value >= direct_.size()) direct_.resize(value + 1);
    ++direct_[value];
  } else {
    // Latencies in a row are alike: the page is nearly always the one before.
    if (page_ == nullptr || page_number_ != value / kPage) {
      page_number_ = value / kPage;
      page_ = &pages_[page_number_];
    }
    ++(*page_)[value % kPage];
  }
  ++count_;
  sum_ += value;
  min_ = std::min(min_, value);
  max_ = std::max(max_, value);
}

void Histogram::reset() {
  direct_.clear();
  pages_.clear();
  page_ = nullptr;
  count_ = sum_ = max_ = 0;
  min_ = ~std::uint64_t{0};
}

template <class Visit>
void Histogram::each(Visit visit) const {
  for (std::size_t value = 0; value < direct_.size(); ++value)
    if (direct_[value] && !visit(value, direct_[value])) return;
  for (const auto& [number, page] : pages_)
    for (std::size_t i = 0; i < kPage; ++i)
      if (page[i] && !visit(number * kPage + i, page[i])) return;
}

std::uint64_t Histogram::percentile(unsigned percent) const {
  DEBURR_CHECK(percent <= 100, fmt::format("{}: percentile {}", name(), percent));
  if (count_ == 0) return 0;
  // Nearest rank: ceil(count * percent / 100), at least the first; in two parts against overflow.
  const std::uint64_t rank =
      std::max<std::uint64_t>(1, count_ / 100 * percent + (count_ % 100 * percent + 99) / 100);
  std::uint64_t below = 0, found = max_;
  each([&](std::uint64_t value, std::uint64_t count) {
    below += count;
    if (below < rank) return true;
    found = value;
    return false;
  });
  return found;
}

std::vector<Histogram::Bin> Histogram::bins(std::size_t at_most) const {
  std::vector<Bin> all;
  each([&](std::uint64_t value, std::uint64_t count) {
    all.push_back({value, value, count});
    return true;
  });
  if (at_most == 0 || all.size() <= at_most) return all;
  // The least power of two of which the whole range needs no more than `at_most` bins.
  int shift = 0;
  while ((max_ >> shift) - (min_ >> shift) >= at_most) ++shift;
  std::vector<Bin> merged;
  for (const Bin& bin : all) {
    const std::uint64_t low = bin.low >> shift << shift;
    if (merged.empty() || merged.back().low != low)
      merged.push_back({low, low + ((std::uint64_t{1} << shift) - 1), 0});
    merged.back().count += bin.count;
  }
  return merged;
}

}  // namespace deburr::rtl
