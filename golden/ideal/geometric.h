// SPDX-License-Identifier: MIT
// Geometric post-process anti-aliasing in real numbers: the paper's equations with exact fractions,
// no rounding of positions, weights or colours.
//
// Reference for the bit-exact golden's arithmetic (paper 002, equations (6) to (8), with the
// corrections of docs/reference/geometric/algorithm.md). What the method itself cannot do it cannot
// do either; that is measured against supersampling.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace deburr::golden::ideal {

struct ScreenPoint {
  double x = 0, y = 0;  // pixels, y downwards, centres at halves
  double depth = 0;     // near / w
};
struct ScreenLine {
  ScreenPoint p, q;
  bool crease = false;
};

// A pixel that a line cuts, once a column of its longer axis, or twice where areas count.
struct CutPixel {
  int x = 0, y = 0;
  int direction = 0;    // of the neighbour: 0 up, 1 down, 2 left, 3 right
  double distance = 0;  // dis of equation (7): along the shorter axis, down or right positive
  double coverage = 0;  // 1/2 - |dis|, or the area that the line cuts off; above 0
  double depth = 0;     // of the line
};
// The area that a line of this slope, at most 1, cuts off a unit square from whose centre it is
// `distance` >= 0 away in the middle of it.
double cut_area(double slope, double distance);
// Pixels of the frame with a neighbour in the frame, in the order of columns. With `area` a
// column's second pixel follows the first.
std::vector<CutPixel> cut_pixels(const ScreenLine& line, int width, int height, bool area = false);

using SideWeights = std::array<double, 4>;  // up, down, left, right
using Light = std::array<double, 3>;

struct GpaaOptions {
  bool last_wins = false;           // else the largest of each direction ...
  bool outermost = false;           // ... or the smallest of a pixel in front of its neighbour
  bool area = false;                // else distances along the shorter axis
  double depth_bias = 1.0 / 512.0;  // relative, against the farther of pixel and neighbour
  double crease_depth = 1.0;        // how far that may lie behind a crease, relative
};

// Weights of all pixels after all lines, row by row. `depth` is near / w of each pixel.
std::vector<SideWeights> side_weights(std::span<const ScreenLine> lines,
                                      std::span<const double> depth, int width, int height,
                                      const GpaaOptions& options = {});
// Equation (8) for both neighbours of the heavier axis.
std::vector<Light> blended(std::span<const Light> frame, std::span<const SideWeights> weights,
                           int width, int height);

// Geometry buffer AA's way of writing the same down: the nearest edge of each pixel along either
// axis, as the share of the neighbour across it; left and up are negative.
struct NearestEdges {
  double horizontal = 0, vertical = 0;
};
std::vector<NearestEdges> nearest_edges(std::span<const SideWeights> weights);
// Each pixel with one neighbour, across the nearer of its two edges; the vertical one if they tie.
std::vector<Light> blended(std::span<const Light> frame, std::span<const NearestEdges> edges,
                           int width);

}  // namespace deburr::golden::ideal
