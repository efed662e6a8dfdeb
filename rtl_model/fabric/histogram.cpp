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

void Histogram::settle() const {
  if (repeats_ == 0) return;
  const std::uint64_t value = last_;
  if (value < kDirect) {
    if (value >= kept_.direct.size()) kept_.direct.resize(value + 1);
    kept_.direct[value] += repeats_;
  } else {
    // Consecutive latencies are similar: the page is nearly always the previous one.
    if (kept_.page == nullptr || kept_.page_number != value / kPage) {
      kept_.page_number = value / kPage;
      kept_.page = &kept_.pages[kept_.page_number];
    }
    (*kept_.page)[value % kPage] += repeats_;
  }
  kept_.count += repeats_;
  kept_.sum += value * repeats_;
  kept_.min = std::min(kept_.min, value);
  kept_.max = std::max(kept_.max, value);
  repeats_ = 0;
}

void Histogram::reset() {
  kept_ = {};
  repeats_ = 0;
}

template <class Visit>
void Histogram::each(Visit visit) const {
  settle();
  for (std::size_t value = 0; value < kept_.direct.size(); ++value)
    if (kept_.direct[value] && !visit(value, kept_.direct[value])) return;
  for (const auto& [number, page] : kept_.pages)
    for (std::size_t i = 0; i < kPage; ++i)
      if (page[i] && !visit(number * kPage + i, page[i])) return;
}

std::uint64_t Histogram::percentile(unsigned percent) const {
  DEBURR_CHECK(percent <= 100, fmt::format("{}: percentile {}", name(), percent));
  if (count() == 0) return 0;
  // Nearest rank: ceil(count * percent / 100), at least 1; in two parts to avoid overflow.
  const std::uint64_t rank = std::max<std::uint64_t>(
      1, kept_.count / 100 * percent + (kept_.count % 100 * percent + 99) / 100);
  std::uint64_t below = 0, found = kept_.max;
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
  // The smallest power of two for which the range needs at most `at_most` bins.
  int shift = 0;
  while ((kept_.max >> shift) - (kept_.min >> shift) >= at_most) ++shift;
  std::vector<Bin> merged;
  for (const Bin& bin : all) {
    const std::uint64_t low = bin.low >> shift << shift;
    if (merged.empty() || merged.back().low != low)
      merged.push_back({low, low + ((std::uint64_t{1} << shift) - 1), 0});
    merged.back().count += bin.count;
  }
  return merged;
}

// Out of line, to keep the code of its users small.
Histogram::~Histogram() = default;

}  // namespace deburr::rtl
