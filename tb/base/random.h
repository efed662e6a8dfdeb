// SPDX-License-Identifier: MIT
// Reproducible random numbers: a seed gives the same numbers on every machine and compiler, which
// the distributions of <random> do not guarantee.
#pragma once

#include <cstdint>
#include <string_view>

namespace deburr::tb {

class Random {
 public:
  // Increment of the state per number; a seed larger by it gives the same sequence, one number
  // later.
  static constexpr std::uint64_t kStride = 0x9E3779B97F4A7C15ULL;

  explicit Random(std::uint64_t seed) : state_(seed) {}
  // An independent stream per name under one seed, whatever the order of construction.
  Random(std::uint64_t seed, std::string_view name) : state_(seed) {
    for (const char c : name)
      state_ = (state_ ^ static_cast<unsigned char>(c)) * 0x100000001B3ULL + kStride;
  }
  // splitmix64: each 64-bit value occurs once per period.
  std::uint64_t next() {
    std::uint64_t z = (state_ += kStride);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }
  std::uint32_t word() { return static_cast<std::uint32_t>(next() >> 32); }
  // Uniform in [low, high).
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(word()) * 0x1p-32);
  }
  // 0..bound-1; bound > 0. The bias is below bound / 2^32.
  std::uint32_t below(std::uint32_t bound) {
    return static_cast<std::uint32_t>(((next() >> 32) * bound) >> 32);
  }
  // low..high, both included.
  int between(int low, int high) {
    return low + static_cast<int>(below(static_cast<std::uint32_t>(high - low) + 1));
  }
  // True in `permille` of 1000 calls.
  bool chance(std::uint32_t permille) { return permille != 0 && below(1000) < permille; }

 private:
  std::uint64_t state_;
};

}  // namespace deburr::tb
