// SPDX-License-Identifier: MIT
// The LevelUnit alone: cycles and counters. Values are compared in equivalence_test.cpp.
#include "rtl_model/texture/level_unit.h"

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::level_unit_test {
namespace {

using namespace rtl::texture;

// Counts fragments between two levels and magnified ones; a fragment without a texture is neither
// and has one sample of level 0.
TEST(TextureRtlLevel, CountsItsDecisions) {
  ClockDomain clock("clock", period());
  Store store(clock);
  LevelUnit unit("unit", clock, store.descriptors.for_levels, spec::texture::Axes::kTwo,
                 spec::texture::CountRule::kFloor, spec::texture::CountCap::kNone);
  Ends<Log2Token, LevelToken> ends(clock);
  unit.logs_in(ends.in);
  unit.levels_out(ends.out);
  spec::texture::Descriptor d;
  d.width = d.height = 256;
  d.levels = 6;
  d.min_filter = spec::texture::MinFilter::kLinearMipmapLinear;
  d.max_lod = 12 << 8;
  write_descriptor(store.bus, 0, d);
  // l = 0, 1/256, 1, 1 + 1/256, 1.5, 2, 5, 9: three of them lie between two levels.
  for (const int lb : {0, 16, 4096, 4112, 6144, 8192, 20480, 36864})
    ends.source.add({ticket(), 0, 0, 0, 0, lb, lb});
  Ticket without = ticket();
  without.valid = false;
  for (const int lb : {0, 6144}) ends.source.add({without, 0, 0, 0, 0, lb, lb - 8192});
  clock.run(20);
  ASSERT_EQ(ends.sink.taken.size(), 10u);
  expect_cycles(LevelUnit::datasheet(), cycles_of(ends.sink), 1);
  // From the first fragment's cycle to the last fragment's last stage.
  const Cycle busy = 9 + LevelUnit::datasheet().latency.cycles;
  EXPECT_EQ(unit.busy_cycles(), busy);
  EXPECT_EQ(unit.idle_cycles(), 20 - busy);
  EXPECT_EQ(unit.two_levels.value(), 3u);
  EXPECT_EQ(unit.magnified.value(), 1u);
  const LevelToken& last = ends.sink.taken.back().token;
  EXPECT_EQ(last.last_index, 0);
  EXPECT_EQ(last.level, 0);
  EXPECT_EQ(last.fraction, 0);
  EXPECT_FALSE(last.linear);
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::level_unit_test
