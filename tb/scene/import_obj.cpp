// SPDX-License-Identifier: MIT
#include <fmt/core.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>

#include "spec/error.h"
#include "tb/scene/import.h"
#include "tb/scene/mesh_builder.h"

namespace deburr::tb {
namespace {

namespace fs = std::filesystem;
using Imath::V2d;
using Imath::V3d;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string_view next_word(std::string_view& line) {
  std::size_t begin = 0;
  while (begin < line.size() && is_space(line[begin])) ++begin;
  std::size_t end = begin;
  while (end < line.size() && !is_space(line[end])) ++end;
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

// tinyobjloader reads "nan", "1e999" and "12x" as some number without a word, and does not check
// face indices. This pass over the text finds them first, with the line to look at, and the lines
// that name materials.
class ObjChecker {
 public:
  ObjChecker(const fs::path& path, std::string_view text) : path_(path) {
    while (!text.empty()) {
      ++line_;
      // tinyobjloader takes a carriage return for the end of a line, whatever comes behind it.
      const std::size_t end = text.find_first_of("\r\n");
      check_line(text.substr(0, end));
      if (end == std::string_view::npos) {
        no_final_newline_ = true;
        break;
      }
      text.remove_prefix(end + (text.substr(end).starts_with("\r\n") ? 2 : 1));
    }
    check_highest(highest_[0], count_[0], "vertex");
    check_highest(highest_[1], count_[1], "texture coordinate");
    check_highest(highest_[2], count_[2], "normal");
  }
  bool no_final_newline() const { return no_final_newline_; }
  bool has_lines() const { return lines_; }
  const std::string& material_lines() const { return material_lines_; }

 private:
  struct Highest {
    std::int64_t index = 0;
    std::uint64_t line = 0;
  };

  [[noreturn]] void fail(const std::string& reason) const {
    fail_mesh(path_, fmt::format("line {}: {}; the file is truncated or damaged, export it again",
                                 line_, reason));
  }

  void check_line(std::string_view line) {
    const std::string_view whole = line, keyword = next_word(line);
    if (keyword == "v") check_numbers(line, 0, 3, "vertex");
    if (keyword == "vt") check_numbers(line, 1, 1, "texture coordinate");
    if (keyword == "vn") check_numbers(line, 2, 3, "normal");
    if (keyword == "f") check_face(line);
    if (keyword == "l" || keyword == "p") lines_ = true;
    if (keyword == "mtllib") material_lines_.append(whole).append("\n");
  }

  void check_numbers(std::string_view line, std::size_t kind, int needed, const char* what) {
    int found = 0;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line), ++found) {
      if (word[0] == '#') break;
      if (word[0] == '+') word.remove_prefix(1);
      double value = 0.0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
        fail(fmt::format("'{}' in a {} is not a finite number", word, what));
      if (std::abs(value) > 1e30)
        fail(fmt::format("'{}' in a {} is beyond 1e30, the largest number that is taken", word,
                         what));
    }
    if (found < needed) fail(fmt::format("a {} has {} numbers instead of {}", what, found, needed));
    ++count_[kind];
  }

  void check_face(std::string_view line) {
    int corners = 0;
    for (std::string_view word = next_word(line); !word.empty();
         word = next_word(line), ++corners) {
      if (word[0] == '#') break;
      check_corner(word);
    }
    if (corners < 3) fail(fmt::format("a face has {} corners", corners));
  }

  // v, v/vt, v//vn or v/vt/vn, each counted from 1 or backwards from -1.
  void check_corner(std::string_view word) {
    std::string_view rest = word;
    for (std::size_t kind = 0; kind < 3; ++kind) {
      const std::size_t slash = rest.find('/');
      const std::string_view digits = rest.substr(0, slash);
      const bool may_be_empty = kind == 1 && slash != std::string_view::npos;
      if (!digits.empty()) {
        std::int64_t index = 0;
        const auto [end, error] =
            std::from_chars(digits.data(), digits.data() + digits.size(), index);
        if (error != std::errc() || end != digits.data() + digits.size() || index == 0)
          fail(fmt::format("'{}' is not a face corner", word));
        if (index < 0 && -index > count_[kind])
          fail(fmt::format("index {} in '{}' is out of range", index, word));
        if (index > highest_[kind].index) highest_[kind] = {index, line_};
      } else if (!may_be_empty) {
        fail(fmt::format("'{}' is not a face corner", word));
      }
      if (slash == std::string_view::npos) return;
      rest.remove_prefix(slash + 1);
    }
    fail(fmt::format("'{}' is not a face corner", word));
  }

