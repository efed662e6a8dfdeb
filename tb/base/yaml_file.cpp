// SPDX-License-Identifier: MIT
#include "tb/base/yaml_file.h"

#include <yaml-cpp/anchor.h>
#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

#include "spec/error.h"
#include "tb/base/file.h"
#include "tb/base/near_matches.h"

namespace deburr::tb {

using spec::ConfigError;

namespace {

// Scans a text before it is loaded, without keeping it: finds alias expansion that would make
// YAML::Load() or a walk through its nodes endless.
class Surveyor final : public YAML::EventHandler {
 public:
  explicit Surveyor(const std::filesystem::path& file) : file_(file) {}

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t anchor) override { leaf(anchor); }
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t anchor,
                const std::string&) override {
    leaf(anchor);
  }
  // yaml-cpp itself rejects aliases of unknown anchors.
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto named = nodes_behind_.find(anchor);
    if (named == nodes_behind_.end()) fail(mark, "an alias refers to a node that contains it");
    const std::uint64_t nodes = named->second;
    aliased_ += nodes;
    if (aliased_ > YamlFile::kMostAliasedNodes)
      fail(mark, fmt::format("aliases expand to more than {} values", YamlFile::kMostAliasedNodes));
    add(nodes);
  }
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open_.push_back({anchor, 1});
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open_.push_back({anchor, 1});
  }
  void OnMapEnd() override { close(); }

 private:
  struct Collection {
    YAML::anchor_t anchor;
    std::uint64_t nodes;  // nodes so far, including this one and the expanded aliases
  };

  void add(std::uint64_t nodes) {
    if (!open_.empty()) open_.back().nodes += nodes;
  }
  void leaf(YAML::anchor_t anchor) {
    name(anchor, 1);
    add(1);
  }
  void close() {
    const Collection closed = open_.back();
    open_.pop_back();
    name(closed.anchor, closed.nodes);
    add(closed.nodes);
  }
  void name(YAML::anchor_t anchor, std::uint64_t nodes) {
    if (anchor != YAML::NullAnchor) nodes_behind_[anchor] = nodes;
  }
  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& what) const {
    throw ConfigError(
        fmt::format("{}:{}:{}: {}", file_.string(), mark.line + 1, mark.column + 1, what));
  }

  const std::filesystem::path& file_;
  std::vector<Collection> open_;
  std::map<YAML::anchor_t, std::uint64_t> nodes_behind_;
  std::uint64_t aliased_ = 0;
};

// Stops at the second document: before a stray ',' yaml-cpp starts one empty document after
// another, so YAML::LoadAll() never returns.
bool has_several_documents(const std::string& text, Surveyor& surveyor) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  return parser.HandleNextDocument(surveyor) && parser.HandleNextDocument(surveyor);
}

// Line of the first bytes that are not UTF-8; 0: none. yaml-cpp accepts them, but JSON made from
// them fails. Text with a byte order mark of UTF-16 or UTF-32 is accepted, because yaml-cpp decodes
// it.
std::size_t line_that_is_not_utf8(std::string_view text) {
  using namespace std::string_view_literals;
  for (const std::string_view mark : {"\xff\xfe"sv, "\xfe\xff"sv, "\0\0\xfe\xff"sv})
    if (text.starts_with(mark)) return 0;
  std::size_t line = 1;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = [&](std::size_t k) {
      return i + k < text.size() ? static_cast<unsigned char>(text[i + k]) : 0U;
    };
    const unsigned first = byte(0);
    const std::size_t more = first < 0x80 ? 0 : first < 0xE0 ? 1 : first < 0xF0 ? 2 : 3;
    bool good = first < 0x80 || (first >= 0xC2 && first < 0xF5);
    for (std::size_t k = 1; k <= more; ++k) good = good && (byte(k) & 0xC0U) == 0x80;
    // Overlong encodings, surrogates, and code points above U+10FFFF.
    if ((first == 0xE0 && byte(1) < 0xA0) || (first == 0xED && byte(1) > 0x9F) ||
        (first == 0xF0 && byte(1) < 0x90) || (first == 0xF4 && byte(1) > 0x8F))
      good = false;
    if (!good) return line;
    line += first == '\n' ? 1 : 0;
    i += more + 1;
  }
  return 0;
}

}  // namespace

YamlFile::YamlFile(const std::filesystem::path& file, std::size_t most)
    : YamlFile(file, read_file(file, most)) {}

YamlFile::YamlFile(std::filesystem::path file, const std::string& text) : path_(std::move(file)) {
  if (const std::size_t line = line_that_is_not_utf8(text); line > 0)
    throw ConfigError(
        fmt::format("{}:{}: not valid UTF-8: save the file as UTF-8", path_.string(), line));
  try {
    Surveyor surveyor(path_);
    if (has_several_documents(text, surveyor))
      throw ConfigError(fmt::format(
          "{}: expected one YAML document, got several, or text before the first, such as ','",
          path_.string()));
    root_ = YAML::Load(text);
  } catch (const YAML::Exception& e) {
    const std::string line =
        e.mark.is_null() ? "" : fmt::format(":{}:{}", e.mark.line + 1, e.mark.column + 1);
    throw ConfigError(fmt::format("{}{}: not valid YAML: {}", path_.string(), line, e.msg));
  }
}

std::string YamlFile::where(const YAML::Node& node) const {
  const YAML::Mark mark = node.Mark();
  return mark.is_null() ? path_.string() : fmt::format("{}:{}", path_.string(), mark.line + 1);
}

void YamlFile::fail(const YAML::Node& node, const std::string& what) const {
  throw ConfigError(fmt::format("{}: {}", where(node), what));
}

const char* YamlFile::kind(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Sequence:
      return node.size() == 0 ? "an empty list" : "a list";
    case YAML::NodeType::Map:
      return node.size() == 0 ? "an empty map" : "a map";
    case YAML::NodeType::Scalar:
      return "a single value";
    default:
      return "nothing";
  }
}

void YamlFile::require_keys(const YAML::Node& map, const std::vector<std::string>& known) const {
  if (!map.IsMap()) fail(map, fmt::format("expected a map, got {}", kind(map)));
  std::set<std::string> seen;
  for (const auto& entry : map) {
    const std::string key = scalar(entry.first, "key");
    if (std::find(known.begin(), known.end(), key) == known.end())
      fail(entry.first,
           fmt::format("unknown key '{}'{} (known: {})", key,
                       did_you_mean(near_matches(key, known)), fmt::join(known, ", ")));
    if (!seen.insert(key).second) fail(entry.first, fmt::format("'{}' is given twice", key));
  }
}

std::string YamlFile::scalar(const YAML::Node& node, std::string_view what) const {
  if (!node.IsScalar())
    fail(node, fmt::format("'{}' must be a single value, got {}", what, kind(node)));
  return node.Scalar();
}

bool YamlFile::boolean(const YAML::Node& node, std::string_view what) const {
  const std::string text = scalar(node, what);
  if (text != "true" && text != "false")
    fail(node, fmt::format("'{}' = '{}' must be true or false", what, text));
  return text == "true";
}

std::uint64_t YamlFile::count(const YAML::Node& node, std::string_view what,
                              std::uint64_t most) const {
  const auto value = number<std::int64_t>(node, what);
  if (value < 1 || static_cast<std::uint64_t>(value) > most)
    fail(node, fmt::format("'{}' = '{}' is outside 1..{}", what, value, most));
  return static_cast<std::uint64_t>(value);
}

}  // namespace deburr::tb
