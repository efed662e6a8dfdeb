// SPDX-License-Identifier: MIT
// Linked into every test program: a failed expectation in a child process (forked.h) fails the
// test.
#include <gtest/gtest.h>

#include "tb/base/forked.h"

namespace deburr::tb {
namespace {
[[maybe_unused]] const bool told = [] {
  expectation_failed = [] { return testing::Test::HasFailure(); };
  return true;
}();
}  // namespace
}  // namespace deburr::tb
