// SPDX-License-Identifier: MIT
#include "golden/morphological/planes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace deburr::golden::morphological {
namespace {

static_assert(std::endian::native == std::endian::little, "the first flag must be the lowest byte");

// Transposes 64 x 64 bits in place: swaps the off-diagonal quarters, then those of every quarter.
void transpose(std::array<std::uint64_t, 64>& block) {
  std::uint64_t mask = 0x00000000FFFFFFFF;
  for (unsigned size = 32; size != 0; size >>= 1, mask ^= mask << size) {
    for (unsigned i = 0; i < 64; i = (i + size + 1) & ~size) {
      const std::uint64_t swap = (block[i] >> size ^ block[i + size]) & mask;
      block[i] ^= swap << size;
      block[i + size] ^= swap;
    }
  }
}

}  // namespace

// The product moves flag i of eight to bit 56 + i.
std::uint64_t packed_flags(const std::uint8_t* flags) {
  std::uint64_t word = 0;
  for (std::ptrdiff_t i = 0; i < 8; ++i) {
    std::uint64_t eight;
    std::memcpy(&eight, flags + 8 * i, sizeof eight);
    word |= (eight * 0x0102040810204080u >> 56) << (8 * i);
  }
  return word;
}

void BitPlane::resize(int width, int height) {
  width_ = width;
  height_ = height;
  words_ = width / 64 + 1;
  bits_.assign(static_cast<std::size_t>(words_) * static_cast<std::size_t>(height), 0);
}

std::uint64_t BitPlane::count() const {
  std::uint64_t sum = 0;
  for (const std::uint64_t word : bits_) sum += static_cast<std::uint64_t>(std::popcount(word));
  return sum;
}

BitPlane BitPlane::transposed() const {
  BitPlane result(height_, width_);
  for (int y0 = 0; y0 < height_; y0 += 64) {
    for (int x0 = 0; x0 < width_; x0 += 64) {
      std::array<std::uint64_t, 64> block{};
      for (int y = y0; y < std::min(y0 + 64, height_); ++y) {
        block[static_cast<std::size_t>(y - y0)] = row(y)[x0 / 64];
      }
      transpose(block);
      for (int x = x0; x < std::min(x0 + 64, width_); ++x) {
        result.row(x)[y0 / 64] = block[static_cast<std::size_t>(x - x0)];
      }
    }
  }
  return result;
}

}  // namespace deburr::golden::morphological
