// SPDX-License-Identifier: MIT
// The FootprintUnit alone. Expected values are worked out by hand from
// docs/reference/texture/formats.md.
#include "rtl_model/texture/footprint_unit.h"

#include <cmath>

#include "tb/base/random.h"
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::footprint_unit_test {
namespace {

using namespace rtl::texture;

struct FootprintBench {
  FootprintBench(ClockDomain& clock, const std::string& name, spec::texture::FootprintRule rule)
      : unit((name + "unit").c_str(), clock, rule), ends(clock, name) {
    unit.derivatives_in(ends.in);
    unit.footprints_out(ends.out);
  }
  FootprintUnit unit;
  Ends<DerivativeToken, FootprintToken> ends;
};

TEST(TextureRtlFootprint, EveryRuleByHand) {
  ClockDomain clock("clock", period());
  struct Row {
    spec::texture::FootprintRule rule;
    std::uint32_t x, y;  // of (s, t) = (300, 401) and (1001, 3)
  };
  // two_segment: max(401 + 37, 401 - 50 + 150) = 501, max(1001 + 0, 1001 - 125 + 1) = 1001.
  // exact: sqrt(250801) = 500.8, sqrt(1002010) = 1001.004.
  const std::vector<Row> rows = {{spec::texture::FootprintRule::kHalf, 551, 1002},
                                 {spec::texture::FootprintRule::kQuarter, 476, 1001},
                                 {spec::texture::FootprintRule::kTwoSegment, 501, 1001},
                                 {spec::texture::FootprintRule::kExact, 500, 1001},
                                 {spec::texture::FootprintRule::kMax, 401, 1001}};
  std::vector<std::unique_ptr<FootprintBench>> benches;
  for (const Row& row : rows) {
    const auto i = static_cast<std::size_t>(row.rule);
    benches.push_back(std::make_unique<FootprintBench>(
        clock, std::string(spec::texture::kFootprintNames[i]) + "_", row.rule));
    DerivativeToken d{ticket(5), 1, 2, 10, 20, 30, 40, 300, 401, 1001, 3};
    benches.back()->ends.source.add(d);
    std::swap(d.size_s_x, d.size_s_y);
    std::swap(d.size_t_x, d.size_t_y);
    benches.back()->ends.source.add(d);
    d.size_s_y = d.size_s_x;
    d.size_t_y = d.size_t_x;
    benches.back()->ends.source.add(d);  // a tie: the x side
  }
  clock.run(30);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    SCOPED_TRACE(spec::texture::kFootprintNames[i]);
    const auto& taken = benches[i]->ends.sink.taken;
    ASSERT_EQ(taken.size(), 3u);
    EXPECT_EQ(taken[0].token.d_max, rows[i].y);
    EXPECT_EQ(taken[0].token.minor, rows[i].x);
    EXPECT_EQ(taken[0].token.axis_s, 30);
    EXPECT_EQ(taken[0].token.axis_t, 40);
    EXPECT_EQ(taken[1].token.d_max, rows[i].y);
    EXPECT_EQ(taken[1].token.axis_s, 10);
    EXPECT_EQ(taken[1].token.axis_t, 20);
    EXPECT_EQ(taken[2].token.axis_s, 10);
    EXPECT_EQ(taken[0].token.ticket.tag, 5u);
    EXPECT_EQ(taken[0].token.s, 1);
    EXPECT_EQ(taken[0].token.t, 2);
  }
}

TEST(TextureRtlFootprint, ErrorIsAsDocumented) {
  struct Row {
    spec::texture::FootprintRule rule;
    double low, high;  // percent
  };
  const std::uint32_t a = 1 << 20;
  for (const Row& row : {Row{spec::texture::FootprintRule::kHalf, 0, 11.9},
                         Row{spec::texture::FootprintRule::kQuarter, -11.7, 3.1},
                         Row{spec::texture::FootprintRule::kTwoSegment, -2.8, 0.8},
                         Row{spec::texture::FootprintRule::kMax, -29.3, 0}}) {
    SCOPED_TRACE(spec::texture::kFootprintNames[static_cast<std::size_t>(row.rule)]);
    double low = 0, high = 0;
    for (std::uint32_t b = 0; b <= a; b += 16) {
      const double error = 100 * (FootprintUnit::side(row.rule, b, a) / std::hypot(a, b) - 1);
      low = std::min(low, error);
      high = std::max(high, error);
    }
    EXPECT_NEAR(low, row.low, 0.1);
    EXPECT_NEAR(high, row.high, 0.1);
    EXPECT_GE(low, row.low);
    EXPECT_LE(high, row.high);
  }
}

rtl::Datasheet sheet_of(spec::texture::FootprintRule rule) {
  spec::texture::Parameters p;
  p.footprint = rule;
  return FootprintUnit::datasheet(p);
}

TEST(TextureRtlFootprint, LatencyAndIntervalOfTheDatasheet) {
  using spec::texture::FootprintRule;
  ClockDomain clock("clock", period());
  FootprintBench half(clock, "half_", FootprintRule::kHalf);
  FootprintBench exact(clock, "exact_", FootprintRule::kExact);
  for (FootprintBench* b : {&half, &exact})
    for (int i = 0; i < 40; ++i) b->ends.source.add({});
  clock.run(100);
  for (const auto& [bench, rule] :
       {std::pair{&half, FootprintRule::kHalf}, std::pair{&exact, FootprintRule::kExact}}) {
    const std::vector<Cycle> seen = clocks_of(bench->ends.sink);
    ASSERT_EQ(seen.size(), 40u);
    // Pushed in i, taken in i + 1; a datasheet that is a clock off is noticed.
    const auto check = [&](const rtl::Datasheet& sheet) { expect_clocks(sheet, seen, 1); };
    expect_notices_a_clock(sheet_of(rule), &rtl::Datasheet::latency, check);
    expect_notices_a_clock(sheet_of(rule), &rtl::Datasheet::interval, check);
    // From the first token's clock to that of the last one's last stage, and not beyond.
    const Cycle busy = 39 + sheet_of(rule).latency.clocks;
    EXPECT_EQ(bench->unit.busy_cycles(), busy);
    EXPECT_EQ(bench->unit.idle_cycles(), 100 - busy);
  }
}

TEST(TextureRtlFootprint, DatasheetsHaveStagesFormatsAndCost) {
  using spec::texture::FootprintRule;
  for (const FootprintRule rule : {FootprintRule::kHalf, FootprintRule::kExact}) {
    const rtl::Datasheet sheet = sheet_of(rule);
    ASSERT_FALSE(sheet.stages.empty()) << title(sheet);
    EXPECT_EQ(sheet.stages.back().clock, std::to_string(sheet.latency.clocks)) << title(sheet);
    EXPECT_NE(sheet.formats, "") << title(sheet);
    EXPECT_NE(sheet.cost, "") << title(sheet);
  }
}

TEST(TextureRtlFootprint, RootIsTheIntegerSquareRoot) {
  ClockDomain clock("clock", period());
  FootprintBench b(clock, "", spec::texture::FootprintRule::kExact);
  Random random(7);
  std::vector<DerivativeToken> tokens;
  for (int i = 0; i < 4000; ++i) {
    const auto any = [&] { return random.word() >> (1 + random.below(31)); };
    tokens.push_back({ticket(), 0, 0, 0, 0, 0, 0, any(), any(), any(), any()});
  }
  tokens.push_back({ticket(), 0, 0, 0, 0, 0, 0, 0x7FFFFFFF, 0x7FFFFFFF, 0, 0});
  tokens.push_back({ticket(), 0, 0, 0, 0, 0, 0, 3 << 16, 4 << 16, 5 << 16, 12 << 16});
  for (const DerivativeToken& t : tokens) b.ends.source.add(t);
  // The consumer stops now and then: nothing may get lost or be worked on twice.
  b.ends.sink.hold_from = 100;
  b.ends.sink.hold_to = 140;
  clock.run(tokens.size() + 100);
  ASSERT_EQ(b.ends.sink.taken.size(), tokens.size());
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    const DerivativeToken& t = tokens[i];
    const FootprintToken& r = b.ends.sink.taken[i].token;
    const auto square = [](std::uint64_t v) { return v * v; };
    const std::uint64_t x = square(t.size_s_x) + square(t.size_t_x),
                        y = square(t.size_s_y) + square(t.size_t_y);
    EXPECT_LE(square(r.d_max), std::max(x, y));
    EXPECT_GT(square(std::uint64_t{r.d_max} + 1), std::max(x, y));
    EXPECT_LE(square(r.minor), std::min(x, y));
    EXPECT_GT(square(std::uint64_t{r.minor} + 1), std::min(x, y));
  }
  EXPECT_EQ(b.ends.sink.taken.back().token.d_max, 13u << 16);
  EXPECT_EQ(b.ends.sink.taken.back().token.minor, 5u << 16);
}

// floor(sqrt) is 5 of both, but the column's square is larger: the root does not order them.
TEST(TextureRtlFootprint, EqualRootsAreOrderedByTheirSquares) {
  ClockDomain clock("clock", period());
  FootprintBench b(clock, "", spec::texture::FootprintRule::kExact);
  b.ends.source.add({ticket(), 0, 0, 10, 20, 30, 40, 3, 4, 5, 1});  // 25 and 26
  b.ends.source.add({ticket(), 0, 0, 10, 20, 30, 40, 3, 4, 4, 3});  // a tie: the row
  b.ends.source.add({ticket(), 0, 0, 10, 20, 30, 40, 5, 1, 3, 4});
  clock.run(40);
  ASSERT_EQ(b.ends.sink.taken.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(b.ends.sink.taken[i].token.d_max, 5u);
    EXPECT_EQ(b.ends.sink.taken[i].token.minor, 5u);
    EXPECT_EQ(b.ends.sink.taken[i].token.axis_s, i == 0 ? 30 : 10);
  }
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::footprint_unit_test
