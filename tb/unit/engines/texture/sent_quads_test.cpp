// SPDX-License-Identifier: MIT
// A colour finds the pixel of its quad, once; an impossible colour is an error, or ignored where
// any colour is allowed.
#include "tb/engines/texture/sent_quads.h"

#include <gtest/gtest.h>

#include "spec/error.h"

namespace deburr::tb::sent_quads_test {
namespace {

traces::TracedQuad quad(std::uint32_t tag, std::uint8_t coverage) {
  traces::TracedQuad q;
  q.quad.tag = tag;
  q.quad.coverage = coverage;
  q.quad.x = 2;
  q.quad.y = 4;
  q.placed = true;
  return q;
}

spec::texture::Colour colour(std::uint32_t tag, std::uint8_t lane) {
  return {tag, lane, false, {1, 2, 3, 4}};
}

TEST(SentQuads, EachLaneIsTakenOnce) {
  SentQuads sent;
  sent.add(quad(0, 0b1010));
  sent.add(quad(1, 0xF));
  EXPECT_EQ(sent.take(colour(0, 1), true)->quad.tag, 0u);
  EXPECT_THROW(sent.take(colour(0, 1), true), spec::CheckFailed) << "twice";
  EXPECT_EQ(sent.take(colour(0, 1), false), nullptr);
  EXPECT_THROW(sent.take(colour(0, 0), true), spec::CheckFailed) << "not covered";
  EXPECT_THROW(sent.take(colour(2, 0), true), spec::CheckFailed) << "never sent";
  EXPECT_EQ(sent.take(colour(2, 0), false), nullptr);
  EXPECT_EQ(sent.take(colour(0, 4), false), nullptr);
  EXPECT_EQ(sent.take(colour(0xFFFFFFFF, 0), false), nullptr);
  EXPECT_EQ(sent.take(colour(0, 3), true)->quad.tag, 0u);
  EXPECT_EQ(sent.find(1)->quad.tag, 1u);
  EXPECT_THROW(sent.add(quad(5, 1)), spec::CheckFailed) << "out of order";
}

// Complete quads are removed; incomplete ones remain until later ones have been sent.
TEST(SentQuads, RemovesCompleteQuads) {
  SentQuads sent;
  constexpr std::uint32_t kMany = 20000;
  for (std::uint32_t tag = 0; tag < kMany; ++tag) {
    sent.add(quad(tag, 1));
    if (tag != 0 && tag != 10) {
      EXPECT_NE(sent.take(colour(tag, 0), true), nullptr);
    }
  }
  EXPECT_EQ(sent.find(0), nullptr);
  EXPECT_EQ(sent.find(10), nullptr);
  EXPECT_NE(sent.find(kMany - 4096), nullptr);
  SentQuads waiting;
  for (std::uint32_t tag = 0; tag < kMany; ++tag) waiting.add(quad(tag, 1));
  EXPECT_NE(waiting.take(colour(0, 0), true), nullptr) << "nothing has come yet: nothing is done";
}

TEST(Show, WritesColourToItsPixel) {
  Image picture(8, 8);
  traces::TracedQuad q = quad(0, 0xF);
  q.visible = 0b0111;
  show(q, colour(0, 2), picture);
  EXPECT_EQ(picture.at(2, 5), (Rgba8{1, 2, 3, 4}));
  const Image before = picture;
  show(q, colour(0, 3), picture);
  q.placed = false;
  show(q, colour(0, 0), picture);
  EXPECT_EQ(picture.pixels, before.pixels);
}

}  // namespace
}  // namespace deburr::tb::sent_quads_test
