// SPDX-License-Identifier: MIT
// Procedural meshes for engines that draw edges: the four models of paper 002, a sphere and a
// terrain.
//
// Faces are counter-clockwise seen from outside and welded (equal positions are bit-identical).
// Vertex normals are smooth where faces meet at less than 40 degrees and split elsewhere. The
// caller chooses the material. Internal to tb/scene.
#pragma once

#include <cstdint>

#include "tb/scene/mesh.h"

namespace deburr::tb {

void add_cube(Mesh& mesh, std::uint32_t material);         // 12 faces, 18 edges
void add_wheel_cover(Mesh& mesh, std::uint32_t material);  // 480 faces, 720 edges
void add_wing(Mesh& mesh, std::uint32_t material);         // NACA 2412; 16 640 faces, 24 960 edges
void add_canopy(Mesh& mesh, std::uint32_t material);       // open below; 1472 faces, 2232 edges
void add_sphere(Mesh& mesh, std::uint32_t material);       // 16 128 faces, 24 192 edges
void add_terrain(Mesh& mesh, std::uint32_t material);      // open; 4608 faces, 7008 edges

}  // namespace deburr::tb
