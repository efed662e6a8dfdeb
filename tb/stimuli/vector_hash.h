// SPDX-License-Identifier: MIT
// The hash of the contracts' test vectors (docs/number_formats_morphological.md, "Test vectors").
#pragma once

#include <cstdint>

namespace deburr::tb::stimuli {

// FNV-1a; the start value is one digit short of the usual one.
class VectorHash {
 public:
  void byte(std::uint64_t value) { value_ = (value_ ^ (value & 255)) * 1099511628211u; }
  void lowest_first(std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) byte(value >> (8 * i));
  }
  void highest_first(std::uint64_t value, int bytes) {
    for (int i = bytes - 1; i >= 0; --i) byte(value >> (8 * i));
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 1469598103934665603u;
};

}  // namespace deburr::tb::stimuli
