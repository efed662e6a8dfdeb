// SPDX-License-Identifier: MIT
// Geometric post-process anti-aliasing in real numbers: the paper's equations with exact fractions;
// positions, weights and colours are not rounded.
//
// Reference for the arithmetic of the bit-exact golden model (paper 002, equations (6) to (8), with
// the corrections of docs/reference/geometric/algorithm.md). It has the limits of the method
// itself, which are measured against supersampling.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace deburr::golden::ideal {

struct ScreenPoint {
  double x = 0, y = 0;  // pixels, y downwards, centres at 0.5
  double depth = 0;     // near / w
};
struct ScreenLine {
  ScreenPoint p, q;
  bool crease = false;
};

// A pixel crossed by a line: one per column of the major axis, or two with area coverage.
struct CutPixel {
  int x = 0, y = 0;
  int direction = 0;    // of the neighbour: 0 up, 1 down, 2 left, 3 right
  double distance = 0;  // dis of equation (7): along the minor axis, positive down or right
  double coverage = 0;  // 1/2 - |dis|, or the area cut off by the line; above 0
  double depth = 0;     // of the line
};
// Area that a line of this slope, at most 1, cuts off a unit square. In the middle of the column
// the line is `distance` >= 0 away from the centre of the square.
double cut_area(double slope, double distance);
// Pixels of the frame whose neighbour is in the frame, ordered by column. With `area`, the second
// pixel of a column follows the first.
std::vector<CutPixel> cut_pixels(const ScreenLine& line, int width, int height, bool area = false);

using SideWeights = std::array<double, 4>;  // up, down, left, right
using Light = std::array<double, 3>;

struct GpaaOptions {
  bool last_wins = false;  // otherwise the largest per direction ...
  bool outermost = false;  // ... or the smallest, if the pixel is nearer than its neighbour
  bool area = false;       // otherwise distances along the minor axis
  double depth_bias = 1.0 / 512.0;  // relative, against the farther of pixel and neighbour
  double crease_depth = 1.0;        // relative tolerance of that depth behind a crease
};

// Weights of all pixels after all lines, row by row. `depth`: near / w of each pixel.
std::vector<SideWeights> side_weights(std::span<const ScreenLine> lines,
                                      std::span<const double> depth, int width, int height,
                                      const GpaaOptions& options = {});
// Equation (8) for both neighbours on the axis with the larger weights.
std::vector<Light> blended(std::span<const Light> frame, std::span<const SideWeights> weights,
                           int width, int height);

// The representation of geometry buffer AA: the nearest edge of each pixel on either axis, as the
// weight of the neighbour across it; negative for left and up.
struct NearestEdges {
  double horizontal = 0, vertical = 0;
};
std::vector<NearestEdges> nearest_edges(std::span<const SideWeights> weights);
// Blends each pixel with one neighbour, across the nearer of its two edges; on a tie, the vertical
// one.
std::vector<Light> blended(std::span<const Light> frame, std::span<const NearestEdges> edges,
                           int width);

}  // namespace deburr::golden::ideal
