// SPDX-License-Identifier: MIT
// Positions and weights of the samples of a fragment, and the texels that each sample reads.
//
// Between level selection and memory (paper 004, section 1.1 step 3 and section 2.2; equation 4).
// Pure functions of integers, one per line of docs/reference/texture/formats.md, "Sample walker"
// and "Addresses". Inline, since they are the inner loop.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "golden/texture/footprint.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/packets.h"
#include "spec/texture/parameters.h"
#include "spec/texture/tables.h"

namespace deburr::golden::texture {

// (x + half of the last kept bit) >> drop for any sign of x; drop >= 1.
inline std::int64_t round_shift(std::int64_t x, int drop) {
  return (x + (std::int64_t{1} << (drop - 1))) >> drop;
}

// Kernel of a fragment with N samples along candidate `major`. kAxis: the tent of a diagonal.
inline spec::texture::Kernel fragment_kernel(const spec::texture::Configuration& configuration,
                                             int major, int n) {
  if (configuration.kernel != spec::texture::Kernel::kAxis) return configuration.kernel;
  const int quarter = candidates(configuration.axes) / 2;  // candidates in a quarter turn
  const bool diagonal = n >= 5 && 2 * (major % quarter) == quarter;
  return diagonal ? spec::texture::Kernel::kAxis : spec::texture::Kernel::kBox;
}

// Length over which N samples are spread, U2.6 of the major axis. A tent of fewer than 4 samples
// has the weights of a box, so its length is limited to 64. kernel: from fragment_kernel().
inline std::int32_t spread_of(spec::texture::Kernel kernel, int n, std::int32_t spread) {
  if (kernel == spec::texture::Kernel::kAxis) return (181 * spread + 64) >> 7;
  const bool shapeless = kernel == spec::texture::Kernel::kTent && n < 4;
  return shapeless ? std::min(spread, 64) : spread;
}

// Half the distance between two of N samples, exact: the common part of sample_offset().
inline std::int64_t half_distance(int n, std::int32_t spread, std::int64_t axis) {
  return spread * axis * spec::texture::kReciprocal[static_cast<std::size_t>(n)];
}
inline std::int64_t offset_at(int i, int n, std::int64_t half_distance) {
  return round_shift((2 * i + 1 - n) * half_distance, 23);
}

// Offset of sample i of N from the pixel centre along one coordinate of the major axis, S9.24.
// axis: S9.24 of that coordinate; spread: U2.6, from spread_of().
inline std::int64_t sample_offset(int i, int n, std::int32_t spread, std::int64_t axis) {
  return offset_at(i, n, half_distance(n, spread, axis));
}

// Weight of sample i of N, U1.8; the weights sum to 256. kernel: from fragment_kernel().
inline std::uint32_t sample_weight(spec::texture::Kernel kernel, int i, int n) {
  const std::size_t shape = kernel == spec::texture::Kernel::kBox ? 0 : 1;
  return spec::texture::kKernelWeights[shape][static_cast<std::size_t>(n)]
                                      [static_cast<std::size_t>(i)];
}

// Side of mip level k: max(1, size >> k), where size is that of level 0.
inline std::int32_t level_size(std::uint32_t size, int level) {
  return std::max(1, static_cast<std::int32_t>(size >> level));
}

// Applies the wrap mode to a sample coordinate S9.24. Returns U0.24; clamp_to_edge: S9.24
// unchanged.
inline std::int64_t wrap_coordinate(spec::texture::Wrap wrap, std::int64_t p) {
  constexpr std::int64_t kOne = spec::texture::kCoordinateOne;
  switch (wrap) {
    case spec::texture::Wrap::kRepeat:
      return p & (kOne - 1);
    case spec::texture::Wrap::kMirroredRepeat: {
      const std::int64_t q = p & (2 * kOne - 1);
      return q < kOne ? q : 2 * kOne - 1 - q;
    }
    case spec::texture::Wrap::kClampToEdge:
      break;
  }
  return p;
}

// The one or two texels next to a sample on one axis.
struct TexelPosition {
  std::int32_t i0 = 0, i1 = 0;  // 0..size - 1
  std::uint32_t fraction = 0;   // U0.8, weight of i1
  friend bool operator==(const TexelPosition&, const TexelPosition&) = default;
};

// Brings any texel index into the range 0..size - 1.
inline std::int32_t texel_in_range(spec::texture::Wrap wrap, std::int64_t i, std::int32_t size) {
  if (wrap == spec::texture::Wrap::kRepeat) {
    if (i < 0) return size - 1;
    return i >= size ? 0 : static_cast<std::int32_t>(i);
  }
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(i, 0, size - 1));
}

// The two texels around a coordinate on a side of `size` texels; `wrapped`: from wrap_coordinate().
inline TexelPosition linear_texels(spec::texture::Wrap wrap, std::int64_t wrapped,
                                   std::int32_t size) {
  const std::int64_t half_texel = spec::texture::kCoordinateOne / 2;
  const std::int64_t u = round_shift(wrapped * size - half_texel,
                                     spec::texture::kCoordinateFractionBits - 8);  // S.8
  const std::int64_t i0 = u >> 8;
  const auto fraction = static_cast<std::uint32_t>(u & 255);
  if (i0 >= 0 && i0 + 1 < size) {  // the common case
    const auto inside = static_cast<std::int32_t>(i0);
    return {inside, inside + 1, fraction};
  }
  return {texel_in_range(wrap, i0, size), texel_in_range(wrap, i0 + 1, size), fraction};
}

// The texel that contains the coordinate.
inline TexelPosition nearest_texel(spec::texture::Wrap wrap, std::int64_t wrapped,
                                   std::int32_t size) {
  const std::int64_t i = (wrapped * size) >> spec::texture::kCoordinateFractionBits;
  const std::int32_t in_range = texel_in_range(wrap, i, size);
  return {in_range, in_range, 0};
}

// Takes a sample coordinate S9.24.
inline TexelPosition linear_position(spec::texture::Wrap wrap, std::int64_t p, std::int32_t size) {
  return linear_texels(wrap, wrap_coordinate(wrap, p), size);
}
inline TexelPosition nearest_position(spec::texture::Wrap wrap, std::int64_t p, std::int32_t size) {
  return nearest_texel(wrap, wrap_coordinate(wrap, p), size);
}

// Byte address of texel (x, y), or of its block, modulo 2^32. 0 <= x < level_size(width, level),
// the same for y.
std::uint32_t texel_address(const spec::texture::Descriptor& descriptor, int level, std::int32_t x,
                            std::int32_t y);

// Addresses of a whole level: that of texel (x, y), or of its block, is column[x] + row[y], modulo
// 2^32.
struct LevelAddresses {
  std::vector<std::uint32_t> column, row;  // row includes the base
};
LevelAddresses level_addresses(const spec::texture::Descriptor& descriptor, int level);

// Bytes from base[level] to the end of the level, with the padding of rows and tile grids.
std::uint64_t level_bytes(const spec::texture::Descriptor& descriptor, int level);

// The reason why a unit with this `decode` rejects the descriptor, or nullptr if it is valid.
const char* descriptor_fault(const spec::texture::Descriptor& descriptor,
                             spec::texture::Decode decode);
inline bool valid(const spec::texture::Descriptor& descriptor, spec::texture::Decode decode) {
  return descriptor_fault(descriptor, decode) == nullptr;
}

}  // namespace deburr::golden::texture
