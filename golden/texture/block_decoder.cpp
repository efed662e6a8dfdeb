// SPDX-License-Identifier: MIT
#include "golden/texture/block_decoder.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "spec/texture/tables.h"

namespace deburr::golden::texture {
namespace {

using spec::texture::BlockRule;
using spec::texture::Format;

constexpr std::uint32_t kOpaque = 255u << 24;

std::uint32_t with_alpha(std::uint32_t colour, std::uint32_t alpha) {
  return (colour & 0xFFFFFF) | alpha << 24;
}

// ---- BC: numbers are little-endian, texel i = 4 y + x -------------------------------------------

std::uint32_t bc_colour(BlockRule rule, const std::uint8_t* block, unsigned i, bool always_four) {
  const auto c0 = static_cast<std::uint32_t>(block[0] | block[1] << 8);
  const auto c1 = static_cast<std::uint32_t>(block[2] | block[3] << 8);
  const unsigned selector = block[4 + i / 4] >> (2 * (i % 4)) & 3u;
  const bool four = always_four || c0 > c1;
  if (!four && selector == 3) return 0;
  const bool rounded = rule == BlockRule::kRounded;
  const std::uint32_t r = rounded ? 1 : 0;
  const auto five = [&](std::uint32_t v) {
    return rounded ? (527 * v + 23) >> 6 : v << 3 | v >> 2;
  };
  const auto six = [&](std::uint32_t v) { return rounded ? (259 * v + 33) >> 6 : v << 2 | v >> 4; };
  const auto between = [&](std::uint32_t p, std::uint32_t q) {
    if (selector % 2 != 0) std::swap(p, q);
    if (selector < 2) return p;
    return four ? (2 * p + q + r) / 3 : (p + q + r) / 2;
  };
  return between(five(c0 >> 11), five(c1 >> 11)) |
         between(six(c0 >> 5 & 63), six(c1 >> 5 & 63)) << 8 |
         between(five(c0 & 31), five(c1 & 31)) << 16 | kOpaque;
}

std::uint32_t bc_value(BlockRule rule, const std::uint8_t* block, unsigned i) {
  const std::uint32_t a = block[0], b = block[1], r = rule == BlockRule::kRounded ? 1 : 0;
  std::uint64_t selectors = 0;
  for (unsigned byte = 0; byte < 6; ++byte)
    selectors |= std::uint64_t{block[2 + byte]} << (8 * byte);
  const auto s = static_cast<std::uint32_t>(selectors >> (3 * i) & 7);
  if (s < 2) return s == 0 ? a : b;
  if (a > b) return ((8 - s) * a + (s - 1) * b + r) / 7;
  if (s >= 6) return s == 6 ? 0 : 255;
  return ((6 - s) * a + (s - 1) * b + r) / 5;
}

// ---- ETC2: one number of 64 bits, byte 0 highest, texel i = 4 x + y
// ------------------------------

using Rgb = std::array<std::int32_t, 3>;

class Number {
 public:
  explicit Number(const std::uint8_t* bytes) {
    for (unsigned byte = 0; byte < 8; ++byte) bits_ = bits_ << 8 | bytes[byte];
  }
  // Bits high..low.
  std::int32_t field(unsigned high, unsigned low) const {
    return static_cast<std::int32_t>(bits_ >> low & ((std::uint64_t{2} << (high - low)) - 1));
  }
  std::int32_t bit(unsigned i) const { return field(i, i); }
  // Three bits with sign, -4..3.
  std::int32_t difference(unsigned high) const { return (field(high, high - 2) ^ 4) - 4; }

