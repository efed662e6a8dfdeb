// SPDX-License-Identifier: MIT
// Kept colours: the cycle in which a kept line can be used, by docs/reference/geometric/memory.md.
// tb/system/geometric_system_test.cpp compares the lines that the resolve reads with the golden
// model.
#include <deque>
#include <set>

#include "tb/unit/rtl/geometric/resolve_bench.h"

namespace deburr::tb::geometric_rtl::kept_colours_test {
namespace {

using namespace rtl::geometric;  // NOLINT: names of units and tokens
using spec::geometric::CacheLines;

// ---- ColourStore

Parameters keeping(int lines, int resolve_lines = 16) {
  Parameters p;
  p.colour_lines = lines;
  p.resolve_lines = resolve_lines;
  return p;
}
rtl::Line line_of(std::uint8_t value) {
  rtl::Line line;
  line.fill(value);
  return line;
}
constexpr std::uint32_t kA = 101, kB = 102, kC = 103, kD = 104;  // tags

struct Store {
  explicit Store(const Parameters& p) : store(p), filler(store.filler()), reader(store.reader()) {}
  void miss(rtl::Cycle cycle, std::uint32_t tag) { places.push_back(read(cycle, tag).place); }
  ColourStore::Filler::Ordered read(rtl::Cycle cycle, std::uint32_t tag) {
    EXPECT_FALSE(filler.find(tag).has_value());
    EXPECT_TRUE(filler.can_order_read(cycle));
    return filler.order_read(cycle, tag);
  }
  void hit(rtl::Cycle cycle, std::uint32_t tag) {
    const auto place = filler.find(tag);
    ASSERT_TRUE(place.has_value());
    ASSERT_TRUE(filler.can_order_kept(cycle));
    filler.order_kept(cycle, *place);
  }
  // The response to the oldest miss.
  void fill(rtl::Cycle cycle, std::uint8_t value) {
    filler.fill(cycle, places.front(), line_of(value));
    places.pop_front();
  }
  // One cycle of the reader: takes a line if it is ready, otherwise returns -1.
  int take(rtl::Cycle cycle) {
    int value = -1;
    if (reader.ready(cycle)) {
      value = reader.line(cycle)[63];
      reader.release(cycle);
    }
    reader.read_ahead(cycle);
    return value;
  }
  ColourStore store;
  ColourStore::Filler filler;
  ColourStore::Reader reader;
  std::deque<std::uint32_t> places;
};

TEST(ColourStore, HitIsReadyTwoCyclesAfterItsLookup) {
  Store s(keeping(2));
  s.miss(1, kA);
  s.fill(10, 7);
  for (rtl::Cycle c = 1; c < 12; ++c) EXPECT_EQ(s.take(c), -1) << c;
  EXPECT_EQ(s.take(12), 7);
  s.hit(20, kA);
  EXPECT_EQ(s.take(20), -1);
  EXPECT_EQ(s.take(21), -1);
  EXPECT_EQ(s.take(22), 7);
}
// A miss, a hit on it while it is in flight, an older hit, a miss: one per cycle.
TEST(ColourStore, OneLinePerCycleHitOrMiss) {
  Store s(keeping(2));
  s.miss(1, kA);
  s.fill(2, 1);
  for (rtl::Cycle c = 1; c < 10; ++c) s.take(c);
  s.miss(10, kB);
  s.hit(11, kB);
  s.hit(12, kA);
  s.miss(13, kC);
  s.fill(30, 2);
  s.fill(31, 3);
  for (rtl::Cycle c = 10; c < 32; ++c) EXPECT_EQ(s.take(c), -1) << c;
  EXPECT_EQ(s.take(32), 2);
  EXPECT_EQ(s.take(33), 2);
  EXPECT_EQ(s.take(34), 1);
  EXPECT_EQ(s.take(35), 3);
}
// Eight entries, and one that is being taken.
TEST(ColourStore, FullOrderQueueBlocksHitsAndMisses) {
  Store s(keeping(1));
  s.miss(1, kA);
  for (rtl::Cycle c = 2; c < 10; ++c) {
    s.take(c - 1);
    s.hit(c, kA);
  }
  s.take(9);
  EXPECT_FALSE(s.filler.can_order_kept(10));
  EXPECT_FALSE(s.filler.can_order_read(10));
  s.fill(10, 1);
  s.take(10);
  s.take(11);
  EXPECT_EQ(s.take(12), 1);
  EXPECT_FALSE(s.filler.can_order_kept(12));
  EXPECT_TRUE(s.filler.can_order_kept(13));
  // A miss also needs a line in the store.
  Store m(keeping(8));
  for (std::uint32_t i = 0; i < 8; ++i) {
    m.miss(1 + i, 200 + i);
    m.take(1 + i);
  }
  EXPECT_TRUE(m.filler.can_order_kept(10));
  EXPECT_FALSE(m.filler.can_order_read(10));
}
TEST(ColourStore, FrameAndResetStartEmpty) {
  for (const bool reset : {false, true}) {
    Store s(keeping(3));
    s.miss(1, kA);
    s.fill(2, 1);
    for (rtl::Cycle c = 1; c < 5; ++c) s.take(c);
    s.miss(5, kB);
    s.hit(6, kA);
    if (reset) {
      s.take(6);
      s.filler.reset();
    } else {
      s.fill(7, 2);
      for (rtl::Cycle c = 6; c < 12; ++c) s.take(c);
      s.filler.clear();
    }
    EXPECT_FALSE(s.filler.find(kA).has_value());
    EXPECT_FALSE(s.filler.find(kB).has_value());
    s.places.clear();
    for (rtl::Cycle c = 12; c < 15; ++c) EXPECT_EQ(s.take(c), -1);
    // The first line of the store again.
    s.miss(20, kC);
    s.miss(21, kD);
    EXPECT_EQ(s.filler.find(kC), 0);
    s.fill(22, 3);
    s.fill(23, 4);
    for (rtl::Cycle c = 20; c < 24; ++c) s.take(c);
    EXPECT_EQ(s.take(24), 3);
    EXPECT_EQ(s.take(25), 4);
  }
}
TEST(ColourStore, EachLineHasItsOwnTag) {
  std::set<std::uint32_t> tags;
  for (const std::uint32_t u : {0u, 1u, 511u})
    for (const std::uint32_t v : {0u, 1u, 511u, 2047u, 4095u, 8191u}) {
      const std::uint32_t raster = ColourStore::Filler::tag_of(false, u, v);
      EXPECT_TRUE(tags.insert(raster).second);
      EXPECT_NE(raster, 0u);
      EXPECT_LT(raster, 1u << 23);
    }
  tags.clear();
  for (const std::uint32_t u : {0u, 1u, 511u, 1024u, 2047u})
    for (const std::uint32_t v : {0u, 1u, 511u, 1023u, 2047u}) {
      const std::uint32_t tiled = ColourStore::Filler::tag_of(true, u, v);
      EXPECT_TRUE(tags.insert(tiled).second);
      EXPECT_LT(tiled, 1u << 23);
    }
}

// ---- the resolve

Parameters kept(int lines) {
  Parameters p;
  p.colour_lines = lines;
  p.weight_blocks = CacheLines::k1024;
  return p;
}

// The only line of the second block is kept, and the previous block's line came long before. The
// line is taken in the second cycle after its lookup, in stage 1 of the Resolver.
TEST(KeptColours, LatencyOfAKeptBlockMatchesDatasheets) {
  ResolveBench b(kept(4), 256, 64);
  // Block (1, 1) takes from the right and reads both lines; block (2, 1) needs only its own.
  b.touch(1, 1, 1u << 7, true, true);
  b.touch(2, 1, 1u << 5);
  b.before_cycle = [&b] {
    if (b.touched.pops() == 1 && !b.at["touched"].empty() &&
        b.clock.cycle() < b.at["touched"][0] + 100)
      b.touched.hold_pop(b.clock.cycle());
  };
  b.run();
  EXPECT_EQ(b.fetch.lines_read.value(), 2u);
  ASSERT_EQ(b.at["hits"].size(), 1u);
  ASSERT_EQ(b.at["writes"].size(), 2u);
  expect_latency(BlockFetch::datasheet(), b.at["blocks"][1] + 1 - b.at["fetched"][1]);
  EXPECT_EQ(b.at["hits"][0], b.at["blocks"][1]);
  expect_latency(Resolver::datasheet(), b.at["writes"][1] - b.at["hits"][0] - 2 + 1);
}

// One cycle for each line of a block, hit or miss.
TEST(KeptColours, OneCyclePerLine) {
  for (const int lines : {0, 128}) {
    const std::string got = in_child([lines] {
      ResolveBench b(kept(lines), 256, 64);
      // All of them are looked up before the first write.
      for (int x = 1; x < 13; ++x) b.touch(x, 1, 1u << 4, true);
      b.run();
      const auto& blocks = b.at["blocks"];
      std::string text;
      for (std::size_t i = 1; i < 12; ++i) text += std::to_string(blocks[i] - blocks[i - 1]) + " ";
      return text + std::to_string(b.fetch.lines_kept.value());
    });
    std::string wanted;
    for (int i = 1; i < 12; ++i) wanted += "2 ";
    EXPECT_EQ(got, wanted + (lines == 0 ? "0" : "11"));
  }
}

// Hits do not need a free line of the store, but they need an entry in the order of lines.
TEST(KeptColours, StallsWithoutAFreeEntry) {
  const auto waits = [](int lines) {
    return in_child([lines] {
      Parameters p = kept(lines);
      p.resolve_lines = 16;
      ResolveBench b(p, 256, 64, 200);
      for (int x = 1; x < 41; ++x) b.touch(x, 1, 1u << 4, true);
      b.run();
      if (b.resolved.size() != 40) return std::string("lost");
      const Cycle cycles = b.at["writes"].back() - b.at["reads"].front();
      return std::string(stalls(b.fetch, "colours") > 0 ? "stalls " : "never ") +
             std::to_string(cycles / 100);
    });
  };
  // Eight lines per round trip of about 208 cycles, for 80 lines, or 41 of 80 with kept colours.
  EXPECT_EQ(waits(0), "stalls 20");
  EXPECT_EQ(waits(128), "stalls 18");
}

}  // namespace
}  // namespace deburr::tb::geometric_rtl::kept_colours_test
