// SPDX-License-Identifier: MIT
#include "tb/scene/obj_text.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "tb/scene/mesh_builder.h"

namespace deburr::tb {

namespace fs = std::filesystem;
using Imath::V2d;
using Imath::V3d;

namespace {

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

// tinyobjloader ends a line at a carriage return, whatever follows it. `text` is empty after the
// last line; `ended` tells whether the line has a line ending.
std::string_view next_line(std::string_view& text, bool& ended) {
  const std::size_t end = text.find_first_of("\r\n");
  const std::string_view line = text.substr(0, end);
  ended = end != std::string_view::npos;
  text.remove_prefix(ended ? end + (text.substr(end).starts_with("\r\n") ? 2 : 1) : text.size());
  return line;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

bool is_number(std::string_view word, double& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double read = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), read);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(read))
    return false;
  value = read;
  return true;
}

template <std::size_t N>
bool is_one_of(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// A keyword as shown in a note, without unprintable bytes, since an unknown keyword can contain any
// bytes.
std::string shown(std::string_view keyword) {
  const bool is_word =
      keyword.size() <= 16 &&
      std::all_of(keyword.begin(), keyword.end(), [](char c) { return c > ' ' && c <= '~'; });
  return is_word ? fmt::format("'{}'", keyword) : "an unreadable keyword";
}

constexpr std::array<std::string_view, 20> kObjStatements = {
    "v",        "vt",       "vn",         "f",         "l",      "p",      "g",
    "o",        "s",        "mg",         "lod",       "usemtl", "mtllib", "bevel",
    "c_interp", "d_interp", "shadow_obj", "trace_obj", "ctech",  "stech"};

// Lights and reflections are ignored: the scenes have their own.
constexpr std::array<std::string_view, 18> kMaterialStatements = {
    "Ka",      "Ks", "Ns", "Ni", "Tf", "Kt",  "Km",    "illum",  "sharpness",
    "map_aat", "Pr", "Pm", "Ps", "Pc", "Pcr", "aniso", "anisor", "newmtl"};

}  // namespace

bool is_utf16(std::string_view text) {
  return text.starts_with("\xFE\xFF") || text.starts_with("\xFF\xFE") ||
         (text.size() >= 2 && (text[0] == '\0') != (text[1] == '\0'));
}

std::string without_byte_order_mark(std::string text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  return text;
}

std::string with_whole_lines(std::string text, Statements statements) {
  if (text.find("\\\n") == std::string::npos && text.find("\\\r\n") == std::string::npos &&
      text.find(" #") == std::string::npos && text.find("\t#") == std::string::npos)
    return text;
  std::string whole, owed;
  bool goes_on = false;  // this line may be continued
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = std::string_view(text).substr(at, end - at);
    at = end + 1;
    if (owed.empty()) {
      std::string_view rest = line;
      const std::string_view keyword = next_word(rest);
      goes_on = statements == Statements::kMaterials
                    ? !keyword.starts_with('#')
                    : keyword == "v" || keyword == "vt" || keyword == "vn" || keyword == "f";
    }
    std::string_view bare = line;
    if (bare.ends_with('\r')) bare.remove_suffix(1);
    if (goes_on && statements == Statements::kObj && bare.find('\r') == std::string_view::npos)
      bare = bare.substr(0, bare.find('#'));
    if (goes_on && bare.ends_with('\\') && end < text.size()) {
      whole += bare.substr(0, bare.size() - 1);
      owed += '\n';
      continue;
    }
    whole += goes_on ? bare : line;
    if (end < text.size()) whole += '\n';
    whole += std::exchange(owed, "");
  }
  return whole;
}

void NotRead::add(std::string_view what, std::uint64_t line) {
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& entry) { return entry.what == what; });
  if (found != entries_.end()) {
    ++found->count;
  } else if (entries_.size() < kMost) {
    entries_.push_back({std::string(what), line, 1});
  } else {
    ++more_;
  }
}

std::string NotRead::text() const {
  std::string text;
  for (const Entry& entry : entries_) {
    text += fmt::format("{}{} (line {}", text.empty() ? "" : ", ", entry.what, entry.line);
    text += entry.count > 1 ? fmt::format(", {} in all)", entry.count) : ")";
  }
  if (more_ > 0) text += fmt::format(" and {} more lines", more_);
  return text;
}

