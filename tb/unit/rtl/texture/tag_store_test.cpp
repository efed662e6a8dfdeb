// SPDX-License-Identifier: MIT
// The TagStore alone: the rules of replacement by hand.
#include "tb/unit/rtl/texture/cache_bench.h"

namespace deburr::tb::texture_rtl {
namespace {

using namespace rtl::texture;

TEST(TextureRtlTagStore, ReplacementRules) {
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
        tags.allocate(line);
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
  for (std::uint32_t line = 0; line < 4; ++line) EXPECT_EQ(tags.allocate(line).slot, line);
  // 0xACE1 -> 0x5670, 0xAB38, 0x559C, 0x2ACE, 0x1567, ...: their low two bits; the last ones come
  // from bits that were shifted in, from every tap.
  for (const std::uint32_t way : {0u, 0u, 0u, 2u, 3u, 3u, 1u, 0u, 2u, 3u, 1u, 2u,
                                  1u, 2u, 1u, 2u, 1u, 0u, 0u, 2u, 1u, 0u, 2u, 3u}) {
    const TagStore::Place place = tags.allocate(100 + way);
    EXPECT_EQ(place.slot, way);
    EXPECT_TRUE(place.evicted);
  }
  tags.invalidate();
  EXPECT_EQ(tags.find(102), TagStore::kAbsent);
  EXPECT_EQ(tags.allocate(7).slot, 0u);
}

}  // namespace
}  // namespace deburr::tb::texture_rtl
