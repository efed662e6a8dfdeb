// SPDX-License-Identifier: MIT
// Reference for morphological anti-aliasing in real numbers: the area of a pixel inside a
// half-plane or a disc, and the areas that Reshetov cuts off between a line and a run of edges.
//
// Reference for the quality tables and the error bound of the integer areas (paper 000, section 2;
// docs/reference/morphological/algorithm.md, "Line through a run" and "Area", without rounding).
#pragma once

#include <span>

namespace deburr::golden::ideal {

// The points with a X + b Y + c > 0.
struct HalfPlane {
  double a = 0, b = 0, c = 0;
  double at(double x, double y) const { return a * x + b * y + c; }
};

// Fraction of the pixel [x, x + 1] x [y, y + 1] inside, 0..1; exact except for rounding errors.
double coverage(const HalfPlane& half_plane, double x, double y);

// The points inside the circle.
struct Disc {
  double x = 0, y = 0, radius = 1;
  bool contains(double px, double py) const {
    return (px - x) * (px - x) + (py - y) * (py - y) < radius * radius;
  }
};

// Fraction of the pixel [x, x + 1] x [y, y + 1] inside, 0..1; exact except for rounding errors.
double disc_coverage(const Disc& disc, double x, double y);

// A corner of a digital line: step `index` is at `position`, relative to the start of the run.
struct StepCorner {
  int index = 0, position = 0;
};

// t(X) = slope (X - zero): height above the edge of the run in steps, -1/2 in the middle of the
// step at corner 0, +1/2 at corner 1.
struct StepLine {
  double slope = 0, zero = 0;
  double at(double position) const { return slope * (position - zero); }
};
// Least squares of the positions over the indices of all corners (at least two).
StepLine fitted(std::span<const StepCorner> corners);
// Through the first and the last corner by index.
StepLine chord(std::span<const StepCorner> corners);
// One end of an L of `length` pixels: -1/2 at its corner, 0 in its middle (mirrored for a tail).
StepLine long_end(int length, bool tail, int tail_length);

// The areas between line and edge over pixel k, with |t| limited to 1. Each is at most 1/2, the
// largest weight of a neighbour.
struct CutAreas {
  double before = 0, after = 0;  // where t < 0, where t > 0
};
CutAreas cut_areas(const StepLine& line, int k);

}  // namespace deburr::golden::ideal
