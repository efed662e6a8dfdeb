// SPDX-License-Identifier: MIT
#include "tb/results/yaml_file.h"

#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "spec/error.h"
#include "tb/results/file.h"
#include "tb/results/parameter_set.h"

namespace deburr::tb {

using spec::ConfigError;

namespace {

// Counts no further than two: before a ',' that belongs to nothing yaml-cpp begins one empty
// document after another, and YAML::LoadAll() never comes back.
bool has_several_documents(const std::string& text) {
  struct Ignore : YAML::EventHandler {
    void OnDocumentStart(const YAML::Mark&) override {}
    void OnDocumentEnd() override {}
    void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
    void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
    void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  const std::string&) override {}
    void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                         YAML::EmitterStyle::value) override {}
    void OnSequenceEnd() override {}
    void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                    YAML::EmitterStyle::value) override {}
    void OnMapEnd() override {}
  } ignore;
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  return parser.HandleNextDocument(ignore) && parser.HandleNextDocument(ignore);
}

}  // namespace

YamlFile::YamlFile(const std::filesystem::path& file, std::size_t most) : path_(file) {
  const std::string text = read_file(file, most);
  try {
    if (has_several_documents(text))
      throw ConfigError(
          fmt::format("{}: holds more than one YAML document, or begins with what belongs to none, "
                      "such as ','; one is expected",
                      file.string()));
    root_ = YAML::Load(text);
  } catch (const YAML::Exception& e) {
    const std::string line =
        e.mark.is_null() ? "" : fmt::format(":{}:{}", e.mark.line + 1, e.mark.column + 1);
    throw ConfigError(fmt::format("{}{}: not valid YAML: {}", file.string(), line, e.msg));
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
      return "a list";
    case YAML::NodeType::Map:
      return "a map";
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
    fail(node, fmt::format("'{}' wants a single value, got {}", what, kind(node)));
  return node.Scalar();
}

bool YamlFile::boolean(const YAML::Node& node, std::string_view what) const {
  const std::string text = scalar(node, what);
  if (text != "true" && text != "false")
    fail(node, fmt::format("'{}' = '{}' wants true or false", what, text));
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
