// SPDX-License-Identifier: MIT
#include "golden/texture/footprint.h"

#include <algorithm>
#include <bit>

#include "spec/texture/parameters.h"
#include "spec/texture/tables.h"

namespace deburr::golden::texture {

Derivative derivative_in_texels(std::int64_t difference, std::uint32_t size) {
  constexpr std::uint64_t kLargest = 0x7FFFFFFF;
  const auto magnitude = static_cast<std::uint64_t>(difference < 0 ? -difference : difference);
  const std::uint64_t texels = (magnitude * size + 128) >> 8;
  return {static_cast<std::uint32_t>(std::min(texels, kLargest)), texels > kLargest};
}

std::uint32_t integer_square_root(std::uint64_t x) {
  std::uint64_t root = 0;
  for (std::uint64_t bit = std::uint64_t{1} << 31; bit != 0; bit >>= 1) {
    const std::uint64_t candidate = root | bit;
    if (candidate * candidate <= x) root = candidate;
  }
  return static_cast<std::uint32_t>(root);
}

std::uint32_t footprint_side(spec::texture::FootprintRule rule, std::uint32_t s, std::uint32_t t) {
  const std::uint32_t a = std::max(s, t), b = std::min(s, t);
  switch (rule) {
    case spec::texture::FootprintRule::kHalf:
      return a + (b >> 1);
    case spec::texture::FootprintRule::kQuarter:
      return a + (b >> 2);
    case spec::texture::FootprintRule::kTwoSegment:
      return std::max(a + (b >> 3), a - (a >> 3) + (b >> 1));
    case spec::texture::FootprintRule::kExact:
      return integer_square_root(std::uint64_t{a} * a + std::uint64_t{b} * b);
    case spec::texture::FootprintRule::kMax:
      break;
  }
  return a;
}

Footprint footprint(spec::texture::FootprintRule rule, std::uint32_t s_x, std::uint32_t t_x,
                    std::uint32_t s_y, std::uint32_t t_y) {
  Footprint result;
  result.d_x = footprint_side(rule, s_x, t_x);
  result.d_y = footprint_side(rule, s_y, t_y);
  result.d_max = std::max(result.d_x, result.d_y);
  result.d_min = std::min(result.d_x, result.d_y);
  result.major_is_x = result.d_x >= result.d_y;
  return result;
}

namespace {

// What the rule of four segments adds to n + y, U0.12.
std::uint32_t segment_correction(std::uint32_t y) {
  const std::uint32_t r = y & 1023;
  switch (y >> 10) {
    case 0:
      return 20 + (r >> 2) + (r >> 5);
    case 1:
      return 305 + (r >> 4) - (r >> 7);
    case 2:
      return 356 - (r >> 3) + (r >> 6);
    default:
      return 243 - (r >> 2) + (r >> 6);
  }
}

// lb(1 + y), U1.12, between the entries of the table.
std::uint32_t interpolated_log2(std::uint32_t y) {
  const std::uint32_t i = y >> 6;
  const std::uint32_t low = spec::texture::kLog2Table[i], high = spec::texture::kLog2Table[i + 1];
  return low + (((high - low) * (y & 63) + 32) >> 6);
}

}  // namespace

std::int32_t log2_fixed(spec::texture::Log2Rule rule, std::uint32_t d) {
  if (d == 0) d = 1;
  const int p = static_cast<int>(std::bit_width(d)) - 1;
  const auto y = static_cast<std::uint32_t>((std::uint64_t{d} << 12) >> p) - 4096;
  std::uint32_t mantissa = y;
  switch (rule) {
    case spec::texture::Log2Rule::kMitchell:
      break;
    case spec::texture::Log2Rule::kCorrected:
      mantissa = y + spec::texture::kLog2Correction[y >> 9];
      break;
    case spec::texture::Log2Rule::kSegments:
      mantissa = y + segment_correction(y);
      break;
    case spec::texture::Log2Rule::kExact:
      mantissa = interpolated_log2(y);
      break;
  }
  return (p - 16) * 4096 + static_cast<std::int32_t>(mantissa);
}

}  // namespace deburr::golden::texture
