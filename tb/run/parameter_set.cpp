// SPDX-License-Identifier: MIT
#include "tb/run/parameter_set.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>
#include <utility>

#include "spec/error.h"
#include "tb/base/json_text.h"
#include "tb/base/near_matches.h"
#include "tb/base/yaml_file.h"

namespace deburr::tb {
namespace {

using spec::ConfigError;

template <class Number>
bool parse_number(std::string_view text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

// Decimal, or hexadecimal as addresses are printed: 0x7fffffc0.
bool parse_integer(std::string_view text, std::int64_t& value) {
  if (!text.starts_with("0x")) return parse_number(text, value);
  text.remove_prefix(2);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  return error == std::errc() && end == text.data() + text.size() && !text.starts_with('-');
}

std::string join(const std::vector<std::string_view>& names, std::string_view separator) {
  return fmt::format("{}", fmt::join(names, separator));
}

constexpr int kMaxNesting = 16;
constexpr std::string_view kMayBeList = "list";  // suffix of the range of such a parameter
// In the parameters of a manifest.
constexpr std::string_view kGiven = "given", kDefault = "default";

// Entry of a map; undefined if missing.
YAML::Node entry_of(const YAML::Node& map, const char* key) {
  return map.IsMap() ? map[key] : YAML::Node(YAML::NodeType::Undefined);
}
std::string scalar_of(const YAML::Node& map, const char* key) {
  const YAML::Node entry = entry_of(map, key);
  return entry.IsDefined() && entry.IsScalar() ? entry.Scalar() : "";
}
bool is_map(const YAML::Node& node) { return node.IsDefined() && node.IsMap(); }

// Reads a run's manifest.json. Only values that were given matter; all others are derived again.
// But if a default has changed since the run, its old value is kept.
class Manifest {
 public:
  static bool is_one(const YAML::Node& root) {
    return !scalar_of(root, "schema").empty() && !scalar_of(root, "unit").empty() &&
           is_map(entry_of(root, "configuration"));
  }

  Manifest(const YamlFile& yaml, std::string_view engine)
      : yaml_(yaml), folder_(scalar_of(yaml.root(), "working_directory")) {
    const YAML::Node& root = yaml.root();
    if (const std::string unit = scalar_of(root, "unit"); !engine.empty() && unit != engine)
      yaml.fail(root["unit"],
                fmt::format("this manifest belongs to a run of '{}', not of '{}'", unit, engine));
    for (const auto& parameter : entry_of(root, "parameters"))
      from_[scalar_of(parameter, "name")] = scalar_of(parameter, "from");
    for (const auto& input : entry_of(root, "inputs"))
      if (const std::string role = scalar_of(input, "role"); role.empty() || role == "surroundings")
        inputs_.insert(scalar_of(input, "file"));
  }

  void apply(ParameterSet& set) const {
    for (const auto& entry : yaml_.root()["configuration"]) {
      const std::string name = yaml_.scalar(entry.first, "configuration");
      const std::string value = yaml_.scalar(entry.second, name);
      if (!follows(set.find(name), value))
        set.set(name, where_it_was(value), yaml_.where(entry.first), ParameterSet::Origin::kFile);
    }
  }

 private:
  // Whether the parameter gets this value without being set. If the manifest does not tell, the
  // value in the manifest is set.
  bool follows(const Parameter* parameter, const std::string& value) const {
    if (!parameter) return false;
    const auto found = from_.find(parameter->name);
    if (found == from_.end() || found->second.empty() || found->second == kGiven) return false;
    return found->second != kDefault || parameter->text() == value ||
           json_text(parameter->json()) == value;
  }

  // File names are relative to the folder in which the run was started.
  std::string where_it_was(const std::string& value) const {
    std::error_code error;
    if (folder_.empty() || value.empty() || !inputs_.contains(value) ||
        folder_ == std::filesystem::current_path(error))
      return value;
    return (folder_ / value).lexically_normal().string();
  }

  const YamlFile& yaml_;
  std::filesystem::path folder_;
  std::map<std::string, std::string> from_;
  std::set<std::string> inputs_;
};

class YamlLoader {
 public:
  YamlLoader(ParameterSet& set, const YamlFile& yaml, std::string_view engine)
      : set_(set), yaml_(yaml), engine_(engine) {}

  void load() {
    const YAML::Node& root = yaml_.root();
    if (root.IsNull()) return;
    if (!root.IsMap())
      yaml_.fail(root, fmt::format("expected a map of parameters, got {}", YamlFile::kind(root)));
    if (Manifest::is_one(root))
      Manifest(yaml_, engine_).apply(set_);
    else
      walk(root, "", 0);
  }

 private:
  void walk(const YAML::Node& map, const std::string& prefix, int depth) {
    if (depth > kMaxNesting) yaml_.fail(map, "maps are nested too deeply");
    for (const auto& entry : map) {
      if (!entry.first.IsScalar())
        yaml_.fail(entry.first,
                   fmt::format("a key must be a name, got {}", YamlFile::kind(entry.first)));
      const std::string name = prefix + entry.first.Scalar();
      if (entry.second.IsMap()) {
        walk(entry.second, name + ".", depth + 1);
        continue;
      }
      const std::string here = yaml_.where(entry.first);
      const auto [first, inserted] = seen_.emplace(name, here);
      if (!inserted)
        yaml_.fail(entry.first,
                   fmt::format("'{}' is given twice (first at {})", name, first->second));
      if (!set_.find(name)) set_.set(name, "", here);  // throws and suggests near matches
      if (entry.second.IsSequence() && set_.find(name)->range.ends_with(kMayBeList)) {
        set_.set(name, joined_list(entry.second, name), here, ParameterSet::Origin::kFile);
        continue;
      }
      if (!entry.second.IsScalar())
        yaml_.fail(entry.first, fmt::format("'{}' must be a single value, got {}", name,
                                            YamlFile::kind(entry.second)));
      set_.set(name, entry.second.Scalar(), here, ParameterSet::Origin::kFile);
    }
  }

  // In the format of the command line.
  std::string joined_list(const YAML::Node& list, const std::string& name) const {
    std::string text;
    for (const auto& entry : list) text += (text.empty() ? "" : "; ") + yaml_.scalar(entry, name);
    return text;
  }

  ParameterSet& set_;
  const YamlFile& yaml_;
  std::string_view engine_;
  std::map<std::string, std::string> seen_;
};

}  // namespace

// ---- Binder -------------------------------------------------------------------------------------

void ParameterSet::Binder::add(std::string_view name, std::string_view unit, std::string range,
                               std::string_view meaning, std::function<std::string()> text,
                               std::function<nlohmann::ordered_json()> json,
                               std::function<std::string(std::string_view)> parse) {
  Parameter p;
  p.name = prefix_.empty() ? std::string(name) : fmt::format("{}.{}", prefix_, name);
  DEBURR_CHECK(!set_.find(p.name), "parameter '" + p.name + "' is declared twice");
  p.kind = kind_;
  p.unit = unit;
  p.range = std::move(range);
  p.meaning = meaning;
  p.default_value = text();
  p.text = std::move(text);
  p.json = std::move(json);
  p.parse = std::move(parse);
  set_.parameters_.push_back(std::move(p));
}

void ParameterSet::Binder::is_work(std::string_view name, GivenWork work) {
  const std::string whole =
      prefix_.empty() ? std::string(name) : fmt::format("{}.{}", prefix_, name);
  const auto found = std::find_if(set_.parameters_.begin(), set_.parameters_.end(),
                                  [&](const Parameter& p) { return p.name == whole; });
  DEBURR_CHECK(found != set_.parameters_.end(), "unknown parameter '" + whole + "' marked as work");
  found->work = work;
}

void ParameterSet::Binder::integer(std::string_view name, std::int64_t& value, std::int64_t min,
                                   std::int64_t max, std::string_view unit,
                                   std::string_view meaning) {
  add(
      name, unit, fmt::format("{}..{}", min, max), meaning,
      [&value] { return std::to_string(value); },
      [&value] { return nlohmann::ordered_json(value); },
      [&value, min, max](std::string_view text) -> std::string {
        std::int64_t parsed = 0;
        if (!parse_integer(text, parsed)) return fmt::format("must be an integer {}..{}", min, max);
        if (parsed < min || parsed > max) return fmt::format("is outside {}..{}", min, max);
        value = parsed;
        return "";
      });
}

void ParameterSet::Binder::integer(std::string_view name, std::int32_t& value, std::int32_t min,
                                   std::int32_t max, std::string_view unit,
                                   std::string_view meaning) {
  add(
      name, unit, fmt::format("{}..{}", min, max), meaning,
      [&value] { return std::to_string(value); },
      [&value] { return nlohmann::ordered_json(value); },
      [&value, min, max](std::string_view text) -> std::string {
        std::int64_t parsed = 0;
        if (!parse_integer(text, parsed)) return fmt::format("must be an integer {}..{}", min, max);
        if (parsed < min || parsed > max) return fmt::format("is outside {}..{}", min, max);
        value = static_cast<std::int32_t>(parsed);
        return "";
      });
}

void ParameterSet::Binder::real(std::string_view name, double& value, double min, double max,
                                std::string_view unit, std::string_view meaning) {
  add(
      name, unit, fmt::format("{}..{}", min, max), meaning,
      [&value] { return fmt::format("{}", value); },
      [&value] { return nlohmann::ordered_json(value); },
      [&value, min, max](std::string_view text) -> std::string {
        double parsed = 0;
        if (!parse_number(text, parsed) || !std::isfinite(parsed))
          return fmt::format("must be a number {}..{}", min, max);
        if (parsed < min || parsed > max) return fmt::format("is outside {}..{}", min, max);
        value = parsed;
        return "";
      });
}

void ParameterSet::Binder::text(std::string_view name, std::string& value, std::string_view range,
                                std::string_view meaning) {
  add(
      name, "", std::string(range), meaning, [&value] { return value; },
      [&value] { return nlohmann::ordered_json(value); },
      [&value](std::string_view text) -> std::string {
        value = text;
        return "";
      });
}

void ParameterSet::Binder::boolean(std::string_view name, bool& value, std::string_view meaning) {
  add(
      name, "", "true | false", meaning, [&value] { return value ? "true" : "false"; },
      [&value] { return nlohmann::ordered_json(value); },
      [&value](std::string_view text) -> std::string {
        if (text == "true" || text == "on" || text == "yes")
          value = true;
        else if (text == "false" || text == "off" || text == "no")
          value = false;
        else
          return "must be true or false";
        return "";
      });
}

void ParameterSet::Binder::add_choice(std::string_view name,
                                      const std::vector<std::string_view>& names,
                                      const std::function<std::size_t()>& get,
                                      const std::function<void(std::size_t)>& set,
                                      std::string_view meaning) {
  const auto current = [names, get] { return std::string(names.at(get())); };
  add(
      name, "", join(names, " | "), meaning, current,
      [current] { return nlohmann::ordered_json(current()); },
      [names, set](std::string_view text) -> std::string {
        const auto found = std::find(names.begin(), names.end(), text);
        if (found == names.end())
          return fmt::format("must be one of {}{}", join(names, ", "),
                             did_you_mean(tb::near_matches(text, {names.begin(), names.end()})));
        set(static_cast<std::size_t>(found - names.begin()));
        return "";
      });
}

// ---- ParameterSet -------------------------------------------------------------------------------

const Parameter* ParameterSet::find(std::string_view name) const {
  const auto found = std::find_if(parameters_.begin(), parameters_.end(),
                                  [&](const Parameter& p) { return p.name == name; });
  return found == parameters_.end() ? nullptr : &*found;
}

void ParameterSet::alias(std::string_view name, std::string_view word, std::string_view value) {
  const auto found = std::find_if(parameters_.begin(), parameters_.end(),
                                  [&](const Parameter& p) { return p.name == name; });
  DEBURR_CHECK(found != parameters_.end(),
               fmt::format("alias '{}' of unknown parameter '{}'", word, name));
  found->aliases.emplace_back(word);
  found->parse = [parse = std::move(found->parse), word = std::string(word),
                  value = std::string(value)](std::string_view text) {
    const std::string complaint = parse(text == word ? std::string_view(value) : text);
    return complaint.empty() ? complaint : fmt::format("{}; {} is {}", complaint, word, value);
  };
}

std::vector<std::string> ParameterSet::near_matches(std::string_view name) const {
  std::vector<std::string> names;
  for (const Parameter& p : parameters_) names.push_back(p.name);
  return tb::near_matches(name, names);
}

void ParameterSet::set(std::string_view name, std::string_view text, std::string_view where,
                       Origin origin) {
  const Parameter* parameter = find(name);
  if (!parameter)
    throw ConfigError(fmt::format("{}: unknown parameter '{}'{} (`deburr params` lists them all)",
                                  where, name, did_you_mean(near_matches(name))));
  const std::string complaint = parameter->parse(text);
  if (!complaint.empty())
    throw ConfigError(fmt::format("{}: '{}' = '{}' {}", where, name, text, complaint));
  given_.insert_or_assign(parameter->name, Given{std::string(where), origin});
}

void ParameterSet::imply(std::string_view name, std::string_view text, std::string_view by) {
  const auto found = std::find_if(parameters_.begin(), parameters_.end(),
                                  [&](const Parameter& p) { return p.name == name; });
  DEBURR_CHECK(found != parameters_.end(), fmt::format("{} implies unknown '{}'", by, name));
  found->implied = text;
  found->implied_by = by;
  if (given(name)) return;
  const std::string complaint = found->parse(text);
  DEBURR_CHECK(complaint.empty(), fmt::format("{}: '{}' {}", by, name, complaint));
}

std::vector<const Parameter*> ParameterSet::changed() const {
  std::vector<const Parameter*> changed;
  for (const Parameter& p : parameters_)
    if (!p.implied_by.empty() && p.text() != p.implied) changed.push_back(&p);
  return changed;
}

void ParameterSet::reject(std::string_view name, std::string_view why) const {
  unused_.emplace(name);
  const auto given = given_.find(name);
  if (given == given_.end()) return;
  const Parameter& p = *find(name);
  const std::string& usual = p.implied_by.empty() ? p.default_value : p.implied;
  if (given->second.origin == Origin::kFile && p.text() == usual) return;
  throw ConfigError(
      fmt::format("{}: '{}' = '{}' has no effect: {}", given->second.where, name, p.text(), why));
}

void ParameterSet::reject_all(std::string_view prefix, std::string_view why) const {
  for (const Parameter& p : parameters_)
    if (p.name.starts_with(prefix)) reject(p.name, why);
}

void ParameterSet::check_build() const {
  for (const std::function<void()>& check : build_checks_) check();
}

void ParameterSet::set_assignment(std::string_view assignment, std::string_view where) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos)
    throw ConfigError(fmt::format("{}: expected name=value, got '{}'", where, assignment));
  set(assignment.substr(0, equals), assignment.substr(equals + 1), where);
}