  void check_highest(const Highest& highest, std::int64_t count, const char* what) {
    if (highest.index <= count) return;
    line_ = highest.line;
    fail(fmt::format("a face uses {} {}, but there are {}", what, highest.index, count));
  }

  const fs::path& path_;
  std::uint64_t line_ = 0;
  std::array<std::int64_t, 3> count_{};
  std::array<Highest, 3> highest_{};
  bool no_final_newline_ = false, lines_ = false;
  std::string material_lines_;
};

std::string one_line(const std::string& text) {
  std::string line;
  std::istringstream lines(text);
  for (std::string each; std::getline(lines, each);)
    if (!each.empty()) line += (line.empty() ? "" : "; ") + each;
  return line;
}

// A line of numbers that ends with a backslash goes on in the next one, which tinyobjloader does
// not know. Empty lines behind it keep the numbers of those that follow.
std::string with_whole_lines(const std::string& text) {
  if (text.find("\\\n") == std::string::npos && text.find("\\\r\n") == std::string::npos)
    return text;
  std::string whole, owed;
  bool numbers = false;  // it is such a line
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = std::string_view(text).substr(at, end - at);
    at = end + 1;
    if (owed.empty()) {
      std::string_view rest = line;
      const std::string_view keyword = next_word(rest);
      numbers = keyword == "v" || keyword == "vt" || keyword == "vn" || keyword == "f";
    }
    std::string_view bare = line;
    if (bare.ends_with('\r')) bare.remove_suffix(1);
    if (numbers && bare.ends_with('\\') && end < text.size()) {
      whole += bare.substr(0, bare.size() - 1);
      owed += '\n';
      continue;
    }
    whole += line;
    if (end < text.size()) whole += '\n';
    whole += std::exchange(owed, "");
  }
  return whole;
}

// tinyobjloader's numbers are flat arrays; -1 is "not given".
class Attributes {
 public:
  Attributes(const fs::path& path, const tinyobj::attrib_t& attributes)
      : path_(path), attributes_(attributes) {}

  MeshBuilder::Corner corner(const tinyobj::index_t& index) const {
    MeshBuilder::Corner corner;
    corner.position = three(attributes_.vertices, index.vertex_index);
    if (index.normal_index >= 0) corner.normal = three(attributes_.normals, index.normal_index);
    if (index.texcoord_index >= 0) {
      const std::size_t at = place(attributes_.texcoords, index.texcoord_index, 2);
      corner.uv = V2d(attributes_.texcoords[at], 1.0 - double{attributes_.texcoords[at + 1]});
    }
    return corner;
  }

 private:
  // The checker has seen to it, if it reads the file as tinyobjloader does.
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
  std::vector<tinyobj::material_t> materials;
  std::string warnings;
};

class ObjImporter final : public Importer {
 public:
  using Importer::Importer;

  // The lines that name materials, by themselves, make tinyobjloader ask for the same files in the
  // same order as all of them do.
  void open() override {
    text_ = with_whole_lines(read_mesh());
    checked_.emplace(path(), text_);
    materials_ = load(checked_->material_lines(), [this](const std::string& name) {
                   return material_texts_[name] = read_material_file(name);
                 }).materials;
    if (!options().textures) return;
    for (const tinyobj::material_t& material : materials_)
      if (!material.diffuse_texname.empty()) add_file(texture_path(material));
  }

