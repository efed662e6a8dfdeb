// SPDX-License-Identifier: MIT
// The BlockFetcher alone and in the cache: cycles, order, priority, replaced lines, errors. Its
// decoded lines are compared in block_decoder_test.cpp.
#include "rtl_model/texture/block_fetcher.h"

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/cache_bench.h"

namespace deburr::tb::texture_rtl::block_fetcher_test {
namespace {

using namespace rtl::texture;
using rtl::MemoryStatus;
using spec::texture::Format;
using testing::ElementsAre;

constexpr Format kBc4 = Format::kBc4, kBc5 = Format::kBc5;

// A line whose eight blocks of BC4 are the numbers from `first` on.
rtl::Line numbers(std::uint32_t first) {
  rtl::Line line{};
  for (std::uint32_t i = 0; i < 8; ++i) line[8 * i] = static_cast<std::uint8_t>(first + i);
  return line;
}
// Entry and red of a fill.
using Fill = std::pair<std::uint32_t, int>;
Fill fill_of(const rtl::MemoryResponse& fill) { return {fill.tag, fill.data[0]}; }

// By the table of the page, with the line pushed in 3 and the response in 6 + L: each in exactly
// that cycle.
TEST(TextureRtlBlockFetcher, TimesMatchTable) {
  FetcherBench b;
  b.clock.run(3);
  b.ask(kBc4, 64, 1);
  EXPECT_EQ(ready_at(b.clock, b.requests), 5u);  // pushed in 4
  const rtl::MemoryRequest line = b.asked();
  EXPECT_EQ(line.address, 64u);
  b.clock.run(10);
  const Cycle response = b.clock.cycle();
  b.answer(line.tag, numbers(10));
  EXPECT_EQ(ready_at(b.clock, b.fills), response + 6);  // pushed in 11 + L
  EXPECT_EQ(fill_of(b.filled()), Fill(1, 10));

  const Cycle present = b.clock.cycle();
  b.ask(kBc4, 64 + 24, 2);
  const rtl::Datasheet sheet = BlockFetcher::datasheet();
  const Cycle filled = ready_at(b.clock, b.fills);
  expect_detects_one_cycle(sheet, &rtl::Datasheet::latency, [&](const rtl::Datasheet& expected) {
    expect_latency(expected, filled - (present + 1));
  });
  EXPECT_EQ(fill_of(b.filled()), Fill(2, 13));
  EXPECT_TRUE(b.requests.empty());

  const Cycle other = b.clock.cycle();
  b.ask(128, 3);
  EXPECT_EQ(ready_at(b.clock, b.requests), other + 2);
  const rtl::MemoryRequest asked = b.asked();
  EXPECT_EQ(asked.address, 128u);
  EXPECT_EQ(asked.tag, 3u);
  const Cycle passed = b.clock.cycle();
  b.answer(asked.tag, numbers(50));
  EXPECT_EQ(ready_at(b.clock, b.fills), passed + 2);
  EXPECT_EQ(fill_of(b.filled()), Fill(3, 50));
  EXPECT_EQ(b.unit.memory_lines.value(), 1u);
  EXPECT_EQ(b.unit.blocks.value(), 2u);
}

// One line per cycle in each direction.
TEST(TextureRtlBlockFetcher, SustainsOneBlockPerCycle) {
  spec::texture::Parameters p = with_fetcher(small_cache());
  p.cache_outstanding = 16;
  FetcherBench b(p);
  b.ask(kBc4, 0, 0);
  b.answer(b.asked().tag, numbers(1));
  b.filled();
  for (std::uint32_t i = 0; i < 8; ++i) {
    b.ask(kBc4, 8 * i, i);
    b.clock.run(1);
    if (i >= 6) {
      EXPECT_EQ(fill_of(b.fills.take(b.clock.cycle())), Fill(i - 6, static_cast<int>(i - 5)));
    }
  }
  EXPECT_EQ(b.unit.stalled_cycles() - stalls(b.unit, "wait_memory"), 0u);
}

// Through the whole cache: 6 cycles more, 2 more, and independent of memory.
template <class Bench, class Time>
void check_times(Bench& b, Cycle miss, Cycle hit, const Time& time_of) {
  const auto block = [](std::uint32_t address) {
    TexelToken t = in_blocks(kBc4, {address, address, address, address});
    t.control.within = 0b10'01'11'00;  // columns 0 and 3, rows 1 and 2
    return t;
  };
  EXPECT_EQ(time_of(block(0x1000)), miss + kMemoryLatency + 6) << "absent";
  EXPECT_EQ(time_of(block(0x1008)), miss + 3) << "present";
  EXPECT_EQ(time_of(block(0x1008)), hit);
  EXPECT_EQ(time_of(in_line(3)), miss + kMemoryLatency + 2) << "another texture";
  EXPECT_THAT(b.memory.lines_read(), ElementsAre(0x1000, 3 * 64));
  EXPECT_EQ(b.cache.miss_queue.line_fills.value(), 3u);
  EXPECT_EQ(b.cache.block_fetcher->memory_lines.value(), 1u);
}
TEST(TextureRtlBlockFetcher, CacheTimesMatchTable) {
  CacheBench b(with_fetcher(small_cache()));
  b.memory.preload(0, numbered_blocks());
  std::vector<TexelToken> asked;
  check_times(b, kMiss, kHit, [&](const TexelToken& t) {
    asked.push_back(t);
    return b.time_of(t);
  });
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(b.ends.sink.taken[i].token.texel, texels_of(asked[i])) << i;
}
TEST(TextureRtlBlockFetcher, WideCacheTimesMatchTable) {
  WideBench b(with_fetcher(wide_cache()));
  check_times(b, kWideMiss, kWideHit, [&](const TexelToken& t) {
    const std::size_t before = b.ends.sink.taken.size();
    const Cycle taken = b.clock.cycle() + 1;
    b.add({t});
    b.clock.run_until([&] { return b.ends.sink.taken.size() > before; }, 1000);
    return b.ends.sink.taken.back().cycle - taken;
  });
}

// Random requests of blocks of two formats and of texels, with responses out of order.
void check_groups(std::int32_t width) {
  WideBench b(with_fetcher(wide_cache(width), 4), kMemoryLatency, 20);
  std::uint32_t random = 1, tag = 0;
  const auto next = [&](std::uint32_t below) {
    random = random * 1664525 + 1013904223;
    return (random >> 8) % below;
  };
  for (int i = 0; i < 300; ++i) {
    std::vector<TexelToken> requests;
    for (std::int32_t r = 0; r < width; ++r) {
      const std::uint32_t kind = next(3), base = 0x8000 * kind + 128 * next(24);
      const auto at = [&] { return base + 16 * next(12); };
      if (kind == 0)
        requests.push_back(request({at() & ~7u, at() & ~7u, at() & ~7u, at() & ~7u}, tag++));
      else
        requests.push_back(in_blocks(kind == 1 ? kBc4 : kBc5, {at(), at(), at(), at()}, tag++));
    }
    b.add(requests);
  }
  b.finish();
  b.check_data();
  EXPECT_GT(b.cache.block_fetcher->memory_lines.value(), 4u);
  check_slots(b.former());
}
TEST(TextureRtlBlockFetcher, GroupsOfTwoGetTheirTexels) { check_groups(2); }
TEST(TextureRtlBlockFetcher, GroupsOfFourGetTheirTexels) { check_groups(4); }

// Texel (x, y) is at its place in the line, which is not turned; of two formats there are two
// lines.
TexelToken four_places() {
  TexelToken t = in_blocks(kBc4, {0x1000, 0x1000, 0x1000, 0x1000});
  t.control.within = 3 << 2 | 1 << 4 | 2 << 6;
  t.turned = {true, true};
  return t;
}
// Selector 1 (90) of texels (3, 1) and (0, 2): 7 and 8.
const std::vector<std::uint8_t> kPlaces = {40, 90, 0, 0, 0b0010'0000, 1, 0, 0};
MATCHER(IsFourPlaces, "") {
  return arg == std::array<std::uint32_t, 4>{0xFF28'2828, 0xFF5A'5A5A, 0xFF5A'5A5A, 0xFF28'2828};
}
TEST(TextureRtlBlockFetcher, LineIsBlockRowByRow) {
  CacheBench b(with_fetcher(small_cache()));
  b.memory.preload(0x1000, kPlaces);
  b.time_of(four_places());
  EXPECT_THAT(b.ends.sink.taken[0].token.texel, IsFourPlaces());
}
TEST(TextureRtlBlockFetcher, WideLineIsBlockRowByRow) {
  WideBench b(with_fetcher(wide_cache()));
  b.memory.preload(0x1000, kPlaces);
  b.add({four_places()});
  b.finish();
  EXPECT_THAT(b.ends.sink.taken[0].token.at[0].texel, IsFourPlaces());
}

// Four lines: the fifth waits until no block needs the first. That block leaves the queue in `t`,
// and still counts in `t`.
void check_line_in_use(bool faulty) {
  spec::texture::Parameters p = with_fetcher(small_cache(), 4);
  p.cache_outstanding = 8;
  FetcherBench b(p);
  b.unit.replaces_used_lines = faulty;
  std::vector<std::uint32_t> tags;
  for (std::uint32_t i = 0; i < 4; ++i) {
    b.ask(kBc4, 64 * i, i);
    tags.push_back(b.asked().tag);
  }
  b.ask(kBc4, 0, 4);  // a second block of the first line
  b.clock.run(1);
  b.ask(kBc4, 256, 5);
  b.clock.run(6);
  EXPECT_EQ(b.unit.memory_lines.value(), 4u);
  EXPECT_EQ(stalls(b.unit, "line_in_use"), 5u);
  const Cycle response = b.clock.cycle();
  b.answer(tags[0], numbers(20));
  b.clock.run(2);
  if (!faulty) b.answer(tags[1], numbers(30));
  if (!faulty) {
    b.clock.run(1);
    b.answer(tags[2], numbers(40));
    b.clock.run(1);
    b.answer(tags[3], numbers(50));
  }
  // The line is written in 1 after the response; the first block leaves the queue in 2, the other
  // ones in 4, 5 and 6, then the second block of the line, in 7. The line is replaced in 8.
  EXPECT_EQ(ready_at(b.clock, b.requests), response + (faulty ? 3 : 9));
  EXPECT_EQ(b.asked().tag, tags[0]) << "the oldest line";
  if (faulty) {
    for (const std::size_t i : {1u, 2u, 3u, 0u}) {
      b.answer(tags[i], numbers(60));
      b.clock.run(1);
    }
    for (const Fill& fill : {Fill(0, 20), Fill(1, 60), Fill(2, 60), Fill(3, 60), Fill(4, 60)})
      EXPECT_EQ(fill_of(b.filled()), fill) << "the last one from the line that replaced its own";
    return;
  }
  b.answer(tags[0], numbers(60));
  for (const Fill& fill :
       {Fill(0, 20), Fill(1, 30), Fill(2, 40), Fill(3, 50), Fill(4, 20), Fill(5, 60)})
    EXPECT_EQ(fill_of(b.filled()), fill);
  // The replaced line is absent, the others are present.
  b.ask(kBc4, 64, 6);
  b.clock.run(5);
  EXPECT_TRUE(b.requests.empty());
  b.ask(kBc4, 0, 7);
  EXPECT_EQ(b.asked().tag, tags[1]);
}
TEST(TextureRtlBlockFetcher, LineInUseIsNotReplaced) { check_line_in_use(false); }
TEST(TextureRtlBlockFetcher, FaultReplacesLineInUse) { check_line_in_use(true); }

// Blocks leave in the order of the misses, however memory answers; another texture may overtake.
TEST(TextureRtlBlockFetcher, BlocksLeaveInOrder) {
  FetcherBench b;
  b.ask(kBc4, 0, 0);
  const std::uint32_t first = b.asked().tag;
  b.ask(kBc4, 64, 1);
  const std::uint32_t second = b.asked().tag;
  b.ask(128, 2);
  EXPECT_EQ(b.asked().tag, 2u);
  b.ask(kBc5, 16, 3);  // the first line again
  b.clock.run(1);
  b.answer(second, numbers(30));
  b.clock.run(1);
  b.answer(2, numbers(50));
  b.clock.run(20);
  EXPECT_EQ(fill_of(b.filled()), Fill(2, 50));
  EXPECT_TRUE(b.fills.empty());
  EXPECT_GT(stalls(b.unit, "wait_memory"), 10u);
  b.answer(first, numbers(20));
  EXPECT_EQ(fill_of(b.filled()), Fill(0, 20));
  EXPECT_EQ(fill_of(b.filled()), Fill(1, 30));
  const rtl::MemoryResponse last = b.filled();
  EXPECT_EQ(fill_of(last), Fill(3, 22));
  EXPECT_EQ(last.data[1], 23) << "both halves";
}

// A response for another texture in the cycle in which a block would be pushed: the block is pushed
// in the next one. In another cycle it changes nothing.
class Priority : public testing::TestWithParam<Cycle> {};
TEST_P(Priority, OtherTextureIsFirst) {
  const Cycle other = GetParam();
  FetcherBench b;
  b.ask(kBc4, 0, 0);
  const std::uint32_t tag = b.asked().tag;
  b.ask(128, 1);
  b.asked();
  const Cycle response = b.clock.cycle();
  b.answer(tag, numbers(20));
  b.clock.run(other);
  b.answer(1, numbers(50));  // popped in response + other + 1
  std::vector<Fill> fills;
  std::vector<Cycle> cycles;
  while (fills.size() < 2) {
    cycles.push_back(ready_at(b.clock, b.fills) - response);
    fills.push_back(fill_of(b.filled()));
  }
  const Fill block = {0, 20}, passed = {1, 50};
  // The block is pushed in response + 5, so it is there in 6.
  if (other == 3) {
    EXPECT_THAT(cycles, ElementsAre(5, 6));
    EXPECT_THAT(fills, ElementsAre(passed, block));
    EXPECT_EQ(stalls(b.unit, "downstream"), 0u);
  } else if (other == 4) {
    EXPECT_THAT(cycles, ElementsAre(6, 7));
    EXPECT_THAT(fills, ElementsAre(passed, block));
  } else {
    EXPECT_THAT(cycles, ElementsAre(6, 7));
    EXPECT_THAT(fills, ElementsAre(block, passed));
  }
}
INSTANTIATE_TEST_SUITE_P(TextureRtlBlockFetcher, Priority, testing::Values(3, 4, 5));

// The MissQueue takes nothing: two fills are in the link, three blocks in the decoder, and a
// response for another texture waits. Nothing is lost, and memory lines are still written.
TEST(TextureRtlBlockFetcher, StallsAsAWhole) {
  spec::texture::Parameters p = with_fetcher(small_cache());
  p.cache_outstanding = 16;
  FetcherBench b(p);
  b.ask(kBc4, 0, 0);
  b.answer(b.asked().tag, numbers(20));
  for (std::uint32_t i = 1; i < 8; ++i) {
    b.clock.run(1);
    b.ask(kBc4, 8 * i, i);
  }
  b.clock.run(1);
  b.ask(128, 8);
  const std::uint32_t other = b.asked().tag;
  b.ask(kBc4, 64, 9);
  const std::uint32_t late = b.asked().tag;
  b.clock.run(20);
  b.answer(late, numbers(60));
  b.clock.run(1);
  b.answer(other, numbers(50));
  b.clock.run(20);
  EXPECT_EQ(b.unit.blocks.value(), 4u);  // a fifth is in the stage that reads
  EXPECT_EQ(b.fills.occupancy(), 2u);
  EXPECT_EQ(b.responses.occupancy(), 1u);
  EXPECT_GT(stalls(b.unit, "downstream"), 30u);
  std::vector<Fill> fills;
  std::vector<Cycle> cycles;
  while (fills.size() < 10) {
    cycles.push_back(ready_at(b.clock, b.fills));
    fills.push_back(fill_of(b.filled()));
  }
  EXPECT_THAT(fills, ElementsAre(Fill(0, 20), Fill(1, 21), Fill(8, 50), Fill(2, 22), Fill(3, 23),
                                 Fill(4, 24), Fill(5, 25), Fill(6, 26), Fill(7, 27), Fill(9, 60)));
  for (std::size_t i = 1; i < cycles.size(); ++i) EXPECT_LE(cycles[i] - cycles[i - 1], 1u) << i;
}

// The memory port takes nothing: a third request waits, but not a block whose line is present.
TEST(TextureRtlBlockFetcher, WaitsWhileMemoryTakesNothing) {
  FetcherBench b;
  for (const std::uint32_t address : {0u, 64u, 8u}) {
    b.ask(kBc4, address, 0);
    b.clock.run(1);
  }
  for (const std::uint32_t address : {128u, 192u}) {
    address == 128 ? b.ask(kBc4, address, 3) : b.ask(address, 3);
    const std::uint64_t before = stalls(b.unit, "downstream");
    b.clock.run(4);
    EXPECT_EQ(b.requests.occupancy(), 2u);
    EXPECT_EQ(stalls(b.unit, "downstream") - before, 3u);
    EXPECT_EQ(stalls(b.unit, "line_in_use"), 0u);
    b.requests.pop(b.clock.cycle());
    b.clock.run(3);
    EXPECT_TRUE(b.lines.empty());
  }
  EXPECT_EQ(b.unit.memory_lines.value(), 3u);
}

// An error counts once per response; every block of the line reads as zeros, until it is replaced.
TEST(TextureRtlBlockFetcher, ErrorMakesZerosAndCountsOnce) {
  FetcherBench b;
  b.ask(kBc4, 0, 0);
  b.answer(b.asked().tag, {}, MemoryStatus::kError);
  EXPECT_EQ(b.filled().status, MemoryStatus::kOk);
  EXPECT_EQ(b.unit.memory_errors.value(), 1u);
  EXPECT_TRUE(b.control.interrupt());
  b.ask(kBc5, 48, 1);
  EXPECT_EQ(fill_of(b.filled()), Fill(1, 0));
  EXPECT_EQ(b.unit.memory_errors.value(), 1u);
  b.ask(64, 2);
  b.asked();
  b.answer(2, {}, MemoryStatus::kError);
  EXPECT_EQ(b.filled().status, MemoryStatus::kOk);
  EXPECT_EQ(b.unit.memory_errors.value(), 2u);
}

// In the unit: the register counts the responses, and texels are those of zeros.
TEST(TextureRtlBlockFetcher, CacheCountsErrorOnce) {
  CacheBench b(with_fetcher(small_cache()));
  b.memory.fail_range(0, 64);
  b.time_of(in_blocks(kBc4, {0, 8, 16, 24}));
  EXPECT_THAT(b.ends.sink.taken[0].token.texel, testing::Each(0xFF00'0000));
  EXPECT_EQ(b.cache.memory_errors().value(), 1u);
  EXPECT_EQ(b.cache.miss_queue.memory_errors.value(), 0u);
}

// After an invalidation and after a reset, also in the middle of work, lines are fetched again.
TEST(TextureRtlBlockFetcher, InvalidationAndResetEmptyTheLines) {
  FetcherBench b;
  const auto fetches = [&](std::uint32_t first) {
    const std::uint64_t before = b.unit.memory_lines.value();
    b.ask(kBc4, 0, 0);
    b.clock.run(2);
    const bool fetched = b.unit.memory_lines.value() != before;
    if (fetched) b.answer(b.asked().tag, numbers(first));
    EXPECT_EQ(b.filled().data[0], first);
    return fetched;
  };
  EXPECT_TRUE(fetches(1));
  EXPECT_FALSE(fetches(1));
  b.unit.invalidate();
  EXPECT_TRUE(fetches(2));
  b.unit.keeps_lines = true;
  b.unit.invalidate();
  EXPECT_FALSE(fetches(2)) << "the injected fault";
  b.ask(kBc4, 64, 1);
  b.clock.run(1);
  b.ask(kBc4, 0, 2);
  b.clock.run(3);
  b.clock.set_reset_n(false);
  b.clock.run(1);
  b.clock.set_reset_n(true);
  b.requests.reset();
  b.clock.run(10);
  EXPECT_TRUE(b.fills.empty());
  EXPECT_TRUE(fetches(3));
}

TEST(TextureRtlBlockFetcher, RejectsExtraPortAndEarlyUse) {
  FetcherBench b;
  EXPECT_THAT((of_one_port_more<rtl::ReadPort<rtl::Line>, rtl::Line>(b.unit, "lines")),
              Rejects("lines", "one port more than 1R1W"));
  EXPECT_THAT((of_one_port_more<rtl::ReadPort<std::uint32_t>, std::uint32_t>(b.unit, "tags")),
              Rejects("tags", "one port more than"));
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::block_fetcher_test