// ---- OBJ ----------------------------------------------------------------------------------------

ObjChecker::ObjChecker(const fs::path& path, std::string_view text) : path_(path) {
  while (!text.empty()) {
    ++line_;
    bool ended = false;
    check_line(next_line(text, ended));
    if (!ended) no_final_newline_ = true;
  }
  check_highest(highest_[0], count_[0], "vertex");
  check_highest(highest_[1], count_[1], "texture coordinate");
  check_highest(highest_[2], count_[2], "normal");
}

void ObjChecker::fail(const std::string& reason) const {
  fail_mesh(path_, fmt::format("line {}: {}; the file is truncated or damaged, export it again",
                               line_, reason));
}

void ObjChecker::check_line(std::string_view line) {
  const std::string_view whole = line, keyword = next_word(line);
  if (keyword == "v" && check_numbers(line, 0, 3, "vertex") >= 6) colours_ = true;
  if (keyword == "vt") check_numbers(line, 1, 1, "texture coordinate");
  if (keyword == "vn") check_numbers(line, 2, 3, "normal");
  if (keyword == "f") check_face(line);
  if (keyword == "l" || keyword == "p") lines_ = true;
  if (keyword == "mtllib") material_lines_.append(whole).append("\n");
  if (!keyword.empty() && keyword[0] != '#' && !is_one_of(kObjStatements, keyword))
    not_read_.add(shown(keyword), line_);
}

// Returns the number of values found.
int ObjChecker::check_numbers(std::string_view line, std::size_t kind, int needed,
                              const char* what) {
  int found = 0;
  for (std::string_view word = next_word(line); !word.empty(); word = next_word(line), ++found) {
    if (word[0] == '#') break;
    double value = 0.0;
    if (!is_number(word, value))
      fail(fmt::format("'{}' in a {} is not a finite number", word, what));
    if (std::abs(value) > 1e30)
      fail(fmt::format("'{}' in a {} is beyond 1e30, the limit", word, what));
  }
  if (found < needed) fail(fmt::format("a {} has {} numbers instead of {}", what, found, needed));
  ++count_[kind];
  return found;
}

void ObjChecker::check_face(std::string_view line) {
  std::uint32_t corners = 0;
  for (std::string_view word = next_word(line); !word.empty(); word = next_word(line), ++corners) {
    if (word[0] == '#') break;
    check_corner(word);
  }
  if (corners < 3) fail(fmt::format("a face has {} corners", corners));
  faces_.push_back({static_cast<std::uint32_t>(line_), corners});
}

