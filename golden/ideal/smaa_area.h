// SPDX-License-Identifier: MIT
// Areas of SMAA's orthogonal patterns in real numbers, with the subsample offsets of its temporal
// and multisampled modes: entries of the published table before rounding.
//
// docs/reference/morphological/smaa.md, "Area table". Source: Jimenez et al., SMAA, 2012, and the
// program published with it that generates the table.
#pragma once

#include <array>

namespace deburr::golden::ideal {

// The fraction that each pixel of an edge takes of the other, 0..1.
struct SmaaWeights {
  double first = 0, second = 0;
};

// pattern: S_start + 2 S_end + 4 N_start + 8 N_end. l, r: pixels to the ends.
SmaaWeights smaa_area(int pattern, int l, int r, double offset = 0);

// Offsets of the seven rows of the table.
inline constexpr std::array<double, 7> kSmaaOffsets = {0,     -0.25,  0.25, -0.125,
                                                       0.125, -0.375, 0.375};

// Largest difference, in codes 0..255, between the entries that paper 003 merges: patterns 7 and 14
// read as 6, 11 and 13 as 9.
int loss_by_merging(double offset);

}  // namespace deburr::golden::ideal
