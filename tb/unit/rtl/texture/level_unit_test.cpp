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

// Footprints of 16 : 1. All samples in a level of 1 x 1 texels are its texel, so one is enough.
TEST(TextureRtlLevel, LevelOfOneTexelIsSampledOnce) {
  using spec::texture::MinFilter;
  struct Case {
    std::uint16_t width, height;
    std::uint8_t levels;
    MinFilter filter;
    int l;  // 1/256 levels
    int level, samples;
  };
  const std::vector<Case> cases = {
      {8, 2, 4, MinFilter::kLinearMipmapLinear, 0, 0, 16},
      {8, 2, 4, MinFilter::kLinearMipmapLinear, 512, 2, 16},
      {8, 2, 4, MinFilter::kLinearMipmapLinear, 767, 2, 16},
      {8, 2, 4, MinFilter::kLinearMipmapLinear, 768, 3, 1},
      {8, 2, 4, MinFilter::kNearestMipmapLinear, 2000, 3, 1},
      {8, 2, 4, MinFilter::kNearestMipmapNearest, 640, 2, 16},
      {8, 2, 4, MinFilter::kLinearMipmapNearest, 641, 3, 1},
      {8, 2, 4, MinFilter::kLinear, 768, 0, 16},
      {2, 8, 3, MinFilter::kLinearMipmapLinear, 768, 2, 16},
      {1, 2, 2, MinFilter::kLinearMipmapLinear, 0, 0, 16},
      {1, 2, 2, MinFilter::kLinearMipmapLinear, 255, 0, 16},
      {1, 2, 2, MinFilter::kLinearMipmapLinear, 256, 1, 1},
      {1, 1, 1, MinFilter::kNearest, 0, 0, 1},
      {1, 1, 1, MinFilter::kLinear, 768, 0, 1},
      {4096, 1, 13, MinFilter::kLinearMipmapNearest, 12 * 256, 12, 1},
      {4096, 1, 13, MinFilter::kLinearMipmapNearest, 11 * 256, 11, 16}};
  ClockDomain clock("clock", period());
  Store store(clock);
  LevelUnit unit("unit", clock, store.descriptors.for_levels, spec::texture::Axes::kTwo,
                 spec::texture::CountRule::kFloor, spec::texture::CountCap::kNone);
  Ends<Log2Token, LevelToken> ends(clock);
  unit.logs_in(ends.in);
  unit.levels_out(ends.out);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const auto handle = static_cast<std::uint8_t>(i);
    spec::texture::Descriptor d;
    d.width = cases[i].width;
    d.height = cases[i].height;
    d.levels = cases[i].levels;
    d.min_filter = cases[i].filter;
    d.max_lod = 12 << 8;
    d.max_anisotropy_log2 = 4;
    write_descriptor(store.bus, handle, d);
    const int lb_min = 16 * cases[i].l;
    ends.source.add({ticket(handle, handle), 0, 0, 0, 0, lb_min + 4 * 4096, lb_min, i % 3 == 0});
  }
  clock.run(40);
  ASSERT_EQ(ends.sink.taken.size(), cases.size());
  expect_cycles(LevelUnit::datasheet(), cycles_of(ends.sink), 1);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    EXPECT_EQ(ends.sink.taken[i].token.level, cases[i].level) << i;
    EXPECT_EQ(ends.sink.taken[i].token.last_index + 1, cases[i].samples) << i;
    EXPECT_EQ(ends.sink.taken[i].token.diagonal, i % 3 == 0) << i;
  }
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::level_unit_test
