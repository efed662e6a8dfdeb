// SPDX-License-Identifier: MIT
// The MissQueue in the cache: what a line takes of its clocks, and a full queue.
#include "tb/unit/rtl/texture/cache_bench.h"

namespace deburr::tb::texture_rtl {
namespace {

using namespace rtl::texture;

// What the miss queue does for one line: queue it, send it, take it; between, it waits.
TEST(TextureRtlMissQueue, MissQueueAccountsForItsClocks) {
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

TEST(TextureRtlMissQueue, FullQueueStallsTheTagStageAndLosesNothing) {
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

}  // namespace
}  // namespace deburr::tb::texture_rtl
