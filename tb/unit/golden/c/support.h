// SPDX-License-Identifier: MIT
// Helpers for tests of the C interface.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "golden/c/deburr_golden.h"
#include "golden/c/every_engine.h"

namespace deburr::tb::c {

struct Close {
  void operator()(deburr_golden* golden) const { EXPECT_EQ(deburr_close(golden), DEBURR_OK); }
};
using Handle = std::unique_ptr<deburr_golden, Close>;

inline std::string error_of(deburr_golden* golden, int status) {
  std::string text(4096, '\0');
  deburr_error(golden, status, text.data(), text.size());
  return text.c_str();
}

inline std::string value_of(deburr_golden* golden, const std::string& name) {
  std::string text(256, '\0');
  const int status = deburr_get(golden, name.c_str(), text.data(), text.size());
  EXPECT_EQ(status, DEBURR_OK) << error_of(golden, status);
  return text.c_str();
}

inline std::vector<std::string> names_of(deburr_golden* golden) {
  std::uint32_t count = 0;
  EXPECT_EQ(deburr_parameter_count(golden, &count), DEBURR_OK);
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < count; ++i) {
    std::string text(256, '\0');
    EXPECT_EQ(deburr_parameter_name(golden, i, text.data(), text.size()), DEBURR_OK);
    names.emplace_back(text.c_str());
  }
  return names;
}

inline std::uint64_t counter_of(deburr_golden* golden, const std::string& name) {
  std::uint64_t value = 0;
  const int status = deburr_counter(golden, name.c_str(), &value);
  EXPECT_EQ(status, DEBURR_OK) << error_of(golden, status);
  return value;
}

// Expect that a call succeeds, or that it fails with `words` in its message. `golden` is a pointer
// to the handle or its owner.
template <class Golden>
void expect_ok(const Golden& golden, int status) {
  EXPECT_EQ(status, DEBURR_OK) << error_of(&*golden, status);
}
template <class Golden>
void expect_rejected(const Golden& golden, const std::string& words, int status,
                     int expected = DEBURR_ARGUMENT) {
  EXPECT_EQ(status, expected) << words;
  EXPECT_THAT(error_of(&*golden, status), testing::HasSubstr(words));
}

}  // namespace deburr::tb::c
