// SPDX-License-Identifier: MIT
// Conservative morphological anti-aliasing 2 in real numbers: edges between pixels, a small blend
// at every corner, and long steps blended between the middles of their two arms.
//
// For comparison with the engine's presets (docs/measurements/morphological_quality.md); no
// hardware implements it. Source: the published descriptions (F. Strugar and A. Lake, Conservative
// Morphological Anti-Aliasing 2.0, Intel, 2018, and the patent application US 2015/0093026), not
// the published code. Chosen here for the best results, since they leave it open: the weights of
// simple shapes; a step stays a step if further edges meet it; each arm rises to a half
// independently. There are no edges outside the frame.
#pragma once

#include <cstdint>
#include <vector>

#include "golden/ideal/colour_frame.h"

namespace deburr::golden::ideal {

struct Cmaa2Settings {
  double threshold = 0.05;  // fraction of full scale; published qualities: 0.15, 0.1, 0.07, 0.05
  // An edge is reduced by this fraction of the strongest edge that crosses one of its ends.
  double contrast_adaptation = 0.1;
  // Weight of each neighbour across the two, three or four edges of a corner pixel.
  double corner = 0.1, tip = 0.1, dot = 0.1;
  int least_arms = 5;        // pixels; both arms of a long step together
  int longest_arm = 86;      // pixels
  double symmetry = 0.22;    // pixels by which each end of a long step's line moves inwards
  bool linear_light = true;  // for blending; edges are detected on codes
};

// Pixels with an edge to their right, and pixels with an edge below them.
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

// Returns the filtered frame; alpha is unchanged.
std::vector<Rgba8> cmaa2(const ColourFrame& frame, const Cmaa2Settings& settings = {});

}  // namespace deburr::golden::ideal
