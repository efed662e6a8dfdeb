// SPDX-License-Identifier: MIT
// Helpers of the runners of the contracts' test vectors (spec/ENGINE/vectors.h): parameters by the
// names in a vector, and the differences between a result and its vector.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tb/base/apply_settings.h"

namespace deburr::tb {

// Each value that differs from the expected one, with its name; empty if all are equal.
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

// The injected fault of a runner: changing any value of a vector is detected.
template <class Result>
void expect_each_value_is_compared(const Result& expected, const Result& got) {
  ASSERT_EQ(differences(expected, got), "");
  std::size_t count = 0, injected = 0;
  Result::fields(expected, [&](std::string_view, const auto&) { ++count; });
  for (; injected < count; ++injected) {
    Result changed = expected;
    std::size_t at = 0;
    std::string name;
    Result::fields(changed, [&](std::string_view title, auto& value) {
      if (at++ != injected) return;
      value ^= 1;
      name = title;
    });
    EXPECT_TRUE(differences(changed, got).starts_with(name + ": ")) << name;
  }
  EXPECT_GT(injected, 0u);
}

}  // namespace deburr::tb
