// SPDX-License-Identifier: MIT
// What runners of the contracts' test vectors (spec/ENGINE/vectors.h) share: parameters by the
// names that a vector gives, and what of a result is not as the vector says.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace deburr::tb {

// A visitor of spec/parameters.h that sets one parameter.
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

// "walkers=1 mark=true", by the names and values of describe().
template <class Parameters>
void apply_settings(Parameters& parameters, std::string_view settings) {
  while (!settings.empty()) {
    const std::string_view one = settings.substr(0, settings.find(' '));
    settings.remove_prefix(std::min(settings.size(), one.size() + 1));
    const std::size_t equals = std::min(one.find('='), one.size() - 1);
    SetByName set(one.substr(0, equals), one.substr(equals + 1));
    describe(parameters, set);
    if (!set.found())
      throw std::invalid_argument(fmt::format("a test vector sets '{}', which is none", one));
  }
}

// Each value that is not as expected, with its name; nothing if all are.
template <class Result>
std::string differences(const Result& expected, const Result& got) {
  std::vector<std::uint64_t> values;
  Result::fields(got, [&](std::string_view, const auto& value) {
    values.push_back(static_cast<std::uint64_t>(value));
  });
  std::string all;
  std::size_t at = 0;
  Result::fields(expected, [&](std::string_view name, const auto& value) {
    const std::uint64_t other = values.at(at++);
    if (other != static_cast<std::uint64_t>(value))
      all += fmt::format("{}: {} (0x{:016x}), expected {} (0x{:016x})\n", name, other, other, value,
                         static_cast<std::uint64_t>(value));
  });
  return all;
}

// The planted fault of a runner: each value of a vector, changed, is seen.
template <class Result>
void expect_each_value_is_compared(const Result& expected, const Result& got) {
  ASSERT_EQ(differences(expected, got), "");
  std::size_t count = 0, planted = 0;
  Result::fields(expected, [&](std::string_view, const auto&) { ++count; });
  for (; planted < count; ++planted) {
    Result changed = expected;
    std::size_t at = 0;
    std::string name;
    Result::fields(changed, [&](std::string_view title, auto& value) {
      if (at++ != planted) return;
      value ^= 1;
      name = title;
    });
    EXPECT_TRUE(differences(changed, got).starts_with(name + ": ")) << name;
  }
  EXPECT_GT(planted, 0u);
}

}  // namespace deburr::tb
