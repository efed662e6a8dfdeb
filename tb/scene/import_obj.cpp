// SPDX-License-Identifier: MIT
#include <fmt/core.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "spec/error.h"
#include "tb/scene/import.h"
#include "tb/scene/mesh_builder.h"
#include "tb/scene/obj_text.h"
#include "tb/scene/polygon.h"

namespace deburr::tb {
namespace {

namespace fs = std::filesystem;
using Imath::V2d;
using Imath::V3d;
using spec::texture::Wrap;

// Removes duplicate lines.
std::string one_line(const std::string& text) {
  std::string line;
  std::set<std::string> seen{""};
  std::istringstream lines(text);
  for (std::string each; std::getline(lines, each);)
    if (seen.insert(each).second) line += (line.empty() ? "" : "; ") + each;
  return line;
}

// tinyobjloader stores numbers in flat arrays; an index of -1 means "not given".
class Attributes {
 public:
  Attributes(const fs::path& path, const tinyobj::attrib_t& attributes)
      : path_(path), attributes_(attributes) {}

  MeshBuilder::Corner corner(const tinyobj::index_t& index, const ObjMaterial& material) const {
    MeshBuilder::Corner corner;
    corner.position = three(attributes_.vertices, index.vertex_index);
    if (index.normal_index >= 0) corner.normal = three(attributes_.normals, index.normal_index);
    if (index.texcoord_index >= 0) {
      const std::size_t at = place(attributes_.texcoords, index.texcoord_index, 2);
      const V2d mapped =
          V2d(attributes_.texcoords[at], attributes_.texcoords[at + 1]) * material.scale +
          material.offset;
      corner.uv = V2d(mapped.x, 1.0 - mapped.y);
    }
    return corner;
  }

 private:
  // ObjChecker guarantees this, provided that it parses the file as tinyobjloader does.
  std::size_t place(const std::vector<tinyobj::real_t>& values, int index, std::size_t each) const {
    const std::size_t at = each * static_cast<std::size_t>(index);
    if (index < 0 || at + each > values.size())
      fail_mesh(path_, fmt::format("a face uses number {} of {} vertices, texture coordinates or "
                                   "normals; the file is damaged, export it again",
                                   std::int64_t{index} + 1, values.size() / each));
    return at;
  }
  V3d three(const std::vector<tinyobj::real_t>& values, int index) const {
    const std::size_t at = place(values, index, 3);
    return {values[at], values[at + 1], values[at + 2]};
  }
  const fs::path& path_;
  const tinyobj::attrib_t& attributes_;
};

struct TinyObj {
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::string warnings;
};

// Splits faces into triangles and notes malformed faces.
class FaceAdder {
 public:
  FaceAdder(const fs::path& path, MeshBuilder& builder) : path_(path), builder_(builder) {}

  void add(const PolygonCorners& face, std::uint32_t line, std::uint32_t material) {
    const auto triangle = [&](const Corner& a, const Corner& b, const Corner& c) {
      builder_.add_triangle({a, b, c}, material);
      any_ = true;
    };
    if (face.size() == 3) {
      triangle(face[0], face[1], face[2]);
      if (!(area_vector(face).length2() > 0.0)) without_area_.add(line);
    } else if (face.size() == 4 && is_strictly_convex(face)) {
      // Splits along the shorter diagonal, computed in single precision as tinyobjloader does.
      if (squared_distance(face[0], face[2]) < squared_distance(face[1], face[3])) {
        triangle(face[0], face[1], face[2]);
        triangle(face[0], face[2], face[3]);
      } else {
        triangle(face[0], face[1], face[3]);
        triangle(face[1], face[2], face[3]);
      }
    } else {
      if (const std::string reason = too_complex(face); !reason.empty())
        fail_mesh(path_, fmt::format("line {}: a face {}", line, reason));
      const auto& triangles = splitter_.split(face);
      for (const auto& [a, b, c] : triangles) triangle(*a, *b, *c);
      if (triangles.empty())
        without_area_.add(line);
      else if (splitter_.crosses_itself())
        crossing_.add(line);
    }
  }

  void finish() const {
    if (!any_ && without_area_.count > 0)
      fail_mesh(path_,
                fmt::format("line {}: this face and all others have zero area; repair the vertices",
                            without_area_.first));
    without_area_.note(builder_, "faces of zero area are invisible");
    crossing_.note(builder_, "self-intersecting faces were filled");
  }

 private:
  using Corner = MeshBuilder::Corner;
  struct Faces {
    std::uint64_t count = 0;
    std::uint32_t first = 0;  // line number
    void add(std::uint32_t line) {
      if (count++ == 0) first = line;
    }
    void note(MeshBuilder& builder, std::string_view what) const {
      if (count > 0) builder.note(fmt::format("{}: {}, the first in line {}", what, count, first));
    }
  };

  static float squared_distance(const Corner& a, const Corner& b) {
    return Imath::V3f(Imath::V3f(b.position) - Imath::V3f(a.position)).length2();
  }

  const fs::path& path_;
  MeshBuilder& builder_;
  PolygonSplitter splitter_;
  Faces without_area_, crossing_;
  bool any_ = false;  // at least one triangle was added
};

class ObjImporter final : public Importer {
 public:
  using Importer::Importer;

  // Passes only the lines that name materials to tinyobjloader. It then requests the same files, in
  // the same order, as for the whole file.
  void open() override {
    text_ = with_whole_lines(plain_text(read_mesh(), path().string()), Statements::kObj);
    checked_.emplace(path(), text_);
    load(checked_->material_lines(), [this](const std::string& name) {
      const ObjMaterials* const read = read_material_file(name);
      if (read != nullptr)
        materials_.insert(materials_.end(), read->materials.begin(), read->materials.end());
      return read;
    });
    if (!options().textures) return;
    for (const ObjMaterial& material : materials_)
      if (!material.map.empty()) add_file(texture_path(material));
  }