void ParameterSet::load(const std::filesystem::path& file) {
  YamlLoader(*this, YamlFile(file, kMaxConfigurationBytes), "").load();
}

void ParameterSet::load(const std::filesystem::path& file, const std::string& text,
                        std::string_view engine) {
  YamlLoader(*this, YamlFile(file, text), engine).load();
}

std::string_view ParameterSet::origin(const Parameter& parameter) const {
  if (given(parameter.name)) return kGiven;
  return parameter.implied_by.empty() ? kDefault : std::string_view(parameter.implied_by);
}

nlohmann::ordered_json ParameterSet::resolved() const {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const Parameter& p : parameters_) json[p.name] = p.json();
  return json;
}

nlohmann::ordered_json ParameterSet::resolved(ParameterKind kind) const {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const Parameter& p : parameters_)
    if (p.kind == kind) json[p.name] = p.json();
  return json;
}

std::string ParameterSet::yaml() const {
  std::string out;
  for (const Parameter& p : parameters_) {
    YAML::Emitter value;
    // Text is quoted, since it may contain any character; numbers, choices and switches need no
    // quotes.
    if (p.json().is_string()) value << YAML::DoubleQuoted;
    value << p.text();
    const bool by_preset = !p.implied_by.empty() && p.text() == p.implied;
    out += fmt::format("{}{}: {}  # {}{}\n", by_preset ? "# " : "", p.name, value.c_str(),
                       by_preset ? fmt::format("By {}. ", p.implied_by) : "", p.meaning);
  }
  return out;
}

}  // namespace deburr::tb
