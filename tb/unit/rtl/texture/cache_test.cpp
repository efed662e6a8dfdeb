// SPDX-License-Identifier: MIT
// The TextureCache and its blocks: hits, misses, merged misses, evictions, full queues, bank
// passes, the order of fills, memory errors. Clocks are counted from the push of a request by its
// producer: pushed in c, taken in c + 1.
#include "rtl_model/texture/texture_cache.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl {
namespace {

using namespace rtl::texture;
using testing::ElementsAre;

// A hit comes out this long after it has been taken: tag check, FIFO, data read.
constexpr Cycle kHit = 3;
// A miss of one line, besides the latency of memory: tag check, miss queue, port, response, fill
// buffer, data stage.
constexpr Cycle kMiss = 7;

spec::texture::Parameters small_cache() {
  spec::texture::Parameters p;
  p.cache_bytes = 256;  // 2 sets x 2 ways x 64 bytes
  p.cache_ways = 2;
  p.cache_outstanding = 4;
  p.cache_fifo_depth = 16;
  return p;
}

TexelToken request(std::array<std::uint32_t, 4> address, std::uint32_t tag = 0) {
  TexelToken t{};
  t.ticket = {tag, 0, true, true, 0};
  t.control = {0,    0,   256, 1, 0, static_cast<std::uint8_t>(spec::texture::Format::kRgba8),
               true, true};
  t.address = address;
  t.bank = {0, 1, 2, 3};
  return t;
}
// Four neighbours in one line.
TexelToken in_line(std::uint32_t line, std::uint32_t tag = 0) {
  const std::uint32_t a = line * 64;
  return request({a, a + 4, a + 16, a + 20}, tag);
}

struct CacheBench {
  explicit CacheBench(const spec::texture::Parameters& p = small_cache(),
                      std::uint32_t latency = kMemoryLatency, std::uint32_t scatter = 0)
      : cache("cache", clock, p, store.store),
        memory("memory", period(), memory_parameters(latency, scatter)) {
    cache.texels_in(ends.in);
    cache.texels_out(ends.out);
    cache.memory_port.memory.bind(memory.ports);
    fill_memory(0);
  }
  // Each word of memory holds its own address, scrambled.
  void fill_memory(std::uint32_t flipped) {
    std::vector<std::uint8_t> image(1 << 20);
    for (std::size_t i = 0; i < image.size(); ++i)
      image[i] = static_cast<std::uint8_t>((word(i & ~3ull) ^ flipped) >> (8 * (i & 3)));
    memory.preload(0, image);
  }
  static std::uint32_t word(std::uint64_t address) {
    return static_cast<std::uint32_t>(address * 2654435761u + 12345);
  }
  // The clock in which a request that is pushed now comes out.
  Cycle time_of(const TexelToken& t) {
    const std::size_t before = ends.sink.taken.size();
    const Cycle taken = clock.cycle() + 1;
    ends.source.add(t);
    clock.run_until([&] { return ends.sink.taken.size() > before; }, 10000);
    return ends.sink.taken.back().cycle - taken;
  }
  void check_data(const std::vector<TexelToken>& asked) const {
    ASSERT_EQ(ends.sink.taken.size(), asked.size());
    for (std::size_t i = 0; i < asked.size(); ++i)
      for (std::size_t k = 0; k < 4; ++k)
        EXPECT_EQ(ends.sink.taken[i].token.texel[k], word(asked[i].address[k])) << i << " " << k;
  }
  ClockDomain clock{"clock", period()};
  Store store{clock};
  Ends<TexelToken, TexelQuadToken> ends{clock};
  TextureCache cache;
  MemoryModel memory;
};

// One request after the other, each with the time it takes and what it counts.
TEST(TextureRtlCache, TimesByTable) {
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
      {"two lines that hit", request({64 * a, 64 * odd, 64 * a + 16, 64 * odd + 16}), kHit, 2, 0,
       0},
      // A second line is sent and comes a clock after the first, and is written in the next clock.
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
    const TagStage& tags = b.cache.tag_stage;
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

TEST(TextureRtlCache, HitIsNotReadyAClockEarlier) {
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

TEST(TextureRtlCache, OneByteAndTwoByteTexelsAnywhereInALine) {
  CacheBench b;
  for (const auto& [format, mask] : {std::pair{spec::texture::Format::kL8, 0xFFu},
                                     std::pair{spec::texture::Format::kRgb565, 0xFFFFu}}) {
    const std::uint32_t step = format == spec::texture::Format::kL8 ? 1 : 2;
    // Cold and warm: from the fill and from the banks.
    const std::uint32_t base = format == spec::texture::Format::kL8 ? 0x1000 : 0x2000;
    for (int twice = 0; twice < 2; ++twice)
      for (std::uint32_t at = base; at < base + 128; at += 4 * step) {
        TexelToken t = request({at, at + step, at + 2 * step, at + 3 * step});
        t.control.format = static_cast<std::uint8_t>(format);
        b.time_of(t);
        for (std::size_t k = 0; k < 4; ++k) {
          const std::uint32_t byte = t.address[k] & 3;
          EXPECT_EQ(b.ends.sink.taken.back().token.texel[k],
                    CacheBench::word(t.address[k] - byte) >> (8 * byte) & mask);
        }
      }
  }
}

// What the miss queue does for one line: queue it, send it, take it; between, it waits.
TEST(TextureRtlCache, MissQueueAccountsForItsClocks) {
  CacheBench b;
  b.time_of(in_line(0));
  const MissQueue& queue = b.cache.miss_queue;
  EXPECT_EQ(queue.busy_cycles(), 3u);
  const auto stalls = queue.stalls();
  ASSERT_EQ(stalls[2].name, "wait_memory");
  // Sent by the port a clock later, back after the latency, handed over in two; then the entry is
  // held until the data stage has used the line.
  EXPECT_EQ(stalls[2].cycles, kMemoryLatency + 2u + 1);
  EXPECT_EQ(stalls[1].cycles, 0u);
}

// Two requests for a line in flight are one fetch, and come out one clock apart.
TEST(TextureRtlCache, SecondRequestForALineInFlightIsMerged) {
  CacheBench b;
  const std::vector<TexelToken> asked = {in_line(0), in_line(0), in_line(3), in_line(0)};
  for (const auto& t : asked) b.ends.source.add(t);
  b.clock.run(60);
  b.check_data(asked);
  EXPECT_EQ(b.cache.tag_stage.misses.value(), 2u);
  EXPECT_EQ(b.cache.tag_stage.merged.value(), 2u);
  EXPECT_EQ(b.cache.tag_stage.hits.value(), 0u);
  EXPECT_THAT(b.memory.lines_read(), ElementsAre(0, 3 * 64));
  const Cycle first = 1 + kMiss + kMemoryLatency;
  EXPECT_EQ(b.ends.sink.taken[0].cycle, first);
  EXPECT_EQ(b.ends.sink.taken[1].cycle, first + 1);
  EXPECT_EQ(b.ends.sink.taken[2].cycle, first + 2);
  EXPECT_EQ(b.ends.sink.taken[3].cycle, first + 3);
}

// A line that is evicted before its own fill has arrived: the older request must still get it, and
// the younger one gets the newer line.
TEST(TextureRtlCache, EvictedBeforeItArrived) {
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

// A hit and a miss that overwrites it, in one request.
TEST(TextureRtlCache, HitIsReadBeforeItsLineIsOverwritten) {
  spec::texture::Parameters p = small_cache();
  p.cache_ways = 1;
  CacheBench b(p);
  const std::vector<TexelToken> asked = {in_line(0), request({0, 4, 64 * 4, 64 * 4 + 4}),
                                         in_line(4)};
  for (const auto& t : asked) b.ends.source.add(t);
  b.clock.run(100);
  b.check_data(asked);
  EXPECT_THAT(b.memory.lines_read(), ElementsAre(0, 256));
}

// The order of fills is the order of misses, whatever order memory answers in.
TEST(TextureRtlCache, OrderOfFills) {
  CacheBench b(small_cache(), kMemoryLatency, 30);
  std::vector<TexelToken> asked = {request({64 * 9, 64 * 3, 64 * 9 + 4, 64 * 20}),
                                   request({64 * 5, 64 * 4, 64 * 5, 64 * 4}), in_line(3),
                                   request({64 * 31, 64 * 30, 64 * 29, 64 * 28}), in_line(7)};
  for (const auto& t : asked) b.ends.source.add(t);
  b.clock.run(400);
  b.check_data(asked);
  EXPECT_THAT(b.memory.lines_read(),
              ElementsAre(576, 192, 1280, 320, 256, 1984, 1920, 1856, 1792, 448));
}

TEST(TextureRtlCache, ReplacementRules) {
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

TEST(TextureRtlCache, RandomReplacementStepsOnlyForValidLines) {
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

TEST(TextureRtlCache, FullQueueStallsTheTagStageAndLosesNothing) {
  CacheBench b(small_cache(), 100);  // four entries
  std::vector<TexelToken> asked;
  for (std::uint32_t i = 0; i < 12; ++i)
    asked.push_back(request({256 * i, 256 * i + 64, 256 * i + 128, 256 * i + 192}));
  for (const auto& t : asked) b.ends.source.add(t);
  b.clock.run(1600);
  b.check_data(asked);
  const auto stalls = b.cache.tag_stage.stalls();
  ASSERT_EQ(stalls[1].name, "miss_queue_full");
  EXPECT_GT(stalls[1].cycles, 500u);
  ASSERT_EQ(stalls[2].name, "fifo_full");
  EXPECT_EQ(stalls[2].cycles, 0u);
  const auto queue_stalls = b.cache.miss_queue.stalls();
  ASSERT_EQ(queue_stalls[1].name, "fill_buffer_full");
  EXPECT_GT(queue_stalls[1].cycles, 500u);
  // Never more lines outstanding than entries: each group of four waits for the group before it.
  EXPECT_EQ(b.cache.memory_port.most_outstanding.value(), 4u);
  EXPECT_EQ(b.cache.miss_queue.most_waiting.value(), 4u);
}

// A hit passes the tag stage while the miss queue is full.
TEST(TextureRtlCache, HitsGoOnWhileTheMissQueueIsFull) {
  CacheBench b(small_cache(), 200);
  b.time_of(in_line(1));
  const Cycle start = b.clock.cycle();
  for (std::uint32_t i = 0; i < 4; ++i)
    b.ends.source.add(request({0x1000 + 512 * i, 0x1080 + 512 * i, 0x1100 + 512 * i,
                               0x1180 + 512 * i}));  // 4 x 4 lines of set 0
  for (int i = 0; i < 5; ++i) b.ends.source.add(in_line(1));
  b.clock.run(30);
  EXPECT_LT(b.clock.cycle() - start, 200u);
  EXPECT_EQ(b.cache.tag_stage.requests.value(), 1u + 4 + 5);
}

TEST(TextureRtlCache, FullFifoStallsTheTagStage) {
  spec::texture::Parameters p = small_cache();
  p.cache_fifo_depth = 2;
  CacheBench b(p, 50);
  std::vector<TexelToken> asked = {in_line(0)};
  for (int i = 0; i < 20; ++i) asked.push_back(in_line(0));
  for (const auto& t : asked) b.ends.source.add(t);
  b.clock.run(120);
  b.check_data(asked);
  EXPECT_GT(b.cache.tag_stage.stalls()[2].cycles, 40u);
}

// Misses overlap: as long as the FIFO covers the latency, each request costs one clock.
TEST(TextureRtlCache, LatencyIsHiddenByADeepEnoughFifo) {
  spec::texture::Parameters p;
  p.cache_outstanding = 128;
  p.cache_fifo_depth = 160;
  CacheBench b(p, 100);
  std::vector<TexelToken> asked;
  for (std::uint32_t i = 0; i < 300; ++i) asked.push_back(in_line(i));
  for (const auto& t : asked) b.ends.source.add(t);
  b.clock.run(600);
  b.check_data(asked);
  EXPECT_EQ(b.ends.sink.taken.back().cycle - b.ends.sink.taken.front().cycle, 299u);
}

// Lines shorter than the memory port's beats, as long, and longer.
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
TEST(TextureRtlCache, Lines32) { check_line_size(32); }
TEST(TextureRtlCache, Lines64) { check_line_size(64); }
TEST(TextureRtlCache, Lines128) { check_line_size(128); }

TEST(TextureRtlCache, BankPasses) {
  CacheBench b;
  const auto conflicting = [](bool column, bool row, std::array<std::uint8_t, 4> bank) {
    TexelToken t = request({0, 20, 40, 60});
    t.column_conflict = column;
    t.row_conflict = row;
    t.bank = bank;
    return t;
  };
  const TexelToken plain = in_line(0), columns = conflicting(true, false, {0, 0, 2, 2}),
                   rows = conflicting(false, true, {0, 1, 0, 1}),
                   both = conflicting(true, true, {3, 3, 3, 3});
  b.time_of(plain);
  EXPECT_EQ(b.time_of(columns), kHit + 1);
  EXPECT_EQ(b.time_of(rows), kHit + 1);
  EXPECT_EQ(b.time_of(both), kHit + 3);
  // One after the other: 1, 2, 2, 4 clocks each.
  const std::size_t first = b.ends.sink.taken.size();
  const Cycle start = b.clock.cycle() + 1;
  for (const auto& t : {plain, columns, plain, rows, both, plain}) b.ends.source.add(t);
  b.clock.run(40);
  std::vector<Cycle> when;
  for (std::size_t i = first; i < b.ends.sink.taken.size(); ++i)
    when.push_back(b.ends.sink.taken[i].cycle - start - kHit);
  EXPECT_THAT(when, ElementsAre(0, 2, 3, 5, 9, 10));
  EXPECT_EQ(b.cache.data_stage.conflicts.value(), 6u);
  const auto stalls = b.cache.data_stage.stalls();
  ASSERT_EQ(stalls[3].name, "bank_conflict");
  EXPECT_EQ(stalls[3].cycles, 2u * (1 + 1 + 3));
  for (const auto& t : b.ends.sink.taken)
    for (const std::uint32_t texel : t.token.texel) EXPECT_NE(texel, 0u);
}

// Two texels of one bank that hit, in lines which the two misses of the same request replace: the
// second line has to wait for the second pass.
TEST(TextureRtlCache, PassesBeforeFills) {
  spec::texture::Parameters p = small_cache();
  p.cache_ways = 1;
  CacheBench b(p);
  TexelToken clash = request({0, 64, 64 * 4, 64 * 5});
  clash.column_conflict = true;
  clash.bank = {0, 0, 2, 2};
  TexelToken one_hit = request({64 * 4, 64 * 4 + 4, 0, 4});
  one_hit.column_conflict = true;
  one_hit.bank = {0, 0, 2, 2};
  const std::vector<TexelToken> asked = {in_line(0), in_line(1), clash, one_hit, in_line(5)};
  for (const auto& t : asked) b.ends.source.add(t);
  b.clock.run(100);
  b.check_data(asked);
  EXPECT_THAT(b.memory.lines_read(), ElementsAre(0, 64, 256, 320, 0));
}

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

// A fragment without a valid descriptor asks for nothing and takes one clock.
TEST(TextureRtlCache, InvalidFragmentsPassThrough) {
  CacheBench b;
  b.time_of(in_line(0));
  TexelToken invalid = request({0x1000, 0x2000, 0x3000, 0x4000}, 99);
  invalid.ticket.valid = false;
  invalid.column_conflict = invalid.row_conflict = true;
  EXPECT_EQ(b.time_of(invalid), kHit);
  EXPECT_EQ(b.memory.lines_read().size(), 1u);
  EXPECT_EQ(b.ends.sink.taken.back().token.ticket.tag, 99u);
}

TEST(TextureRtlCache, ResetDropsLinesInFlight) {
  CacheBench b(small_cache(), 40);
  for (std::uint32_t i = 0; i < 4; ++i) b.ends.source.add(in_line(i));
  b.clock.run(20);  // all asked for, none answered
  EXPECT_EQ(b.memory.lines_read().size(), 4u);
  b.clock.set_reset_n(false);
  b.clock.run(2);
  b.clock.set_reset_n(true);
  EXPECT_EQ(b.cache.tag_stage.misses.value(), 0u);
  // The same lines are missing again, and the late answers of the first time are not taken for
  // them.
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
}  // namespace deburr::tb::texture_rtl
