// SPDX-License-Identifier: MIT
// Colours that are kept: which lines the resolve reads, and in which clock a line that is kept can
// be used, as docs/reference/geometric/memory.md has them.
#include <deque>
#include <set>

#include "tb/base/fnv.h"
#include "tb/base/random.h"
#include "tb/unit/rtl/geometric/resolve_bench.h"

namespace deburr::tb::geometric_rtl::kept_colours_test {
namespace {

using namespace rtl::geometric;  // NOLINT: names of units and tokens
using spec::geometric::CacheLines;
using spec::geometric::Layout;
using testing::ElementsAre;

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
  // What memory answers to the oldest miss.
  void fill(rtl::Cycle cycle, std::uint8_t value) {
    filler.fill(cycle, places.front(), line_of(value));
    places.pop_front();
  }
  // The reader's clock: takes a line if it is there, else gives -1.
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

TEST(ColourStore, AHitIsThereInTheSecondClockAfterItsLookUp) {
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
// A miss, a hit of it that is ordered while it is on its way, an older hit, a miss: one a clock.
TEST(ColourStore, ALineAClockHitOrMiss) {
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
// C takes A's place in the clock of its look-up; hits of A before that still read A, since C comes
// there when it is taken. A hit does not make A younger.
TEST(ColourStore, TheLineThatWasReadFirstIsReplaced) {
  Store s(keeping(2));
  EXPECT_FALSE(s.read(1, kA).replaces);
  EXPECT_FALSE(s.read(2, kB).replaces);
  s.places = {0, 1};
  s.hit(3, kA);
  const auto third = s.read(4, kC);
  EXPECT_TRUE(third.replaces);
  s.places.push_back(third.place);
  EXPECT_FALSE(s.filler.find(kA).has_value());
  EXPECT_TRUE(s.filler.find(kB).has_value());
  s.hit(5, kB);
  s.hit(6, kC);
  s.fill(10, 1);
  s.fill(11, 2);
  s.fill(12, 3);
  std::vector<int> taken;
  for (rtl::Cycle c = 1; c < 30; ++c)
    if (const int value = s.take(c); value >= 0) taken.push_back(value);
  EXPECT_THAT(taken, ElementsAre(1, 2, 1, 3, 2, 3));
  s.miss(30, kA);
  EXPECT_FALSE(s.filler.find(kB).has_value());
}
// Eight entries, and one that is being taken.
TEST(ColourStore, WithoutAnEntryNothingIsOrdered) {
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
  // Misses need a place besides.
  Store m(keeping(8));
  for (std::uint32_t i = 0; i < 8; ++i) {
    m.miss(1 + i, 200 + i);
    m.take(1 + i);
  }
  EXPECT_TRUE(m.filler.can_order_kept(10));
  EXPECT_FALSE(m.filler.can_order_read(10));
}
TEST(ColourStore, AFrameAndAResetBeginWithNothingKept) {
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
    // The first place again.
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
TEST(ColourStore, ATagIsOneLineOfItsLayout) {
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

constexpr std::uint32_t kColours = 0x40000;
Parameters kept(int lines, Layout layout = Layout::kTiled) {
  Parameters p;
  p.colour_lines = lines;
  p.layout = layout;
  p.weight_blocks = CacheLines::k1024;
  return p;
}
// Tiled, 256 pixels across: block (x, y).
std::uint64_t tiled_line(int x, int y) {
  return kColours +
         static_cast<std::uint64_t>(256 * (y / 2 * 32 + x / 2) + 64 * (y % 2 * 2 + x % 2));
}

// Block (x, 1) takes from the left: the line of the block before it, which that has read, and its
// own.
TEST(KeptColours, WhatTheBlockBeforeHasReadIsNotReadAgain) {
  for (const int lines : {0, 1, 2, 256}) {
    const std::string got = in_child([lines] {
      ResolveBench b(kept(lines), 256, 64);
      for (int x = 1; x < 4; ++x) b.touch(x, 1, 1u << 4, true);
      b.memory.clear_statistics();
      b.run();
      std::string text = std::to_string(b.fetch.lines_kept.value()) + ":";
      for (const std::uint64_t line : b.memory.lines_read())
        for (int x = 0; x < 4; ++x)
          if (line == tiled_line(x, 1)) text += " " + std::to_string(x);
      return text + ", " + std::to_string(b.fetch.lines_replaced.value());
    });
    EXPECT_EQ(got, lines == 0   ? "0: 0 1 1 2 2 3, 0"
                   : lines == 1 ? "2: 0 1 2 3, 3"
                   : lines == 2 ? "2: 0 1 2 3, 2"
                                : "2: 0 1 2 3, 0");
  }
}

// A block whose only line is kept, behind a block whose line came long before: the line is taken in
// the second clock after its look-up, in stage 1 of the Resolver.
TEST(KeptColours, LatencyOfABlockThatReadsNothing) {
  ResolveBench b(kept(4), 256, 64);
  // Block (1, 1) takes from the right and reads both lines; block (2, 1) needs its own.
  b.touch(1, 1, 1u << 7, true, true);
  b.touch(2, 1, 1u << 5);
  b.before_clock = [&b] {
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

// A clock for each line of a block, hit or miss.
TEST(KeptColours, AClockForEachLine) {
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

// Hits need no place of a line that is on its way, but an entry in the order of lines.
TEST(KeptColours, StallsWithoutAnEntry) {
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
  // Eight lines in a round trip of some 208 cycles: 80 of them, or 41 of 80.
  EXPECT_EQ(waits(0), "stalls 20");
  EXPECT_EQ(waits(128), "stalls 18");
}

// ---- the rule of the page, in words of its own

struct Touched {
  int x, y;
  std::uint16_t pixels;
  bool vertical, forward;
};
using LineOfMemory = std::pair<int, int>;  // v, u
std::vector<LineOfMemory> lines_of(Layout layout, int width, int height, const Touched& block) {
  std::set<LineOfMemory> lines;
  const auto add = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= width || y >= height) return;
    lines.insert(layout == Layout::kTiled ? LineOfMemory{y / 4, x / 4} : LineOfMemory{y, x / 16});
  };
  for (int i = 0; i < 16; ++i) {
    if (!(block.pixels >> i & 1)) continue;
    const int x = 4 * block.x + i % 4, y = 4 * block.y + i / 4, step = block.forward ? 1 : -1;
    const int nx = block.vertical ? x + step : x, ny = block.vertical ? y : y + step;
    if (x >= width || y >= height || nx < 0 || ny < 0 || nx >= width || ny >= height) continue;
    add(x, y);
    add(nx, ny);
  }
  return {lines.begin(), lines.end()};
}
std::uint64_t address_of(Layout layout, int width, const LineOfMemory& line) {
  const auto [v, u] = line;
  return kColours + static_cast<std::uint64_t>(layout == Layout::kTiled
                                                   ? 256 * (v / 2 * ((width + 7) / 8) + u / 2) +
                                                         64 * (v % 2 * 2 + u % 2)
                                                   : 64 * (v * ((width + 15) / 16) + u));
}

std::string random_blocks(int lines, Layout layout, std::uint64_t seed) {
  Random random(seed, "blocks");
  const int width = random.between(40, 250), height = random.between(30, 64);
  std::map<std::pair<int, int>, Touched> touched;
  for (int i = 0; i < 300; ++i) {
    const int x = random.between(0, (width - 1) / 4), y = random.between(0, (height - 1) / 4);
    touched[{y, x}] = {x, y, static_cast<std::uint16_t>(random.word() & random.word()),
                       random.chance(500), random.chance(500)};
  }
  std::vector<std::uint8_t> colours(0x20000);
  for (std::uint8_t& byte : colours) byte = static_cast<std::uint8_t>(random.word());
  Parameters p = kept(lines, layout);
  if (seed % 2 == 0) p.resolve_lines = 16;
  const auto frame = [&](int kept_lines, bool stalls) {
    return in_child([&] {
      p.colour_lines = kept_lines;
      ResolveBench b(p, width, height, std::array{1u, 20u, 100u}[seed % 3]);
      b.memory.preload(kColours, colours);
      for (const auto& [place, block] : touched)
        b.touch(block.x, block.y, block.pixels, block.vertical, block.forward);
      Random when(seed, "stalls");
      if (stalls)
        b.before_clock = [&] {
          if (when.chance(200)) b.requests.hold_push(b.clock.cycle());
          if (when.chance(200)) b.responses.hold_pop(b.clock.cycle());
          if (when.chance(200)) b.blocks.hold_pop(b.clock.cycle());
        };
      b.before_resolve = [&] { b.memory.clear_statistics(); };
      b.run();
      // The page's ring.
      std::vector<std::uint64_t> wanted;
      std::deque<LineOfMemory> ring;
      std::uint64_t hits = 0;
      for (const auto& [place, block] : touched) {
        if (block.pixels == 0) continue;
        for (const LineOfMemory& line : lines_of(layout, width, height, block)) {
          if (std::find(ring.begin(), ring.end(), line) != ring.end()) {
            ++hits;
            continue;
          }
          wanted.push_back(address_of(layout, width, line));
          ring.push_back(line);
          if (ring.size() > static_cast<std::size_t>(kept_lines)) ring.pop_front();
        }
      }
      std::vector<std::uint64_t> read;  // without weights
      for (const std::uint64_t line : b.memory.lines_read())
        if (line < 0x80000) read.push_back(line);
      std::string text;
      if (read != wanted) text += "reads ";
      if (b.fetch.lines_kept.value() != hits) text += "hits ";
      if (b.fetch.lines_read.value() != wanted.size()) text += "misses ";
      if (kept_lines > 1 && hits == 0) text += "nothing was hit ";
      FnvHash hash;
      for (const auto& block : b.resolved)
        for (std::size_t i = 0; i < 16; ++i)
          for (const std::uint8_t byte : block.pixels[i])
            if (block.blended >> i & 1) hash.byte(byte);
      return text + std::to_string(hash.value()) + " " + std::to_string(b.resolved.size());
    });
  };
  const std::string without = frame(0, false), with = frame(lines, true);
  return with == without ? "" : with + " for " + without;
}
TEST(KeptColours, RandomBlocksByTheRule) {
  for (const int lines : {0, 1, 2, 3, 64, 128, 256})
    for (const Layout layout : {Layout::kTiled, Layout::kRaster})
      for (std::uint64_t seed = 0; seed < 3; ++seed)
        EXPECT_EQ(random_blocks(lines, layout, seed), "")
            << lines << " lines, layout " << static_cast<int>(layout) << ", seed " << seed;
}

}  // namespace
}  // namespace deburr::tb::geometric_rtl::kept_colours_test
