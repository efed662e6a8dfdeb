// SPDX-License-Identifier: MIT
// Every parameter of a run by its dotted name: the one place where the command line, configuration
// files, the manifest and the reference pages meet the structs that declare parameters
// (spec/parameters.h).
//
// A struct is added with a prefix, so that `cache.bytes` of the texture unit is
// `texture.cache.bytes` everywhere. Precedence: defaults, then the configuration file, then the
// command line in the order given. A value that cannot be applied is a ConfigError that says where
// it came from (file and line, or the option) and names near matches; nothing is ignored.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "spec/check_build.h"
#include "spec/parameters.h"
#include "tb/run/given_work.h"

namespace deburr::tb {

// A configuration has a few dozen keys, and a manifest a few hundred; anything far beyond is
// neither.
inline constexpr std::size_t kMaxConfigurationBytes = 1 << 20;

// What a change of a parameter changes. Runs that agree in rules and inputs (and in the seed) share
// one golden result, whatever they are built with.
enum class ParameterKind : std::uint8_t {
  kRun,           // how it is simulated and checked: nothing of the hardware
  kInput,         // what the engine is given
  kRule,          // pixels
  kBuild,         // cycles and cost, and no pixel
  kSurroundings,  // cycles: what is around the engine, such as memory
};
inline constexpr std::array<std::string_view, 5> kParameterKindNames = {"run", "input", "rule",
                                                                        "build", "surroundings"};

// One parameter, bound to the variable that holds it.
struct Parameter {
  std::string name;
  ParameterKind kind = ParameterKind::kRun;
  std::string unit;   // empty for choices, switches and text
  std::string range;  // "1..16", "half | quarter | ...", "true | false"
  std::string meaning;
  std::string default_value;
  // What a preset makes of it where it is not given, and the preset's name; else both are empty.
  std::string implied, implied_by;
  std::function<std::string()> text;                   // the value now
  std::function<nlohmann::ordered_json()> json;        // the same, typed
  std::function<std::string(std::string_view)> parse;  // "" or why the text is rejected
  std::vector<std::string> aliases{};                  // other words for values, as of alias()
  GivenWork work = GivenWork::kNone;
};

inline std::string_view kind_name(const Parameter& parameter) {
  return kParameterKindNames[static_cast<std::size_t>(parameter.kind)];
}

// A rule of what can be built, beyond the ranges of its parameters.
struct BuildLimit {
  std::vector<std::string> parameters;  // the first is the one that it is about
  std::string must;                     // "must be a power of two"
  friend bool operator==(const BuildLimit&, const BuildLimit&) = default;
};

// The name of a choice, in the words of its parameter.
template <class Enum, std::size_t N>
std::string_view name_of(Enum value, const std::array<std::string_view, N>& names) {
  return names[static_cast<std::size_t>(value)];
}

class ParameterSet {
 public:
  // Binds every parameter of `values` under `prefix`. The values at this moment are the defaults.
  // `values` must outlive the set.
  template <class P>
  void add(std::string_view prefix, ParameterKind kind, P& values) {
    Binder binder(*this, prefix, kind);
    describe(values, binder);
  }
  // The same of an engine, whose parameters are a struct of Rules and one of Build, with what it
  // can be built with (spec/check_build.h).
  template <class P>
  void add_engine(std::string_view prefix, P& values) {
    add(prefix, ParameterKind::kRule, static_cast<typename P::Configuration&>(values));
    add(prefix, ParameterKind::kBuild, static_cast<typename P::Build&>(values));
    for (const spec::BuildRule<P>& rule : build_rules(values)) add_build_rule(prefix, rule);
    build_checks_.push_back(
        [engine = std::string(prefix), &values] { spec::check_build(engine, values); });
  }

  // Another word for a value of a parameter: what the field calls it.
  void alias(std::string_view name, std::string_view word, std::string_view value);

  enum class Origin { kCommandLine, kFile };
  // `where` is put in front of every complaint: "run.yaml:12" or "--set".
  void set(std::string_view name, std::string_view text, std::string_view where,
           Origin origin = Origin::kCommandLine);
  // What a preset makes of a parameter that was not given; one that was given stays as it is.
  void imply(std::string_view name, std::string_view text, std::string_view by);
  // "a.b=value", as given to --set.
  void set_assignment(std::string_view assignment, std::string_view where);
  // Applies a YAML file: nested maps or dotted keys. Unknown, duplicate, misshapen or out-of-range
  // entries are errors with file and line. A run's manifest.json gives what that run was given.
  void load(const std::filesystem::path& file);
  // The same of a text that was read already. A manifest must be of a run of the engine.
  void load(const std::filesystem::path& file, const std::string& text, std::string_view engine);

  const std::vector<Parameter>& all() const { return parameters_; }
  const Parameter* find(std::string_view name) const;
  // Whether someone has set it, be it to its default.
  bool given(std::string_view name) const { return given_.contains(name); }
  // Parameters that were given something else than their preset makes of them.
  std::vector<const Parameter*> changed() const;
  // Where its value comes from, for the manifest: "given", what implied it, or "default".
  std::string_view origin(const Parameter& parameter) const;
  // ConfigError if it was given although it has no effect. A file, which may be a whole resolved
  // configuration, may hold its default.
  void reject(std::string_view name, std::string_view why) const;
  // The same for every parameter whose name begins so.
  void reject_all(std::string_view prefix, std::string_view why) const;
  // ConfigError if hardware of one of the engines cannot be built, for the first reason.
  void check_build() const;
  const std::vector<BuildLimit>& build_limits() const { return build_limits_; }
  // Up to three names that a typing error could have meant, best first.
  std::vector<std::string> near_matches(std::string_view name) const;
  // name -> value for every parameter, in order of declaration.
  nlohmann::ordered_json resolved() const;
  // The same of those of one kind.
  nlohmann::ordered_json resolved(ParameterKind kind) const;
  // The same as a YAML file that `load` accepts, each line with its meaning as comment. What a
  // preset made is a comment too, so that another preset can be chosen beside the file.
  std::string yaml() const;

 private:
  // The visitor of spec/parameters.h, with two kinds more that only the testbench uses, and with
  // what it says of a parameter that was declared.
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
    // Of names that are known at run time, which must outlive the set.
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
};

}  // namespace deburr::tb
