// SPDX-License-Identifier: MIT
#include "tb/base/file.h"

#include <gtest/gtest.h>

#include "tb/harness/test_paths.h"

namespace deburr::tb::file_test {
namespace {

// A user's text may be taken for a name: no system gives an answer for one of 300 characters.
TEST(FileNames, WhatCannotBeAskedForIsNotThere) {
  const std::string too_long(300, 'a');
  EXPECT_FALSE(is_there(too_long));
  EXPECT_FALSE(is_folder(too_long));
  EXPECT_FALSE(is_there(source_folder() / "README.md" / "below_a_file"));
  EXPECT_TRUE(is_there(source_folder() / "README.md"));
  EXPECT_FALSE(is_folder(source_folder() / "README.md"));
  EXPECT_TRUE(is_folder(source_folder() / "docs"));
}

}  // namespace
}  // namespace deburr::tb::file_test
