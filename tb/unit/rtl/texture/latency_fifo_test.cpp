// SPDX-License-Identifier: MIT
// The LatencyFifo in the cache: full, and deep enough to hide the memory latency.
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/cache_bench.h"

namespace deburr::tb::texture_rtl::latency_fifo_test {
namespace {

using namespace rtl::texture;

TEST(TextureRtlLatencyFifo, LatencyMatchesDatasheet) {
  ClockDomain clock("clock", period());
  LatencyFifo fifo("fifo", clock, small_cache());
  Link<CacheToken> requests("requests");
  fifo.requests_in(requests);
  requests.push(0, {});
  Cycle latency = 0;
  for (clock.run(1); !fifo.entries.can_pop(clock.cycle()) && latency < 9; ++latency) clock.run(1);
  expect_latency(LatencyFifo::datasheet(), latency);  // taken in 1
}

TEST(TextureRtlLatencyFifo, FullFifoStallsTagStage) {
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

// Misses overlap: while the FIFO covers the latency, each request costs one cycle.
TEST(TextureRtlLatencyFifo, DeepFifoHidesLatency) {
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

}  // namespace
}  // namespace deburr::tb::texture_rtl::latency_fifo_test
