// SPDX-License-Identifier: MIT
// Triangulates polygons with the GLU tessellator. Internal to tb/scene.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "tb/scene/mesh_builder.h"

namespace deburr::tb {

using PolygonCorners = std::vector<MeshBuilder::Corner>;

// Twice the area of a polygon along each axis, positive where it is counter-clockwise (Newell).
Imath::V3d area_vector(const PolygonCorners& polygon);

// Whether every corner turns the same way; a collinear corner makes it false.
bool is_strictly_convex(const PolygonCorners& polygon);

// The tessellator's time grows with the square of the number of corners, and with the number of
// crossings times that of corners.
inline constexpr std::size_t kMaxPolygonCorners = 1 << 15;
inline constexpr std::size_t kMaxPolygonCrossings = 1
                                                    << 12;  // for polygons of more than 128 corners
// Reason why tessellation would take too long; empty if it would not.
std::string too_complex(const PolygonCorners& polygon);

// A triangle.
using PolygonPart = std::array<const MeshBuilder::Corner*, 3>;

class PolygonSplitter {
 public:
  PolygonSplitter();
  ~PolygonSplitter();
  PolygonSplitter(const PolygonSplitter&) = delete;
  PolygonSplitter& operator=(const PolygonSplitter&) = delete;

  // Returns triangles in the direction of the polygon, or none if its area is zero. They are valid
  // until the next call or until the polygon changes. A hole is part of the outline, which enters
  // and leaves it by a bridge. If the outline crosses itself, every region around which it winds is
  // filled, with new corners at the crossings. Throws bad_alloc.
  const std::vector<PolygonPart>& split(const PolygonCorners& polygon);
  // Whether the polygon of the last split() crosses itself.
  bool crosses_itself() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace deburr::tb
