// SPDX-License-Identifier: MIT
// All parameters of a run, by their dotted names. Command line, configuration files, manifest and
// reference pages access the parameter structs (spec/parameters.h) through this set.
//
// A struct is added under a prefix, so `cache.bytes` of the texture unit is `texture.cache.bytes`
// everywhere. Values are applied in this order, and the last one wins: defaults, the configuration
// file, the command line from left to right. A value that cannot be applied throws a ConfigError
// that names its origin (file and line, or option) and near matches. No value is ignored.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "spec/check_build.h"
#include "spec/parameters.h"
#include "tb/run/given_work.h"

namespace deburr::tb {

// Size limit of configuration files. A configuration has a few dozen keys and a manifest a few
// hundred.
inline constexpr std::size_t kMaxConfigurationBytes = 1 << 20;

// What a parameter affects. Runs with equal configuration, inputs and seed share one golden result,
// even if their build parameters differ.
enum class ParameterKind : std::uint8_t {
  kRun,           // simulation and checks; not the hardware
  kInput,         // input data of the engine
  kRule,          // pixels (programmable configuration)
  kBuild,         // cycles and cost, but not pixels (build parameters)
  kSurroundings,  // cycles, through the environment of the engine such as memory
};
inline constexpr std::array<std::string_view, 5> kParameterKindNames = {"run", "input", "rule",
                                                                        "build", "surroundings"};

// One parameter, bound to the variable that holds its value.
struct Parameter {
  std::string name;
  ParameterKind kind = ParameterKind::kRun;
  std::string unit;   // empty for choices, switches and text
  std::string range;  // "1..16", "half | quarter | ...", "true | false"
  std::string meaning;
  std::string default_value;
  // If a preset implies a value: that value, used if the parameter is not given, and the name of
  // the preset.
  std::string implied, implied_by;
  std::function<std::string()> text;                   // current value
  std::function<nlohmann::ordered_json()> json;        // current value with its JSON type
  std::function<std::string(std::string_view)> parse;  // returns "" or why the text is rejected
  std::vector<std::string> aliases{};                  // other names of values; see alias()
  GivenWork work = GivenWork::kNone;
};

inline std::string_view kind_name(const Parameter& parameter) {
  return kParameterKindNames[static_cast<std::size_t>(parameter.kind)];
}

// A constraint on build parameters beyond their ranges.
struct BuildLimit {
  std::vector<std::string> parameters;  // the first one is the subject of the message
  std::string must;                     // "must be a power of two"
  friend bool operator==(const BuildLimit&, const BuildLimit&) = default;
};

// Name of a choice, as its parameter spells it.
template <class Enum, std::size_t N>
std::string_view name_of(Enum value, const std::array<std::string_view, N>& names) {
  return names[static_cast<std::size_t>(value)];
}

class ParameterSet {
 public:
  // Binds every parameter of `values` under `prefix`. Current values become the defaults. `values`
  // must outlive the set.
  template <class P>
  void add(std::string_view prefix, ParameterKind kind, P& values) {
    Binder binder(*this, prefix, kind);
    describe(values, binder);
  }
  // As add(), for the parameters of an engine: a struct with Rules and Build. Also adds its build
  // constraints (spec/check_build.h).
  template <class P>
  void add_engine(std::string_view prefix, P& values) {
    add(prefix, ParameterKind::kRule, static_cast<typename P::Configuration&>(values));
    add(prefix, ParameterKind::kBuild, static_cast<typename P::Build&>(values));
    for (const spec::BuildRule<P>& rule : build_rules(values)) add_build_rule(prefix, rule);
    build_checks_.push_back(
        [engine = std::string(prefix), &values] { spec::check_build(engine, values); });
  }

  // Adds another name for a value, such as the term that is usual in the field.
  void alias(std::string_view name, std::string_view word, std::string_view value);

  enum class Origin { kCommandLine, kFile };
  // `where` prefixes error messages: "run.yaml:12" or "--set".
  void set(std::string_view name, std::string_view text, std::string_view where,
           Origin origin = Origin::kCommandLine);
  // Value that a preset implies. A parameter that was given keeps its value.
  void imply(std::string_view name, std::string_view text, std::string_view by);
  // Applies "a.b=value", as given to --set.
  void set_assignment(std::string_view assignment, std::string_view where);
  // Applies a YAML file with nested maps or dotted keys. Unknown, duplicate, malformed or
  // out-of-range entries are errors with file and line. If the file is the manifest.json of a run,
  // the values that were given to that run are restored.
  void load(const std::filesystem::path& file);
  // As above, for text already read. A manifest must belong to a run of `engine`.
  void load(const std::filesystem::path& file, const std::string& text, std::string_view engine);

