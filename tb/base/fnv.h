// SPDX-License-Identifier: MIT
// 64-bit FNV-1a, to compare runs, images or texts. Not cryptographic.
#pragma once

#include <cstdint>

namespace deburr::tb {

inline constexpr std::uint64_t kFnvStart = 0xCBF29CE484222325;
// FNV-1a if `value` is a byte. A whole word per step is faster but mixes its upper bits less into
// the lower ones.
constexpr std::uint64_t fnv_step(std::uint64_t hash, std::uint64_t value) {
  return (hash ^ value) * 0x100000001B3;
}

// Hash over a sequence of bytes.
class FnvHash {
 public:
  constexpr explicit FnvHash(std::uint64_t start = kFnvStart) : value_(start) {}
  // Adds the lowest eight bits of `value`.
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
