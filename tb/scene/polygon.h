// SPDX-License-Identifier: MIT
// Polygons become triangles with the tessellator of GLU. Internal to tb/scene.
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

// Every corner turns the same way: none is on a line with its neighbours.
bool is_strictly_convex(const PolygonCorners& polygon);

// The tessellator's time grows with the square of corners, and with crossings times corners.
inline constexpr std::size_t kMaxPolygonCorners = 1 << 15;
inline constexpr std::size_t kMaxPolygonCrossings = 1 << 12;  // of more than 128 corners
// Why the tessellator would take too long; empty if it would not.
std::string too_complex(const PolygonCorners& polygon);

// A triangle.
using PolygonPart = std::array<const MeshBuilder::Corner*, 3>;

class PolygonSplitter {
 public:
  PolygonSplitter();
  ~PolygonSplitter();
  PolygonSplitter(const PolygonSplitter&) = delete;
  PolygonSplitter& operator=(const PolygonSplitter&) = delete;

  // Triangles that pass the polygon's direction, none if it has no area; valid until the next call
  // or a change of the polygon. A hole is a part of the outline that a bridge leads to and back
  // from. Whatever an outline that crosses itself winds around is filled; where it does, corners
  // are made. Throws bad_alloc.
  const std::vector<PolygonPart>& split(const PolygonCorners& polygon);
  // The last one did.
  bool crosses_itself() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace deburr::tb
