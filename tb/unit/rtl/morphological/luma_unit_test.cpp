// SPDX-License-Identifier: MIT
// LumaUnit: hand-computed luma values, and its cycles.
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/morphological/parts.h"

namespace deburr::tb::morphological_rtl::luma_unit_test {
namespace {

using namespace rtl::morphological;  // NOLINT: a test of these

TEST(LumaUnitBlock, LumaIsExactAfterTwoCycles) {
  ClockDomain clock("clock", period());
  Parameters p = preset(spec::morphological::Preset::kDeburrLine);
  p.lanes = spec::morphological::Lanes::kTwo;
  Registers registers(p, 4, 4);
  Ends<SlotToken, LumaToken> ends(clock);
  LumaUnit luma("luma", clock, p);
  luma.configuration_in(registers.configuration);
  luma.slots_in(ends.in);
  luma.lumas_out(ends.out);
  SlotToken token{};
  token.pixel[0] = {255, 255, 255, 9};
  token.pixel[1] = {1, 2, 3, 9};
  token.depth = {7, 8, 0, 0};
  for (int i = 0; i < 3; ++i) ends.source.add(token);
  clock.run(1);  // pushed in 0
  EXPECT_FALSE(ends.out.can_pop(clock.cycle()));
  clock.run(1);  // popped in 1
  EXPECT_FALSE(ends.out.can_pop(clock.cycle()));
  clock.run(1);  // added in 2
  EXPECT_TRUE(ends.out.can_pop(clock.cycle()));
  clock.run(4);
  ASSERT_EQ(ends.sink.taken.size(), 3u);
  // Pushed in 0, popped in 1. A datasheet that is off by one cycle fails.
  const auto check = [&](const rtl::Datasheet& sheet) {
    expect_cycles(sheet, cycles_of(ends.sink), 1);
  };
  expect_detects_one_cycle(LumaUnit::datasheet(), &rtl::Datasheet::latency, check);
  expect_detects_one_cycle(LumaUnit::datasheet(), &rtl::Datasheet::interval, check);
  // From the first pop to the last push.
  EXPECT_EQ(luma.busy_cycles(), 4u);
  EXPECT_EQ(luma.idle_cycles(), 7u - 4u);
  EXPECT_EQ(ends.sink.taken[0].token.luma[0], 255u * 65536u);
  EXPECT_EQ(ends.sink.taken[0].token.luma[1], 13933u + 2u * 46871u + 3u * 4732u);
  EXPECT_EQ(ends.sink.taken[0].token.depth[1], 8u);
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::luma_unit_test
