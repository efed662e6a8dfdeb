// SPDX-License-Identifier: MIT
// The FillBuffer alone: when a line is available, and what its memory rejects.
#include "rtl_model/texture/fill_buffer.h"

#include "spec/error.h"
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::fill_buffer_test {
namespace {

using rtl::texture::FillBuffer;

constexpr std::array<std::uint8_t, 64> kBeat = {11, 22};

// A beat that arrives in t is read in t + 1 and available in t + 2; the next line follows one cycle
// after the first was used.
TEST(TextureRtlFillBuffer, LineIsAvailableTwoCyclesAfterBeat) {
  FillBuffer buffer("buffer", 4, 64);
  FillBuffer::Reader lines = buffer.reader();
  const Cycle there = 10 + FillBuffer::datasheet().latency.cycles;
  for (int i = 0; i < 3; ++i) buffer.reserve(1);
  buffer.fill(10, 0, 0, kBeat, true);
  lines.read_ahead(10);
  EXPECT_FALSE(lines.ready(11));
  buffer.fill(11, 1, 0, kBeat, true);
  lines.read_ahead(11);
  EXPECT_FALSE(lines.ready(11));
  EXPECT_THROW(lines.line(11), spec::CheckFailed);  // its word arrives in 12
  EXPECT_FALSE(lines.ready(there - 1));
  ASSERT_TRUE(lines.ready(there));
  EXPECT_EQ(lines.line(there)[1], 22);
  lines.release(12);
  lines.read_ahead(12);
  ASSERT_TRUE(lines.ready(13));
  lines.release(13);
  lines.read_ahead(13);
  EXPECT_FALSE(lines.ready(14));
  EXPECT_THROW(lines.line(14), spec::CheckFailed);  // still the previous line
}

TEST(TextureRtlFillBuffer, SecondBeatInOneCycleIsRejected) {
  FillBuffer buffer("buffer", 4, 64);
  buffer.reserve(1);
  buffer.reserve(2);
  buffer.fill(10, 0, 0, kBeat, true);
  EXPECT_THROW(buffer.fill(10, 1, 0, kBeat, true), spec::CheckFailed);
  // Whether or not it completes its line.
  FillBuffer wide("wide", 4, 128);
  wide.reserve(1);
  wide.fill(10, 0, 0, kBeat, false);
  EXPECT_THROW(wide.fill(10, 0, 64, kBeat, false), spec::CheckFailed);
}

// Rejects a beat for the second half of a line that has only one, as in a broken response.
TEST(TextureRtlFillBuffer, RejectsBeatPastTheLine) {
  FillBuffer buffer("buffer", 4, 64);
  buffer.reserve(1);
  EXPECT_THROW(buffer.fill(10, 0, 64, kBeat, true), spec::CheckFailed);
  FillBuffer wide("wide", 4, 128);
  wide.reserve(1);
  wide.fill(10, 0, 64, kBeat, false);
  EXPECT_THROW(wide.fill(11, 0, 128, kBeat, true), spec::CheckFailed);
}

// Above 16 kbit it is SRAM; a line of two beats is written by halves.
TEST(TextureRtlFillBuffer, LinesOf128BytesArriveInTwoBeats) {
  FillBuffer buffer("buffer", 64, 128);
  FillBuffer::Reader lines = buffer.reader();
  buffer.reserve(1);
  buffer.fill(10, 0, 64, kBeat, false);
  lines.read_ahead(11);
  EXPECT_FALSE(lines.ready(12));
  buffer.fill(12, 0, 0, kBeat, true);
  lines.read_ahead(13);
  ASSERT_TRUE(lines.ready(14));
  EXPECT_EQ(lines.line(14)[65], 22);
  EXPECT_EQ(lines.line(14)[0], 11);
}

// The output register holds one word: two lines cannot be read in the same cycle.
TEST(TextureRtlFillBuffer, SecondReadInOneCycleIsRejected) {
  FillBuffer buffer("buffer", 4, 64);
  FillBuffer::Reader lines = buffer.reader();
  for (std::uint32_t i = 0; i < 2; ++i) {
    buffer.reserve(1);
    buffer.fill(10 + i, i, 0, kBeat, true);
  }
  lines.read_ahead(12);
  lines.release(12);
  EXPECT_THAT(rejection([&] { lines.read_ahead(12); }), Rejects("buffer", kTooMany));
}

// Four banks: each reads ahead its oldest line, so four lines are there in one cycle, and the next
// one of a bank a cycle after it was used.
TEST(TextureRtlFillBuffer, EachBankReadsAheadOneLine) {
  FillBuffer buffer("buffer", 8, 64, 4);
  FillBuffer::Reader lines = buffer.reader();
  for (std::uint32_t i = 0; i < 7; ++i) {
    EXPECT_EQ(buffer.reserve(1), i);
    std::array<std::uint8_t, 64> beat{};
    beat[0] = static_cast<std::uint8_t>(i);
    if (i != 5) buffer.fill(2 + i, i, 0, beat, true);
    lines.read_ahead(2 + i);
  }
  const auto use = [&](Cycle cycle) {
    std::vector<int> used;
    for (; lines.ready(cycle); lines.release(cycle)) used.push_back(lines.line(cycle)[0]);
    lines.read_ahead(cycle);
    return used;
  };
  EXPECT_FALSE(lines.ready(3));
  EXPECT_EQ(buffer.held(20), 7u);
  EXPECT_THAT(use(20), testing::ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(buffer.held(20), 7u) << "free in the next cycle";
  EXPECT_EQ(buffer.held(21), 3u);
  buffer.fill(20, 5, 0, kBeat, true);             // is read in 21 and there in 22
  EXPECT_THAT(use(21), testing::ElementsAre(4));  // read in 20
  EXPECT_THAT(use(22), testing::ElementsAre(11, 6));
  EXPECT_TRUE(buffer.can_reserve(23));
  for (std::uint32_t i = 7; i < 15; ++i) EXPECT_EQ(buffer.reserve(23), i % 8);
  EXPECT_FALSE(buffer.can_reserve(23));
  // Entry 0 is the second line of the next round: bank 0 waits for it, bank 3 for entry 7.
  buffer.fill(24, 0, 0, kBeat, true);
  lines.read_ahead(25);
  EXPECT_FALSE(lines.ready(26));
  buffer.fill(26, 7, 0, kBeat, true);
  lines.read_ahead(27);
  EXPECT_EQ(use(28).size(), 2u);
  buffer.reset();
  EXPECT_EQ(buffer.reserve(30), 0u);
  buffer.fill(30, 0, 0, kBeat, true);
  lines.read_ahead(31);
  EXPECT_EQ(use(32).size(), 1u);
}

// A bank has one output register, and one line of a bank is used per cycle.
TEST(TextureRtlFillBuffer, SecondReadOfBankIsRejected) {
  FillBuffer buffer("buffer", 8, 64, 4);
  FillBuffer::Reader lines = buffer.reader();
  for (std::uint32_t i = 0; i < 5; ++i) {
    buffer.reserve(1);
    buffer.fill(10 + i, i, 0, kBeat, true);
  }
  lines.read_ahead(16);
  for (int i = 0; i < 4; ++i) lines.release(16);
  EXPECT_THAT(rejection([&] { lines.read_ahead(16); }), Rejects("buffer", kTooMany));
}

// A reused entry: the output register still holds the previous line.
TEST(TextureRtlFillBuffer, PreviousLineOfSameEntryIsStale) {
  FillBuffer buffer("buffer", 1, 64);
  FillBuffer::Reader lines = buffer.reader();
  buffer.reserve(1);
  buffer.fill(10, 0, 0, kBeat, true);
  lines.read_ahead(11);
  lines.line(12);
  lines.release(12);
  buffer.reserve(13);
  buffer.fill(20, 0, 0, kBeat, true);
  lines.read_ahead(21);
  EXPECT_THAT(rejection([&] { lines.line(21); }), Rejects("buffer", kEarly));
  EXPECT_EQ(rejection([&] { lines.line(22); }), "nothing");
}

// Each beat is written, each line is read once, and its bit is set once and cleared once.
TEST(TextureRtlFillBuffer, AccessesMatchBeatsAndLines) {
  FillBuffer buffer("buffer", 4, 128);
  FillBuffer::Reader lines = buffer.reader();
  buffer.reserve(1);
  buffer.fill(10, 0, 0, kBeat, false);
  buffer.fill(11, 0, 64, kBeat, true);
  lines.read_ahead(12);
  lines.line(13);
  lines.release(13);
  std::string accesses;
  rtl::for_each<rtl::PortedMemory>([&](const rtl::PortedMemory& memory) {
    accesses += std::string(memory.name()) + " " + std::to_string(memory.reads()) + "R" +
                std::to_string(memory.writes()) + "W ";
  });
  EXPECT_EQ(accesses, "buffer 1R2W buffer_arrived 1R2W ");
}

// Flip-flops up to 16 kbit, SRAM above; a line of two beats needs a write mask.
TEST(TextureRtlFillBuffer, MemoryKindDependsOnSize) {
  const auto built = [](std::uint32_t entries, std::uint32_t line_bytes,
                        std::uint32_t banks = 1) -> std::string {
    const FillBuffer buffer("buffer", entries, line_bytes, banks);
    std::string text;
    rtl::for_each<rtl::MemoryBase>([&](const rtl::MemoryBase& memory) {
      if (std::string(memory.name()) == "buffer")
        text = std::to_string(memory.words()) + " x " + std::to_string(memory.word_bits()) + " " +
               memory.built_as();
    });
    return text;
  };
  EXPECT_EQ(built(32, 64), "32 x 512 flip-flops");
  EXPECT_EQ(built(33, 64), "33 x 512 1R1W");
  EXPECT_EQ(built(64, 32), "64 x 256 flip-flops");
  EXPECT_EQ(built(16, 128), "16 x 1024 flip-flops, write mask of 512 bits");
  EXPECT_EQ(built(17, 128), "17 x 1024 1R1W, write mask of 512 bits");
  EXPECT_EQ(built(64, 64, 2), "64 x 512 1R1W, 2 banks");
  EXPECT_EQ(built(128, 64, 4), "128 x 512 1R1W, 4 banks");
}

TEST(TextureRtlFillBuffer, RejectsReservationBeyondItsEntries) {
  FillBuffer buffer("buffer", 2, 64);
  FillBuffer::Reader lines = buffer.reader();
  EXPECT_EQ(buffer.reserve(1), 0u);
  EXPECT_TRUE(buffer.can_reserve(2));
  EXPECT_EQ(buffer.reserve(2), 1u);
  EXPECT_FALSE(buffer.can_reserve(3));
  EXPECT_THAT(rejection([&] { buffer.reserve(3); }), Rejects("buffer", "no free entry"));
  buffer.fill(4, 0, 0, kBeat, true);
  lines.read_ahead(5);
  lines.release(6);
  EXPECT_FALSE(buffer.can_reserve(6));  // free from the next cycle on
  EXPECT_EQ(buffer.reserve(7), 0u);
}

TEST(TextureRtlFillBuffer, RejectsRepeatedBeat) {
  FillBuffer buffer("buffer", 4, 64);
  buffer.reserve(1);
  buffer.fill(10, 0, 0, kBeat, true);
  EXPECT_THAT(rejection([&] { buffer.fill(11, 0, 0, kBeat, true); }), Rejects("buffer", "twice"));
  EXPECT_THAT(rejection([&] { buffer.fill(12, 4, 0, kBeat, true); }), Rejects("buffer", "entry 4"));
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::fill_buffer_test
