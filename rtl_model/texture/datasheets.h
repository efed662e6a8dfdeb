// SPDX-License-Identifier: MIT
// Datasheets of the texture unit's parts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

// Counts and widths in bits of a build, from which its operators follow.
struct Sizes {
  explicit Sizes(const spec::texture::Parameters& parameters);
  std::uint32_t fragments, width, axis_cycles;
  std::uint32_t candidates;    // directions of the major axis that are measured per cycle
  std::uint32_t axis, minor;   // component of the axis; d_min, or the area
  std::uint32_t step;          // axis x spread, without the zeros below it
  std::uint32_t position;      // of a sample
  std::uint32_t walking;       // groups of fragments in the walking registers
  std::uint32_t texels;        // of a group
  std::uint32_t line, offset;  // number of a line; byte in it
  std::uint32_t set, slot;     // number of a set; of a line in the data banks
  std::uint32_t tag, set_word;
  std::uint32_t sets, ways, lookups, allocations, outstanding;
  std::uint32_t words, line_banks, bank_reads, fill_writes;  // words: of a line
};

// Texts of variants: "`log2 = segments`"; "`axes = two`" or those of the AxisUnit.
std::string chosen(const char* parameter, std::string_view value);
std::string chosen(const char* parameter, std::uint64_t value);
template <class Names, class Value>
std::string chosen(const char* parameter, const Names& names, Value value) {
  return chosen(parameter, names[static_cast<std::size_t>(value)]);
}
std::string with_decode(const spec::texture::Build& build);    // ", `decode = after`", "" if none
std::string with_decoders(const spec::texture::Build& build);  // the same only with decoders
std::string with_blocks(
    const spec::texture::Build& build);  // "", or ", `decode = after` or `before`"
std::string chosen_axes(const spec::texture::Parameters& parameters);
std::string sets_text(const spec::texture::Parameters& parameters);  // "128 sets of 2 ways, ..."

// The first stage of `sides` lengths by every rule but `exact`, and the bits that it passes on.
struct SideHardware {
  std::vector<Operator> operators, longest;
  std::uint32_t bits;
};
SideHardware side_hardware(spec::texture::FootprintRule rule, std::uint32_t sides);
// Non-zero digits of a constant, as digits of -1, 0 and 1.
std::uint32_t signed_digits(std::uint32_t constant);

// Parts built with these parameters, in pipeline order.
std::vector<Datasheet> datasheets(const spec::texture::Parameters& parameters);
// All parts as both presets, the build `wide` and some other parameters build them, and the whole
// unit with each preset.
std::vector<Datasheet> datasheets();

}  // namespace deburr::rtl::texture
