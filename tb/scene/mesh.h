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
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "spec/texture/descriptor.h"
#include "tb/scene/compressed_file.h"
#include "tb/scene/image.h"

namespace deburr::tb {

struct Texture {
  std::string name = {};
  Image image = {};  // level 0; mip_chain() makes the other levels
  spec::texture::Wrap wrap_s = spec::texture::Wrap::kRepeat, wrap_t = spec::texture::Wrap::kRepeat;
  std::shared_ptr<const CompressedTexture> compressed = nullptr;  // if read from a file of blocks
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
  std::vector<std::string> notes;  // decisions of the import: missing uv, missing normals, ...
  std::vector<std::filesystem::path> files;  // mesh_files(), and textures from other sources
};

struct Bounds {
  Imath::V3d low, high;
  Imath::V3d centre() const { return (low + high) * 0.5; }
  double radius() const { return (high - low).length() * 0.5; }
};
Bounds bounds(const Mesh& mesh);
// Decides by the file extension, ignoring case.
bool is_mesh_file(const std::filesystem::path& path);

// Import limits, checked before memory is allocated.
inline constexpr std::uint64_t kMaxMeshFileBytes = std::uint64_t{1} << 30;
inline constexpr std::uint64_t kMaxTriangles = 4'000'000;

// Reads .obj (with its .mtl and textures), .gltf or .glb (all nodes of the default scene with their
// transforms; embedded and external textures). Polygons, including concave ones, become triangles.
// Omitted content is noted. Triangles without texture coordinates get a box projection: (s, t) are
// the two coordinates perpendicular to the largest component of the face normal, one repeat per
// quarter of the mesh's longest side. Triangles without normals get the face normal. OBJ's v axis
// is flipped to t = 1 - v. Throws FileError that names the file and what to do: missing, empty,
// truncated, malformed, a number that is not finite, an index out of range, no triangles, too
// large, texture missing or unreadable.
struct ImportOptions {
  bool textures = true;  // false: do not read the file's textures, because they will be replaced
};
Mesh import_mesh(const std::filesystem::path& path, const ImportOptions& options = {});

// Every file that import_mesh() opens: the mesh, then all files that it names (materials, textures,
// buffers), each once. Missing files are listed too, since the mesh changes if one is created. It
// runs the first step of import_mesh(); if this step fails, it returns the files found so far.
std::vector<std::filesystem::path> mesh_files(const std::filesystem::path& path,
                                              const ImportOptions& options = {});

// mesh_files() with a cache per mesh.
class MeshFiles {
 public:
  const std::vector<std::filesystem::path>& of(const std::filesystem::path& path,
                                               const ImportOptions& options);

 private:
  std::map<std::pair<std::filesystem::path, bool>, std::vector<std::filesystem::path>> known_;
};

// Appends a file unless it is already listed. "./a" counts as "a"; "b/../a" does not, since it may
// be a different file.
void add_once(std::vector<std::filesystem::path>& files, const std::filesystem::path& file);

// Gives every material a texture, for engines that only support textured materials. If no material
// has a texture and there is a `fallback`, all materials get the fallback. Otherwise the plain
// colours become cells of one palette texture. Texture coordinates are then at the centres of the
// cells, so the colours do not change.
void texture_everything(Mesh& mesh, const Texture* fallback);

}  // namespace deburr::tb
