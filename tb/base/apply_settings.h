// SPDX-License-Identifier: MIT
// Sets parameters by the names and values of their description (spec/parameters.h), for test
// vectors and benchmarks. The command uses a ParameterSet instead.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <system_error>

namespace deburr::tb {

// Visitor of spec/parameters.h that sets one parameter.
class SetByName {
 public:
  SetByName(std::string_view name, std::string_view value) : name_(name), value_(value) {}
  void integer(std::string_view name, std::int32_t& value, std::int32_t min, std::int32_t max,
               std::string_view, std::string_view) {
    if (name != name_) return;
    const char* const end = value_.data() + value_.size();
    const auto [last, error] = std::from_chars(value_.data(), end, value);
    found_ = error == std::errc() && last == end && value >= min && value <= max;
  }
  template <class Enum, std::size_t N>
  void choice(std::string_view name, Enum& value, const std::array<std::string_view, N>& names,
              std::string_view) {
    for (std::size_t i = 0; name == name_ && i < N; ++i)
      if (names[i] == value_) set(value, static_cast<Enum>(i));
  }
  void boolean(std::string_view name, bool& value, std::string_view) {
    if (name == name_ && (value_ == "true" || value_ == "false")) set(value, value_ == "true");
  }
  bool found() const { return found_; }

 private:
  template <class Value>
  void set(Value& value, Value to) {
    value = to;
    found_ = true;
  }
  std::string_view name_, value_;
  bool found_ = false;
};

// Applies "walkers=1 mark=true", with the names and values of describe().
template <class Parameters>
void apply_settings(Parameters& parameters, std::string_view settings) {
  while (!settings.empty()) {
    const std::string_view one = settings.substr(0, settings.find(' '));
    settings.remove_prefix(std::min(settings.size(), one.size() + 1));
    const std::size_t equals = std::min(one.find('='), one.size() - 1);
    SetByName set(one.substr(0, equals), one.substr(equals + 1));
    describe(parameters, set);
    if (!set.found())
      throw std::invalid_argument(
          fmt::format("'{}' is not a known setting, or has an invalid value", one));
  }
}

}  // namespace deburr::tb
