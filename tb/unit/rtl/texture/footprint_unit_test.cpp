// SPDX-License-Identifier: MIT
// The FootprintUnit alone: cycles, and the order of two sides with equal roots. Other values are
// compared in equivalence_test.cpp.
#include "rtl_model/texture/footprint_unit.h"

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

rtl::Datasheet sheet_of(spec::texture::FootprintRule rule) {
  spec::texture::Parameters p;
  p.footprint = rule;
  return FootprintUnit::datasheet(p);
}

TEST(TextureRtlFootprint, LatencyAndIntervalMatchDatasheet) {
  using spec::texture::FootprintRule;
  ClockDomain clock("clock", period());
  FootprintBench half(clock, "half_", FootprintRule::kHalf);
  FootprintBench exact(clock, "exact_", FootprintRule::kExact);
  for (FootprintBench* b : {&half, &exact})
    for (int i = 0; i < 40; ++i) b->ends.source.add({});
  clock.run(100);
  for (const auto& [bench, rule] :
       {std::pair{&half, FootprintRule::kHalf}, std::pair{&exact, FootprintRule::kExact}}) {
    const std::vector<Cycle> seen = cycles_of(bench->ends.sink);
    ASSERT_EQ(seen.size(), 40u);
    // Pushed in i, taken in i + 1; a datasheet that is one cycle off is detected.
    const auto check = [&](const rtl::Datasheet& sheet) { expect_cycles(sheet, seen, 1); };
    expect_detects_one_cycle(sheet_of(rule), &rtl::Datasheet::latency, check);
    expect_detects_one_cycle(sheet_of(rule), &rtl::Datasheet::interval, check);
    // From the first token's cycle to the last token's last stage.
    const Cycle busy = 39 + sheet_of(rule).latency.cycles;
    EXPECT_EQ(bench->unit.busy_cycles(), busy);
    EXPECT_EQ(bench->unit.idle_cycles(), 100 - busy);
  }
}

TEST(TextureRtlFootprint, DatasheetsHaveStagesFormatsAndOperators) {
  using spec::texture::FootprintRule;
  for (const FootprintRule rule : {FootprintRule::kHalf, FootprintRule::kExact}) {
    const rtl::Datasheet sheet = sheet_of(rule);
    ASSERT_FALSE(sheet.stages.empty()) << title(sheet);
    EXPECT_EQ(sheet.stages.back().clock, std::to_string(sheet.latency.cycles)) << title(sheet);
    EXPECT_NE(sheet.formats, "") << title(sheet);
    EXPECT_FALSE(operators_of(sheet).empty()) << title(sheet);
  }
}

// floor(sqrt) is 5 for both, but the square of the column is larger: the root does not order them.
TEST(TextureRtlFootprint, EqualRootsAreOrderedBySquares) {
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
