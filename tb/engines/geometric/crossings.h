// SPDX-License-Identifier: MIT
// Where the faces of a mesh pass through each other: no edge of it, and an edge in every picture.
//
// Before the engine: docs/reference/geometric/index.md. Double precision, without
// contraction; once a mesh. A tree of boxes finds pairs of faces that may cross: O(n log n) on
// meshes whose faces mostly do not.
#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace deburr::tb {

// A face of three places; equal numbers are one place.
struct CrossingFace {
  std::array<std::uint32_t, 3> place{};
  std::uint32_t face = 0;  // its number in the mesh
};

// A segment that two faces share.
struct Crossing {
  std::array<Imath::V3d, 2> ends;
  std::uint32_t f0 = 0, f1 = 0;  // f0 < f1
};

struct Crossings {
  std::vector<Crossing> segments;  // by f0, then f1
  std::uint64_t tested = 0;        // pairs of faces whose boxes meet
};

// Of faces without a common place, finite and with an area. Ends are the same to the bit where
// segments follow each other across an edge of the mesh.
Crossings find_crossings(std::span<const Imath::V3d> places, std::span<const CrossingFace> faces);

}  // namespace deburr::tb
