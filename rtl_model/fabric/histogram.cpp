// SPDX-License-Identifier: MIT
#include "rtl_model/fabric/histogram.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "spec/error.h"

namespace deburr::rtl {
namespace {
constexpr int kExactBits = 12;  // log2(kExact)
constexpr int kSubBits = 6;     // 64 bins for each power of two
}  // namespace

Histogram::Histogram(const char* name, const char* unit, const char* meaning)
    : sc_object(name), unit_(unit), meaning_(meaning) {
  static_assert(kExact == std::uint64_t{1} << kExactBits);
  DEBURR_CHECK(!unit_.empty() && !meaning_.empty(),
               fmt::format("{}: a histogram needs a unit and a meaning", this->name()));
}

std::size_t Histogram::index_of(std::uint64_t value) {
  if (value < kExact) return value;
  const int exponent = static_cast<int>(std::bit_width(value)) - 1;  // >= kExactBits
  const std::uint64_t sub = (value >> (exponent - kSubBits)) & ((1U << kSubBits) - 1);
  return kExact + (static_cast<std::size_t>(exponent - kExactBits) << kSubBits) + sub;
}

Histogram::Bin Histogram::range_of(std::size_t index) {
  if (index < kExact) return {index, index, 0};
  const std::size_t rest = index - kExact;
  const int exponent = kExactBits + static_cast<int>(rest >> kSubBits);
  const std::uint64_t width = std::uint64_t{1} << (exponent - kSubBits);
  const std::uint64_t low =
      (std::uint64_t{1} << exponent) + (rest & ((1U << kSubBits) - 1)) * width;
  return {low, low + (width - 1), 0};
}

void Histogram::record(std::uint64_t value) {
  const std::size_t index = index_of(value);
  if (index >= bins_.size()) bins_.resize(index + 1);
  ++bins_[index];
  ++count_;
  sum_ += value;
  min_ = std::min(min_, value);
  max_ = std::max(max_, value);
}

void Histogram::reset() {
  bins_.clear();
  count_ = sum_ = max_ = 0;
  min_ = ~std::uint64_t{0};
}

std::uint64_t Histogram::percentile(unsigned percent) const {
  DEBURR_CHECK(percent <= 100, fmt::format("{}: percentile {}", name(), percent));
  if (count_ == 0) return 0;
  // Nearest rank: ceil(count * percent / 100), at least the first; in two parts against overflow.
  const std::uint64_t rank =
      std::max<std::uint64_t>(1, count_ / 100 * percent + (count_ % 100 * percent + 99) / 100);
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    below += bins_[i];
    if (below >= rank) return std::clamp(range_of(i).high, min_, max_);
  }
  return max_;
}

std::vector<Histogram::Bin> Histogram::bins(std::size_t at_most) const {
  std::vector<Bin> all;
  for (std::size_t i = 0; i < bins_.size(); ++i)
    if (bins_[i]) {
      Bin bin = range_of(i);
      bin.count = bins_[i];
      all.push_back(bin);
    }
  if (at_most == 0 || all.size() <= at_most) return all;
  // The least power of two of which the whole range needs no more than `at_most` bins. A bin of the
  // logarithmic part that is wider than that goes where its lower end is.
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
