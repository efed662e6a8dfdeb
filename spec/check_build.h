// SPDX-License-Identifier: MIT
// What hardware can be built with: each parameter within its range (spec/parameters.h), and the
// rules between parameters that an engine lists in spec/ENGINE/check_build.h:
//
//   inline constexpr std::array<BuildRule<Parameters>, 1> kBuildRules = {{
//       {{"cache.bytes"}, "must be a power of two", [](const Parameters& p) { return ...; }},
//   }};
//   inline std::span<const BuildRule<Parameters>> build_rules(const Parameters&);
//
// The hardware's constructor calls check_build(), and so does whatever is to know before: resolved
// configurations, plans of sweeps, searches, random draws. The reference pages list the rules.
// Nothing here computes what an engine computes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "spec/error.h"

namespace deburr::spec {

inline constexpr std::size_t kMostRuleNames = 3;

template <class Parameters>
struct BuildRule {
  // The parameter that the rule is about, and those that it depends on.
  std::array<std::string_view, kMostRuleNames> names;
  std::string_view must;  // "must be a power of two", in words that hold for all values
  bool (*holds)(const Parameters&);
  // What would do with the values given, if that is more than the words say.
  std::string (*remedy)(const Parameters&) = nullptr;
};

// A visitor of parameters that rejects a value out of its declared range.
class RangeCheck {
 public:
  explicit RangeCheck(std::string_view engine) : engine_(engine) {}
  void integer(std::string_view name, std::int32_t value, std::int32_t min, std::int32_t max,
               std::string_view unit, std::string_view) const {
    if (value >= min && value <= max) return;
    throw ConfigError(of(name) + " = " + std::to_string(value) + " is outside " +
                      std::to_string(min) + ".." + std::to_string(max) + " " + std::string(unit));
  }
  template <class Enum, std::size_t N>
  void choice(std::string_view name, Enum value, const std::array<std::string_view, N>& names,
              std::string_view) const {
    check_choice(name, static_cast<std::size_t>(value), names);
  }
  void boolean(std::string_view, bool, std::string_view) const {}

 private:
  void check_choice(std::string_view name, std::size_t value,
                    std::span<const std::string_view> names) const {
    if (value < names.size()) return;
    std::string known;
    for (const std::string_view one : names) {
      if (!known.empty()) known += ", ";
      known += one;
    }
    throw ConfigError(of(name) + " = " + std::to_string(value) + " is none of " + known);
  }
  std::string of(std::string_view name) const {
    return std::string(engine_) + "." + std::string(name);
  }
  std::string_view engine_;
};

// A visitor that writes down the value of one parameter.
class ValueText {
 public:
  explicit ValueText(std::string_view wanted) : wanted_(wanted) {}
  void integer(std::string_view name, std::int32_t value, std::int32_t, std::int32_t,
               std::string_view, std::string_view) {
    if (name == wanted_) text_ = std::to_string(value);
  }
  template <class Enum, std::size_t N>
  void choice(std::string_view name, Enum value, const std::array<std::string_view, N>& names,
              std::string_view) {
    if (name == wanted_) take(static_cast<std::size_t>(value), names);
  }
  void boolean(std::string_view name, bool value, std::string_view) {
    if (name == wanted_) text_ = value ? "true" : "false";
  }
  const std::string& text() const { return text_; }

 private:
  void take(std::size_t value, std::span<const std::string_view> names) {
    text_ = value < names.size() ? std::string(names[value]) : std::to_string(value);
  }
  std::string_view wanted_;
  std::string text_;
};

// The value of a parameter as users write it.
template <class Parameters>
std::string value_text(Parameters parameters, std::string_view name) {
  ValueText value(name);
  describe(parameters, value);
  DEBURR_CHECK(!value.text().empty(), "no parameter is named " + std::string(name));
  return value.text();
}

// ConfigError for the first value out of its range.
template <class Parameters>
void check_ranges(std::string_view engine, Parameters parameters) {
  const RangeCheck check(engine);
  describe(parameters, check);  // of the namespace that declares them
}

// "unit.cache.bytes = 256 with cache.ways = 8: must hold a set; make it at least 512"
template <class Parameters>
std::string rejection(std::string_view engine, const BuildRule<Parameters>& rule,
                      const Parameters& parameters) {
  std::string text;
  for (std::size_t i = 0; i < rule.names.size() && !rule.names[i].empty(); ++i) {
    text += i == 0 ? "" : i == 1 ? " with " : ", ";
    if (i == 0) text += std::string(engine) + ".";
    text += std::string(rule.names[i]) + " = " + value_text(parameters, rule.names[i]);
  }
  text += ": " + std::string(rule.must);
  if (rule.remedy) text += "; " + rule.remedy(parameters);
  return text;
}

// The parameters, if hardware can be built with them; ConfigError if not, for the first reason.
template <class Parameters>
const Parameters& check_build(std::string_view engine, const Parameters& parameters) {
  check_ranges(engine, parameters);
  for (const BuildRule<Parameters>& rule : build_rules(parameters))
    if (!rule.holds(parameters)) throw ConfigError(rejection(engine, rule, parameters));
  return parameters;
}

}  // namespace deburr::spec
