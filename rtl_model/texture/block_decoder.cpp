// SPDX-License-Identifier: MIT
#include "rtl_model/texture/block_decoder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <string>
#include <utility>

#include "rtl_model/texture/datasheets.h"
#include "spec/texture/tables.h"

namespace deburr::rtl::texture {
namespace {

using spec::texture::BlockRule, spec::texture::Format;
using Fault = BlockDecoderBase::Fault;
using Rgb = std::array<std::int32_t, 3>;

// What the texels of a block select from, after stage 2.
struct Palette {
  std::array<Rgb, 8> colour{};                         // ETC2: four of each half
  std::array<std::array<std::int32_t, 8>, 2> value{};  // alpha is the first
  std::uint32_t clear = 0;                             // bit s: selector s is a hole
  bool planar = false;      // colour 0, and from it to H and V in colours 1 and 2
  std::uint32_t kinds = 0;  // bit k: of kind k, for coverage
};
enum Kind { kFour, kThree, kSeven, kFive, kIndividual, kDifferential, kT, kH, kPlanar, kHoles };
// The selectors of texel (x, y), after stage 1.
struct Selectors {
  std::uint32_t colour = 0;
  std::array<std::uint32_t, 2> value{};
};

// Field high..low of a number.
constexpr std::uint32_t field(std::uint64_t bits, unsigned high, unsigned low) {
  return static_cast<std::uint32_t>(bits >> low & ((std::uint64_t{1} << (high - low + 1)) - 1));
}
constexpr std::int32_t byte(std::int32_t v) { return std::clamp(v, 0, 255); }
constexpr Rgb sum(const Rgb& colour, std::int32_t difference) {
  return {byte(colour[0] + difference), byte(colour[1] + difference), byte(colour[2] + difference)};
}
// A channel of `bits` bits to eight, by repeating its high bits.
constexpr std::int32_t widened(std::uint32_t v, unsigned bits) {
  return static_cast<std::int32_t>(v << (8 - bits) | v >> (2 * bits - 8));
}

// Half `n` of a block as little-endian and as big-endian number.
constexpr std::uint64_t little(const Block& block, std::size_t n) {
  return block[2 * n] | std::uint64_t{block[2 * n + 1]} << 32;
}
constexpr std::uint64_t big(const Block& block, std::size_t n) {
  const std::uint64_t bits = little(block, n);
  std::uint64_t turned = 0;
  for (unsigned i = 0; i < 8; ++i) turned |= (bits >> (8 * i) & 255) << (56 - 8 * i);
  return turned;
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

void bc_values(std::uint64_t bits, BlockRule rule, Fault fault, std::size_t n, Palette& palette) {
  std::array<std::int32_t, 8>& out = palette.value[n];
  const auto a = static_cast<std::int32_t>(field(bits, 7, 0)),
             b = static_cast<std::int32_t>(field(bits, 15, 8));
  const bool seven = (a > b) != (fault == Fault::kValues);
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

void etc_colours(std::uint64_t bits, bool punch_through, Fault fault, Palette& out) {
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
  if (fault == Fault::kModes) std::swap(t_mode, h_mode);
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

std::size_t half_of_colours(Format format) {
  return format == Format::kBc3 || format == Format::kEtc2Rgba8 ? 1 : 0;
}

// Stages 1 and 2.
Palette palette(const Block& block, Format format, BlockRule rule, Fault fault) {
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

Selectors selectors(const Block& block, Format format, std::uint32_t x, std::uint32_t y,
                    Fault fault) {
  const std::uint32_t by_rows = 4 * y + x, by_columns = 4 * x + y;
  const std::size_t colours = half_of_colours(format);
  Selectors out;
  if (format >= Format::kEtc2Rgb) {
    const std::uint64_t bits = big(block, colours);
    const bool flip = field(bits, 32, 32) != 0;
    const std::uint32_t half = (flip ? y : x) / 2;
    const std::uint32_t high = field(bits, 16 + by_columns, 16 + by_columns),
                        low = field(bits, by_columns, by_columns);
    out.colour = half << 2 | (fault == Fault::kSelectors ? low << 1 | high : high << 1 | low);
    out.value[0] = field(big(block, 0), 47 - 3 * by_columns, 45 - 3 * by_columns);
    return out;
  }
  out.colour = field(little(block, colours), 32 + 2 * by_rows + 1, 32 + 2 * by_rows);
  if (fault == Fault::kSelectors) out.colour = out.colour >> 1 | (out.colour & 1) << 1;
  for (std::size_t n = 0; n < 2; ++n)
    out.value[n] = field(little(block, n), 16 + 3 * by_rows + 2, 16 + 3 * by_rows);
  return out;
}

constexpr std::uint32_t packed(std::int32_t r, std::int32_t g, std::int32_t b, std::int32_t a) {
  return static_cast<std::uint32_t>(r | g << 8 | b << 16) | static_cast<std::uint32_t>(a) << 24;
}

// Stage 3.
std::uint32_t select(const Palette& from, const Selectors& s, Format format, std::uint32_t x,
                     std::uint32_t y) {
  const std::int32_t value = from.value[0][s.value[0]];
  if (format == Format::kBc4) return packed(value, value, value, 255);
  if (format == Format::kBc5) return packed(value, from.value[1][s.value[1]], 0, 255);
  if ((from.clear >> s.colour & 1) != 0) return 0;
  Rgb colour = from.colour[s.colour];
  if (from.planar)
    for (std::size_t c = 0; c < 3; ++c)
      colour[c] =
          byte((static_cast<std::int32_t>(x) * from.colour[1][c] +
                static_cast<std::int32_t>(y) * from.colour[2][c] + 4 * from.colour[0][c] + 2) >>
               2);
  const bool has_alpha = format == Format::kBc3 || format == Format::kEtc2Rgba8;
  return packed(colour[0], colour[1], colour[2], has_alpha ? value : 255);
}

}  // namespace

template <class Width>
BlockDecoderOf<Width>::BlockDecoderOf(const sc_core::sc_module_name& name, ClockDomain& clock,
                                      const spec::texture::Parameters& p)
    : BlockDecoderBase(name, clock), decoders_(decoders(p)), rule_(p.bc) {}

// Last stage first.
template <class Width>
Activity BlockDecoderOf<Width>::tick(Cycle cycle) {
  const bool arrives = cycles_left_ == 0 && blocks_in.can_pop(cycle);
  if (pipe_.empty() && cycles_left_ == 0 && !arrives) return kIdle;
  if (pipe_.leaves() && !texels_out.can_push(cycle)) return kStalledDownstream;
  pipe_.move();
  if (const auto* done = pipe_.at(kStages)) texels_out.push(cycle, *done);
  if (arrives) {
    const BlockGroup& arrived = blocks_in.take(cycle);
    if (fault != Fault::kNone) changed_ = faulty(arrived);
    const BlockGroup& group = fault == Fault::kNone ? arrived : changed_;
    blocks += group.blocks;
    if (group.blocks <= decoders_) {
      decode(group, pipe_.enter());
    } else {
      decode(group, in_hand_);
      cycles_left_ = (group.blocks - 1u) / decoders_;
    }
  } else if (cycles_left_ != 0 && --cycles_left_ == 0) {
    pipe_.enter() = in_hand_;
  }
  return kBusy;
}

template <class Width>
void BlockDecoderOf<Width>::decode(const BlockGroup& group, typename Width::TexelQuads& texels) {
  std::array<Palette, spec::texture::kMostDecoders> palettes;
  std::uint32_t known = 0;  // bit k: of block k
  set_count(texels, group.count);
  for (std::size_t r = 0; r < count_of(texels); ++r) {
    const BlockRequest& request = group.at[r];
    TexelQuadToken& out = nth(texels, r);
    out.ticket = request.ticket;
    out.control = request.control;
    out.texel = request.texel;
    if (!request.ticket.valid || request.control.codec == 0) continue;
    const Format format = format_of(request.control.codec);
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::size_t k = std::min<std::size_t>(request.index[i], palettes.size() - 1);
      if ((known >> k & 1) == 0) {
        palettes[k] = palette(group.block[k], format, rule_, fault);
        for (std::uint32_t left = palettes[k].kinds; left != 0; left &= left - 1)
          ++kinds[static_cast<std::size_t>(std::countr_zero(left))];
        known |= 1U << k;
      }
      const std::uint32_t x = request.control.within >> 2 * (i % 2) & 3,
                          y = request.control.within >> (4 + 2 * (i / 2)) & 3;
      out.texel[i] =
          select(palettes[k], selectors(group.block[k], format, x, y, fault), format, x, y);
    }
  }
}

template <class Width>
BlockGroup BlockDecoderOf<Width>::faulty(BlockGroup group) {
  const auto blocks_now = group.block;
  if (fault == Fault::kEdge)
    for (BlockRequest& request : group.at) request.index[1] = request.index[0];
  if (fault == Fault::kHalf)
    for (std::size_t k = 0; k < group.block.size(); ++k)
      std::copy_n(previous_[k].begin() + 2, 2, group.block[k].begin() + 2);
  previous_ = blocks_now;
  return group;
}

template <class Width>
void BlockDecoderOf<Width>::reset() {
  pipe_.reset();
  cycles_left_ = 0;
}

template <class Width>
Datasheet BlockDecoderOf<Width>::datasheet(const spec::texture::Parameters& p) {
  const Sizes z(p);
  const std::uint32_t d = decoders(p), passes = z.width == 1 ? (4 + d - 1) / d : 1;
  const bool rounded = p.bc == BlockRule::kRounded;
  // Quotients by 3, 5 and 7, and 5 or 6 bits to 8, by constants.
  const Operator third = op::multiply_constant(10, signed_digits(683) - 1),
                 fifth = op::multiply_constant(11, signed_digits(3277) - 1),
                 seventh = op::multiply_constant(11, signed_digits(9363) - 1),
                 widen = op::multiply_constant(6, signed_digits(527));
  constexpr std::uint32_t kClamp = 12;  // gates: a byte from 0 to 255
  // End points or fields of the mode (57 bits), modifiers (28), mode, selectors; of two blocks of
  // values the ends, order and selectors; of the alpha its modifiers and multiplier.
  constexpr std::uint32_t kFields = 57 + 28 + 5 + 32 + 2 * (16 + 1 + 48) + 40 + 4 + 3;
  // Colours, or the planes; values; selectors; mode and format.
  constexpr std::uint32_t kPalette = 8 * 24 + 2 * 64 + 32 + 2 * 48 + 8;
  const std::uint32_t request = Payload::of<BlockGroup>(block_shape(p)).bits() - 3 -
                                (z.width == 1 ? spec::texture::kBlocksPerRequest : d) * 128;
  Datasheet sheet = {
      .unit = "BlockDecoder",
      .variant = chosen("width", z.width) + ", " + chosen("cache.decoders", d) + ", " +
                 chosen("bc", spec::texture::kBlockRuleNames, p.bc),
      .does = "Decodes the blocks of a request to texels.",
      .latency = {3},
      .interval = {1, "max(1, ceil(n / D)) cycles per request of n distinct blocks"},
      .stages = {{.clock = "1",
                  .work = "mode, end points and fields of each block",
                  .operators = {op::mux(128, passes), op::compare(16), 2 * op::compare(8),
                                3 * op::add(6), op::compare(12), op::mux(57, 6),
                                2 * op::rom_read(14, 8), op::rom_read(7, 8), op::rom_read(40, 16),
                                (rounded ? 6 : 0) * widen, op::logic(60)},
                  .longest = {op::mux(128, passes), op::add(6), op::priority(4), op::mux(57, 6)},
                  .registers = kFields},
                 {.clock = "2",
                  .work = "colours and values that the texels of each block select",
                  // BC: thirds and halves; ETC2: eight colours with modifiers; BC: six steps of two
                  // blocks of values; alpha of ETC2; planes.
                  .operators = {6 * op::add(10), 6 * third, 3 * op::add(9), 24 * op::mux(8, 3),
                                24 * op::add(9), 24 * op::logic(kClamp), 4 * 6 * op::add(11),
                                2 * 6 * seventh, 2 * 4 * fifth, 2 * 6 * op::mux(8, 3),
                                8 * op::multiply(5, 4), 8 * op::add(10), 8 * op::logic(kClamp),
                                6 * op::subtract(9), op::mux(8 * 24, 3), op::mux(64, 2)},
                  .longest = {2 * op::add(11), seventh, op::mux(8, 3), op::mux(64, 2)},
                  .registers = kPalette}},
      .formats = "blocks of 8 or 16 bytes, texels of four channels U8.0.",
      .copies = d,
      .per = "block",
      // Two stages of the requests; of a request in passes its texels so far, and the pass.
      .shared_registers = 2 * request + (passes > 1 ? 4 * 32 + 2 : 0)};
  // Of each texel: its selectors, its colour and values, the plane at it, and what it is made of.
  const std::uint32_t n = z.texels;
  sheet.stages.push_back({.clock = "3",
                          .work = "selects texels",
                          .longest = {op::mux(78, d), op::add(10), 2 * op::add(11),
                                      op::logic(kClamp), op::mux(32, 5)}});
  sheet.shared = {n * op::mux(9, 16 * d),    n * op::mux(24, 8 * d), n * op::mux(16, 8 * d),
                  n * op::mux(78, d),        6 * n * op::add(10),    6 * n * op::add(11),
                  3 * n * op::logic(kClamp), n * op::mux(32, 5)};
  return sheet;
}

template class BlockDecoderOf<Narrow>;
template class BlockDecoderOf<Wide>;

}  // namespace deburr::rtl::texture
