// SPDX-License-Identifier: MIT
// Labels: every letter exists, differs from the others and has the right position.
#include "tb/scene/label.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "spec/error.h"
#include "tb/unit/scene/fixtures.h"

namespace deburr::tb::label_test {
namespace {

constexpr Rgba8 kInk = {10, 20, 30, 255}, kPaper = {250, 240, 230, 255};

TEST(Label, EachCharacterHasItsOwnShape) {
  std::set<std::vector<Rgba8>> seen;
  const std::string all = "abcdefghijklmnopqrstuvwxyzABMS0123456789.-+ ";
  for (const char c : all) seen.insert(label(std::string(1, c), 1, kInk, kPaper).pixels);
  EXPECT_EQ(seen.size(), all.size());
}

TEST(Label, PlacesLettersSideBySideAtAnyScale) {
  const Image one = label("db", 1, kInk, kPaper), three = label("db", 3, kInk, kPaper);
  EXPECT_EQ(one.width, 12);
  EXPECT_EQ(one.height, 9);
  EXPECT_EQ(three.width, 36);
  EXPECT_EQ(three.height, 27);
  for (int y = 0; y < three.height; ++y)
    for (int x = 0; x < three.width; ++x) EXPECT_EQ(three.at(x, y), one.at(x / 3, y / 3));
  // The stems: on the right of d, on the left of b; one background dot after each letter.
  for (int y = 0; y < 7; ++y) {
    EXPECT_EQ(one.at(4, y), kInk);
    EXPECT_EQ(one.at(5, y), kPaper);
    EXPECT_EQ(one.at(6, y), kInk);
    EXPECT_EQ(one.at(11, y), kPaper);
  }
}

TEST(Label, LettersHaveTheDrawnDots) {
  EXPECT_EQ(test::fnv(label("abcdefghijklmnopqrstuvwxyzABMS0123456789.,-+ ", 1, kInk, kPaper)),
            0x5E31BCB3990285BDu);
  EXPECT_EQ(label("", 2).width, 2);
}

TEST(Label, RejectsCharactersWithoutLetter) {
  EXPECT_THROW(label("50 %", 1), spec::ConfigError);
  EXPECT_EQ(label("", 2).height, 18);
}

}  // namespace
}  // namespace deburr::tb::label_test
