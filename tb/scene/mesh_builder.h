// SPDX-License-Identifier: MIT
// The common part of OBJ and glTF import: collects triangles, fills in missing attributes, merges
// equal vertices, and rejects meshes that cannot be drawn. Internal to tb/scene.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include "tb/scene/mesh.h"

namespace deburr::tb {

// "cannot read the mesh 'file': reason"
[[noreturn]] void fail_mesh(const std::filesystem::path& path, const std::string& reason);

// Makes a file's text safe for terminals: no control characters, names of at most 64.
std::string printable(std::string text);
std::string shown_name(std::string_view name);

class MeshBuilder {
 public:
  explicit MeshBuilder(const std::filesystem::path& path);

  struct Corner {
    Imath::V3d position{0, 0, 0};
    std::optional<Imath::V3d> normal;
    std::optional<Imath::V2d> uv;
  };
  void add_triangle(const std::array<Corner, 3>& corners, std::uint32_t material);
  void note(const std::string& text) { mesh_.notes.push_back(printable(text)); }

  // Reads a texture file once per wrap mode, even if several materials use it. Throws FileError.
  int texture_from_file(const std::filesystem::path& file, spec::texture::Wrap wrap);
  int add_texture(Texture texture);
  void add_material(Material material) { mesh_.materials.push_back(std::move(material)); }

  Mesh finish();  // throws FileError if there are no triangles

 private:
  struct Hash {
    std::size_t operator()(const Vertex& vertex) const;
  };
  struct Equal {
    bool operator()(const Vertex& a, const Vertex& b) const;
  };
  std::uint32_t vertex_index(Vertex vertex);
  void project_boxes();
  void drop_unused();

  std::filesystem::path path_;
  Mesh mesh_;
  std::unordered_map<Vertex, std::uint32_t, Hash, Equal> indices_;
  std::map<std::pair<std::filesystem::path, spec::texture::Wrap>, int> texture_files_;
  std::vector<std::array<Corner, 3>>
      unmapped_;  // triangles without uv: projected once the size of the mesh is known
  std::vector<std::uint32_t> unmapped_triangle_;
  std::uint64_t without_normals_ = 0;
};

}  // namespace deburr::tb
