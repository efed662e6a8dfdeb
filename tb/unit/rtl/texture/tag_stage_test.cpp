// SPDX-License-Identifier: MIT
// The TagStage in the cache: merged misses, fill order, hits after misses.
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/cache_bench.h"

namespace deburr::tb::texture_rtl::tag_stage_test {
namespace {

using namespace rtl::texture;
using testing::ElementsAre;

// Two requests for a line in flight are one fetch; their results are one cycle apart.
TEST(TextureRtlTagStage, MergesSecondRequestForLineInFlight) {
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

// The stage alone: its misses are not taken.
struct StageBench {
  StageBench() {
    stage.texels_in(ends.in);
    stage.requests_out(ends.out);
    stage.misses_out(misses);
    stage.line_used_in(line_used);
  }
  ClockDomain clock{"clock", period()};
  Ends<TexelToken, CacheToken> ends{clock};
  Link<MissToken> misses{"misses"};
  rtl::Wire<bool> line_used{"line_used", false};
  TagStage stage{"stage", clock, small_cache()};
};

TEST(TextureRtlTagStage, LatencyAndIntervalMatchDatasheet) {
  StageBench b;
  for (int i = 0; i < 9; ++i) b.ends.source.add(in_line(0));
  b.clock.run(20);
  ASSERT_EQ(b.ends.sink.taken.size(), 9u);
  expect_cycles(TagStage::datasheet(), cycles_of(b.ends.sink), 1);
}

// A line is a hit from the cycle after its use; a reset clears lines and uses.
constexpr Cycle kFirstLookup = 2;  // of the first request, which misses
class LineUsed : public testing::TestWithParam<Cycle> {};
TEST_P(LineUsed, LineIsInFlightUntilWireReportsUse) {
  const Cycle used = GetParam();
  StageBench b;
  std::vector<std::pair<Cycle, LookUp>> seen;
  b.stage.observer = [&](Cycle cycle, std::uint32_t, LookUp outcome) {
    seen.emplace_back(cycle, outcome);
  };
  for (int i = 0; i < 4; ++i) b.ends.source.add(in_line(0));
  b.clock.run(used);
  b.line_used.drive(used, true);
  b.clock.run(1);
  b.line_used.drive(used + 1, false);
  b.clock.run(10);
  ASSERT_EQ(seen.size(), 4u);
  EXPECT_EQ(seen[0], std::pair(kFirstLookup, LookUp::kMiss));
  for (Cycle i = 1; i < 4; ++i)
    EXPECT_EQ(seen[i], std::pair(kFirstLookup + i,
                                 kFirstLookup + i <= used ? LookUp::kMerged : LookUp::kHit));
  b.clock.set_reset_n(false);
  b.clock.run(1);
  b.clock.set_reset_n(true);
  seen.clear();
  for (int i = 0; i < 2; ++i) b.ends.source.add(in_line(0));
  b.clock.run(10);
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen[0].second, LookUp::kMiss);
  EXPECT_EQ(seen[1].second, LookUp::kMerged);
}
INSTANTIATE_TEST_SUITE_P(TextureRtlTagStage, LineUsed,
                         testing::Values(kFirstLookup, kFirstLookup + 1, kFirstLookup + 2));

// The observer sees each line once per request, in the cycle of its lookup.
TEST(TextureRtlTagStage, ReportsOutcomeOfEachLine) {
  CacheBench b;
  using Seen = std::tuple<Cycle, std::uint32_t, LookUp>;
  std::vector<Seen> seen;
  b.cache.tag_stage.observer = [&](Cycle cycle, std::uint32_t line, LookUp outcome) {
    seen.emplace_back(cycle, line, outcome);
  };
  for (const auto& t : {in_line(0), in_line(0), request({64 * 3, 4, 64 * 3 + 4, 8})})
    b.ends.source.add(t);
  b.clock.run(60);
  ASSERT_EQ(seen.size(), 4u);
  const Cycle first = std::get<Cycle>(seen.front());
  EXPECT_THAT(seen,
              ElementsAre(Seen{first, 0, LookUp::kMiss}, Seen{first + 1, 0, LookUp::kMerged},
                          Seen{first + 2, 3, LookUp::kMiss}, Seen{first + 2, 0, LookUp::kMerged}));
  seen.clear();
  const Cycle asked = b.clock.cycle();
  b.time_of(in_line(3));
  EXPECT_THAT(seen, ElementsAre(Seen{asked + 2, 3, LookUp::kHit}));
}

// Fills are in the order of the misses, in whatever order memory answers.
TEST(TextureRtlTagStage, FillsFollowOrderOfMisses) {
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

// Whichever of the four texels share a line: each line is fetched once and each texel is correct.
TEST(TextureRtlTagStage, TexelsMayShareLinesInAnyWay) {
  spec::texture::Parameters p = small_cache();
  p.cache_bytes = 16384;
  p.cache_ways = 4;
  p.cache_outstanding = 64;
  p.cache_fifo_depth = 64;
  CacheBench b(p);
  std::vector<TexelToken> asked;
  std::uint64_t lines = 0;
  for (std::uint32_t second = 0; second < 2; ++second)
    for (std::uint32_t third = 0; third < 3; ++third)
      for (std::uint32_t fourth = 0; fourth < 4; ++fourth) {
        const std::uint32_t base = 4 * static_cast<std::uint32_t>(asked.size());
        const std::array<std::uint32_t, 4> of = {0, second, third, fourth};
        std::array<std::uint32_t, 4> address{};
        for (std::uint32_t i = 0; i < 4; ++i) address[i] = 64 * (base + of[i]) + 4 * i;
        asked.push_back(request(address));
        lines += std::set<std::uint32_t>(of.begin(), of.end()).size();
      }
  for (const auto& t : asked) b.ends.source.add(t);
  b.clock.run(2000);
  b.check_data(asked);
  EXPECT_EQ(b.cache.tag_stage.misses.value(), lines);
  EXPECT_EQ(b.memory.lines_read().size(), lines);
}

// Line numbers are compared completely, not only by common set bits: lines 1 and 2.
TEST(TextureRtlTagStage, DistinguishesLinesWithoutCommonBit) {
  CacheBench b;
  std::vector<TexelToken> asked;
  for (std::size_t i = 1; i < 4; ++i) {
    std::array<std::uint32_t, 4> address = {64, 68, 72, 76};
    address[i] = 128;
    asked.push_back(request(address));
  }
  for (const auto& t : asked) b.time_of(t);
  b.check_data(asked);
  EXPECT_EQ(b.cache.tag_stage.misses.value(), 2u);
}

// A hit passes the tag stage while the miss queue is full.
TEST(TextureRtlTagStage, HitsProceedWhileMissQueueIsFull) {
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

// A request that hits several lines proceeds as well.
TEST(TextureRtlTagStage, HitsInTwoLinesProceed) {
  CacheBench b(small_cache(), 200);
  const TexelToken two_lines = request({64, 68, 192, 196});  // of set 1
  b.time_of(two_lines);
  for (std::uint32_t i = 0; i < 4; ++i)
    b.ends.source.add(request({0x1000 + 512 * i, 0x1080 + 512 * i, 0x1100 + 512 * i,
                               0x1180 + 512 * i}));  // 4 x 4 lines of set 0
  for (int i = 0; i < 5; ++i) b.ends.source.add(two_lines);
  b.clock.run(30);
  EXPECT_EQ(b.cache.tag_stage.requests.value(), 1u + 4 + 5);
}

// A request with a miss waits, whichever of its texels misses, or all of them.
class OneMiss : public testing::TestWithParam<std::size_t> {};
TEST_P(OneMiss, WaitsForMissQueue) {
  CacheBench b(small_cache(), 200);
  b.time_of(in_line(1));
  std::vector<TexelToken> asked = {in_line(1)};
  for (std::uint32_t i = 0; i < 4; ++i)
    asked.push_back(request({0x1000 + 512 * i, 0x1080 + 512 * i, 0x1100 + 512 * i,
                             0x1180 + 512 * i}));  // 4 x 4 lines of set 0
  std::array<std::uint32_t, 4> address = {64, 68, 80, 84};
  address[GetParam() % 4] = 0x40C0;  // of set 1, as the others
  asked.push_back(GetParam() < 4 ? request(address) : in_line(0x103));
  for (std::size_t i = 1; i < asked.size(); ++i) b.ends.source.add(asked[i]);
  b.clock.run(30);
  EXPECT_EQ(b.cache.tag_stage.requests.value(), 1u + 4);
  EXPECT_GT(b.cache.tag_stage.stalls()[1].cycles, 10u);
  b.clock.run(2000);
  b.check_data(asked);
}
INSTANTIATE_TEST_SUITE_P(TextureRtlTagStage, OneMiss, testing::Values(0, 1, 2, 3, 4));

}  // namespace
}  // namespace deburr::tb::texture_rtl::tag_stage_test
