// SPDX-License-Identifier: MIT
// Arithmetic of a block, for the BlockDecoder and the BlockFetcher:
// docs/reference/texture/compressed.md. First the colours and values that its texels select from
// (palette), then the selectors of each texel, then the texel.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

// What blocks are met: ends of colours and values of BC, modes of ETC2, and blocks with holes.
inline constexpr std::array<std::string_view, 10> kBlockKindNames = {
    "four_colours", "three_colours", "seven_steps", "five_steps",
    "individual",   "differential",  "t",           "h",
    "planar",       "holes"};
// For coverage, no hardware: palettes made, by these names.
using BlockKinds = std::array<std::uint64_t, kBlockKindNames.size()>;

// Faults that tests inject: modes T and H exchanged; the bits of each selector exchanged; values
// with the steps of the other mode. In the BlockDecoder also: the second texel in the block of the
// first; the second half of a block of 16 bytes from the previous request.
enum class BlockFault : std::uint8_t { kNone, kModes, kSelectors, kValues, kEdge, kHalf };

namespace block_colours {

using spec::texture::BlockRule, spec::texture::Format;
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

// Stages 1 and 2.
Palette palette(const Block& block, Format format, BlockRule rule,
                BlockFault fault = BlockFault::kNone);
// The same, counted by kind.
inline Palette counted_palette(const Block& block, Format format, BlockRule rule, BlockFault fault,
                               BlockKinds& kinds) {
  const Palette made = palette(block, format, rule, fault);
  for (std::uint32_t left = made.kinds; left != 0; left &= left - 1)
    ++kinds[static_cast<std::size_t>(std::countr_zero(left))];
  return made;
}

// Field high..low of a number.
constexpr std::uint32_t field(std::uint64_t bits, unsigned high, unsigned low) {
  return static_cast<std::uint32_t>(bits >> low & ((std::uint64_t{1} << (high - low + 1)) - 1));
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

constexpr std::size_t half_of_colours(Format format) {
  return format == Format::kBc3 || format == Format::kEtc2Rgba8 ? 1 : 0;
}

inline Selectors selectors(const Block& block, Format format, std::uint32_t x, std::uint32_t y,
                           BlockFault fault) {
  const std::uint32_t by_rows = 4 * y + x, by_columns = 4 * x + y;
  const std::size_t colours = half_of_colours(format);
  Selectors out;
  if (format >= Format::kEtc2Rgb) {
    const std::uint64_t bits = big(block, colours);
    const bool flip = field(bits, 32, 32) != 0;
    const std::uint32_t half = (flip ? y : x) / 2;
    const std::uint32_t high = field(bits, 16 + by_columns, 16 + by_columns),
                        low = field(bits, by_columns, by_columns);
    out.colour = half << 2 | (fault == BlockFault::kSelectors ? low << 1 | high : high << 1 | low);
    out.value[0] = field(big(block, 0), 47 - 3 * by_columns, 45 - 3 * by_columns);
    return out;
  }
  out.colour = field(little(block, colours), 32 + 2 * by_rows + 1, 32 + 2 * by_rows);
  if (fault == BlockFault::kSelectors) out.colour = out.colour >> 1 | (out.colour & 1) << 1;
  for (std::size_t n = 0; n < 2; ++n)
    out.value[n] = field(little(block, n), 16 + 3 * by_rows + 2, 16 + 3 * by_rows);
  return out;
}

constexpr std::int32_t byte(std::int32_t v) { return std::clamp(v, 0, 255); }
constexpr std::uint32_t packed(std::int32_t r, std::int32_t g, std::int32_t b, std::int32_t a) {
  return static_cast<std::uint32_t>(r | g << 8 | b << 16) | static_cast<std::uint32_t>(a) << 24;
}

// Stage 3.
inline std::uint32_t select(const Palette& from, const Selectors& s, Format format, std::uint32_t x,
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

// What the texels of a block are summed of: two ends and a step of each channel (26 bits), planes
// (54), modifiers (32), ends and steps of two values or alpha (38), mode, format.
inline constexpr std::uint32_t kSummandBits = 3 * 26 + 54 + 32 + 2 * 38 + 8;
// Operators that make texels of the summands of their blocks.
std::vector<Operator> of_texels(std::uint32_t texels);
// Stages 1 and 2 of a datasheet, for one block. `chosen` selects the block.
std::array<Stage, 2> stages(BlockRule rule, const char* first, const char* second,
                            const Operator& chosen);
constexpr std::uint32_t kClamp = 12;  // gates: a byte from 0 to 255

}  // namespace block_colours
}  // namespace deburr::rtl::texture
