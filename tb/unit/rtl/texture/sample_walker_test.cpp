// SPDX-License-Identifier: MIT
// The SampleWalker alone: cycles, stalls and ports. Values are compared in equivalence_test.cpp.
#include "rtl_model/texture/sample_walker.h"

#include "spec/texture/tables.h"
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::sample_walker_test {
namespace {

using namespace rtl::texture;

struct WalkerBench {
  WalkerBench(ClockDomain& clock, const std::string& name, spec::texture::Kernel kernel,
              std::int32_t spread,
              spec::texture::CountRule count = spec::texture::CountRule::kFloor,
              spec::texture::Blend blend = spec::texture::Blend::kSample)
      : unit((name + "unit").c_str(), clock, count, kernel, spread, blend), ends(clock, name) {
    unit.levels_in(ends.in);
    unit.samples_out(ends.out);
  }
  SampleWalker unit;
  Ends<LevelToken, SampleToken> ends;
};

rtl::Datasheet sheet_of(spec::texture::CountRule count) {
  spec::texture::Parameters p;
  p.count = count;
  return SampleWalker::datasheet(p);
}

TEST(TextureRtlWalker, LatencyMatchesDatasheet) {
  ClockDomain clock("clock", period());
  using spec::texture::CountRule;
  WalkerBench floor(clock, "floor_", spec::texture::Kernel::kBox, 64),
      any(clock, "any_", spec::texture::Kernel::kBox, 64, CountRule::kAny);
  for (WalkerBench* b : {&floor, &any}) b->ends.in.push(0, {ticket(), 0, 0, 0, 0, 0, 0, 0, true});
  clock.run(1);
  const Cycle taken = 1;
  expect_latency(sheet_of(CountRule::kFloor), ready_at(clock, floor.ends.out) - taken);
  expect_latency(sheet_of(CountRule::kAny), ready_at(clock, any.ends.out) - taken);
}

// One sample each: one fragment per cycle, also through the division; nothing is lost in a stall.
TEST(TextureRtlWalker, AnyCountSustainsOneFragmentPerCycle) {
  ClockDomain clock("clock", period());
  WalkerBench b(clock, "", spec::texture::Kernel::kBox, 64, spec::texture::CountRule::kAny);
  for (std::uint8_t i = 0; i < 60; ++i) b.ends.source.add({ticket(i), i, 0, 0, 0, 0, 0, 0, true});
  b.ends.sink.hold_from = 30;
  b.ends.sink.hold_to = 41;
  clock.run(100);
  ASSERT_EQ(b.ends.sink.taken.size(), 60u);
  for (std::size_t i = 0; i < 60; ++i) {
    const Cycle alone = i + 1 + sheet_of(spec::texture::CountRule::kAny).latency.cycles;
    EXPECT_EQ(b.ends.sink.taken[i].cycle, alone < 30 ? alone : alone + 11);
    EXPECT_EQ(b.ends.sink.taken[i].token.ticket.tag, i);
  }
}

// While its requests wait, fragments move on until each stage holds one.
TEST(TextureRtlWalker, StagesFillWhileOutputWaits) {
  ClockDomain clock("clock", period());
  using spec::texture::CountRule;
  WalkerBench floor(clock, "floor_", spec::texture::Kernel::kBox, 64),
      any(clock, "any_", spec::texture::Kernel::kBox, 64, CountRule::kAny);
  for (WalkerBench* b : {&floor, &any}) {
    b->ends.sink.hold_to = 1000;
    b->ends.source.add({ticket(), 0, 0, 0, 0, 15, 0, 0, true});
  }
  clock.run(30);
  for (WalkerBench* b : {&floor, &any})
    for (std::uint8_t i = 1; i < 6; ++i) b->ends.source.add({ticket(i), 0, 0, 0, 0, 0, 0, 0, true});
  clock.run(30);
  EXPECT_EQ(floor.ends.in.pops(), 2u);
  EXPECT_EQ(any.ends.in.pops(), 3u);
}

struct DividingBench : WalkerBench {
  explicit DividingBench(ClockDomain& domain)
      : WalkerBench(domain, "", spec::texture::Kernel::kBox, 64, spec::texture::CountRule::kAny) {
    ends.source.add(token);
    domain.run(2);  // taken in 1
  }
  const LevelToken token = {ticket(), 0, 0, 8, 8, 2, 0, 0, true};
};

TEST(TextureRtlWalkerReciprocal, WordReadInSameCycleIsRejected) {
  ClockDomain clock("clock", period());
  DividingBench b(clock);
  EXPECT_THAT(read_one_cycle_early(b.unit, clock), Rejects("reciprocal", kEarly));
}

TEST(TextureRtlWalkerReciprocal, SecondFragmentInOneCycleIsRejected) {
  ClockDomain clock("clock", period());
  DividingBench b(clock);
  EXPECT_THAT(of_a_second_token(b.unit, b.ends.in, b.token, clock),
              Rejects("reciprocal", kTooMany));
}

TEST(TextureRtlWalker, CostsNTimesLevelsCycles) {
  ClockDomain clock("clock", period());
  WalkerBench b(clock, "", spec::texture::Kernel::kBox, 64);
  Cycle at = 4;  // pushed in 0, taken in 1, to be taken in 4
  std::vector<Cycle> last;
  for (std::uint8_t n = 0; n <= 4; ++n)
    for (const std::uint8_t fraction : std::to_array<std::uint8_t>({0, 77})) {
      b.ends.source.add(
          {ticket(), 0, 0, 0, 0, static_cast<std::uint8_t>((1 << n) - 1), 1, fraction, true});
      at += (1u << n) * (fraction ? 2 : 1);
      last.push_back(at - 1);
    }
  Ticket invalid = ticket();
  invalid.valid = false;
  b.ends.source.add({invalid, 0, 0, 0, 0, 0, 0, 0, false});
  last.push_back(at);
  clock.run(200);
  std::vector<Cycle> got;
  for (const auto& t : b.ends.sink.taken)
    if (t.token.last_of_fragment) got.push_back(t.cycle);
  EXPECT_EQ(got, last);
}

// Three samples of levels 4 and 5 along an axis of three units, at -1, 0 and 1: with `level` all of
// level 4 come first, and both orders take the same cycles.
TEST(TextureRtlWalker, BlendLevelEmitsFinerLevelFirst) {
  struct Request {
    std::int64_t s;
    int level, index, weight;
    bool last_of_sample, last_of_fragment;
    bool operator==(const Request&) const = default;
  };
  using spec::texture::Blend;
  const std::vector<Request> by_sample = {{99, 4, 0, 179, false, false},
                                          {99, 5, 0, 77, true, false},
                                          {100, 4, 1, 179, false, false},
                                          {100, 5, 1, 77, true, false},
                                          {101, 4, 2, 179, false, false},
                                          {101, 5, 2, 77, true, true}},
                             by_level = {
                                 {99, 4, 0, 179, false, false}, {100, 4, 1, 179, false, false},
                                 {101, 4, 2, 179, true, false}, {99, 5, 0, 77, false, false},
                                 {100, 5, 1, 77, false, false}, {101, 5, 2, 77, true, true}};
  ClockDomain clock("clock", period());
  WalkerBench sample(clock, "sample_", spec::texture::Kernel::kBox, 64,
                     spec::texture::CountRule::kAny, Blend::kSample),
      level(clock, "level_", spec::texture::Kernel::kBox, 64, spec::texture::CountRule::kAny,
            Blend::kLevel);
  for (WalkerBench* b : {&sample, &level}) {
    b->ends.source.add({ticket(), 100, 0, 3, -3, 2, 4, 77, true});
    b->ends.source.add({ticket(), 100, 0, 3, -3, 2, 4, 0, true});  // only one level
  }
  clock.run(30);
  for (const WalkerBench* b : {&sample, &level}) {
    std::vector<Request> got;
    std::vector<Cycle> cycles, expected_cycles;
    for (const auto& t : b->ends.sink.taken) {
      EXPECT_EQ(t.token.t, 100 - t.token.s);
      cycles.push_back(t.cycle);
      if (got.size() < 6)
        got.push_back({t.token.s, t.token.level, t.token.index, t.token.level_weight,
                       t.token.last_of_sample, t.token.last_of_fragment});
    }
    EXPECT_EQ(got, b == &level ? by_level : by_sample);
    for (Cycle i = 0; i < 9; ++i)
      expected_cycles.push_back(1 + sheet_of(spec::texture::CountRule::kAny).latency.cycles + i);
    EXPECT_EQ(cycles, expected_cycles);
    EXPECT_EQ(b->unit.samples.value(), 6u);
    ASSERT_EQ(b->ends.sink.taken.size(), 9u);
    for (std::size_t i = 6; i < 9; ++i) {
      EXPECT_EQ(b->ends.sink.taken[i].token.level_weight, 256);
      EXPECT_EQ(b->ends.sink.taken[i].token.last_of_sample, b == &sample || i == 8);
      EXPECT_EQ(b->ends.sink.taken[i].token.last_of_fragment, i == 8);
    }
  }
}

// `kernel = axis` by hand: from five samples on, a diagonal axis makes a tent of 91/64 of it, which
// `last_index` tells; all others are boxes. One request per cycle, also through a stall.
TEST(TextureRtlWalker, KernelAxisMakesTentsOfDiagonals) {
  using spec::texture::CountRule, spec::texture::Kernel;
  ClockDomain clock("clock", period());
  WalkerBench any(clock, "any_", Kernel::kAxis, 64, CountRule::kAny),
      floor(clock, "floor_", Kernel::kAxis, 64, CountRule::kFloor),
      long_spread(clock, "long_", Kernel::kAxis, 128, CountRule::kAny);
  struct Fragment {
    std::uint8_t n;
    bool diagonal, tent;
  };
  const std::vector<Fragment> fragments = {{1, true, false},  {4, true, false},  {8, true, true},
                                           {8, false, false}, {16, true, true},  {16, false, false},
                                           {5, true, true},   {5, false, false}, {13, true, true}};
  constexpr std::int64_t kAxis = 1 << 20;
  const auto check = [&](WalkerBench& b, std::int64_t box, std::int64_t tent, bool powers) {
    SCOPED_TRACE(b.unit.name());
    std::size_t at = 0;
    const Cycle first = b.ends.sink.taken.at(0).cycle;
    for (const Fragment& f : fragments) {
      if (powers && (f.n & (f.n - 1)) != 0) continue;
      for (int i = 0; i < f.n; ++i, ++at) {
        const auto& [cycle, token] = b.ends.sink.taken.at(at);
        EXPECT_EQ(token.last_index, f.n - 1 + (f.tent ? 16 : 0)) << int{f.n};
        EXPECT_EQ(token.index, i);
        const std::int64_t product =
            (2 * i + 1 - f.n) * (f.tent ? tent : box) * kAxis * spec::texture::kReciprocal[f.n];
        EXPECT_EQ(token.s, 7 + ((product + (1 << 22)) >> 23)) << int{f.n} << " " << i;
        EXPECT_EQ(token.t, 9 + ((-product + (1 << 22)) >> 23));
        EXPECT_EQ(cycle, first + at < 20 ? first + at : first + at + 11);
      }
    }
    EXPECT_EQ(at, b.ends.sink.taken.size());
  };
  for (WalkerBench* b : {&any, &floor, &long_spread}) {
    for (const Fragment& f : fragments)
      if (b != &floor || (f.n & (f.n - 1)) == 0)
        b->ends.source.add({ticket(), 7, 9, kAxis, -kAxis, static_cast<std::uint8_t>(f.n - 1), 0, 0,
                            true, f.diagonal});
    b->ends.sink.hold_from = 20;
    b->ends.sink.hold_to = 31;
  }
  clock.run(150);
  check(any, 64, 91, false);
  check(floor, 64, 91, true);
  check(long_spread, 128, 181, false);
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::sample_walker_test
