// SPDX-License-Identifier: MIT
// The TextureCache as a whole: hits, misses, evictions, lines of every length, memory errors,
// reset.
#include "tb/unit/rtl/texture/cache_bench.h"

namespace deburr::tb::texture_rtl::texture_cache_test {
namespace {

using namespace rtl::texture;
using testing::ElementsAre;

// One request after the other, each with its time and its counters.
TEST(TextureRtlCache, TimesMatchTable) {
  CacheBench b;
  const Cycle latency = kMemoryLatency;
  const std::uint32_t a = 0, c = 2, e = 4, odd = 1;  // a, c, e share set 0
  struct Row {
    const char* name;
    TexelToken request;
    Cycle time;
    int hits, misses, evictions;
  };
  const std::vector<Row> rows = {
      {"cold miss", in_line(a), kMiss + latency, 0, 1, 0},
      {"hit", in_line(a), kHit, 1, 0, 0},
      {"miss in the same set", in_line(c), kMiss + latency, 0, 1, 0},
      {"both stay", in_line(a), kHit, 1, 0, 0},
      {"miss evicts the least recently used, c", in_line(e), kMiss + latency, 0, 1, 1},
      {"a is still there", in_line(a), kHit, 1, 0, 0},
      {"c is not, and evicts e", in_line(c), kMiss + latency, 0, 1, 1},
      {"other set", in_line(odd), kMiss + latency, 0, 1, 0},
      {"two lines that hit", request({64 * a, 64 * odd + 4, 64 * a + 16, 64 * odd + 20}), kHit, 2,
       0, 0},
      // A second line is sent, and arrives, one cycle after the first, and is written in the next
      // cycle.
      {"two lines, both miss", request({64 * 6, 64 * 7, 64 * 6 + 16, 64 * 7 + 16}),
       kMiss + latency + 1, 0, 2, 1},
      {"four lines, all miss", request({64 * 8, 64 * 9, 64 * 10, 64 * 11}), kMiss + latency + 3, 0,
       4, 4},
  };
  std::vector<TexelToken> asked;
  std::uint64_t hits = 0, misses = 0, evictions = 0;
  for (const Row& row : rows) {
    SCOPED_TRACE(row.name);
    EXPECT_EQ(b.time_of(row.request), row.time);
    asked.push_back(row.request);
    const TagUnit& tags = b.cache.tag_stage;
    EXPECT_EQ(tags.hits.value() - hits, static_cast<std::uint64_t>(row.hits));
    EXPECT_EQ(tags.misses.value() - misses, static_cast<std::uint64_t>(row.misses));
    EXPECT_EQ(tags.evictions.value() - evictions, static_cast<std::uint64_t>(row.evictions));
    EXPECT_EQ(tags.merged.value(), 0u);
    hits = tags.hits.value();
    misses = tags.misses.value();
    evictions = tags.evictions.value();
  }
  b.check_data(asked);
  EXPECT_EQ(b.cache.miss_queue.line_fills.value(), misses);
  EXPECT_EQ(b.cache.miss_queue.fill_bytes.value(), 64 * misses);
  EXPECT_EQ(b.cache.data_stage.lines_written.value(), misses);
}

TEST(TextureRtlCache, HitIsNotReadyOneCycleEarly) {
  CacheBench b;
  b.time_of(in_line(0));
  b.ends.sink.hold_to = rtl::kNever;
  const Cycle pushed = b.clock.cycle();
  b.ends.in.push(pushed, in_line(0));
  b.clock.run(kHit);
  EXPECT_FALSE(b.ends.out.can_pop(pushed + 1 + kHit - 1));
  b.clock.run(1);
  EXPECT_TRUE(b.ends.out.can_pop(pushed + 1 + kHit));
}

// Missed lines that arrive while the output is blocked: one is written, and its request waits in
// stage 2. The next waits on the output register of the FillBuffer, so that requests leave one
// cycle after each other.
TEST(TextureRtlCache, MissesLeaveCorrectlyAfterOutputStall) {
  CacheBench b;
  std::vector<TexelToken> asked = {in_line(0)};
  b.time_of(asked[0]);
  const Cycle held_to = b.clock.cycle() + 120;
  b.ends.sink.hold_to = held_to;
  // Two hits fill the link, and a miss stage 2. The others arrive when nothing moves any more.
  const auto add = [&](std::uint32_t line) {
    asked.push_back(in_line(line));
    b.ends.source.add(asked.back());
  };
  for (const std::uint32_t line : {0u, 0u, 1u}) add(line);
  b.clock.run(60);
  EXPECT_EQ(b.cache.data_stage.lines_written.value(), 2u);
  for (const std::uint32_t line : {2u, 3u}) add(line);
  b.clock.run_until([&] { return b.clock.cycle() >= held_to; }, 100);
  EXPECT_EQ(b.cache.memory_port.bytes_read.value(), 4 * 64u);  // requested long ago
  EXPECT_EQ(b.cache.data_stage.lines_written.value(), 2u);
  EXPECT_EQ(b.ends.sink.taken.size(), 1u);
  b.clock.run(20);
  b.check_data(asked);
  std::vector<Cycle> cycles = cycles_of(b.ends.sink);
  cycles.erase(cycles.begin());
  EXPECT_THAT(cycles, ElementsAre(held_to, held_to + 1, held_to + 2, held_to + 3, held_to + 4));
}

// A line that is evicted before its own fill has arrived: the older request still gets it, and the
// younger one gets the newer line.
TEST(TextureRtlCache, LineEvictedBeforeArrivalIsStillDelivered) {
  spec::texture::Parameters p = small_cache();
  p.cache_ways = 1;  // four sets
  CacheBench b(p);
  std::vector<TexelToken> asked;
  for (const std::uint32_t line : {0u, 4u, 0u, 0u, 8u, 4u, 4u}) asked.push_back(in_line(line));
  // And one request whose own lines evict each other.
  asked.push_back(request({0, 64 * 4, 64 * 8, 64 * 8 + 4}));
  asked.push_back(request({64 * 8, 64 * 8 + 4, 0, 64 * 4}));
  for (const auto& t : asked) b.ends.source.add(t);
  b.clock.run(300);
  b.check_data(asked);
  EXPECT_THAT(b.memory.lines_read(), ElementsAre(0, 256, 0, 512, 256, 0, 256, 512, 0, 256));
}

// Lines shorter than the memory port's beats, equal, and longer.
void check_line_size(std::int32_t bytes) {
  spec::texture::Parameters p = small_cache();
  p.cache_bytes = 1024;
  p.cache_line_bytes = bytes;
  p.cache_ways = 4;
  CacheBench b(p, kMemoryLatency, 9);
  std::vector<TexelToken> asked;
  for (std::uint32_t i = 0; i < 40; ++i)
    asked.push_back(request({i * 1000, i * 1000 + 64, 4096 - 4 * i, 8192 + i * 4}));
  for (const auto& t : asked) b.ends.source.add(t);
  b.clock.run(2000);
  b.check_data(asked);
  EXPECT_EQ(b.cache.memory_port.bytes_read.value(),
            b.cache.tag_stage.misses.value() * static_cast<std::uint64_t>(bytes));
  for (const std::uint64_t address : b.memory.lines_read())
    EXPECT_EQ(address % static_cast<std::uint64_t>(std::min(bytes, 64)), 0u);
}
TEST(TextureRtlCache, WorksWithLinesOf32Bytes) { check_line_size(32); }
TEST(TextureRtlCache, WorksWithLinesOf64Bytes) { check_line_size(64); }
TEST(TextureRtlCache, WorksWithLinesOf128Bytes) { check_line_size(128); }

TEST(TextureRtlCache, MemoryErrorReadsAsZeroAndIsCounted) {
  CacheBench b;
  b.memory.fail_range(64, 128);
  const std::vector<TexelToken> asked = {in_line(0), in_line(1), in_line(2)};
  for (const auto& t : asked) b.ends.source.add(t);
  b.clock.run(60);
  ASSERT_EQ(b.ends.sink.taken.size(), 3u);
  EXPECT_EQ(b.ends.sink.taken[0].token.texel[1], CacheBench::word(4));
  EXPECT_THAT(b.ends.sink.taken[1].token.texel, ElementsAre(0, 0, 0, 0));
  EXPECT_EQ(b.ends.sink.taken[2].token.texel[1], CacheBench::word(132));
  EXPECT_EQ(b.cache.miss_queue.memory_errors.value(), 1u);
  namespace reg = spec::texture::reg;
  EXPECT_TRUE(b.store.bus.read(reg::kStatus) & reg::kStatusMemoryError);
  b.store.bus.write(reg::kStatus, reg::kStatusMemoryError);
  EXPECT_FALSE(b.store.bus.read(reg::kStatus) & reg::kStatusMemoryError);
}

// A fragment without a valid descriptor requests nothing and takes one cycle.
TEST(TextureRtlCache, InvalidFragmentsPassThrough) {
  CacheBench b;
  b.time_of(in_line(0));
  TexelToken invalid = request({0x1000, 0x2000, 0x3000, 0x4000}, 99);
  invalid.ticket.valid = false;
  EXPECT_EQ(b.time_of(invalid), kHit);
  EXPECT_EQ(b.memory.lines_read().size(), 1u);
  EXPECT_EQ(b.ends.sink.taken.back().token.ticket.tag, 99u);
}

TEST(TextureRtlCache, ResetDropsLinesInFlight) {
  CacheBench b(small_cache(), 40);
  for (std::uint32_t i = 0; i < 4; ++i) b.ends.source.add(in_line(i));
  b.clock.run(20);  // all requested, none answered
  EXPECT_EQ(b.memory.lines_read().size(), 4u);
  b.clock.set_reset_n(false);
  b.clock.run(2);
  b.clock.set_reset_n(true);
  EXPECT_EQ(b.cache.tag_stage.misses.value(), 0u);
  // The same lines miss again, and late responses from before the reset are not used for them.
  b.fill_memory(~0u);
  const std::vector<TexelToken> asked = {in_line(3), in_line(2), in_line(1)};
  for (const auto& t : asked) b.ends.source.add(t);
  b.clock.run(120);
  ASSERT_EQ(b.ends.sink.taken.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_EQ(b.ends.sink.taken[i].token.texel[k], ~CacheBench::word(asked[i].address[k]));
  EXPECT_EQ(b.memory.lines_read().size(), 7u);
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::texture_cache_test