  Mesh build() override {
    const TinyObj loaded = load(text_, [this](const std::string& name) {
      const auto found = material_files_.find(name);
      DEBURR_CHECK(found != material_files_.end(), "material file was not opened: " + name);
      return found->second ? &*found->second : nullptr;
    });
    MeshBuilder builder(path());
    add_notes(loaded, builder);
    for (const ObjMaterial& material : materials_) {
      Material ours;
      ours.name = material.name;
      ours.colour = material.colour;
      if (options().textures && !material.map.empty())
        ours.texture = builder.texture_from_file(
            texture_path(material), material.clamp ? Wrap::kClampToEdge : Wrap::kRepeat);
      builder.add_material(ours);
    }
    add_faces(loaded, builder);
    return builder.finish();
  }

 private:
  using MaterialFile = std::function<const ObjMaterials*(const std::string& name)>;

  // Gives tinyobjloader the material indices of `file`. The properties of materials come from our
  // own parser.
  class Materials final : public tinyobj::MaterialReader {
   public:
    explicit Materials(const MaterialFile& file) : file_(file) {}
    bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                    std::map<std::string, int>* indices, std::string* warnings,
                    std::string* /*errors*/) override {
      const ObjMaterials* const file = file_(name);
      if (file == nullptr) {
        *warnings += fmt::format("the material file '{}' is missing\n", shown_name(name));
        return false;
      }
      for (const ObjMaterial& material : file->materials) {
        indices->try_emplace(material.name, static_cast<int>(materials->size()));
        materials->emplace_back();
      }
      return true;
    }

   private:
    const MaterialFile& file_;
  };

  TinyObj load(const std::string& text, const MaterialFile& material_file) const {
    TinyObj loaded;
    Materials reader(material_file);
    std::istringstream stream(text);
    std::string errors;
    std::vector<tinyobj::material_t> materials;
    if (!tinyobj::LoadObj(&loaded.attributes, &loaded.shapes, &materials, &loaded.warnings, &errors,
                          &stream, &reader, /*triangulate=*/false,
                          /*default_vcols_fallback=*/false))
      fail_mesh(path(), one_line(errors) + "; export it again");
    return loaded;
  }

  std::string plain_text(std::string text, const std::string& file) const {
    if (is_utf16(text))
      fail_mesh(path(), fmt::format("'{}' is written in UTF-16; save it as UTF-8", file));
    return without_byte_order_mark(std::move(text));
  }

  // A trailing blank means an empty name.
  const ObjMaterials* read_material_file(const std::string& name) {
    std::optional<ObjMaterials>& file = material_files_[name];
    if (std::optional<std::string> text = name.empty() ? std::nullopt : read_named(folder() / name))
      file = parse_materials(
          with_whole_lines(plain_text(std::move(*text), name), Statements::kMaterials));
    return file ? &*file : nullptr;
  }

  fs::path texture_path(const ObjMaterial& material) const {
    std::string name = material.map;
    std::replace(name.begin(), name.end(), '\\', '/');
    return folder() / name;
  }

  void add_notes(const TinyObj& loaded, MeshBuilder& builder) const {
    if (!loaded.warnings.empty()) builder.note(one_line(loaded.warnings));
    if (checked_->no_final_newline())
      builder.note("the last line is not terminated; the file may be truncated");
    if (checked_->has_lines()) builder.note("points and lines were left out");
    if (checked_->has_colours()) builder.note("vertex colours were left out");
    if (const std::string text = checked_->not_read().text(); !text.empty())
      builder.note("statements were left out: " + text);
    for (const auto& [name, file] : material_files_)
      if (const std::string text = file ? file->not_read.text() : ""; !text.empty())
        builder.note(fmt::format("'{}': left out: {}", shown_name(name), text));
  }

  void add_faces(const TinyObj& loaded, MeshBuilder& builder) const {
    // Used for faces before the first usemtl and for materials that no .mtl describes.
    const auto plain = static_cast<std::uint32_t>(materials_.size());
    builder.add_material({"default", V3d(0.8, 0.8, 0.8), -1});
    const ObjMaterial none;
    const Attributes attributes(path(), loaded.attributes);
    FaceAdder adder(path(), builder);
    // tinyobjloader keeps the order of faces, but only the low eight bits of their corner count.
    auto next = checked_->faces().begin();
    PolygonCorners corners;
    for (const tinyobj::shape_t& shape : loaded.shapes) {
      auto index = shape.mesh.indices.begin();
      for (std::size_t face = 0; face < shape.mesh.num_face_vertices.size(); ++face, ++next) {
        if (next == checked_->faces().end() || shape.mesh.indices.end() - index < next->corners)
          fail_mesh(path(), "its faces cannot be told apart; the file is damaged, export it again");
        const int material = shape.mesh.material_ids[face];
        const bool known = material >= 0;
        corners.clear();
        for (std::uint32_t k = 0; k < next->corners; ++k, ++index)
          corners.push_back(attributes.corner(
              *index, known ? materials_[static_cast<std::size_t>(material)] : none));
        adder.add(corners, next->line, known ? static_cast<std::uint32_t>(material) : plain);
      }
    }
    adder.finish();
  }

  std::string text_;
  std::optional<ObjChecker> checked_;
  std::vector<ObjMaterial> materials_;  // all files, in the order in which they are named
  std::map<std::string, std::optional<ObjMaterials>>
      material_files_;  // by the name used in the mesh
};

}  // namespace

std::unique_ptr<Importer> obj_importer(const fs::path& path, const ImportOptions& options) {
  return std::make_unique<ObjImporter>(path, options);
}

}  // namespace deburr::tb