 private:
  std::uint64_t bits_ = 0;
};

std::int32_t clamped(std::int32_t v) { return std::clamp(v, 0, 255); }

std::uint32_t opaque(const Rgb& colour) {
  return static_cast<std::uint32_t>(clamped(colour[0]) | clamped(colour[1]) << 8 |
                                    clamped(colour[2]) << 16) |
         kOpaque;
}

Rgb plus(Rgb colour, std::int32_t distance) {
  for (std::int32_t& c : colour) c += distance;
  return colour;
}

// Repeats the high bits of v, which has `bits` bits, up to 8.
std::int32_t widened(std::int32_t v, int bits) { return v << (8 - bits) | v >> (2 * bits - 8); }
Rgb widened(Rgb colour, int bits) {
  for (std::int32_t& c : colour) c = widened(c, bits);
  return colour;
}

std::uint32_t t_texel(const Number& n, std::int32_t selector, bool holes) {
  const Rgb a = {n.field(60, 59) << 2 | n.field(57, 56), n.field(55, 52), n.field(51, 48)};
  const Rgb b = {n.field(47, 44), n.field(43, 40), n.field(39, 36)};
  const auto t = static_cast<std::size_t>(n.field(35, 34) << 1 | n.bit(32));
  const std::int32_t e = spec::texture::kEtcDistances[t];
  switch (selector) {
    case 0:
      return opaque(widened(a, 4));
    case 1:
      return opaque(plus(widened(b, 4), e));
    case 2:
      return holes ? 0 : opaque(widened(b, 4));
    default:
      return opaque(plus(widened(b, 4), -e));
  }
}

std::uint32_t h_texel(const Number& n, std::int32_t selector, bool holes) {
  const Rgb a = {n.field(62, 59), n.field(58, 56) << 1 | n.bit(52),
                 n.bit(51) << 3 | n.field(49, 47)};
  const Rgb b = {n.field(46, 43), n.field(42, 39), n.field(38, 35)};
  // Arrays compare R first, then G, then B.
  const auto t = static_cast<std::size_t>(n.bit(34) << 2 | n.bit(32) << 1 | (a >= b ? 1 : 0));
  const std::int32_t e = spec::texture::kEtcDistances[t];
  if (holes && selector == 2) return 0;
  return opaque(plus(widened(selector < 2 ? a : b, 4), selector % 2 == 0 ? e : -e));
}

std::uint32_t planar_texel(const Number& n, std::int32_t x, std::int32_t y) {
  const auto channel = [x, y](std::int32_t o, std::int32_t h, std::int32_t v, int bits) {
    o = widened(o, bits);
    return (x * (widened(h, bits) - o) + y * (widened(v, bits) - o) + 4 * o + 2) >> 2;
  };
  return opaque({channel(n.field(62, 57), n.field(38, 34) << 1 | n.bit(32), n.field(18, 13), 6),
                 channel(n.bit(56) << 6 | n.field(54, 49), n.field(31, 25), n.field(12, 6), 7),
                 channel(n.bit(48) << 5 | n.field(44, 43) << 3 | n.field(41, 39), n.field(24, 19),
                         n.field(5, 0), 6)});
}

std::uint32_t etc_colour(Format format, const std::uint8_t* block, unsigned x, unsigned y) {
  const Number n(block);
  const unsigned i = 4 * x + y;
  const std::int32_t selector = n.bit(16 + i) << 1 | n.bit(i);
  const bool d = n.bit(33) != 0, one_bit_alpha = format == Format::kEtc2RgbA1;
  const bool individual = !d && !one_bit_alpha, holes = !d && one_bit_alpha;
  Rgb first, second;
  if (individual) {
    first = widened({n.field(63, 60), n.field(55, 52), n.field(47, 44)}, 4);
    second = widened({n.field(59, 56), n.field(51, 48), n.field(43, 40)}, 4);
  } else {
    const Rgb base = {n.field(63, 59), n.field(55, 51), n.field(47, 43)};
    const Rgb sum = {base[0] + n.difference(58), base[1] + n.difference(50),
                     base[2] + n.difference(42)};
    const auto outside = [](std::int32_t v) { return v < 0 || v > 31; };
    if (outside(sum[0])) return t_texel(n, selector, holes);
    if (outside(sum[1])) return h_texel(n, selector, holes);
    if (outside(sum[2]))
      return planar_texel(n, static_cast<std::int32_t>(x), static_cast<std::int32_t>(y));
    first = widened(base, 5);
    second = widened(sum, 5);
  }
  if (holes && selector == 2) return 0;
  const bool flip = n.bit(32) != 0, in_first = (flip ? y : x) < 2;
  const auto table = static_cast<std::size_t>(in_first ? n.field(39, 37) : n.field(36, 34));
  const std::int32_t modifier =
      holes && selector == 0
          ? 0
          : spec::texture::kEtcModifiers[table][static_cast<std::size_t>(selector % 2)];
  return opaque(plus(in_first ? first : second, selector < 2 ? modifier : -modifier));
}

std::uint32_t eac_alpha(const std::uint8_t* block, unsigned x, unsigned y) {
  const Number n(block);
  const unsigned high = 47 - 3 * (4 * x + y);
  const auto table = static_cast<std::size_t>(n.field(51, 48));
  const auto selector = static_cast<std::size_t>(n.field(high, high - 2));
  return static_cast<std::uint32_t>(
      clamped(n.field(63, 56) + n.field(55, 52) * spec::texture::kEacModifiers[table][selector]));
}

}  // namespace

std::uint32_t block_texel(Format format, BlockRule rule, const std::uint8_t* block, unsigned x,
                          unsigned y) {
  const unsigned i = 4 * y + x;
  switch (format) {
    case Format::kBc1:
      return bc_colour(rule, block, i, false);
    case Format::kBc3:
      return with_alpha(bc_colour(rule, block + 8, i, true), bc_value(rule, block, i));
    case Format::kBc4:
      return bc_value(rule, block, i) * 0x010101 | kOpaque;
    case Format::kBc5:
      return bc_value(rule, block, i) | bc_value(rule, block + 8, i) << 8 | kOpaque;
    case Format::kEtc2Rgb:
    case Format::kEtc2RgbA1:
      return etc_colour(format, block, x, y);
    case Format::kEtc2Rgba8:
      return with_alpha(etc_colour(format, block + 8, x, y), eac_alpha(block, x, y));
    default:
      return 0;  // has no blocks
  }
}

std::array<std::uint32_t, 16> decode_block(Format format, BlockRule rule,
                                           const std::uint8_t* block) {
  std::array<std::uint32_t, 16> texels{};
  for (unsigned i = 0; i < texels.size(); ++i)
    texels[i] = block_texel(format, rule, block, i % 4, i / 4);
  return texels;
}

}  // namespace deburr::golden::texture
