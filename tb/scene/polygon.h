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

// Every corner turns the same way; collinear corners are not allowed.
bool is_strictly_convex(const PolygonCorners& polygon);

// The tessellator's time grows with the square of the corners, and with crossings times corners.
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

  // Triangles in the polygon's direction, none if its area is zero; valid until the next call or a
  // change of the polygon. A hole is part of the outline, entered and left by a bridge. Every
  // region that a self-crossing outline winds around is filled, with new corners at the crossings.
  // Throws bad_alloc.
  const std::vector<PolygonPart>& split(const PolygonCorners& polygon);
  // Whether the polygon of the last split() crosses itself.
  bool crosses_itself() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace deburr::tb
