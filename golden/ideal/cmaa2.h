// SPDX-License-Identifier: MIT
// Conservative morphological anti-aliasing 2 in real numbers: edges between pixels, a small blend
// of every corner, and long steps blended between the middles of their two arms.
//
// For comparison with the engine's presets (docs/measurements/morphological_quality.md); nothing is
// built from it. Written from the published descriptions (F. Strugar and A. Lake, Conservative
// Morphological Anti-Aliasing 2.0, Intel, 2018, and the patent application US 2015/0093026), not
// from the code that came with them. What they leave open is chosen here, for the best figures: the
// weights of simple shapes, that no further edge at a step makes it none, and that either arm rises
// to a half for itself. Edges outside of the frame are none.
#pragma once

#include <cstdint>
#include <vector>

#include "golden/ideal/colour_frame.h"

namespace deburr::golden::ideal {

struct Cmaa2Settings {
  double threshold = 0.05;  // share of full scale; the published qualities: 0.15, 0.1, 0.07, 0.05
  // An edge is weakened by this share of the strongest one that crosses an end of it.
  double contrast_adaptation = 0.1;
  // What a corner's pixel takes of each neighbour across its two, three or four edges.
  double corner = 0.1, tip = 0.1, dot = 0.1;
  int least_arms = 5;        // pixels of both arms of a long step
  int longest_arm = 86;      // pixels
  double symmetry = 0.22;    // pixels by which either end of a long step's line moves inwards
  bool linear_light = true;  // blend; edges are found on codes
};

// Which pixels have an edge on their right, and which below them.
struct Cmaa2Edges {
  std::vector<bool> right, below;
  int width = 0, height = 0;
  bool has_right(int x, int y) const { return inside(x, y) && right[index(x, y)]; }
  bool has_below(int x, int y) const { return inside(x, y) && below[index(x, y)]; }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }

 private:
  bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
};
Cmaa2Edges cmaa2_edges(const ColourFrame& frame, const Cmaa2Settings& settings = {});

// The filtered frame; alpha stays.
std::vector<Rgba8> cmaa2(const ColourFrame& frame, const Cmaa2Settings& settings = {});

}  // namespace deburr::golden::ideal
