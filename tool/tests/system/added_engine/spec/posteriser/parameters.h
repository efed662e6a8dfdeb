// SPDX-License-Identifier: MIT
// Parameters of the posteriser, which reduces each colour channel to a few levels.
//
// With `bits` bits per channel there are n = 2^bits levels, and level l is the code 255 l / (n -
// 1), rounded, halves up. truncate: code c becomes level floor(c n / 256). nearest: the level whose
// code is nearest to c; ties go to the higher level.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace deburr::spec::posteriser {

enum class Rounding : std::uint8_t { kTruncate, kNearest };
inline constexpr std::array<std::string_view, 2> kRoundingNames = {"truncate", "nearest"};

struct Configuration {
  std::int32_t bits = 3;
  Rounding rounding = Rounding::kNearest;
};
struct Build {
  std::int32_t link_depth = 2;
};
struct Parameters : Configuration, Build {};

template <class Visitor>
void describe(Configuration& p, Visitor& v) {
  v.integer("bits", p.bits, 1, 8, "bit", "Levels of a colour, as a power of two.");
  v.choice("rounding", p.rounding, kRoundingNames, "To which level a code goes.");
}
template <class Visitor>
void describe(Build& p, Visitor& v) {
  v.integer("link_depth", p.link_depth, 1, 8, "tone", "Depth of the links around it.");
}
template <class Visitor>
void describe(Parameters& p, Visitor& v) {
  describe(static_cast<Configuration&>(p), v);
  describe(static_cast<Build&>(p), v);
}

}  // namespace deburr::spec::posteriser
