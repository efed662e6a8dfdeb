// SPDX-License-Identifier: MIT
// FNV-1a: values published by its authors, byte orders, and a given initial value.
#include "tb/base/fnv.h"

#include <gtest/gtest.h>

#include <string_view>

namespace deburr::tb::fnv_test {
namespace {

std::uint64_t hash_of(std::string_view text) {
  FnvHash hash;
  for (const char c : text) hash.byte(static_cast<unsigned char>(c));
  return hash.value();
}

TEST(Fnv, MatchesPublishedValues) {
  EXPECT_EQ(hash_of(""), 0xCBF29CE484222325u);
  EXPECT_EQ(hash_of("a"), 0xAF63DC4C8601EC8Cu);
  EXPECT_EQ(hash_of("foobar"), 0x85944171F73967E8u);
}

TEST(Fnv, HashesBytesOfWordInEitherOrder) {
  FnvHash lowest, highest;
  lowest.lowest_first(0x6F6F66, 3);
  highest.highest_first(0x666F6F, 3);
  EXPECT_EQ(lowest.value(), hash_of("foo"));
  EXPECT_EQ(highest.value(), hash_of("foo"));
}

TEST(Fnv, UsesLowestByteOfWiderValues) {
  FnvHash hash;
  hash.byte(0x161);
  EXPECT_EQ(hash.value(), hash_of("a"));
}

TEST(Fnv, ContinuesFromGivenValue) {
  FnvHash hash{hash_of("foo")};
  for (const char c : std::string_view("bar")) hash.byte(static_cast<unsigned char>(c));
  EXPECT_EQ(hash.value(), hash_of("foobar"));
}

TEST(Fnv, StepHashesWholeWord) {
  EXPECT_EQ(fnv_step(kFnvStart, 'a'), hash_of("a"));
  EXPECT_NE(fnv_step(kFnvStart, 0x161), hash_of("a"));
}

}  // namespace
}  // namespace deburr::tb::fnv_test
