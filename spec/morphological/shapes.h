// SPDX-License-Identifier: MIT
// The sixteen shapes of a run of edges. Meaning: docs/reference/morphological/algorithm.md.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace deburr::spec::morphological {

// The pixel of an edge that the line enters.
enum class Side : std::uint8_t {
  kNone,
  kFirst,
  kSecond
};  // first: upper (left); second: lower (right)

// Code of an end: bit 0 for a crossing edge on the first side (north, west), bit 1 for one on the
// second side (south, east). Index of the table: code of the start + 4 * code of the end.
struct RunShape {
  std::string_view name;
  Side before, after;
  bool clean_z;  // the run may be extended
};
inline constexpr std::array<RunShape, 16> kRunShapes = {{
    {"none-none", Side::kNone, Side::kNone, false},
    {"L-first-none", Side::kFirst, Side::kNone, false},
    {"L-second-none", Side::kSecond, Side::kNone, false},
    {"T-none", Side::kNone, Side::kNone, false},
    {"L-none-first", Side::kNone, Side::kFirst, false},
    {"U-first", Side::kFirst, Side::kFirst, false},
    {"Z-second-first", Side::kSecond, Side::kFirst, true},
    {"T-first", Side::kSecond, Side::kFirst, false},
    {"L-none-second", Side::kNone, Side::kSecond, false},
    {"Z-first-second", Side::kFirst, Side::kSecond, true},
    {"U-second", Side::kSecond, Side::kSecond, false},
    {"T-second", Side::kFirst, Side::kSecond, false},
    {"none-T", Side::kNone, Side::kNone, false},
    {"first-T", Side::kFirst, Side::kSecond, false},
    {"second-T", Side::kSecond, Side::kFirst, false},
    {"T-T", Side::kNone, Side::kNone, false},
}};

}  // namespace deburr::spec::morphological
