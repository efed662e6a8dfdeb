// SPDX-License-Identifier: MIT
// Computes the colour of a fragment from the bytes of its texels: unpack, bilinear, level lerp and
// kernel sum, or with blend = level kernel sums and their lerp.
//
// Last part of the texture golden model (paper 004, section 2.3 and equation 4). Pure functions of
// integers, one channel at a time; docs/reference/texture/formats.md, table. Inline, since they are
// the inner loop.
#pragma once

#include <array>
#include <cstdint>

#include "spec/texture/descriptor.h"
#include "spec/texture/tables.h"

namespace deburr::golden::texture {

using Texel = std::array<std::uint32_t, 4>;  // R, G, B, A in U8.4

// Decodes a texel from its bytes in one little-endian word (low 8, 16 or 32 bits used).
inline Texel decode_texel(spec::texture::Format format, std::uint32_t word) {
  const auto five = [](std::uint32_t v) { return (v << 3 | v >> 2) << 4; };
  const auto six = [](std::uint32_t v) { return (v << 2 | v >> 4) << 4; };
  const auto four = [](std::uint32_t v) { return (v << 4 | v) << 4; };
  switch (format) {
    case spec::texture::Format::kRgba8:
      return {(word & 255) << 4, (word >> 8 & 255) << 4, (word >> 16 & 255) << 4,
              (word >> 24) << 4};
    case spec::texture::Format::kRgb565:
      return {five(word >> 11 & 31), six(word >> 5 & 63), five(word & 31), 255 << 4};
    case spec::texture::Format::kRgba4444:
      return {four(word >> 12 & 15), four(word >> 8 & 15), four(word >> 4 & 15), four(word & 15)};
    case spec::texture::Format::kL8:
      return {(word & 255) << 4, (word & 255) << 4, (word & 255) << 4, 255 << 4};
    case spec::texture::Format::kSrgb8A8:
      return {spec::texture::kSrgbToLinear[word & 255],
              spec::texture::kSrgbToLinear[word >> 8 & 255],
              spec::texture::kSrgbToLinear[word >> 16 & 255], (word >> 24) << 4};
    default:
      return {};
  }
  return {};
}

// Two channels of 32 bits each.
using Lanes = std::uint64_t;
inline constexpr Lanes kOneInBothLanes = 0x1'0000'0001;

// Four channels of a texel or a filtered value: R in the low half of rb, B in its high half; the
// same for G and A.
struct Channels {
  Lanes rb = 0, ga = 0;
  friend bool operator==(const Channels&, const Channels&) = default;
};

inline Channels to_channels(const Texel& texel) {
  return {texel[0] | Lanes{texel[2]} << 32, texel[1] | Lanes{texel[3]} << 32};
}
inline Texel to_texel(const Channels& channels) {
  return {static_cast<std::uint32_t>(channels.rb), static_cast<std::uint32_t>(channels.ga),
          static_cast<std::uint32_t>(channels.rb >> 32),
          static_cast<std::uint32_t>(channels.ga >> 32)};
}

// As decode_texel(), for the inner loop.
inline Channels decode_channels(spec::texture::Format format, std::uint32_t word) {
  if (format == spec::texture::Format::kRgba8) {  // each byte to its half, then << 4
    constexpr Lanes kByteInBothLanes = 255 * kOneInBothLanes;
    const Lanes spread = word | Lanes{word} << 16;  // bytes R at 0, B at 32; G at 8, A at 40
    return {(spread & kByteInBothLanes) << 4, (spread >> 8 & kByteInBothLanes) << 4};
  }
  return to_channels(decode_texel(format, word));
}

// a (1 - f) + b f: U8.4 and U0.8 to U8.12, exact.
inline std::uint32_t horizontal_lerp(std::uint32_t a, std::uint32_t b, std::uint32_t f_u) {
  return a * (256 - f_u) + b * f_u;
}
inline Lanes horizontal_lerp(Lanes a, Lanes b, std::uint32_t f_u) {
  return a * (256 - f_u) + b * f_u;
}

// Between two rows: U8.12 and U0.8 to U8.12, rounded.
inline std::uint32_t vertical_lerp(std::uint32_t top, std::uint32_t bottom, std::uint32_t f_v) {
  return (top * (256 - f_v) + bottom * f_v + 128) >> 8;
}
inline Lanes vertical_lerp(Lanes top, Lanes bottom, std::uint32_t f_v) {
  constexpr Lanes kKept = 0xFFFFFF * kOneInBothLanes;  // drops bits shifted out of the upper half
  return (top * (256 - f_v) + bottom * f_v + 128 * kOneInBothLanes) >> 8 & kKept;
}

// Between two levels: U8.12 and U0.8 to U8.12, rounded. f = 0 returns `level` unchanged.
inline std::uint32_t level_lerp(std::uint32_t level, std::uint32_t next_level, std::uint32_t f) {
  return (level * (256 - f) + next_level * f + 128) >> 8;
}
inline Lanes level_lerp(Lanes level, Lanes next_level, std::uint32_t f) {
  return vertical_lerp(level, next_level, f);
}

// Between the kernel sums of two levels (blend = level): U8.20 and U0.8 to U8.28, exact.
inline std::uint64_t level_sum_lerp(std::uint32_t level, std::uint32_t next_level,
                                    std::uint32_t f) {
  return std::uint64_t{level} * (256 - f) + std::uint64_t{next_level} * f;
}

// Fraction bits of the accumulator.
inline constexpr int kSampleSumBits = 20, kLevelSumBits = 28;

// Rounds the accumulator to 8 bits.
inline std::uint8_t round_result(std::uint64_t accumulator, int fraction_bits = kSampleSumBits) {
  return static_cast<std::uint8_t>((accumulator + (std::uint64_t{1} << (fraction_bits - 1))) >>
                                   fraction_bits);
}

// Converts an accumulator in linear light to an sRGB code.
inline std::uint8_t encode_result(std::uint64_t accumulator, int fraction_bits = kSampleSumBits) {
  const int dropped = fraction_bits - 4;
  return spec::texture::kLinearToSrgb[(accumulator + (std::uint64_t{1} << (dropped - 1))) >>
                                      dropped];
}

}  // namespace deburr::golden::texture