  Mesh build() override {
    const TinyObj loaded = load(text_, [this](const std::string& name) {
      const auto found = material_texts_.find(name);
      DEBURR_CHECK(found != material_texts_.end(), "nobody has opened the materials " + name);
      return found->second;
    });
    MeshBuilder builder(path());
    add_notes(loaded, builder);
    for (const tinyobj::material_t& material : materials_) {
      Material ours;
      ours.name = material.name;
      ours.colour = {material.diffuse[0], material.diffuse[1], material.diffuse[2]};
      if (options().textures && !material.diffuse_texname.empty())
        ours.texture = builder.texture_from_file(texture_path(material));
      builder.add_material(ours);
    }
    add_triangles(loaded, builder);
    return builder.finish();
  }

 private:
  using MaterialText = std::function<std::optional<std::string>(const std::string& name)>;

  // Gives tinyobjloader materials from `text`, which says what stands in them.
  class Materials final : public tinyobj::MaterialReader {
   public:
    explicit Materials(const MaterialText& text) : text_(text) {}
    bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                    std::map<std::string, int>* indices, std::string* warnings,
                    std::string* errors) override {
      const std::optional<std::string> text = text_(name);
      if (!text) {
        *warnings += fmt::format("the materials '{}' are not there\n", name);
        return false;
      }
      std::istringstream stream(*text);
      tinyobj::LoadMtl(indices, materials, &stream, warnings, errors);
      return true;
    }

   private:
    const MaterialText& text_;
  };

  TinyObj load(const std::string& text, const MaterialText& material_text) const {
    TinyObj loaded;
    Materials materials(material_text);
    std::istringstream stream(text);
    std::string errors;
    if (!tinyobj::LoadObj(&loaded.attributes, &loaded.shapes, &loaded.materials, &loaded.warnings,
                          &errors, &stream, &materials, /*triangulate=*/true,
                          /*default_vcols_fallback=*/false))
      fail_mesh(path(), one_line(errors) + "; export it again");
    return loaded;
  }

  // A blank at the end of the line is an empty name.
  std::optional<std::string> read_material_file(const std::string& name) {
    return name.empty() ? std::nullopt : read_named(folder() / name);
  }

  fs::path texture_path(const tinyobj::material_t& material) const {
    std::string name = material.diffuse_texname;
    std::replace(name.begin(), name.end(), '\\', '/');
    return folder() / name;
  }

  void add_notes(const TinyObj& loaded, MeshBuilder& builder) const {
    if (!loaded.warnings.empty()) builder.note(one_line(loaded.warnings));
    if (checked_->no_final_newline())
      builder.note("the last line has no end; the file may have been truncated there");
    if (checked_->has_lines()) builder.note("points and lines were left out");
  }

  void add_triangles(const TinyObj& loaded, MeshBuilder& builder) const {
    // Faces before the first usemtl, or of a material that no .mtl describes.
    const auto plain = static_cast<std::uint32_t>(materials_.size());
    builder.add_material({"default", V3d(0.8, 0.8, 0.8), -1});
    const Attributes corners(path(), loaded.attributes);
    for (const tinyobj::shape_t& shape : loaded.shapes) {
      const tinyobj::mesh_t& mesh = shape.mesh;
      for (std::size_t face = 0; 3 * face + 2 < mesh.indices.size(); ++face) {
        const int material = face < mesh.material_ids.size() ? mesh.material_ids[face] : -1;
        builder.add_triangle(
            {corners.corner(mesh.indices[3 * face]), corners.corner(mesh.indices[3 * face + 1]),
             corners.corner(mesh.indices[3 * face + 2])},
            material < 0 ? plain : static_cast<std::uint32_t>(material));
      }
    }
  }

  std::string text_;
  std::optional<ObjChecker> checked_;
  std::vector<tinyobj::material_t> materials_;
  std::map<std::string, std::optional<std::string>> material_texts_;  // by the name in the mesh
};

}  // namespace

std::unique_ptr<Importer> obj_importer(const fs::path& path, const ImportOptions& options) {
  return std::make_unique<ObjImporter>(path, options);
}

}  // namespace deburr::tb
