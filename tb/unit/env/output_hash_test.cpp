// SPDX-License-Identifier: MIT
// Hashes of engine outputs, compared with independently computed values.
#include <gtest/gtest.h>

#include <cstdint>
#include <initializer_list>

#include "tb/env/environment.h"

namespace deburr::tb::output_hash_test {
namespace {

std::uint64_t hash_of(std::initializer_list<std::uint64_t> values) {
  OutputHash hash;
  for (const std::uint64_t value : values) hash.add(value);
  return hash.value();
}

TEST(OutputHash, DependsOnEveryBitAndOrder) {
  EXPECT_EQ(hash_of({}), 0xCBF29CE484222325u);
  EXPECT_EQ(hash_of({0}), 0xAF63BD49FD1C5DBBu);
  EXPECT_EQ(hash_of({1}), 0xAF63BC49FD1C5448u);
  EXPECT_EQ(hash_of({0x12345678}), 0xA3B5F56E1586C65Fu);
  EXPECT_EQ(hash_of({std::uint64_t{1} << 63}), 0x2F63BD4DFD1C5DBBu);
  EXPECT_EQ(hash_of({1, 2}), 0x22CD3BB8014AE476u);
  EXPECT_EQ(hash_of({2, 1}), 0x22BF2AB802FBFCA8u);
}

}  // namespace
}  // namespace deburr::tb::output_hash_test
