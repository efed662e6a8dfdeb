// SPDX-License-Identifier: MIT
// One side of a trial of a predictor: what it asks of the edges, which candidates hit, and the
// class of the crossing that it begins at.
#pragma once

#include <algorithm>
#include <cstdint>

namespace deburr::rtl::morphological {

// Positions count along the axis, lattice lines across it, both from the frame's border.
struct Trial {
  std::int32_t line;    // that the corners lie on
  std::int32_t from;    // where the step begins
  std::int32_t length;  // L
  std::int32_t room;    // the longest step that stays within the reach
  bool to_the_right;
  std::uint8_t origin, corner;       // codes of the corners at its beginning and its end
  bool tries = true;                 // candidates are asked for
  std::uint8_t crossing = 0;         // of the corner `from`: bit of the edge beyond its crossing
  bool classes = false;              // its class is asked for ..
  std::int32_t looks = 0;            // .. and so many edges from there on
  std::int32_t first = 0, last = 0;  // columns that are read for it, in rows

  std::int32_t at(std::int32_t step) const { return to_the_right ? from + step : from - step; }
};

// Bits of a corner's code: edges along the axis before and after the corner, edges across it on the
// first and on the second side.
inline constexpr std::uint8_t kBeforeBit = 1, kAfterBit = 2, kFirstBit = 4, kSecondBit = 8;
// Edges that tell one class from another.
inline constexpr std::int32_t kMostLooks = 10;

// Which of the candidates L - 1, L and L + 1 hit.
inline constexpr std::uint8_t kShorter = 1, kEqual = 2, kLonger = 4;

// `edges` shows what has been read: code(p) of the corner at p on the trial's line; unbroken(from,
// end): are the edges along the axis at from..end - 1 all set? In hardware: four comparators of 4
// bits and, contiguous, an AND over the edges that all candidates weight (a corner's code holds the
// last edge of its step).
template <class Edges>
std::uint8_t hits_of(const Trial& trial, const Edges& edges, bool contiguous) {
  if (contiguous && edges.code(trial.from) != trial.origin) return 0;
  std::uint8_t hits = 0;
  for (std::int32_t k = 0; k < 3; ++k) {
    const std::int32_t step = trial.length - 1 + k;
    if (step < 1 || step > trial.room) continue;
    const std::int32_t end = trial.at(step);
    if (edges.code(end) != trial.corner) continue;
    if (contiguous && !edges.unbroken(std::min(trial.from, end), std::max(trial.from, end)))
      continue;
    hits |= static_cast<std::uint8_t>(1u << k);
  }
  return hits;
}

// Of the crossing edge at an end, by the corner where it ends: 2 if it goes on, 1 if an edge lies
// there towards the run, 3 to 8 by the number of those that lead away from it, 0 if there is
// nothing. In hardware: four bits of the corner's code and the first gap of ten.
template <class Edges>
std::uint8_t class_of(const Trial& trial, const Edges& edges) {
  const std::uint8_t code = edges.code(trial.from);
  if (code & trial.crossing) return 2;
  if (code & (trial.to_the_right ? kBeforeBit : kAfterBit)) return 1;
  if (trial.looks == 0 || (code & (trial.to_the_right ? kAfterBit : kBeforeBit)) == 0) return 0;
  const auto along = [&](std::int32_t k) {
    return edges.along(trial.to_the_right ? trial.from + k : trial.from - 1 - k);
  };
  std::int32_t count = 1;
  while (count < trial.looks && along(count)) ++count;
  return static_cast<std::uint8_t>(count < 4 ? 2 + count : count < 6 ? 6 : count < 10 ? 7 : 8);
}

}  // namespace deburr::rtl::morphological
