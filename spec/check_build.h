// SPDX-License-Identifier: MIT
// Checks whether hardware can be built: each parameter must be in its range (spec/parameters.h),
// and the rules between parameters must hold that an engine lists in spec/ENGINE/check_build.h:
//
//   inline constexpr std::array<BuildRule<Parameters>, 1> kBuildRules = {{
//       {{"cache.bytes"}, "must be a power of two", [](const Parameters& p) { return ...; }},
//   }};
//   inline std::span<const BuildRule<Parameters>> build_rules(const Parameters&);
//
// The constructor of the hardware calls check_build(). It is called earlier too, for resolved
// configurations, plans of sweeps, searches and random draws. The reference pages list the rules.
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

inline constexpr std::size_t kMostRuleNames = 6;

template <class Parameters>
struct BuildRule {
  // The parameter that is restricted, then the parameters on which it depends.
  std::array<std::string_view, kMostRuleNames> names;
  std::string_view must;  // text that holds for all values: "must be a power of two"
  bool (*holds)(const Parameters&);
  // Advice that depends on the values; nullptr if the text is enough.
  std::string (*remedy)(const Parameters&) = nullptr;
};

// Visitor of parameters; rejects a value outside its declared range.
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
    throw ConfigError(of(name) + " = " + std::to_string(value) + " is not one of " + known);
  }
  std::string of(std::string_view name) const {
    return std::string(engine_) + "." + std::string(name);
  }
  std::string_view engine_;
};

// Visitor that formats the value of one parameter.
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

// Throws ConfigError for the first value outside its range.
template <class Parameters>
void check_ranges(std::string_view engine, Parameters parameters) {
  const RangeCheck check(engine);
  describe(parameters, check);  // found in the namespace of Parameters
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

// Returns the parameters if hardware can be built with them. Otherwise throws ConfigError with the
// first reason.
template <class Parameters>
const Parameters& check_build(std::string_view engine, const Parameters& parameters) {
  check_ranges(engine, parameters);
  for (const BuildRule<Parameters>& rule : build_rules(parameters))
    if (!rule.holds(parameters)) throw ConfigError(rejection(engine, rule, parameters));
  return parameters;
}

}  // namespace deburr::spec
