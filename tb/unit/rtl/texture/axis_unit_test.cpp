// SPDX-License-Identifier: MIT
// The AxisUnit alone: ties by hand, from docs/reference/texture/formats.md, and its cycles. Other
// values are compared in equivalence_test.cpp.
#include "rtl_model/texture/axis_unit.h"

#include <array>

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::axis_unit_test {
namespace {

using namespace rtl::texture;
using spec::texture::Axes;
using spec::texture::FootprintRule;

struct AxisBench {
  AxisBench(ClockDomain& clock, const std::string& name, Axes axes, FootprintRule rule,
            std::int32_t cycles = 1)
      : unit((name + "unit").c_str(), clock, axes, rule, cycles), ends(clock, name) {
    unit.derivatives_in(ends.in);
    unit.footprints_out(ends.out);
  }
  AxisUnit unit;
  Ends<DerivativeToken, FootprintToken> ends;
};

// P and D of a fragment in a 1024 x 1024 texture: a texel is 64 of 2^16 coordinate units.
DerivativeToken token(std::int64_t s_x, std::int64_t t_x, std::int64_t s_y, std::int64_t t_y,
                      std::uint32_t tag = 0) {
  const auto size = [](std::int64_t v) {
    return static_cast<std::uint32_t>(std::min(std::abs(v), std::int64_t{0x7FFFFFFF}));
  };
  return {ticket(tag), 11, -12, s_x, t_x, s_y, t_y, size(s_x), size(t_x), size(s_y), size(t_y)};
}

// By hand: rows and columns that are equal, opposite, or at right angles.
TEST(TextureRtlAxis, MatchesValuesByHand) {
  ClockDomain clock("clock", period());
  AxisBench b(clock, "", Axes::kEight, FootprintRule::kExact);
  b.ends.source.add(token(1280, 0, 0, 1280));     // a square: 0 and 4 are equal, the smaller wins
  b.ends.source.add(token(0, 0, 0, 1280));        // upright
  b.ends.source.add(token(1280, 0, 1280, 0));     // both equal: 45 degrees, (90 + 90) x 10
  b.ends.source.add(token(1280, 0, -1280, 0));    // 135 degrees
  b.ends.source.add(token(-1280, 256, 0, 2560));  // 67.5: 49 P_x + 118 P_y, against 0 + 128 P_y
  clock.run(60);
  const auto& taken = b.ends.sink.taken;
  ASSERT_EQ(taken.size(), 5u);
  const std::int64_t d[] = {1280, 1280, 1800, 1800, 2560};
  const std::int64_t s[] = {1280, 0, 1800, -1800, 0};
  const std::uint64_t area[] = {25, 0, 0, 0, 50};  // 5 x 5 in U15.8; 5 x 10 + 1 x 0
  for (std::size_t i = 0; i < 5; ++i) {
    if (i < 4) {
      EXPECT_EQ(taken[i].token.d_max, d[i]) << i;
      EXPECT_EQ(taken[i].token.axis_s, s[i]) << i;
    }
    EXPECT_EQ(taken[i].token.minor, area[i]) << i;
  }
  // 67.5 degrees: s = -49 x 10, t = 49 x 2 + 118 x 20 = 2458: 2506.4; upright 2560 is longer.
  EXPECT_EQ(taken[4].token.d_max, 2560u);
  EXPECT_EQ(taken[4].token.axis_t, 2560);
}

// The long side of a footprint turns by 22.5 degrees from row to row. Only 45 and 135 degrees are
// diagonals of the pixel, with four as with eight directions.
TEST(TextureRtlAxis, DiagonalsAreMarked) {
  ClockDomain clock("clock", period());
  AxisBench four(clock, "four_", Axes::kFour, FootprintRule::kExact),
      eight(clock, "eight_", Axes::kEight, FootprintRule::kHalf, 4);
  constexpr std::array kCosine = {1280, 1180, 900, 490, 0, -490, -900, -1180},
                       kSine = {0, 490, 900, 1180, 1280, 1180, 900, 490};
  for (AxisBench* b : {&four, &eight}) {
    for (std::size_t i = 0; i < 8; ++i) b->ends.source.add(token(kCosine[i], 0, kSine[i], 0));
    b->ends.sink.hold_from = 20;
    b->ends.sink.hold_to = 45;
  }
  clock.run(100);
  const auto diagonals = [](const AxisBench& b) {
    std::vector<int> all;
    for (const auto& taken : b.ends.sink.taken) all.push_back(taken.token.diagonal ? 1 : 0);
    return all;
  };
  using testing::ElementsAre;
  EXPECT_THAT(diagonals(eight), ElementsAre(0, 0, 1, 0, 0, 0, 1, 0));
  // A long side between two of four directions belongs to the row or the column here.
  EXPECT_THAT(diagonals(four),
              ElementsAre(0, testing::_, 1, testing::_, 0, testing::_, 1, testing::_));
}

struct Timed {
  const char* name;
  Axes axes;
  FootprintRule rule;
  std::int32_t cycles;

  rtl::Datasheet sheet() const {
    spec::texture::Parameters p;
    p.axes = axes;
    p.footprint = rule;
    p.axis_cycles = cycles;
    return AxisUnit::datasheet(p);
  }
};
constexpr std::array<Timed, 7> kTimed = {{
    {"four_", Axes::kFour, FootprintRule::kHalf, 1},
    {"four2_", Axes::kFour, FootprintRule::kMax, 2},
    {"eight_", Axes::kEight, FootprintRule::kTwoSegment, 1},
    {"eight2_", Axes::kEight, FootprintRule::kQuarter, 2},
    {"eight4_", Axes::kEight, FootprintRule::kHalf, 4},
    {"exact_", Axes::kEight, FootprintRule::kExact, 1},
    {"exact4_", Axes::kEight, FootprintRule::kExact, 4},
}};

TEST(TextureRtlAxis, LatencyAndCyclesFollowConfiguration) {
  ClockDomain clock("clock", period());
  std::vector<std::unique_ptr<AxisBench>> benches;
  for (const Timed& row : kTimed) {
    benches.push_back(std::make_unique<AxisBench>(clock, row.name, row.axes, row.rule, row.cycles));
    benches.back()->ends.in.push(0, token(1, 2, 3, 4));
    benches.back()->ends.sink.hold_to = 1000;
  }
  clock.run(1);
  const Cycle taken = 1;
  while (clock.cycle() < taken + 30) {
    for (std::size_t i = 0; i < benches.size(); ++i)
      EXPECT_EQ(benches[i]->ends.out.can_pop(clock.cycle()),
                clock.cycle() >= taken + kTimed[i].sheet().latency.cycles)
          << kTimed[i].name << clock.cycle();
    clock.run(1);
  }
}

// One fragment per axis_cycles, also through a stall.
TEST(TextureRtlAxis, IntervalIsAxisCycles) {
  constexpr Cycle kHeld = 30, kStall = 13;  // every row is then in the middle of its tokens
  ClockDomain clock("clock", period());
  std::vector<std::unique_ptr<AxisBench>> benches;
  for (const Timed& row : kTimed) {
    benches.push_back(std::make_unique<AxisBench>(clock, row.name, row.axes, row.rule, row.cycles));
    for (std::uint32_t i = 0; i < 40; ++i)
      benches.back()->ends.source.add(token(10 * i, 2, 3, 400, i));
    benches.back()->ends.sink.hold_from = kHeld;
    benches.back()->ends.sink.hold_to = kHeld + kStall;
  }
  clock.run(400);
  for (std::size_t i = 0; i < benches.size(); ++i) {
    SCOPED_TRACE(kTimed[i].name);
    const auto& got = benches[i]->ends.sink.taken;
    ASSERT_EQ(got.size(), 40u);
    const rtl::Datasheet sheet = kTimed[i].sheet();
    const Cycle cycles = sheet.interval.cycles;
    const auto alone = [&](Cycle n) { return 1 + n * cycles + sheet.latency.cycles; };
    for (std::size_t n = 0; n < 40; ++n) {
      if (alone(n) < kHeld) {
        EXPECT_EQ(got[n].cycle, alone(n));
      }
      EXPECT_EQ(got[n].token.ticket.tag, n);
    }
    // The two entries of the link fill in the meantime; the unit is late by the rest of the stall.
    const Cycle late = got.back().cycle - alone(39);
    EXPECT_LE(late, kStall);
    EXPECT_GE(late + 3 * (cycles - 1), kStall);
  }
}

TEST(TextureRtlAxis, ResetDropsFragmentInProgress) {
  ClockDomain clock("clock", period());
  AxisBench b(clock, "", Axes::kEight, FootprintRule::kHalf, 4);
  b.ends.source.add(token(1, 2, 3, 4, 1));
  clock.run(3);  // taken in 1, three more cycles of directions
  clock.set_reset_n(false);
  clock.run(1);
  clock.set_reset_n(true);
  b.ends.source.add(token(1, 2, 3, 4, 2));
  clock.run(40);
  ASSERT_EQ(b.ends.sink.taken.size(), 1u);
  EXPECT_EQ(b.ends.sink.taken[0].token.ticket.tag, 2u);
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::axis_unit_test