// v, v/vt, v//vn or v/vt/vn, each counted from 1 or backwards from -1.
void ObjChecker::check_corner(std::string_view word) {
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

void ObjChecker::check_highest(const Highest& highest, std::int64_t count, const char* what) {
  if (highest.index <= count) return;
  line_ = highest.line;
  fail(fmt::format("a face uses {} {}, but there are {}", what, highest.index, count));
}

// ---- materials ----------------------------------------------------------------------------------

namespace {

// The same grey as for faces without a material.
constexpr double kGrey = 0.8;

// Takes a number from the line; on failure the line is unchanged.
bool take_number(std::string_view& line, double& value) {
  std::string_view rest = line;
  if (!is_number(next_word(rest), value)) return false;
  line = rest;
  return true;
}

class MaterialParser {
 public:
  explicit MaterialParser(std::string_view text) {
    bool ended = true;
    while (!text.empty()) {
      ++line_;
      statement(next_line(text, ended));
    }
    finish();
  }
  ObjMaterials result() { return std::move(result_); }

 private:
  void statement(std::string_view line) {
    const std::string_view keyword = next_word(line);
    if (keyword.empty() || keyword[0] == '#') return;
    if (keyword == "newmtl") {
      finish();
      material_.name = trimmed(line);
      first_line_ = line_;
      return;
    }
    double value = 0.0;
    if (keyword == "Kd") {
      has_colour_ = true;
      material_.colour = colour(line);
    } else if (keyword == "map_Kd") {
      map(line);
    } else if (keyword == "d") {
      if (trimmed(line).starts_with("-halo")) next_word(line);
      if (take_number(line, value) && value < 1.0) not_read("'d' below 1");
    } else if (keyword == "Tr") {
      if (take_number(line, value) && value > 0.0) not_read("'Tr' above 0");
    } else if (keyword == "Ke") {
      while (take_number(line, value))
        if (value != 0.0) return not_read("'Ke'");
    } else if (!is_one_of(kMaterialStatements, keyword)) {
      not_read(shown(keyword));
    }
  }

  void not_read(std::string_view what) { result_.not_read.add(what, line_); }

  void finish() {
    if (!has_colour_) {
      const bool mapped = !material_.map.empty();
      material_.colour = mapped ? V3d(0.6, 0.6, 0.6) : V3d(kGrey, kGrey, kGrey);
      if (!mapped && !material_.name.empty())
        result_.not_read.add("a material without 'Kd' and 'map_Kd', grey instead", first_line_);
    }
    if (!material_.name.empty()) result_.materials.push_back(std::move(material_));
    material_ = {};
    has_colour_ = false;
  }

  V3d colour(std::string_view line) {
    const std::string_view first = trimmed(line);
    for (const std::string_view other : {"spectral", "xyz"}) {
      if (!first.starts_with(other)) continue;
      not_read(fmt::format("'Kd {}', grey instead", other));
      return V3d(kGrey, kGrey, kGrey);
    }
    V3d values(0, 0, 0);
    int found = 0;
    while (found < 3 && take_number(line, values[found])) ++found;
    if (const std::string_view rest = trimmed(line); found < 3 && !rest.empty() && rest[0] != '#') {
      not_read("'Kd' that is not a number, grey instead");
      return V3d(kGrey, kGrey, kGrey);
    }
    if (found == 1) return V3d(values.x, values.x, values.x);
    if (found == 2) not_read("'Kd' of two numbers, blue is 0");
    if (found > 0) return values;
    not_read("'Kd' without a number, grey instead");
    return V3d(kGrey, kGrey, kGrey);
  }

  void map(std::string_view line) {
    material_.scale = V2d(1, 1);
    material_.offset = V2d(0, 0);
    material_.clamp = false;
    std::string_view rest = line;
    for (std::string_view word = next_word(rest); option(word, rest); word = next_word(rest))
      line = rest;
    material_.map = trimmed(line);
    if (material_.map.empty()) not_read("'map_Kd' without a file");
  }

  // Takes the values of an option of map_Kd. Returns false if `name` is the file name instead of an
  // option.
  bool option(std::string_view name, std::string_view& line) {
    double value = 0.0;
    const auto is_on = [&] {
      std::string_view rest = line;
      const std::string_view word = next_word(rest);
      if (word == "on" || word == "off") line = rest;
      return word != "off";
    };
    if (name == "-s" || name == "-o") {
      V2d& pair = name == "-s" ? material_.scale : material_.offset;
      if (take_number(line, pair.x) && take_number(line, pair.y)) take_number(line, value);
    } else if (name == "-clamp") {
      material_.clamp = is_on();
    } else if (name == "-blendu" || name == "-blendv" || name == "-cc") {
      if (is_on() != (name != "-cc")) not_read(fmt::format("'map_Kd {}'", name));
    } else if (name == "-mm" || name == "-t") {
      const std::array<double, 3> usual{0.0, name == "-mm" ? 1.0 : 0.0, 0.0};
      bool changes = false;
      for (std::size_t k = 0; k < (name == "-mm" ? 2u : 3u) && take_number(line, value); ++k)
        changes = changes || value != usual[k];
      if (changes) not_read(fmt::format("'map_Kd {}'", name));
    } else if (is_one_of(kOneValue, name)) {
      next_word(line);
      not_read(fmt::format("'map_Kd {}'", name));
    } else {
      return false;
    }
    return true;
  }

  static constexpr std::array<std::string_view, 6> kOneValue = {
      "-bm", "-boost", "-texres", "-imfchan", "-type", "-colorspace"};
  ObjMaterials result_;
  ObjMaterial material_;
  bool has_colour_ = false;
  std::uint64_t line_ = 0, first_line_ = 0;  // first_line_: of the material
};

}  // namespace

ObjMaterials parse_materials(std::string_view text) { return MaterialParser(text).result(); }

}  // namespace deburr::tb
