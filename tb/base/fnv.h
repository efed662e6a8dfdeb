// SPDX-License-Identifier: MIT
// FNV-1a in 64 bits: whether two runs, pictures or texts are the same, no secret.
#pragma once

#include <cstdint>

namespace deburr::tb {

inline constexpr std::uint64_t kFnvStart = 0xCBF29CE484222325;
// With a byte it is FNV-1a; a word at a time is faster and reaches the lower bits less.
constexpr std::uint64_t fnv_step(std::uint64_t hash, std::uint64_t value) {
  return (hash ^ value) * 0x100000001B3;
}

// Over bytes in order.
class FnvHash {
 public:
  constexpr explicit FnvHash(std::uint64_t start = kFnvStart) : value_(start) {}
  // Its lowest eight bits.
  constexpr void byte(std::uint64_t value) { value_ = fnv_step(value_, value & 255); }
  constexpr void lowest_first(std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) byte(value >> (8 * i));
  }
  constexpr void highest_first(std::uint64_t value, int bytes) {
    for (int i = bytes - 1; i >= 0; --i) byte(value >> (8 * i));
  }
  constexpr std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_;
};

}  // namespace deburr::tb
