// SPDX-License-Identifier: MIT
// Checks the text of an OBJ and its materials before tinyobjloader reads the OBJ. Internal to
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

// Detected by the byte order mark or the first character.
bool is_utf16(std::string_view text);
// Removes the UTF-8 byte order mark.
std::string without_byte_order_mark(std::string text);

// Joins continued lines and strips comments that tinyobjloader does not support: numbers ending
// with a backslash continue on the next line, and a face may end with a comment. In materials every
// statement may be continued, and a hash may be part of a name. Line numbers are kept.
enum class Statements { kObj, kMaterials };
std::string with_whole_lines(std::string text, Statements statements);

// Ignored statements, each with the line of its first use.
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

// tinyobjloader silently reads "nan", "1e999" and "12x" as numbers, does not check face indices,
// and drops unknown statements. This pass finds them first and reports the line. It also collects
// the lines that name materials.
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

// The properties used of a material. `scale` and `offset` are map_Kd's -s and -o.
struct ObjMaterial {
  std::string name;
  Imath::V3d colour{0, 0, 0};
  std::string map;  // empty: no texture
  Imath::V2d scale{1, 1}, offset{0, 0};
  bool clamp = false;
};
struct ObjMaterials {
  std::vector<ObjMaterial> materials;
  NotRead not_read;
};
ObjMaterials parse_materials(std::string_view text);

}  // namespace deburr::tb
