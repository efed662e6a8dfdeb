// SPDX-License-Identifier: MIT
// The WideTagStage alone: cycles of allocation, both outputs or neither, and what each use counts.
#include <set>
#include <tuple>

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/cache_bench.h"

namespace deburr::tb::texture_rtl::wide_tag_stage_test {
namespace {

using namespace rtl::texture;
using testing::ElementsAre;

// A group as the GroupFormer makes it.
LineGroup group_of(const std::vector<TexelToken>& requests) {
  LineGroup group{};
  group.count = static_cast<std::uint8_t>(requests.size());
  for (std::size_t n = 0; n < requests.size(); ++n) {
    const TexelToken& t = requests[n];
    group.at[n] = {t.ticket, t.control, {}, {}};
    if (!t.ticket.valid) continue;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto end = group.line.begin() + group.lines;
      const auto k = std::find(group.line.begin(), end, t.address[i] / 64) - group.line.begin();
      if (k == group.lines) {
        group.line[group.lines] = t.address[i] / 64;
        group.turned[group.lines++] = t.turned[i / 2];
      }
      group.at[n].index[i] = static_cast<std::uint8_t>(k);
      group.at[n].offset[i] = static_cast<std::uint8_t>(t.address[i] % 64);
    }
  }
  return group;
}
// A request with a texel in each of four lines.
TexelToken four(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  return request({64 * a, 64 * b + 4, 64 * c + 8, 64 * d + 12});
}
// A group that uses the lines first, ..., first + lines - 1.
LineGroup lines_from(std::uint32_t first, std::uint32_t lines) {
  std::vector<TexelToken> requests;
  for (std::uint32_t i = 0; i < std::max(lines, 1u); i += 4) {
    const auto line = [&](std::uint32_t k) {
      return first + std::min(i + k, std::max(lines, 1u) - 1);
    };
    requests.push_back(four(line(0), line(1), line(2), line(3)));
  }
  if (lines == 0) requests = {invalid_request()};
  return group_of(requests);
}

struct StageBench {
  explicit StageBench(const spec::texture::Parameters& p = wide_cache())
      : stage("stage", clock, p) {
    stage.groups_in(ends.in);
    stage.requests_out(ends.out);
    stage.misses_out(misses);
    stage.lines_used_in(lines_used);
    stage.stall_in(data_stall);
    stage.stall_out(stall);
  }
  void add(const std::vector<TexelToken>& requests) { ends.source.add(group_of(requests)); }
  ClockDomain clock{"clock", period()};
  Ends<LineGroup, CacheGroup> ends{clock};
  Link<MissToken> misses{"misses", 32};
  rtl::Wire<std::uint8_t> lines_used{"lines_used", 0};
  rtl::Wire<SlotStall> data_stall{"data_stall", SlotStall::kNone}, stall{"stall", SlotStall::kNone};
  WideTagStage stage;
};

TEST(TextureRtlWideTagStage, LatencyAndIntervalMatchDatasheet) {
  StageBench b;
  for (int i = 0; i < 9; ++i) b.add({in_line(0)});
  b.clock.run(20);
  ASSERT_EQ(b.ends.sink.taken.size(), 9u);
  const auto check = [&](const rtl::Datasheet& sheet) {
    expect_cycles(sheet, cycles_of(b.ends.sink), 1);
  };
  expect_detects_one_cycle(WideTagStage::datasheet(), &rtl::Datasheet::latency, check);
  expect_detects_one_cycle(WideTagStage::datasheet(), &rtl::Datasheet::interval, check);
}

// max(1, misses / A) cycles; in the last one the group and its misses leave, and the next group is
// taken.
class Allocation : public testing::TestWithParam<std::tuple<std::int32_t, std::uint32_t>> {};
TEST_P(Allocation, GroupTakesOneCyclePerAllocations) {
  const auto [allocations, missed] = GetParam();
  spec::texture::Parameters p = wide_cache();
  p.cache_allocations = allocations;
  StageBench b(p);
  const Cycle cycles = std::max<Cycle>(
      1, (missed + static_cast<Cycle>(allocations) - 1) / static_cast<Cycle>(allocations));
  b.ends.source.add(lines_from(0, missed));
  b.ends.source.add(lines_from(8, missed));
  b.ends.source.add(lines_from(0, missed));  // nothing to allocate
  std::vector<Cycle> sent;
  for (std::uint64_t pushes = 0; b.clock.cycle() < 40; b.clock.run(1))
    if (b.misses.pushes() != pushes) {
      sent.push_back(b.clock.cycle() - 1);
      pushes = b.misses.pushes();
    }
  // Taken in 1, looked up from 2 on, popped behind it one cycle after the push.
  const Cycle first = 1 + cycles, second = first + cycles, third = second + 1;
  EXPECT_THAT(cycles_of(b.ends.sink), ElementsAre(first + 1, second + 1, third + 1));
  if (missed == 0)
    EXPECT_TRUE(sent.empty());
  else
    EXPECT_THAT(sent, ElementsAre(first, second));
  EXPECT_EQ(stalls(b.stage, "allocate"), 2 * (cycles - 1));
  EXPECT_EQ(b.stall.high_cycles(b.clock.cycle()), 2 * (cycles - 1));
  EXPECT_EQ(b.stage.misses.value(), 2 * missed);
  for (int i = 0; i < 2 && missed != 0; ++i) {
    const MissToken& token = b.misses.take(b.clock.cycle() + static_cast<Cycle>(i));
    ASSERT_EQ(token.count, missed);
    for (std::uint32_t k = 0; k < missed; ++k)
      EXPECT_EQ(token.line[k], 8 * static_cast<std::uint32_t>(i) + k);
  }
}
INSTANTIATE_TEST_SUITE_P(TextureRtlWideTagStage, Allocation,
                         testing::Combine(testing::Values(1, 2, 3, 4), testing::Range(0u, 9u)));

// A group leaves with its misses or not at all; it repeats its last cycle.
class Held : public testing::TestWithParam<bool> {};
TEST_P(Held, GroupAndMissesLeaveTogether) {
  const bool fifo = GetParam();

  spec::texture::Parameters p = wide_cache();
  p.cache_allocations = 2;
  StageBench b(p);
  b.ends.source.add(lines_from(0, 4));
  b.ends.source.add(lines_from(0, 4));
  // Allocates in 2, its last cycle is 3; held in 3 and 4.
  while (b.clock.cycle() < 20) {
    const Cycle now = b.clock.cycle();
    if (now == 3 || now == 4) fifo ? b.ends.out.hold_push(now) : b.misses.hold_push(now);
    b.clock.run(1);
    if (now < 5) {
      EXPECT_TRUE(b.ends.out.empty() && b.misses.empty()) << now;
      EXPECT_EQ(b.stage.misses.value(), 0u) << now;
    }
  }
  EXPECT_THAT(cycles_of(b.ends.sink), ElementsAre(6, 7));
  EXPECT_EQ(b.misses.pushes(), 1u);
  EXPECT_EQ(stalls(b.stage, "allocate"), 1u);
  EXPECT_EQ(stalls(b.stage, "fifo_full"), fifo ? 2u : 0u);
  EXPECT_EQ(stalls(b.stage, "miss_queue_full"), fifo ? 0u : 2u);
  EXPECT_EQ(b.stage.misses.value(), 4u);
  EXPECT_EQ(b.stage.merged.value(), 4u);
}
INSTANTIATE_TEST_SUITE_P(TextureRtlWideTagStage, Held, testing::Bool());

// A group that hits does not wait for the MissQueue.
TEST(TextureRtlWideTagStage, HitsDoNotNeedMissQueue) {
  StageBench b;
  b.add({in_line(0)});
  b.add({in_line(0)});
  b.clock.run(3);
  for (Cycle now = 3; now < 9; ++now) {
    b.misses.hold_push(now);
    b.clock.run(1);
  }
  EXPECT_THAT(cycles_of(b.ends.sink), ElementsAre(3, 4));
}

// The wire names the stall of the previous cycle; for a full FIFO what the DataStage did.
class Stalled : public testing::TestWithParam<SlotStall> {};
TEST_P(Stalled, WireNamesStall) {
  const SlotStall data = GetParam();

  spec::texture::Parameters p = wide_cache();
  p.cache_allocations = 1;
  StageBench b(p);
  b.ends.source.add(lines_from(0, 2));
  std::vector<SlotStall> seen;
  while (b.clock.cycle() < 10) {
    const Cycle now = b.clock.cycle();
    if (now == 3) b.misses.hold_push(now);
    if (now == 4 || now == 5) b.ends.out.hold_push(now);
    if (now == 3) b.data_stall.drive(now, data);                   // read in 4
    if (now == 4) b.data_stall.drive(now, SlotStall::kWriteFill);  // read in 5
    seen.push_back(b.stall.read(now));
    b.clock.run(1);
  }
  using enum SlotStall;
  EXPECT_THAT(seen, ElementsAre(kNone, kNone, kNone, kAllocate, kMissQueue, data, kWriteFill, kNone,
                                kNone, kNone));
}
INSTANTIATE_TEST_SUITE_P(TextureRtlWideTagStage, Stalled,
                         testing::Values(SlotStall::kNone, SlotStall::kWaitFill,
                                         SlotStall::kWriteFill, SlotStall::kBankPass,
                                         SlotStall::kOutput));

// Every use of a line by a request counts, with the cycle in which the group leaves.
TEST(TextureRtlWideTagStage, EveryUseIsLookedUp) {
  spec::texture::Parameters p = wide_cache();
  p.cache_allocations = 1;
  StageBench b(p);
  using Seen = std::tuple<Cycle, std::uint32_t, LookUp>;
  std::vector<Seen> seen;
  b.stage.observer = [&](Cycle cycle, std::uint32_t line, LookUp outcome) {
    seen.emplace_back(cycle, line, outcome);
  };
  b.add({four(5, 9, 5, 9), invalid_request(), four(9, 9, 9, 9), four(5, 2, 9, 2)});
  b.add({in_line(2), in_line(9)});
  b.clock.run(20);
  const auto miss = LookUp::kMiss, merged = LookUp::kMerged;
  EXPECT_THAT(seen, ElementsAre(Seen{4, 5, miss}, Seen{4, 9, miss}, Seen{4, 9, merged},
                                Seen{4, 5, merged}, Seen{4, 2, miss}, Seen{4, 9, merged},
                                Seen{5, 2, merged}, Seen{5, 9, merged}));
  EXPECT_EQ(b.stage.requests.value(), 3u + 2);
  EXPECT_EQ(b.stage.misses.value(), 3u);
  EXPECT_EQ(b.stage.merged.value(), 3u + 2);
}

// Lines are hits from the cycle after their use on, up to four in a cycle.
class LinesUsed : public testing::TestWithParam<Cycle> {};
TEST_P(LinesUsed, LinesAreInFlightUntilWireReportsUse) {
  const Cycle used = GetParam();

  StageBench b;
  std::vector<LookUp> seen;
  b.stage.observer = [&](Cycle, std::uint32_t, LookUp outcome) { seen.push_back(outcome); };
  b.ends.source.add(lines_from(0, 4));
  for (int i = 0; i < 3; ++i) b.add({in_line(2)});
  b.clock.run(used);
  b.lines_used.drive(used, 3);
  b.clock.run(1);
  b.lines_used.drive(used + 1, 0);
  b.clock.run(20);
  ASSERT_EQ(seen.size(), 7u);
  for (Cycle i = 0; i < 3; ++i)  // looked up in 3, 4, 5
    EXPECT_EQ(seen[4 + i], 3 + i > used ? LookUp::kHit : LookUp::kMerged);
}
INSTANTIATE_TEST_SUITE_P(TextureRtlWideTagStage, LinesUsed, testing::Range<Cycle>(1, 6));

// Two lines of one set and the least recently used one: the order of uses within a group decides.
constexpr std::uint32_t kA = 0, kC = 32, kE = 64;  // one set of two ways
std::uint64_t misses_of(const std::vector<std::vector<TexelToken>>& groups) {
  StageBench b;
  for (const auto& group : groups) b.add(group);
  b.clock.run(20);
  return b.stage.misses.value();
}
TEST(TextureRtlWideTagStage, OlderLineOfGroupIsEvicted) {
  EXPECT_EQ(misses_of({{in_line(kA), in_line(kC)}, {in_line(kE)}, {in_line(kA)}}), 4u);
}
TEST(TextureRtlWideTagStage, UseByLaterGroupKeepsLine) {
  EXPECT_EQ(
      misses_of(
          {{in_line(kA), in_line(kC)}, {in_line(kC), in_line(kA)}, {in_line(kE)}, {in_line(kA)}}),
      3u);
}
TEST(TextureRtlWideTagStage, SecondUseInGroupKeepsLine) {
  EXPECT_EQ(misses_of({{in_line(kA), in_line(kC), in_line(kA)}, {in_line(kE)}, {in_line(kA)}}), 3u);
}
TEST(TextureRtlWideTagStage, LineMayBeEvictedBeforeFirstUseOfGroup) {
  EXPECT_EQ(misses_of({{in_line(kA), in_line(kC)}, {in_line(kE), in_line(kA)}}), 4u);
}

// Two lines of one set get different slots, which keep the low bits of the line.
TEST(TextureRtlWideTagStage, SlotsKeepBankOfLine) {
  StageBench b;
  b.add({four(1, 33, 2, 34), four(7, 12, 1, 33)});
  b.add({four(65, 1, 33, 97)});  // exceeds the set by itself
  b.clock.run(20);
  std::set<std::uint32_t> slots;
  const CacheGroup& group = b.ends.sink.taken[0].token;
  ASSERT_EQ(group.lines, 6u);
  const std::vector<std::uint32_t> lines = {1, 33, 2, 34, 7, 12};
  for (std::size_t k = 0; k < lines.size(); ++k) {
    EXPECT_TRUE(group.missed[k]);
    EXPECT_EQ(group.slot[k] % 32, lines[k] % 32);
    EXPECT_TRUE(slots.insert(group.slot[k]).second);
  }
  // 65 evicts 1, 1 evicts 33, 33 evicts 65, 97 evicts 1: in the order of the texels.
  const CacheGroup& alone = b.ends.sink.taken[1].token;
  const auto way = [](std::uint16_t slot) { return slot / 32; };
  EXPECT_THAT(std::vector(alone.missed.begin(), alone.missed.begin() + 4),
              ElementsAre(true, true, true, true));
  const int first = way(group.slot[0]);
  EXPECT_THAT(
      (std::vector{way(alone.slot[0]), way(alone.slot[1]), way(alone.slot[2]), way(alone.slot[3])}),
      ElementsAre(first, 1 - first, first, 1 - first));
}

TEST(TextureRtlWideTagStage, RejectsExtraPort) {
  StageBench b;
  EXPECT_THAT((of_one_port_more<rtl::ReadPort<void>, void>(b.stage, "tags")),
              Rejects("tags", "one port more than 8R8W"));
  EXPECT_THAT((of_one_port_more<rtl::WritePort<void>, void>(b.stage, "tags")),
              Rejects("tags", "one port more than 8R8W"));
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::wide_tag_stage_test
