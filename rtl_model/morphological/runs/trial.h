// SPDX-License-Identifier: MIT
// One side of a trial of a predictor: what it asks of the edges, and which candidates hit.
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
  std::int32_t first = 0, last = 0;  // columns that are read for it, in rows

  std::int32_t at(std::int32_t step) const { return to_the_right ? from + step : from - step; }
};

// Which of the candidates L - 1, L and L + 1 hit.
inline constexpr std::uint8_t kShorter = 1, kEqual = 2, kLonger = 4;

// `edges` shows what has been read: code(p) of the corner at p on the trial's line; unbroken(from,
// end): are the edges along the axis at from..end - 1 all set? In hardware: four comparators of 4
// bits and, contiguous, an AND over the edges that all candidates share (a corner's code holds the
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

}  // namespace deburr::rtl::morphological
