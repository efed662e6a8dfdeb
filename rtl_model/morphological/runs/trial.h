// SPDX-License-Identifier: MIT
// One side of a predictor's trial: the edges it needs, the candidates that hit, and the class of
// the crossing at its start.
#pragma once

#include <algorithm>
#include <cstdint>

namespace deburr::rtl::morphological {

// Positions along the axis and lattice lines across it, both counted from the frame border.
struct Trial {
  std::int32_t line;    // lattice line of the corners
  std::int32_t from;    // start of the step
  std::int32_t length;  // L
  std::int32_t room;    // longest step within the search range
  bool to_the_right;
  std::uint8_t origin, corner;       // codes of the corners at its start and end
  bool tries = true;                 // candidates are tested
  std::uint8_t crossing = 0;         // bit of corner `from`: the edge that continues the crossing
  bool classes = false;              // the class is needed
  std::int32_t looks = 0;            // number of edges after `from` for the class
  std::int32_t first = 0, last = 0;  // columns read (rows memory only)

  std::int32_t at(std::int32_t step) const { return to_the_right ? from + step : from - step; }
};

// Bits of a corner code: edges along the axis before and after the corner, edges across it on the
// first and on the second side.
inline constexpr std::uint8_t kBeforeBit = 1, kAfterBit = 2, kFirstBit = 4, kSecondBit = 8;
// Largest number of edges that distinguishes two classes.
inline constexpr std::int32_t kMostLooks = 10;

// Set of the candidates L - 1, L, L + 1 that hit.
inline constexpr std::uint8_t kShorter = 1, kEqual = 2, kLonger = 4;

// `edges` gives access to the data read: code(p) is the corner code at p on the trial's line;
// unbroken(from, end) is true if all edges along the axis at from .. end - 1 are set. In hardware:
// four 4-bit comparators and, with contiguous, an AND over the edges common to all candidates (a
// corner code contains the last edge of its step).
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

// Class of the crossing edge at an end, from the corner where the edge ends: 2 if it continues, 1
// if an edge leads back towards the run, 3 to 8 by the number of edges that lead away from the run,
// else 0. In hardware: four bits of the corner code and the first gap of ten edges.
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
