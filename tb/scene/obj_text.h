// SPDX-License-Identifier: MIT
// The texts of an OBJ and of its materials, before tinyobjloader reads the OBJ. Internal to
// tb/scene.
#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace deburr::tb {

// By its byte order mark, or by its first character.
bool is_utf16(std::string_view text);
// Without that of UTF-8.
std::string without_byte_order_mark(std::string text);

// A line of numbers that ends with a backslash goes on in the next one, and one of a face may end
// with a comment: tinyobjloader knows neither. Of materials every statement may go on, and a hash
// may be part of a name. Lines keep their numbers.
enum class Statements { kObj, kMaterials };
std::string with_whole_lines(std::string text, Statements statements);

// What a file has and nobody reads, each with the line that it is first in.
class NotRead {
 public:
  void add(std::string_view what, std::uint64_t line);
  // "a (line 3), b (line 5, 2 in all)"
  std::string text() const;

 private:
  struct Entry {
    std::string what;
    std::uint64_t line = 0, count = 0;
  };
  static constexpr std::size_t kMost = 12;
  std::vector<Entry> entries_;
  std::uint64_t more_ = 0;
};

// tinyobjloader reads "nan", "1e999" and "12x" as some number without a word, does not check face
// indices, and drops what it does not know. This pass over the text finds them first, with the line
// to look at, and the lines that name materials.
class ObjChecker {
 public:
  struct Face {
    std::uint32_t line = 0, corners = 0;
  };

  ObjChecker(const std::filesystem::path& path, std::string_view text);
  bool no_final_newline() const { return no_final_newline_; }
  bool has_lines() const { return lines_; }
  bool has_colours() const { return colours_; }
  const NotRead& not_read() const { return not_read_; }
  const std::vector<Face>& faces() const { return faces_; }
  const std::string& material_lines() const { return material_lines_; }

 private:
  struct Highest {
    std::int64_t index = 0;
    std::uint64_t line = 0;
  };

  [[noreturn]] void fail(const std::string& reason) const;
  void check_line(std::string_view line);
  int check_numbers(std::string_view line, std::size_t kind, int needed, const char* what);
  void check_face(std::string_view line);
  void check_corner(std::string_view word);
  void check_highest(const Highest& highest, std::int64_t count, const char* what);

  const std::filesystem::path& path_;
  std::uint64_t line_ = 0;
  std::array<std::int64_t, 3> count_{};
  std::array<Highest, 3> highest_{};
  bool no_final_newline_ = false, lines_ = false, colours_ = false;
  std::vector<Face> faces_;
  NotRead not_read_;
  std::string material_lines_;
};

// What a material says that is used. `scale` and `offset` are map_Kd's -s and -o.
struct ObjMaterial {
  std::string name;
  Imath::V3d colour{0, 0, 0};
  std::string map;  // empty: none
  Imath::V2d scale{1, 1}, offset{0, 0};
  bool clamp = false;
};
struct ObjMaterials {
  std::vector<ObjMaterial> materials;
  NotRead not_read;
};
ObjMaterials parse_materials(std::string_view text);

}  // namespace deburr::tb
