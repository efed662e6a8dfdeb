// SPDX-License-Identifier: MIT
// The AxisUnit alone, against a reference written from docs/reference/texture/formats.md, and its
// clocks.
#include "rtl_model/texture/axis_unit.h"

#include <array>
#include <cmath>

#include "spec/texture/tables.h"
#include "tb/base/random.h"
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::axis_unit_test {
namespace {

using namespace rtl::texture;
using spec::texture::Axes;
using spec::texture::FootprintRule;

struct AxisBench {
  AxisBench(ClockDomain& clock, const std::string& name, Axes axes, FootprintRule rule,
            std::int32_t clocks = 1)
      : unit((name + "unit").c_str(), clock, axes, rule, clocks), ends(clock, name) {
    unit.derivatives_in(ends.in);
    unit.footprints_out(ends.out);
  }
  AxisUnit unit;
  Ends<DerivativeToken, FootprintToken> ends;
};

struct Expected {
  std::int64_t d_max, axis_s, axis_t;
  std::uint64_t area;
  int k;
};

std::int64_t root(std::int64_t x) {
  auto r = static_cast<std::int64_t>(std::sqrt(static_cast<long double>(x)));
  while (r * r > x) --r;
  while ((r + 1) * (r + 1) <= x) ++r;
  return r;
}

// What a wrong unit would do.
enum class Wrong {
  kNothing,
  kSwapped,      // sine and cosine of 22.5 degrees
  kSwappedFlat,  // the same in coordinates alone: lengths are right, samples lie elsewhere
  kExchanged,    // 49 and 118 everywhere: the same candidates in another order, so ties alone tell
  kLargest       // k of equally long candidates
};

// The contract, line by line.
Expected expected(const DerivativeToken& d, Axes axes, FootprintRule rule,
                  Wrong wrong = Wrong::kNothing) {
  const int candidates = 2 << static_cast<int>(axes);
  const auto sign = [](std::int64_t difference, std::int64_t size) {
    return difference < 0 ? -size : size;
  };
  const std::int64_t s_x = sign(d.s_x, d.size_s_x), t_x = sign(d.t_x, d.size_t_x),
                     s_y = sign(d.s_y, d.size_s_y), t_y = sign(d.t_y, d.size_t_y);
  Expected best{};
  std::int64_t longest = -1;
  for (int k = 0; k < candidates; ++k) {
    const int straight = 8 * k / candidates;
    const bool exchanged = wrong == Wrong::kExchanged && straight % 2 == 1;
    const int direction = exchanged ? straight ^ 2 : straight;
    const auto axis = [&](bool swapped) {
      const auto [cosine, sine] = spec::texture::kAxes[static_cast<std::size_t>(direction)];
      return swapped && direction == 1 ? spec::texture::Axis{sine, cosine}
                                       : spec::texture::Axis{cosine, sine};
    };
    const auto texels = [a = axis(wrong == Wrong::kSwapped)](std::int64_t x, std::int64_t y) {
      return std::min(std::abs(a.cosine * x + a.sine * y) / 128, std::int64_t{0x7FFFFFFF});
    };
    const auto coordinate = [c = axis(wrong == Wrong::kSwapped || wrong == Wrong::kSwappedFlat)](
                                std::int64_t x, std::int64_t y) {
      const std::int64_t exact = c.cosine * x + c.sine * y,
                         magnitude = (std::abs(exact) + 64) / 128;
      return exact < 0 ? -magnitude : magnitude;
    };
    const std::int64_t s = texels(s_x, s_y), t = texels(t_x, t_y);
    const std::int64_t a = std::max(s, t), b = std::min(s, t);
    std::int64_t measure = a;
    if (rule == FootprintRule::kHalf) measure = a + b / 2;
    if (rule == FootprintRule::kQuarter) measure = a + b / 4;
    if (rule == FootprintRule::kTwoSegment) measure = std::max(a + b / 8, a - a / 8 + b / 2);
    if (rule == FootprintRule::kExact) measure = a * a + b * b;
    if (measure < longest || (measure == longest && wrong != Wrong::kLargest)) continue;
    longest = measure;
    best = {rule == FootprintRule::kExact ? root(measure) : measure, coordinate(d.s_x, d.s_y),
            coordinate(d.t_x, d.t_y), 0, k};
  }
  const auto coarse = [](std::int64_t v) { return v < 0 ? -(-v / 256) : v / 256; };
  best.area =
      static_cast<std::uint64_t>(std::abs(coarse(s_x) * coarse(t_y) - coarse(t_x) * coarse(s_y)));
  return best;
}

// P and D of a fragment of a 1024 x 1024 texture: texels are 64 coordinate units... 2^16 of 2^14.
DerivativeToken token(std::int64_t s_x, std::int64_t t_x, std::int64_t s_y, std::int64_t t_y,
                      std::uint32_t tag = 0) {
  const auto size = [](std::int64_t v) {
    return static_cast<std::uint32_t>(std::min(std::abs(v), std::int64_t{0x7FFFFFFF}));
  };
  return {ticket(tag), 11, -12, s_x, t_x, s_y, t_y, size(s_x), size(t_x), size(s_y), size(t_y)};
}

std::vector<DerivativeToken> tokens_of_all_kinds() {
  Random random(3);
  std::vector<DerivativeToken> tokens;
  constexpr std::int64_t kLimit = 0xFFFFFFFF;  // of a difference
  for (const std::int64_t s_x :
       {-kLimit, std::int64_t{-1}, std::int64_t{0}, std::int64_t{127}, kLimit})
    for (const std::int64_t t_x : {-kLimit, std::int64_t{0}, std::int64_t{64}, kLimit})
      for (const std::int64_t s_y : {-kLimit, std::int64_t{-65}, std::int64_t{0}, kLimit})
        for (const std::int64_t t_y : {-kLimit, std::int64_t{0}, std::int64_t{63}, kLimit})
          tokens.push_back(token(s_x, t_x, s_y, t_y));
  // Nearly a circle, long at 45 degrees: 22.5 and 67.5 are equal, 45 itself is measured shorter.
  for (const std::int64_t sign : {-1, 1})
    tokens.push_back(token(100'000, 700 * sign, 700 * sign, 100'000));
  // Every degree of roll at a few ratios, and anything.
  for (int degree = 0; degree < 360; ++degree)
    for (const double ratio : {1.0, 1.5, 6.0, 40.0}) {
      const double angle = degree * std::acos(-1) / 180, length = 300'000;
      const auto at = [](double v) { return static_cast<std::int64_t>(std::lround(v)); };
      tokens.push_back(token(at(length * std::cos(angle)), at(length / ratio * -std::sin(angle)),
                             at(length * std::sin(angle)), at(length / ratio * std::cos(angle))));
    }
  for (int i = 0; i < 4000; ++i) {
    const auto any = [&] {
      const auto size = static_cast<std::int64_t>(random.next() >> (32 + random.below(31)));
      return random.chance(500) ? -size : size;
    };
    const std::int64_t s_x = any(), t_x = any(), s_y = any();
    tokens.push_back(token(s_x, t_x, s_y, any()));
  }
  return tokens;
}

class AxisRules : public testing::TestWithParam<std::tuple<Axes, FootprintRule>> {};

TEST_P(AxisRules, AreTheContract) {
  const auto [axes, rule] = GetParam();
  ClockDomain clock("clock", period());
  AxisBench b(clock, "", axes, rule);
  const std::vector<DerivativeToken> tokens = tokens_of_all_kinds();
  for (const DerivativeToken& t : tokens) b.ends.source.add(t);
  b.ends.sink.hold_from = 100;  // nothing may get lost or be worked on twice
  b.ends.sink.hold_to = 140;
  clock.run(tokens.size() + 200);
  ASSERT_EQ(b.ends.sink.taken.size(), tokens.size());
  std::array<int, 8> major{};
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    const Expected want = expected(tokens[i], axes, rule);
    const FootprintToken& got = b.ends.sink.taken[i].token;
    ++major[static_cast<std::size_t>(want.k)];
    ASSERT_EQ(got.d_max, want.d_max) << i;
    ASSERT_EQ(got.minor, want.area) << i;
    ASSERT_EQ(got.axis_s, want.axis_s) << i;
    ASSERT_EQ(got.axis_t, want.axis_t) << i;
    EXPECT_EQ(got.s, 11);
    EXPECT_EQ(got.t, -12);
  }
  for (int k = 0; k < 2 << static_cast<int>(axes); ++k)
    EXPECT_GT(major[static_cast<std::size_t>(k)], 20) << "direction " << k << " never was major";
}

// A unit that turned the wrong way, or took the last of equals, would be seen above.
TEST_P(AxisRules, NoticeAWrongUnit) {
  const auto [axes, rule] = GetParam();
  const auto differ = [axes = axes, rule = rule](Wrong wrong) {
    int count = 0;
    for (const DerivativeToken& t : tokens_of_all_kinds()) {
      const Expected right = expected(t, axes, rule), other = expected(t, axes, rule, wrong);
      count += right.d_max != other.d_max || right.axis_s != other.axis_s ||
               right.axis_t != other.axis_t;
    }
    return count;
  };
  EXPECT_EQ(differ(Wrong::kNothing), 0);
  EXPECT_GT(differ(Wrong::kLargest), 10);
  const bool has_22_degrees = axes == Axes::kEight;
  EXPECT_EQ(differ(Wrong::kSwapped) > 50, has_22_degrees);
  EXPECT_EQ(differ(Wrong::kSwappedFlat) > 50, has_22_degrees);
  EXPECT_EQ(differ(Wrong::kExchanged) > 0, has_22_degrees);
}

INSTANTIATE_TEST_SUITE_P(
    Texture, AxisRules,
    testing::Combine(testing::Values(Axes::kFour, Axes::kEight),
                     testing::Values(FootprintRule::kHalf, FootprintRule::kQuarter,
                                     FootprintRule::kTwoSegment, FootprintRule::kExact,
                                     FootprintRule::kMax)));

// By hand: rows and columns that are equal, opposite, at right angles.
TEST(TextureRtlAxis, ByHand) {
  ClockDomain clock("clock", period());
  AxisBench b(clock, "", Axes::kEight, FootprintRule::kExact);
  b.ends.source.add(token(1280, 0, 0, 1280));     // a square: 0 and 4 are equal, the smaller stays
  b.ends.source.add(token(0, 0, 0, 1280));        // upright
  b.ends.source.add(token(1280, 0, 1280, 0));     // both alike: 45 degrees, (90 + 90) x 10
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

struct Timed {
  const char* name;
  Axes axes;
  FootprintRule rule;
  std::int32_t clocks;

  rtl::Datasheet sheet() const {
    spec::texture::Parameters p;
    p.axes = axes;
    p.footprint = rule;
    p.axis_clocks = clocks;
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

TEST(TextureRtlAxis, LatencyByRuleAndClocks) {
  ClockDomain clock("clock", period());
  std::vector<std::unique_ptr<AxisBench>> benches;
  for (const Timed& row : kTimed) {
    benches.push_back(std::make_unique<AxisBench>(clock, row.name, row.axes, row.rule, row.clocks));
    benches.back()->ends.in.push(0, token(1, 2, 3, 4));
    benches.back()->ends.sink.hold_to = 1000;
  }
  clock.run(1);
  const Cycle taken = 1;
  while (clock.cycle() < taken + 30) {
    for (std::size_t i = 0; i < benches.size(); ++i)
      EXPECT_EQ(benches[i]->ends.out.can_pop(clock.cycle()),
                clock.cycle() >= taken + kTimed[i].sheet().latency.clocks)
          << kTimed[i].name << clock.cycle();
    clock.run(1);
  }
}

// A fragment every so many clocks, through a stall as well.
TEST(TextureRtlAxis, IntervalIsAxisClocks) {
  constexpr Cycle kHeld = 30, kStall = 13;  // every row is in the middle of its tokens then
  ClockDomain clock("clock", period());
  std::vector<std::unique_ptr<AxisBench>> benches;
  for (const Timed& row : kTimed) {
    benches.push_back(std::make_unique<AxisBench>(clock, row.name, row.axes, row.rule, row.clocks));
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
    const Cycle clocks = sheet.interval.clocks;
    const auto alone = [&](Cycle n) { return 1 + n * clocks + sheet.latency.clocks; };
    for (std::size_t n = 0; n < 40; ++n) {
      if (alone(n) < kHeld) {
        EXPECT_EQ(got[n].cycle, alone(n));
      }
      EXPECT_EQ(got[n].token.ticket.tag, n);
      EXPECT_EQ(got[n].token.axis_s, expected(token(10 * static_cast<std::int64_t>(n), 2, 3, 400),
                                              kTimed[i].axes, kTimed[i].rule)
                                         .axis_s);
    }
    // The link's two places are used up meanwhile; the unit is late by the rest of the stall.
    const Cycle late = got.back().cycle - alone(39);
    EXPECT_LE(late, kStall);
    EXPECT_GE(late + 3 * (clocks - 1), kStall);
  }
}

TEST(TextureRtlAxis, ResetForgetsTheFragmentInHand) {
  ClockDomain clock("clock", period());
  AxisBench b(clock, "", Axes::kEight, FootprintRule::kHalf, 4);
  b.ends.source.add(token(1, 2, 3, 4, 1));
  clock.run(3);  // taken in 1, three more clocks of directions
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
