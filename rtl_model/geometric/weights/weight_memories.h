// SPDX-License-Identifier: MIT
// Address mapping and word types of the WeightCombiner's memories, shared with the resolve, which
// reads them through handles of its ports.
#pragma once

#include <array>
#include <cstdint>

#include "spec/geometric/parameters.h"

namespace deburr::rtl::geometric {

// 128 blocks of a row.
struct TouchedWord {
  std::array<std::uint64_t, 2> bits{};
  bool get(std::uint32_t bit) const { return bits[bit >> 6] >> (bit & 63) & 1; }
  void set(std::uint32_t bit) { bits[bit >> 6] |= std::uint64_t{1} << (bit & 63); }
};

// Position of a block of weights in the cache.
class WeightPlaces {
 public:
  static constexpr std::uint32_t kTagBits = 23, kValid = 1u << (kTagBits - 1);

  explicit WeightPlaces(const spec::geometric::Parameters& p)
      : index_bits_(spec::geometric::kCacheLineBits[static_cast<std::size_t>(p.weight_blocks)]),
        low_bits_((index_bits_ + 1) / 2) {}
  std::uint32_t index_of(std::uint32_t x, std::uint32_t y) const {
    return (x & ((1u << low_bits_) - 1)) | (y & ((1u << (index_bits_ - low_bits_)) - 1))
                                               << low_bits_;
  }
  static std::uint32_t tag_of(std::uint32_t x, std::uint32_t y) { return kValid | y << 11 | x; }

 private:
  std::uint32_t index_bits_, low_bits_;
};

}  // namespace deburr::rtl::geometric
