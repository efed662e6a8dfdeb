// SPDX-License-Identifier: MIT
#include "rtl_model/texture/block_colours.h"

#include <utility>

#include "rtl_model/texture/datasheets.h"
#include "spec/texture/tables.h"

namespace deburr::rtl::texture::block_colours {
namespace {

constexpr Rgb sum(const Rgb& colour, std::int32_t difference) {
  return {byte(colour[0] + difference), byte(colour[1] + difference), byte(colour[2] + difference)};
}
// A channel of `bits` bits to eight, by repeating its high bits.
constexpr std::int32_t widened(std::uint32_t v, unsigned bits) {
  return static_cast<std::int32_t>(v << (8 - bits) | v >> (2 * bits - 8));
}

// ---- BC

Rgb end_point(std::uint32_t c, BlockRule rule) {
  const auto five = [&](std::uint32_t v) {
    return rule == BlockRule::kTruncated ? widened(v, 5)
                                         : static_cast<std::int32_t>((527 * v + 23) >> 6);
  };
  const auto six = [&](std::uint32_t v) {
    return rule == BlockRule::kTruncated ? widened(v, 6)
                                         : static_cast<std::int32_t>((259 * v + 33) >> 6);
  };
  return {five(c >> 11), six(c >> 5 & 63), five(c & 31)};
}

void bc_colours(std::uint64_t bits, bool three_allowed, BlockRule rule, Palette& out) {
  const std::uint32_t c0 = field(bits, 15, 0), c1 = field(bits, 31, 16);
  const bool three = three_allowed && c0 <= c1;
  const std::int32_t up = rule == BlockRule::kRounded ? 1 : 0;
  out.kinds |= 1U << (three ? kThree : kFour);
  const Rgb a = end_point(c0, rule), b = end_point(c1, rule);
  out.colour[0] = a;
  out.colour[1] = b;
  for (std::size_t c = 0; c < 3; ++c) {
    out.colour[2][c] = three ? (a[c] + b[c] + up) / 2 : (2 * a[c] + b[c] + up) / 3;
    out.colour[3][c] = three ? 0 : (2 * b[c] + a[c] + up) / 3;
  }
  if (three) out.clear = 1U << 3;
}

void bc_values(std::uint64_t bits, BlockRule rule, BlockFault fault, std::size_t n,
               Palette& palette) {
  std::array<std::int32_t, 8>& out = palette.value[n];
  const auto a = static_cast<std::int32_t>(field(bits, 7, 0)),
             b = static_cast<std::int32_t>(field(bits, 15, 8));
  const bool seven = (a > b) != (fault == BlockFault::kValues);
  palette.kinds |= 1U << (seven ? kSeven : kFive);
  const std::int32_t up = rule == BlockRule::kRounded ? 1 : 0, parts = seven ? 7 : 5;
  out[0] = a;
  out[1] = b;
  for (std::int32_t s = 2; s <= parts; ++s)
    out[static_cast<std::size_t>(s)] = ((parts + 1 - s) * a + (s - 1) * b + up) / parts;
  if (seven) return;
  out[6] = 0;
  out[7] = 255;
}

// ---- ETC2

void etc_colours(std::uint64_t bits, bool punch_through, BlockFault fault, Palette& out) {
  const bool d = field(bits, 33, 33) != 0, holes = punch_through && !d;
  if (holes) out.clear = 1U << 2 | 1U << 6;
  const auto four = [&](unsigned high) { return widened(field(bits, high, high - 3), 4); };
  // Two colours, each with four modifiers.
  const auto halves = [&](const Rgb& first, const Rgb& second) {
    const std::array<Rgb, 2> half = {first, second};
    for (std::size_t h = 0; h < 2; ++h) {
      const auto& [m, n] =
          spec::texture::kEtcModifiers[h == 0 ? field(bits, 39, 37) : field(bits, 36, 34)];
      const std::array<std::int32_t, 4> modifiers = {holes ? 0 : m, n, -m, -n};
      for (std::size_t s = 0; s < 4; ++s) out.colour[4 * h + s] = sum(half[h], modifiers[s]);
    }
  };
  // The same four for both halves.
  const auto paint = [&](const std::array<Rgb, 4>& colours) {
    for (std::size_t s = 0; s < 8; ++s) out.colour[s] = colours[s % 4];
  };
  const auto meet = [&](Kind kind) { out.kinds |= 1U << kind; };
  if (!d && !punch_through) {
    meet(kIndividual);
    return halves({four(63), four(55), four(47)}, {four(59), four(51), four(43)});
  }

  std::array<std::int32_t, 3> base{}, other{};
  for (std::size_t c = 0; c < 3; ++c) {
    const unsigned high = 63 - 8 * static_cast<unsigned>(c);
    const auto difference = static_cast<std::int32_t>(field(bits, high - 5, high - 7));
    base[c] = static_cast<std::int32_t>(field(bits, high, high - 4));
    other[c] = base[c] + (difference ^ 4) - 4;
  }
  const auto in_range = [&](std::size_t c) { return other[c] >= 0 && other[c] <= 31; };
  bool t_mode = !in_range(0), h_mode = in_range(0) && !in_range(1);
  if (fault == BlockFault::kModes) std::swap(t_mode, h_mode);
  if (t_mode || h_mode || in_range(2)) {
    meet(t_mode ? kT : h_mode ? kH : kDifferential);
    if (holes) meet(kHoles);
  }
  if (t_mode) {
    const Rgb a = {widened(field(bits, 60, 59) << 2 | field(bits, 57, 56), 4), four(55), four(51)},
              b = {four(47), four(43), four(39)};
    const std::int32_t e =
        spec::texture::kEtcDistances[field(bits, 35, 34) << 1 | field(bits, 32, 32)];
    return paint({a, sum(b, e), b, sum(b, -e)});
  }
  if (h_mode) {
    const std::array<std::uint32_t, 3> a = {field(bits, 62, 59),
                                            field(bits, 58, 56) << 1 | field(bits, 52, 52),
                                            field(bits, 51, 51) << 3 | field(bits, 49, 47)},
                                       b = {field(bits, 46, 43), field(bits, 42, 39),
                                            field(bits, 38, 35)};
    const auto number = [](const auto& c) { return c[0] << 8 | c[1] << 4 | c[2]; };
    const auto colour = [](const auto& c) {
      return Rgb{widened(c[0], 4), widened(c[1], 4), widened(c[2], 4)};
    };
    const std::int32_t e =
        spec::texture::kEtcDistances[field(bits, 34, 34) << 2 | field(bits, 32, 32) << 1 |
                                     (number(a) >= number(b) ? 1U : 0U)];
    return paint({sum(colour(a), e), sum(colour(a), -e), sum(colour(b), e), sum(colour(b), -e)});
  }
  if (!in_range(2)) {
    meet(kPlanar);
    out.planar = true;
    out.clear = 0;
    const Rgb o = {widened(field(bits, 62, 57), 6),
                   widened(field(bits, 56, 56) << 6 | field(bits, 54, 49), 7),
                   widened(
                       field(bits, 48, 48) << 5 | field(bits, 44, 43) << 3 | field(bits, 41, 39),
                       6)},
              h = {widened(field(bits, 38, 34) << 1 | field(bits, 32, 32), 6),
                   widened(field(bits, 31, 25), 7), widened(field(bits, 24, 19), 6)},
              v = {widened(field(bits, 18, 13), 6), widened(field(bits, 12, 6), 7),
                   widened(field(bits, 5, 0), 6)};
    out.colour[0] = o;
    for (std::size_t c = 0; c < 3; ++c) {
      out.colour[1][c] = h[c] - o[c];
      out.colour[2][c] = v[c] - o[c];
    }
    return;
  }
  const auto five = [](const std::array<std::int32_t, 3>& channels) {
    Rgb colour{};
    for (std::size_t c = 0; c < 3; ++c)
      colour[c] = widened(static_cast<std::uint32_t>(channels[c]), 5);
    return colour;
  };
  halves(five(base), five(other));
}

void eac_values(std::uint64_t bits, std::array<std::int32_t, 8>& out) {
  const auto base = static_cast<std::int32_t>(field(bits, 63, 56)),
             factor = static_cast<std::int32_t>(field(bits, 55, 52));
  const auto& modifiers = spec::texture::kEacModifiers[field(bits, 51, 48)];
  for (std::size_t s = 0; s < 8; ++s) out[s] = byte(base + factor * modifiers[s]);
}

}  // namespace

Palette palette(const Block& block, Format format, BlockRule rule, BlockFault fault) {
  Palette out;
  const std::size_t colours = half_of_colours(format);
  switch (format) {
    case Format::kBc3:
      bc_values(little(block, 0), rule, fault, 0, out);
      [[fallthrough]];
    case Format::kBc1:
      bc_colours(little(block, colours), format == Format::kBc1, rule, out);
      break;
    case Format::kBc5:
      bc_values(little(block, 1), rule, fault, 1, out);
      [[fallthrough]];
    case Format::kBc4:
      bc_values(little(block, 0), rule, fault, 0, out);
      break;
    case Format::kEtc2Rgba8:
      eac_values(big(block, 0), out.value[0]);
      [[fallthrough]];
    case Format::kEtc2Rgb:
    case Format::kEtc2RgbA1:
      etc_colours(big(block, colours), format == Format::kEtc2RgbA1, fault, out);
      break;
    default:
      break;
  }
  return out;
}

std::array<Stage, 2> stages(BlockRule rule, const char* first, const char* second,
                            const Operator& chosen) {
  const bool rounded = rule == BlockRule::kRounded;
  // Quotients by 3, 5 and 7, and 5 or 6 bits to 8, by constants.
  const Operator third = op::multiply_constant(10, signed_digits(683) - 1),
                 fifth = op::multiply_constant(11, signed_digits(3277) - 1),
                 seventh = op::multiply_constant(11, signed_digits(9363) - 1),
                 widen = op::multiply_constant(6, signed_digits(527));
  // End points or fields of the mode (57 bits), modifiers (28), mode; of two blocks of values the
  // ends and their order, of the alpha its modifiers and multiplier; format. Selectors of the
  // texels stay in the block.
  constexpr std::uint32_t kFields = 57 + 28 + 5 + 2 * (16 + 1) + 40 + 4 + 3 + 128;
  return {
      {{.clock = first,
        .work = "mode, end points and fields of each block",
        .operators = {chosen, op::compare(16), 2 * op::compare(8), 3 * op::add(6), op::compare(12),
                      op::mux(57, 6), 2 * op::rom_read(14, 8), op::rom_read(7, 8),
                      op::rom_read(40, 16), (rounded ? 6 : 0) * widen, op::logic(60)},
        .longest = {chosen, op::add(6), op::priority(4), op::mux(57, 6)},
        .registers = kFields},
       {.clock = second,
        .work = "what the texels of each block are summed of",
        // BC: a third of each channel's difference, a seventh and a fifth of two values'
        // differences; ETC2: two colours and their modifiers, planes; alpha of ETC2.
        .operators = {3 * op::subtract(9), 3 * third, 2 * op::subtract(9), 2 * seventh, 2 * fifth,
                      2 * op::mux(11, 2), 6 * op::subtract(9), 4 * op::multiply(4, 4),
                      op::mux(kSummandBits - 32, 3)},
        .longest = {op::subtract(9), seventh, op::mux(11, 2), op::mux(kSummandBits - 32, 3)},
        .registers = kSummandBits + 128}}};
}

// Of a texel: its selectors, the summands that they choose, and three colours and alpha of them.
std::vector<Operator> of_texels(std::uint32_t texels) {
  return {texels * op::mux(8, 16),      3 * texels * op::mux(9, 4), 2 * texels * op::mux(11, 8),
          2 * 3 * texels * op::add(11), 2 * texels * op::add(11),   4 * texels * op::logic(kClamp),
          texels * op::mux(32, 3)};
}

}  // namespace deburr::rtl::texture::block_colours
