// SPDX-License-Identifier: MIT
// The FillBuffer alone: in which clock a line is there, and what its memory refuses.
#include "rtl_model/texture/fill_buffer.h"

#include "spec/error.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl {
namespace {

using rtl::texture::FillBuffer;

constexpr std::array<std::uint8_t, 64> kBeat = {11, 22};

// What comes in t is read in t + 1 and there in t + 2; the next line a clock after the first was
// used.
TEST(TextureRtlFillBuffer, ALineIsThereTwoClocksAfterItsBeat) {
  FillBuffer buffer("buffer", 4, 64);
  for (int i = 0; i < 3; ++i) buffer.reserve(1);
  buffer.fill(10, 0, 0, kBeat, true);
  buffer.read_ahead(10);
  EXPECT_FALSE(buffer.ready(11));
  buffer.fill(11, 1, 0, kBeat, true);
  buffer.read_ahead(11);
  EXPECT_FALSE(buffer.ready(11));
  EXPECT_THROW(buffer.line(11), spec::CheckFailed);  // its word comes in 12
  ASSERT_TRUE(buffer.ready(12));
  EXPECT_EQ(buffer.line(12)[1], 22);
  buffer.release(12);
  buffer.read_ahead(12);
  ASSERT_TRUE(buffer.ready(13));
  buffer.release(13);
  buffer.read_ahead(13);
  EXPECT_FALSE(buffer.ready(14));
  EXPECT_THROW(buffer.line(14), spec::CheckFailed);  // there is still the line of before
}

TEST(TextureRtlFillBuffer, OneBeatAClock) {
  FillBuffer buffer("buffer", 4, 64);
  buffer.reserve(1);
  buffer.reserve(2);
  buffer.fill(10, 0, 0, kBeat, true);
  EXPECT_THROW(buffer.fill(10, 1, 0, kBeat, true), spec::CheckFailed);
}

// Above 16 kbit it is SRAM; a line of two beats is written half by half.
TEST(TextureRtlFillBuffer, LinesOf128BytesComeInTwoBeats) {
  FillBuffer buffer("buffer", 64, 128);
  buffer.reserve(1);
  buffer.fill(10, 0, 64, kBeat, false);
  buffer.read_ahead(11);
  EXPECT_FALSE(buffer.ready(12));
  buffer.fill(12, 0, 0, kBeat, true);
  buffer.read_ahead(13);
  ASSERT_TRUE(buffer.ready(14));
  EXPECT_EQ(buffer.line(14)[65], 22);
  EXPECT_EQ(buffer.line(14)[0], 11);
}

// The output register has one word: the next line cannot be read in the clock in which the one
// before it was.
TEST(TextureRtlFillBuffer, OneReadAClock) {
  FillBuffer buffer("buffer", 4, 64);
  for (std::uint32_t i = 0; i < 2; ++i) {
    buffer.reserve(1);
    buffer.fill(10 + i, i, 0, kBeat, true);
  }
  buffer.read_ahead(12);
  buffer.release(12);
  EXPECT_THAT(refusal([&] { buffer.read_ahead(12); }), Refuses("buffer", kTooMany));
}

// An entry that is used again: the line before it still stands on the output register.
TEST(TextureRtlFillBuffer, TheLineBeforeInTheSameEntryIsStale) {
  FillBuffer buffer("buffer", 1, 64);
  buffer.reserve(1);
  buffer.fill(10, 0, 0, kBeat, true);
  buffer.read_ahead(11);
  buffer.line(12);
  buffer.release(12);
  buffer.reserve(13);
  buffer.fill(20, 0, 0, kBeat, true);
  buffer.read_ahead(21);
  EXPECT_THAT(refusal([&] { buffer.line(21); }), Refuses("buffer", kEarly));
  EXPECT_EQ(refusal([&] { buffer.line(22); }), "nothing");
}

TEST(TextureRtlFillBuffer, EachBeatComesOnce) {
  FillBuffer buffer("buffer", 4, 64);
  buffer.reserve(1);
  buffer.fill(10, 0, 0, kBeat, true);
  EXPECT_THAT(refusal([&] { buffer.fill(11, 0, 0, kBeat, true); }), Refuses("buffer", "twice"));
  EXPECT_THAT(refusal([&] { buffer.fill(12, 4, 0, kBeat, true); }), Refuses("buffer", "entry 4"));
}

}  // namespace
}  // namespace deburr::tb::texture_rtl
