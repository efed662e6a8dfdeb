// SPDX-License-Identifier: MIT
#include "golden/texture/footprint.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "spec/texture/parameters.h"
#include "spec/texture/tables.h"

namespace deburr::golden::texture {

namespace {

// A root and its remainder: x = root^2 + rest, 0 <= rest <= 2 root.
struct Root {
  std::uint64_t root, rest;
};

// Extends the root of the upper half of a number by its lower half, `high` and `low`, of `bits`
// bits each. The number must be normalised; then division by twice the root gives the lower half
// of the root, or one too many (Zimmermann, "Karatsuba Square Root", 1999).
constexpr Root lengthened(Root upper, int bits, std::uint64_t high, std::uint64_t low) {
  const std::uint64_t dividend = upper.rest << bits | high;
  const std::uint64_t digits = dividend / (2 * upper.root);
  Root whole = {(upper.root << bits) + digits,
                (dividend % (2 * upper.root) << bits | low) - digits * digits};
  if (static_cast<std::int64_t>(whole.rest) < 0) {
    --whole.root;
    whole.rest += 2 * whole.root + 1;
  }
  return whole;
}

constexpr std::array<std::uint8_t, 256> kRootsOfBytes = [] {
  std::array<std::uint8_t, 256> roots{};
  for (unsigned x = 1, root = 0; x < roots.size(); ++x) {
    if ((root + 1) * (root + 1) <= x) ++root;
    roots[x] = static_cast<std::uint8_t>(root);
  }
  return roots;
}();

}  // namespace

std::uint32_t integer_square_root(std::uint64_t x) {
  if (x == 0) return 0;
  const int shift = std::countl_zero(x) & ~1;  // even, so that the root shifts by half of it
  const std::uint64_t n = x << shift;
  const auto bits = [n](int from, int count) {
    return n >> from & ((std::uint64_t{1} << count) - 1);
  };
  const std::uint64_t byte = kRootsOfBytes[bits(56, 8)];
  Root root = {byte, bits(56, 8) - byte * byte};
  root = lengthened(root, 4, bits(52, 4), bits(48, 4));
  root = lengthened(root, 8, bits(40, 8), bits(32, 8));
  root = lengthened(root, 16, bits(16, 16), bits(0, 16));
  return static_cast<std::uint32_t>(root.root >> shift / 2);
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

namespace {

constexpr int kAxisFractionBits = 7;

const spec::texture::Axis& direction(spec::texture::Axes axes, int k) {
  const int step = 1 << (static_cast<int>(spec::texture::Axes::kEight) - static_cast<int>(axes));
  return spec::texture::kAxes.at(static_cast<std::uint32_t>(k * step));
}

std::int64_t along(const spec::texture::Axis& axis, std::int64_t x, std::int64_t y) {
  return axis.cosine * x + axis.sine * y;
}

std::uint32_t magnitude_in_texels(std::int64_t u) {
  constexpr std::int64_t kLargest = 0x7FFFFFFF;
  return static_cast<std::uint32_t>(std::min((u < 0 ? -u : u) >> kAxisFractionBits, kLargest));
}

std::int64_t rounded_in_coordinates(std::int64_t d) {
  constexpr std::int64_t kHalf = 1 << (kAxisFractionBits - 1);
  return d < 0 ? -((-d + kHalf) >> kAxisFractionBits) : (d + kHalf) >> kAxisFractionBits;
}

// P_x x P_y| of components truncated to 8 fraction bits.
std::uint64_t area(const Step& p_x, const Step& p_y) {
  const auto cut = [](std::int64_t p) { return p < 0 ? -(-p >> 8) : p >> 8; };
  const std::int64_t product = cut(p_x.s) * cut(p_y.t) - cut(p_x.t) * cut(p_y.s);
  return static_cast<std::uint64_t>(product < 0 ? -product : product);
}

std::uint64_t square_of_length(const Magnitudes& u) {
  return std::uint64_t{u.s} * u.s + std::uint64_t{u.t} * u.t;
}

}  // namespace

Magnitudes candidate_in_texels(spec::texture::Axes axes, int k, const Step& p_x, const Step& p_y) {
  const spec::texture::Axis& axis = direction(axes, k);
  return {magnitude_in_texels(along(axis, p_x.s, p_y.s)),
          magnitude_in_texels(along(axis, p_x.t, p_y.t))};
}

Step candidate_in_coordinates(spec::texture::Axes axes, int k, const Step& d_x, const Step& d_y) {
  const spec::texture::Axis& axis = direction(axes, k);
  return {rounded_in_coordinates(along(axis, d_x.s, d_y.s)),
          rounded_in_coordinates(along(axis, d_x.t, d_y.t))};
}

namespace {

struct Longest {
  int k = 0;
  std::uint64_t measure = 0;
};

// The candidate with the largest measure; on a tie, the first. kStep is the distance of two
// directions in the table: a constant, so that most products fold.
template <std::size_t kStep, class Measure>
Longest longest_candidate(const Step& p_x, const Step& p_y, Measure&& measure) {
  Longest result;
  const auto look_at = [&]<std::size_t kIndex>() {
    constexpr spec::texture::Axis kAxis = spec::texture::kAxes[kIndex * kStep];
    const Magnitudes u = {magnitude_in_texels(along(kAxis, p_x.s, p_y.s)),
                          magnitude_in_texels(along(kAxis, p_x.t, p_y.t))};
    const std::uint64_t length = measure(u);
    const bool longer = length > result.measure;
    result.measure = longer ? length : result.measure;
    result.k = longer ? static_cast<int>(kIndex) : result.k;
  };
  [&]<std::size_t... kIndices>(std::index_sequence<kIndices...>) {
    (look_at.template operator()<kIndices>(), ...);
  }
  (std::make_index_sequence<spec::texture::kAxes.size() / kStep>{});
  return result;
}

template <class Measure>
Longest longest_candidate(spec::texture::Axes axes, const Step& p_x, const Step& p_y,
                          Measure&& measure) {
  switch (axes) {
    case spec::texture::Axes::kTwo:
      return longest_candidate<4>(p_x, p_y, measure);
    case spec::texture::Axes::kFour:
      return longest_candidate<2>(p_x, p_y, measure);
    case spec::texture::Axes::kEight:
      break;
  }
  return longest_candidate<1>(p_x, p_y, measure);
}

}  // namespace

Footprint footprint(spec::texture::Axes axes, spec::texture::FootprintRule rule, const Step& p_x,
                    const Step& p_y) {
  Footprint result;
  if (rule == spec::texture::FootprintRule::kExact) {  // the largest square has the largest root
    const Longest longest =
        longest_candidate(axes, p_x, p_y, [](const Magnitudes& u) { return square_of_length(u); });
    result.major = longest.k;
    result.d_max = integer_square_root(longest.measure);
  } else {
    const Longest longest = longest_candidate(
        axes, p_x, p_y,
        [rule](const Magnitudes& u) -> std::uint64_t { return footprint_side(rule, u.s, u.t); });
    result.major = longest.k;
    result.d_max = static_cast<std::uint32_t>(longest.measure);
  }
  if (axes == spec::texture::Axes::kTwo) {
    const Magnitudes other = candidate_in_texels(axes, 1 - result.major, p_x, p_y);
    result.d_min = footprint_side(rule, other.s, other.t);
  } else {
    result.area = area(p_x, p_y);
  }
  return result;
}

namespace {

// The correction that the four-segment rule adds to n + y, U0.12.
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

// lb(1 + y), U1.12, interpolated between the entries of the table.
std::uint32_t interpolated_log2(std::uint32_t y) {
  const std::uint32_t i = y >> 6;
  const std::uint32_t low = spec::texture::kLog2Table[i], high = spec::texture::kLog2Table[i + 1];
  return low + (((high - low) * (y & 63) + 32) >> 6);
}

}  // namespace

std::int32_t log2_fixed(spec::texture::Log2Rule rule, std::uint64_t d) {
  if (d == 0) d = 1;
  const int p = static_cast<int>(std::bit_width(d)) - 1;
  const auto y = static_cast<std::uint32_t>((d << 12) >> p) - 4096;
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

AxisLogarithms axis_logarithms(spec::texture::Axes axes, spec::texture::Log2Rule rule,
                               const Footprint& footprint) {
  const std::int32_t d_max = log2_fixed(rule, footprint.d_max);
  if (axes == spec::texture::Axes::kTwo) return {d_max, log2_fixed(rule, footprint.d_min)};
  return {d_max, log2_fixed(rule, footprint.area) - d_max};
}

}  // namespace deburr::golden::texture
