// SPDX-License-Identifier: MIT
// The MissQueue in the cache: cycles per line, and a full queue.
#include "tb/unit/rtl/texture/cache_bench.h"

namespace deburr::tb::texture_rtl::miss_queue_test {
namespace {

using namespace rtl::texture;

// Per line the miss queue works to queue it, send it and take it; otherwise it waits.
TEST(TextureRtlMissQueue, AccountsForEveryCycle) {
  CacheBench b;
  b.time_of(in_line(0));
  const MissQueue& queue = b.cache.miss_queue;
  EXPECT_EQ(queue.busy_cycles(), 3u);
  // The port sends one cycle later, the response returns after the latency and is delivered in two;
  // then the entry is held until the data stage has used the line, which it reads one cycle after
  // its arrival.
  EXPECT_EQ(stalls(queue, "wait_memory"), kMemoryLatency + 2u + 2);
  EXPECT_EQ(stalls(queue, "fill_buffer_full"), 0u);
}

TEST(TextureRtlMissQueue, FullQueueStallsTagStageAndLosesNothing) {
  CacheBench b(small_cache(), 100);  // four entries
  std::vector<TexelToken> asked;
  for (std::uint32_t i = 0; i < 12; ++i)
    asked.push_back(request({256 * i, 256 * i + 64, 256 * i + 128, 256 * i + 192}));
  for (const auto& t : asked) b.ends.source.add(t);
  b.clock.run(1600);
  b.check_data(asked);
  EXPECT_GT(stalls(b.cache.tag_stage, "miss_queue_full"), 500u);
  EXPECT_EQ(stalls(b.cache.tag_stage, "fifo_full"), 0u);
  EXPECT_GT(stalls(b.cache.miss_queue, "fill_buffer_full"), 500u);
  // At most one outstanding line per entry: each group of four waits for the previous group.
  EXPECT_EQ(b.cache.memory_port.max_outstanding.value(), 4u);
  EXPECT_EQ(b.cache.miss_queue.max_waiting.value(), 4u);
}

// The queue alone, with the test at both ends.
struct QueueBench {
  explicit QueueBench(const spec::texture::Parameters& p = small_cache())
      : queue("queue", clock, p, store.control) {
    queue.misses_in(misses);
    queue.requests_out(requests);
    queue.responses_in(responses);
  }
  ClockDomain clock{"clock", period()};
  Store store{clock};
  rtl::Link<MissToken> misses{"misses"};
  rtl::Link<rtl::MemoryRequest> requests{"requests"};
  rtl::Link<rtl::MemoryResponse> responses{"responses"};
  MissQueue queue;
};

// Lines of 128 bytes arrive in two beats: an error in one beat is one erroneous line, and the next
// line in the same entry has no error, also after a reset.
TEST(TextureRtlMissQueue, LineOfTwoBeatsFailsOnce) {
  spec::texture::Parameters p = small_cache();
  p.cache_bytes = 512;
  p.cache_line_bytes = 128;
  p.cache_outstanding = 1;
  QueueBench b(p);
  std::uint32_t line = 0;
  const auto ask = [&] {
    b.misses.push(b.clock.cycle(), {{++line}, 1});
    b.clock.run(4);
    ASSERT_FALSE(b.requests.empty());
    EXPECT_EQ(b.requests.front(b.clock.cycle()).lines, 2u);
    b.requests.pop(b.clock.cycle());
  };
  const auto answer = [&](std::uint16_t beat, bool failed) {
    rtl::MemoryResponse response;
    response.line = beat;
    response.last = beat == 1;
    response.status = failed ? rtl::MemoryStatus::kError : rtl::MemoryStatus::kOk;
    b.responses.push(b.clock.cycle(), response);
    b.clock.run(3);
  };
  const auto use = [&] {
    FillBuffer::Reader lines = b.queue.fills.reader();
    lines.read_ahead(b.clock.cycle());
    ASSERT_TRUE(lines.ready(b.clock.cycle() + 1));
    lines.release(b.clock.cycle() + 1);
    b.clock.run(2);
  };
  std::uint64_t errors = 0;
  for (const auto& [first, second] : {std::pair{false, false},
                                      {true, false},
                                      {false, false},
                                      {false, true},
                                      {false, false},
                                      {true, true},
                                      {false, false}}) {
    ask();
    answer(0, first);
    EXPECT_EQ(b.queue.memory_errors.value(), errors) << "the line has not come yet";
    answer(1, second);
    errors += first || second;
    EXPECT_EQ(b.queue.memory_errors.value(), errors) << first << second;
    use();
  }
  EXPECT_EQ(errors, 3u);
  ask();
  answer(0, true);
  b.clock.set_reset_n(false);
  b.clock.run(1);
  b.clock.set_reset_n(true);
  ask();
  answer(0, false);
  answer(1, false);
  EXPECT_EQ(b.queue.memory_errors.value(), 0u);
}

// The lines of two requests in one cycle exceed its write ports.
TEST(TextureRtlMissQueue, SecondRequestInOneCycleIsRejected) {
  QueueBench b;
  const MissToken two{{1, 2}, 2};
  b.misses.push(0, two);
  b.clock.run(2);
  EXPECT_THAT(of_a_second_token(b.queue, b.misses, two, b.clock), Rejects("lines", kTooMany));
}

// The cycle in which the lines of a second request enter a queue of four entries, when the link to
// memory is popped from cycle `from` on.
Cycle second_taken(Cycle from) {
  QueueBench b;
  b.misses.push(0, {{1, 2, 3, 4}, 4});
  while (b.misses.pops() < 2 && b.clock.cycle() < 40) {
    const Cycle now = b.clock.cycle();
    if (now == 1) b.misses.push(1, {{5, 6, 7, 8}, 4});
    if (now >= from && b.requests.can_pop(now)) b.requests.pop(now);
    b.clock.run(1);
  }
  return b.clock.cycle() - 1;
}
// Four entries, the last of which becomes free in that cycle: the first lines are taken in 1 and
// sent in 2, 3, 4 and 5.
TEST(TextureRtlMissQueue, EntryFreedInCycleIsReusedInCycle) { EXPECT_EQ(second_taken(0), 5u); }
// Two lines are in the link; from 10 on one is popped per cycle, and the others are sent in 11 and
// 12.
TEST(TextureRtlMissQueue, EntryIsReusedAfterMemoryStall) { EXPECT_EQ(second_taken(10), 12u); }

// The queue of a wide build takes eight lines in a cycle, or none.
TEST(TextureRtlMissQueue, TakesAllLinesOfGroup) {
  spec::texture::Parameters p = wide_cache();
  p.cache_outstanding = 12;
  QueueBench b(p);
  b.misses.push(0, {{0, 1, 2, 3, 4, 5, 6, 7}, 8});
  b.misses.push(1, {{8, 9, 10, 11, 12, 13}, 6});
  std::vector<std::uint64_t> sent;
  std::vector<Cycle> taken;
  while (b.clock.cycle() < 20) {
    const std::uint64_t pops = b.misses.pops();
    if (b.requests.can_pop(b.clock.cycle()))
      sent.push_back(b.requests.take(b.clock.cycle()).address / 64);
    b.clock.run(1);
    if (b.misses.pops() != pops) taken.push_back(b.clock.cycle() - 1);
  }
  // Eight in 1; two have to leave before there is room for six.
  EXPECT_THAT(taken, testing::ElementsAre(1, 3));
  EXPECT_THAT(sent, testing::ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11));
  EXPECT_GT(stalls(b.queue, "fill_buffer_full"), 0u);
  EXPECT_THAT((of_one_port_more<rtl::WritePort<std::uint32_t>, std::uint32_t>(b.queue, "lines")),
              Rejects("lines", "one port more than 1R8W"));
}

// If the link took a second request in one cycle, the next line would be read as well.
TEST(TextureRtlMissQueue, SecondLineSentInOneCycleIsRejected) {
  QueueBench b;
  b.misses.push(0, {{1, 2, 3}, 3});
  b.clock.run(3);  // taken in 1, the first line is sent in 2
  ASSERT_EQ(b.queue.line_fills.value(), 1u);
  b.requests.reset();
  EXPECT_THAT(read_one_cycle_early(b.queue, b.clock), Rejects("lines", kTooMany));
}

// Memory takes nothing: two lines are in the link, and the third waits and is counted as waiting.
TEST(TextureRtlMissQueue, WaitsWhileMemoryTakesNothing) {
  QueueBench b;
  b.misses.push(0, {{1, 2, 3}, 3});
  b.clock.run(10);  // taken in 1, sent in 2 and 3
  EXPECT_EQ(b.requests.occupancy(), 2u);
  EXPECT_EQ(b.queue.idle_cycles(), 1u);
  EXPECT_EQ(b.queue.busy_cycles(), 3u);
  EXPECT_EQ(b.queue.cycles_of(rtl::kStalledDownstream), 6u);
  EXPECT_EQ(b.queue.line_fills.value(), 2u);
  b.requests.pop(b.clock.cycle());
  b.clock.run(2);
  EXPECT_EQ(b.queue.line_fills.value(), 3u);
  EXPECT_EQ(b.queue.fill_bytes.value(), 3u * 64);
  EXPECT_EQ(b.queue.cycles_of(rtl::kStalledDownstream), 7u);
}

TEST(TextureRtlMissQueue, RejectsExtraPort) {
  QueueBench b;
  EXPECT_THAT((of_one_port_more<rtl::ReadPort<std::uint32_t>, std::uint32_t>(b.queue, "lines")),
              Rejects("lines", "one port more than 1R4W"));
  EXPECT_THAT((of_one_port_more<rtl::WritePort<std::uint32_t>, std::uint32_t>(b.queue, "lines")),
              Rejects("lines", "one port more than 1R4W"));
}

// A response for an entry that is already filled, and for one that does not exist.
TEST(TextureRtlMissQueue, RejectsRepeatedLine) {
  QueueBench b;
  b.misses.push(0, {{1}, 1});
  b.clock.run(3);
  const auto answer = [&](std::uint32_t tag) {
    rtl::MemoryResponse response;
    response.tag = tag;
    b.responses.push(b.clock.cycle(), response);
    return rejection([&] { b.clock.run(2); });
  };
  EXPECT_EQ(answer(0), "nothing");
  EXPECT_THAT(answer(0), Rejects("fill_buffer", "twice"));
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::miss_queue_test