  const std::vector<Parameter>& all() const { return parameters_; }
  const Parameter* find(std::string_view name) const;
  // Whether the parameter was set explicitly, even to its default.
  bool given(std::string_view name) const { return given_.contains(name); }
  // Parameters that were given a value other than their preset's.
  std::vector<const Parameter*> changed() const;
  // Origin of the value, for the manifest: "given", the preset that implied it, or "default".
  std::string_view origin(const Parameter& parameter) const;
  // Throws ConfigError if the parameter, which has no effect, was given. The default is allowed in
  // a file, since a file may be a complete resolved configuration. Then has_effect() is false.
  void reject(std::string_view name, std::string_view why) const;
  // Applies reject() to every parameter whose name starts with `prefix`.
  void reject_all(std::string_view prefix, std::string_view why) const;
  bool has_effect(std::string_view name) const { return !unused_.contains(name); }
  // Throws ConfigError for the first violated build constraint.
  void check_build() const;
  const std::vector<BuildLimit>& build_limits() const { return build_limits_; }
  // Up to three similar names, best match first.
  std::vector<std::string> near_matches(std::string_view name) const;
  // All parameters as name -> value, in declaration order.
  nlohmann::ordered_json resolved() const;
  // Parameters of one kind.
  nlohmann::ordered_json resolved(ParameterKind kind) const;
  // The configuration as a YAML file that load() accepts, with the meaning of each parameter as a
  // comment. Values implied by a preset are commented out, so that the file can be used with
  // another preset.
  std::string yaml() const;

 private:
  // A visitor for spec/parameters.h. It has two more kinds of parameters, which only the testbench
  // uses, and attributes that apply to the parameter declared last.
  class Binder {
   public:
    Binder(ParameterSet& set, std::string_view prefix, ParameterKind kind)
        : set_(set), prefix_(prefix), kind_(kind) {}
    void integer(std::string_view name, std::int32_t& value, std::int32_t min, std::int32_t max,
                 std::string_view unit, std::string_view meaning);
    void integer(std::string_view name, std::int64_t& value, std::int64_t min, std::int64_t max,
                 std::string_view unit, std::string_view meaning);
    void real(std::string_view name, double& value, double min, double max, std::string_view unit,
              std::string_view meaning);
    void text(std::string_view name, std::string& value, std::string_view range,
              std::string_view meaning);
    void boolean(std::string_view name, bool& value, std::string_view meaning);
    void is_work(std::string_view name, GivenWork work);
    template <class Enum, std::size_t N>
    void choice(std::string_view name, Enum& value, const std::array<std::string_view, N>& names,
                std::string_view meaning) {
      add_choice(
          name, {names.begin(), names.end()}, [&value] { return static_cast<std::size_t>(value); },
          [&value](std::size_t index) { value = static_cast<Enum>(index); }, meaning);
    }
    // Choice whose names are known only at run time; `names` must outlive the set.
    void choice(std::string_view name, std::size_t& value, const std::vector<std::string>& names,
                std::string_view meaning) {
      add_choice(
          name, {names.begin(), names.end()}, [&value] { return value; },
          [&value](std::size_t index) { value = index; }, meaning);
    }

   private:
    void add(std::string_view name, std::string_view unit, std::string range,
             std::string_view meaning, std::function<std::string()> text,
             std::function<nlohmann::ordered_json()> json,
             std::function<std::string(std::string_view)> parse);
    void add_choice(std::string_view name, const std::vector<std::string_view>& names,
                    const std::function<std::size_t()>& get,
                    const std::function<void(std::size_t)>& set, std::string_view meaning);

    ParameterSet& set_;
    std::string_view prefix_;
    ParameterKind kind_;
  };

  struct Given {
    std::string where;
    Origin origin;
  };

  template <class P>
  void add_build_rule(std::string_view prefix, const spec::BuildRule<P>& rule) {
    BuildLimit limit{{}, std::string(rule.must)};
    for (const std::string_view name : rule.names)
      if (!name.empty()) limit.parameters.push_back(std::string(prefix) + "." + std::string(name));
    build_limits_.push_back(std::move(limit));
  }

  std::vector<Parameter> parameters_;
  std::vector<BuildLimit> build_limits_;
  std::vector<std::function<void()>> build_checks_;
  std::map<std::string, Given, std::less<>> given_;
  mutable std::set<std::string, std::less<>> unused_;  // names that reject() was called with
};

}  // namespace deburr::tb
