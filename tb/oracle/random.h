// SPDX-License-Identifier: MIT
// Random numbers that are the same on every machine and standard library: splitmix64.
#pragma once

#include <cstdint>

namespace deburr::tb::texture {

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15u + 1) {}

  std::uint32_t next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return static_cast<std::uint32_t>((z ^ (z >> 31)) >> 32);
  }

  // Uniform in [low, high).
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(next()) * 0x1p-32);
  }

 private:
  std::uint64_t state_;
};

}  // namespace deburr::tb::texture
