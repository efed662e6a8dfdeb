// SPDX-License-Identifier: MIT
#include "tb/base/file.h"

#include <gtest/gtest.h>

#include "tb/harness/test_paths.h"

namespace deburr::tb::file_test {
namespace {

// User text may be taken for a file name: for 300 characters the system returns an error.
TEST(FileNames, OverlongNameCountsAsMissing) {
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
