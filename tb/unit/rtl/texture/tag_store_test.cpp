// SPDX-License-Identifier: MIT
// The TagStore alone: the rules of replacement by hand.
#include "spec/error.h"
#include "tb/unit/rtl/texture/cache_bench.h"

namespace deburr::tb::texture_rtl::tag_store_test {
namespace {

using namespace rtl::texture;

TEST(TextureRtlTagStore, ReplacementConfiguration) {
  struct Row {
    spec::texture::Replacement rule;
    std::vector<std::uint64_t> fills;
  };
  // Two ways, lines a b a c a d a. lru keeps a. fifo: c replaces a, a replaces b, d replaces c.
  // `random` from 0xACE1: r = 0x5670 (even: way 0), then 0xAB38 (way 0), 0x559C (way 0).
  const std::vector<std::uint32_t> lines = {0, 2, 0, 4, 0, 6, 0};
  const std::vector<Row> rows = {{spec::texture::Replacement::kLru, {0, 2, 4, 6}},
                                 {spec::texture::Replacement::kFifo, {0, 2, 4, 0, 6}},
                                 {spec::texture::Replacement::kRandom, {0, 2, 4, 0, 6, 0}}};
  for (const Row& row : rows) {
    spec::texture::Parameters p = small_cache();
    p.cache_replacement = row.rule;
    TagStore tags(spec::texture::kReplacementNames[static_cast<std::size_t>(row.rule)].data(), p);
    std::vector<std::uint64_t> fills;
    for (const std::uint32_t line : lines) {
      if (const std::uint32_t slot = tags.find(line); slot != TagStore::kAbsent) {
        tags.use(slot);
      } else {
        fills.push_back(line);
        tags.allocate(line, false);
      }
    }
    EXPECT_EQ(fills, row.fills)
        << spec::texture::kReplacementNames[static_cast<std::size_t>(row.rule)];
  }
}

TEST(TextureRtlTagStore, RandomReplacementStepsOnlyForValidLines) {
  spec::texture::Parameters p = small_cache();
  p.cache_replacement = spec::texture::Replacement::kRandom;
  p.cache_ways = 4;  // one set
  TagStore tags("tags", p);
  for (std::uint32_t line = 0; line < 4; ++line) EXPECT_EQ(tags.allocate(line, false).slot, line);
  // 0xACE1 -> 0x5670, 0xAB38, 0x559C, 0x2ACE, 0x1567, ...: their low two bits; the last ones come
  // from bits that were shifted in, from every tap.
  for (const std::uint32_t way : {0u, 0u, 0u, 2u, 3u, 3u, 1u, 0u, 2u, 3u, 1u, 2u,
                                  1u, 2u, 1u, 2u, 1u, 0u, 0u, 2u, 1u, 0u, 2u, 3u}) {
    const TagStore::Place place = tags.allocate(100 + way, false);
    EXPECT_EQ(place.slot, way);
    EXPECT_TRUE(place.evicted);
  }
  tags.invalidate();
  EXPECT_EQ(tags.find(102), TagStore::kAbsent);
  for (std::uint32_t line = 0; line < 4; ++line) EXPECT_EQ(tags.allocate(line, false).slot, line);
  // The shift register goes on where it was; a reset begins it again.
  for (const std::uint32_t way : {3u, 1u, 0u, 0u})
    EXPECT_EQ(tags.allocate(200 + way, false).slot, way);
  tags.reset();
  for (std::uint32_t line = 0; line < 4; ++line) EXPECT_EQ(tags.allocate(line, false).slot, line);
  for (const std::uint32_t way : {0u, 0u, 0u, 2u})
    EXPECT_EQ(tags.allocate(300 + way, false).slot, way);
}

// The sets are read a clock before they are looked up, each through a port of its own.
TEST(TextureRtlTagStore, SetsComeInTheNextClock) {
  TagStore tags("tags", small_cache());
  tags.read(5, 0, 2);
  tags.read(5, 1, 3);
  EXPECT_THROW(tags.check(5, 0, 2, 5), spec::CheckFailed);  // a clock early
  EXPECT_THROW(tags.check(6, 2, 2, 5), spec::CheckFailed);  // nobody asked this port
  EXPECT_THROW(tags.check(6, 0, 3, 5), spec::CheckFailed);  // the set of another line
  tags.check(6, 0, 2, 5);
  tags.check(6, 1, 3, 5);
  tags.read(6, 0, 3);
  EXPECT_THROW(tags.read(6, 0, 3), spec::CheckFailed);      // one access too many
  tags.check(6, 0, 2, 5);                                   // the word of before is still there
  EXPECT_THROW(tags.check(7, 0, 2, 6), spec::CheckFailed);  // and now it is not
}

// A set that is read in every clock: the word of the clock before is not the one that has been
// asked for.
TEST(TextureRtlTagStore, TheSetOfTheClockBeforeIsStale) {
  TagStore tags("tags", small_cache());
  tags.read(5, 0, 2);
  tags.read(6, 0, 2);
  EXPECT_THROW(tags.check(6, 0, 2, 6), spec::CheckFailed);
  tags.check(7, 0, 2, 6);
}

// However many lines of a set a request changes, the set is written once; two requests in a clock
// would write twice.
TEST(TextureRtlTagStore, ASetIsWrittenOnceAClock) {
  TagStore tags("tags", small_cache());
  tags.allocate(0, false);
  tags.allocate(2, false);
  tags.allocate(1, false);
  tags.commit(3);
  tags.allocate(4, false);
  EXPECT_THROW(tags.commit(3), spec::CheckFailed);
}

// Whichever set the request before has changed.
TEST(TextureRtlTagStore, EverySetThatChangesIsWritten) {
  TagStore tags("tags", small_cache());
  std::uint64_t writes = 0;
  Cycle cycle = 0;
  for (const std::uint32_t line : {0u, 2u, 1u, 3u, 4u, 6u}) {
    tags.allocate(line, false);
    tags.commit(++cycle);
    ++writes;
    rtl::for_each<rtl::PortedMemory>(
        [&](const rtl::PortedMemory& memory) { EXPECT_EQ(memory.writes(), writes); });
  }
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::tag_store_test
