// SPDX-License-Identifier: MIT
// The TagStore alone: replacement policies by hand.
#include "spec/error.h"
#include "tb/unit/rtl/texture/cache_bench.h"

namespace deburr::tb::texture_rtl::tag_store_test {
namespace {

using namespace rtl::texture;

TEST(TextureRtlTagStore, ReplacementFollowsConfiguration) {
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
  // 0xACE1 -> 0x5670, 0xAB38, 0x559C, 0x2ACE, 0x1567, ...: their low two bits; the last ones depend
  // on bits that every tap shifted in.
  for (const std::uint32_t way : {0u, 0u, 0u, 2u, 3u, 3u, 1u, 0u, 2u, 3u, 1u, 2u,
                                  1u, 2u, 1u, 2u, 1u, 0u, 0u, 2u, 1u, 0u, 2u, 3u}) {
    const TagStore::Place place = tags.allocate(100 + way, false);
    EXPECT_EQ(place.slot, way);
    EXPECT_TRUE(place.evicted);
  }
  tags.invalidate();
  EXPECT_EQ(tags.find(102), TagStore::kAbsent);
  for (std::uint32_t line = 0; line < 4; ++line) EXPECT_EQ(tags.allocate(line, false).slot, line);
  // The shift register continues; a reset restarts it.
  for (const std::uint32_t way : {3u, 1u, 0u, 0u})
    EXPECT_EQ(tags.allocate(200 + way, false).slot, way);
  tags.reset();
  for (std::uint32_t line = 0; line < 4; ++line) EXPECT_EQ(tags.allocate(line, false).slot, line);
  for (const std::uint32_t way : {0u, 0u, 0u, 2u})
    EXPECT_EQ(tags.allocate(300 + way, false).slot, way);
}

// The sets are read one cycle before their lookup, each through its own port.
TEST(TextureRtlTagStore, SetsArriveInNextCycle) {
  TagStore tags("tags", small_cache());
  tags.read(5, 0, 2);
  tags.read(5, 1, 3);
  EXPECT_THROW(tags.check(5, 0, 2, 5), spec::CheckFailed);  // one cycle early
  EXPECT_THROW(tags.check(6, 2, 2, 5), spec::CheckFailed);  // this port was not read
  EXPECT_THROW(tags.check(6, 0, 3, 5), spec::CheckFailed);  // the set of another line
  tags.check(6, 0, 2, 5);
  tags.check(6, 1, 3, 5);
  tags.read(6, 0, 3);
  EXPECT_THROW(tags.read(6, 0, 3), spec::CheckFailed);      // too many accesses
  tags.check(6, 0, 2, 5);                                   // the previous word is still there
  EXPECT_THROW(tags.check(7, 0, 2, 6), spec::CheckFailed);  // now it is replaced
}

// A set that is read in every cycle: the word of the previous cycle is not the requested one.
TEST(TextureRtlTagStore, SetOfPreviousCycleIsStale) {
  TagStore tags("tags", small_cache());
  tags.read(5, 0, 2);
  tags.read(6, 0, 2);
  EXPECT_THROW(tags.check(6, 0, 2, 6), spec::CheckFailed);
  tags.check(7, 0, 2, 6);
}

// A set is written once, however many of its lines a request changes; two requests in one cycle
// would write it twice.
TEST(TextureRtlTagStore, SecondWriteOfSetInOneCycleIsRejected) {
  TagStore tags("tags", small_cache());
  tags.allocate(0, false);
  tags.allocate(2, false);
  tags.allocate(1, false);
  tags.commit(3);
  tags.allocate(4, false);
  EXPECT_THROW(tags.commit(3), spec::CheckFailed);
}

// Whichever set the previous request changed.
TEST(TextureRtlTagStore, EveryChangedSetIsWritten) {
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
