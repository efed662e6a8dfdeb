// SPDX-License-Identifier: MIT
// Triangle meshes with materials and textures, and their import from OBJ (tinyobjloader) and
// glTF/GLB (tinygltf). Right-handed, y up. (s, t) = (0, 0) is the top left corner of the texture's
// top left texel.
#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "spec/texture/descriptor.h"
#include "tb/scene/image.h"

namespace deburr::tb {

struct Texture {
  std::string name = {};
  Image image = {};  // level 0; mip_chain() makes the rest
  spec::texture::Wrap wrap_s = spec::texture::Wrap::kRepeat, wrap_t = spec::texture::Wrap::kRepeat;
};

struct Material {
  std::string name = {};
  Imath::V3d colour{1, 1, 1};  // linear light, multiplies the texture in lit frames
  int texture = -1;            // index into Mesh::textures, -1: plain colour
};

struct Vertex {
  Imath::V3d position{0, 0, 0};
  Imath::V3d normal{0, 0, 0};  // unit length
  Imath::V2d uv{0, 0};         // (s, t)
};

struct Triangle {
  std::array<std::uint32_t, 3> vertex{};  // counter-clockwise seen from outside
  std::uint32_t material = 0;
};

struct Mesh {
  std::string name;
  std::vector<Vertex> vertices;
  std::vector<Triangle> triangles;
  std::vector<Material> materials;  // at least one
  std::vector<Texture> textures;
  std::vector<std::string> notes;  // what import had to decide: missing uv, missing normals, ...
  std::vector<std::filesystem::path> files;  // mesh_files(), and textures from elsewhere
};

struct Bounds {
  Imath::V3d low, high;
  Imath::V3d centre() const { return (low + high) * 0.5; }
  double radius() const { return (high - low).length() * 0.5; }
};
Bounds bounds(const Mesh& mesh);
// By its extension, in small letters or capitals.
bool is_mesh_file(const std::filesystem::path& path);

// Limits of an import, checked before memory is spent on it.
inline constexpr std::uint64_t kMaxMeshFileBytes = std::uint64_t{1} << 30;
inline constexpr std::uint64_t kMaxTriangles = 4'000'000;

// Reads .obj (with its .mtl and textures), .gltf or .glb (all nodes of the default scene with their
// transforms; embedded and external textures). Polygons become triangles, also concave ones; what
// is left out is noted. Where a triangle has no texture coordinates it gets a box projection: (s,
// t) are the two coordinates across the largest component of its face normal, one repeat to a
// quarter of the mesh's longest side. Where it has no normals it gets its face normal. OBJ's v axis
// is flipped to t = 1 - v. Throws FileError that names the file and what to do: missing, empty,
// truncated, malformed, a number that is not finite, an index out of range, no triangles, too
// large, texture missing or unreadable.
struct ImportOptions {
  bool textures = true;  // false: leave the file's textures unread (someone else's replaces them)
};
Mesh import_mesh(const std::filesystem::path& path, const ImportOptions& options = {});

// Every file that import_mesh() opens: the mesh, then all that it names (materials, textures,
// buffers), each once. A name that no file has is listed too: when there is one, the mesh is
// another one. It is the first half of import_mesh() itself that finds them, so that they are the
// same; where that fails, what it had come to.
std::vector<std::filesystem::path> mesh_files(const std::filesystem::path& path,
                                              const ImportOptions& options = {});

// The same, found once for each mesh.
class MeshFiles {
 public:
  const std::vector<std::filesystem::path>& of(const std::filesystem::path& path,
                                               const ImportOptions& options);

 private:
  std::map<std::pair<std::filesystem::path, bool>, std::vector<std::filesystem::path>> known_;
};

// Appends a file unless it is there. "./a" is "a", but "b/../a" may be another one.
void add_once(std::vector<std::filesystem::path>& files, const std::filesystem::path& file);

// Makes every material textured, for an engine that only knows textures. If none is and there is a
// `fallback`, all get that. Else the colours of the plain ones become cells of one palette texture,
// and their triangles' coordinates the centre of the cell, which gives exactly that colour.
void texture_everything(Mesh& mesh, const Texture* fallback);

}  // namespace deburr::tb
