// SPDX-License-Identifier: MIT
// The LevelUnit alone. Expected values are worked out by hand from
// docs/reference/texture/formats.md.
#include "rtl_model/texture/level_unit.h"

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::level_unit_test {
namespace {

using namespace rtl::texture;

struct LevelCase {
  const char* name;
  std::int32_t lb_max, lb_minor;  // 1/4096
  spec::texture::MinFilter filter;
  std::uint8_t max_log2;
  std::int16_t bias;  // 1/256
  std::uint16_t min_lod, max_lod;
  int count, level, fraction;
  bool linear;
};

void check_levels(const std::vector<LevelCase>& cases, spec::texture::CountRule count,
                  spec::texture::CountCap cap,
                  spec::texture::Axes axes = spec::texture::Axes::kTwo) {
  ClockDomain clock("clock", period());
  Store store(clock);
  LevelUnit unit("unit", clock, store.descriptors.for_levels, axes, count, cap);
  Ends<Log2Token, LevelToken> ends(clock);
  unit.logs_in(ends.in);
  unit.levels_out(ends.out);
  for (const LevelCase& c : cases) {
    SCOPED_TRACE(c.name);
    spec::texture::Descriptor d;
    d.width = d.height = 256;
    d.levels = 6;
    d.min_filter = c.filter;
    d.mag_filter = spec::texture::MagFilter::kNearest;
    d.max_anisotropy_log2 = c.max_log2;
    d.lod_bias = c.bias;
    d.min_lod = c.min_lod;
    d.max_lod = c.max_lod;
    write_descriptor(store.bus, 0, d);
    ends.source.add({ticket(), 1, 2, 3, 4, c.lb_max, c.lb_minor});
    clock.run(7);
    const LevelToken& r = ends.sink.taken.back().token;
    EXPECT_EQ(r.last_index + 1, c.count);
    EXPECT_EQ(r.level, c.level);
    EXPECT_EQ(r.fraction, c.fraction);
    EXPECT_EQ(r.linear, c.linear);
    EXPECT_EQ(r.s, 1);
    EXPECT_EQ(r.axis_t, 4);
  }
  EXPECT_EQ(ends.sink.taken.size(), cases.size());
  EXPECT_EQ(ends.sink.taken.front().cycle, 4u);
}

constexpr auto kTri = spec::texture::MinFilter::kLinearMipmapLinear;
constexpr std::uint16_t kTop = 12 << 8;

TEST(TextureRtlLevel, PaperRule) {
  using F = spec::texture::MinFilter;
  check_levels(
      {
          {"isotropic, l = 1.5", 6144, 6144, kTri, 4, 0, 0, kTop, 1, 1, 128, true},
          {"ratio 2^1.99 gives N = 2", 3 * 4096, 4096 + 41, kTri, 4, 0, 0, kTop, 2, 2, 0, true},
          {"ratio 4", 3 * 4096, 4096, kTri, 4, 0, 0, kTop, 4, 1, 0, true},
          {"N at most 2", 4 * 4096, 0, kTri, 1, 0, 0, kTop, 2, 3, 0, true},
          {"N at most 16", 8 * 4096, -8 * 4096, kTri, 4, 0, 0, kTop, 16, 4, 0, true},
          {"footprint of one texel: N = 1, magnified", 0, -16 * 4096, kTri, 4, 0, 0, kTop, 1, 0, 0,
           false},
          {"just above a texel: N = 16", 1, -16 * 4096, kTri, 4, 0, 0, kTop, 16, 0, 0, false},
          {"l = 1/4096 minifies, rounds to level 0, f = 0", 1, 1, kTri, 4, 0, 0, kTop, 1, 0, 0,
           true},
          {"l = 7/4096 rounds down", 7, 7, kTri, 4, 0, 0, kTop, 1, 0, 0, true},
          {"l = 8/4096 rounds up to 1/256", 8, 8, kTri, 4, 0, 0, kTop, 1, 0, 1, true},
          {"f rounds up to the next level", 8191, 8191, kTri, 4, 0, 0, kTop, 1, 2, 0, true},
          {"just below the coarsest", 5 * 4096 - 16, 5 * 4096, kTri, 4, 0, 0, kTop, 1, 4, 255,
           true},
          {"the coarsest", 5 * 4096, 5 * 4096, kTri, 4, 0, 0, kTop, 1, 5, 0, true},
          {"half a level after it", 5 * 4096 + 2048, 6 * 4096, kTri, 4, 0, 0, kTop, 1, 5, 0, true},
          {"beyond the coarsest", 7 * 4096 + 9, 7 * 4096, kTri, 4, 0, 0, kTop, 1, 5, 0, true},
          {"L not below 0", 4096, 8192, kTri, 4, 0, 0, kTop, 1, 1, 0, true},
          {"within a texel, biased to a level", -8, -8, kTri, 4, 256, 0, kTop, 1, 1, 0, true},
          {"bias +1.5", 4096, 4096, kTri, 4, 384, 0, kTop, 1, 2, 128, true},
          {"bias -1", 4096, 4096, kTri, 4, -256, 0, kTop, 1, 0, 0, false},
          {"min_lod 2.25", 4096, 4096, kTri, 4, 0, 576, kTop, 1, 2, 64, true},
          {"max_lod 0.5", 4096, 4096, kTri, 4, 0, 0, 128, 1, 0, 128, true},
          {"limits crossed: the upper one", 4096, 4096, kTri, 4, 0, 768, 512, 1, 2, 0, true},
          {"nearest: level 0", 9 * 4096, 9 * 4096, F::kNearest, 4, 0, 0, kTop, 1, 0, 0, false},
          {"linear: level 0", 9 * 4096, 9 * 4096, F::kLinear, 4, 0, 0, kTop, 1, 0, 0, true},
          {"mipmap nearest, 1.5: down", 6144, 6144, F::kLinearMipmapNearest, 4, 0, 0, kTop, 1, 1, 0,
           true},
          {"mipmap nearest, above 1.5: up", 6145, 6145, F::kNearestMipmapNearest, 4, 0, 0, kTop, 1,
           2, 0, false},
          {"mipmap nearest, beyond", 9 * 4096, 9 * 4096, F::kNearestMipmapNearest, 4, 0, 0, kTop, 1,
           5, 0, false},
          {"nearest mipmap linear", 6144, 6144, F::kNearestMipmapLinear, 4, 0, 0, kTop, 1, 1, 128,
           false},
      },
      spec::texture::CountRule::kFloor, spec::texture::CountCap::kNone);
}

TEST(TextureRtlLevel, CeilAndTexelCap) {
  check_levels(
      {
          {"ratio 2^1.01 gives N = 4, the cap allows 8", 3 * 4096 - 1, 2 * 4096 - 42, kTri, 4, 0, 0,
           kTop, 4, 1, 0, true},
          {"cap: lb d = 0.5 allows N = 2", 2048, -8 * 4096, kTri, 4, 0, 0, kTop, 2, 0, 0, false},
          {"cap: lb d = 1 allows N = 2", 4096, -8 * 4096, kTri, 4, 0, 0, kTop, 2, 0, 0, false},
          {"cap: lb d = 1.1 allows N = 4", 4506, -8 * 4096, kTri, 4, 0, 0, kTop, 4, 0, 0, false},
      },
      spec::texture::CountRule::kCeil, spec::texture::CountCap::kTexel);
}

// Each threshold from both sides: N is the ratio rounded up, 72 places aside, l the part that
// samples do not take.
TEST(TextureRtlLevel, AnyCountIsTheRatioRoundedUp) {
  std::vector<LevelCase> cases;
  const int thresholds[] = {0,     4096,  6492,  8192,  9511,  10588, 11499, 12288,
                            12984, 13607, 14170, 14684, 15157, 15595, 16003};  // 4096 lb n
  for (int n = 1; n <= 15; ++n) {
    const int ratio = thresholds[n - 1] + 72;
    cases.push_back({"at", 4096 + ratio, 4096, kTri, 4, 0, 0, kTop, n, 1, 0, true});
    cases.push_back({"above", 4096 + ratio + 1, 4096, kTri, 4, 0, 0, kTop, n + 1, 1, 0, true});
  }
  cases.push_back({"N_max 4", 5 * 4096 + 16, 4096, kTri, 2, 0, 0, kTop, 4, 3, 1, true});
  cases.push_back({"N_max 1: trilinear", 3 * 4096, 0, kTri, 0, 0, 0, kTop, 1, 3, 0, true});
  cases.push_back({"L not below 0", 4096, 8192, kTri, 4, 0, 0, kTop, 1, 1, 0, true});
  cases.push_back(
      {"a square gives all to the level", 4104, 4104, kTri, 4, 0, 0, kTop, 1, 1, 1, true});
  cases.push_back({"within a texel", 0, -8192, kTri, 4, 0, 0, kTop, 1, 0, 0, false});
  check_levels(cases, spec::texture::CountRule::kAny, spec::texture::CountCap::kNone);
}

TEST(TextureRtlLevel, AnyCountWithTexelCap) {
  check_levels({{"as many as texels", 6492 + 72, -16 * 4096, kTri, 4, 0, 0, kTop, 3, 0, 0, false},
                {"one more", 6493 + 72, -16 * 4096, kTri, 4, 0, 0, kTop, 4, 0, 0, false},
                {"the ratio is less", 3 * 4096, 2 * 4096, kTri, 4, 0, 0, kTop, 2, 2, 0, true}},
               spec::texture::CountRule::kAny, spec::texture::CountCap::kTexel);
}

// Fragments between two levels, and those that are magnified; without a texture a fragment is
// neither, and has one sample of level 0.
TEST(TextureRtlLevel, CountsWhatItDecides) {
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
  d.min_filter = kTri;
  d.max_lod = kTop;
  write_descriptor(store.bus, 0, d);
  // l = 0, 1/256, 1, 1 + 1/256, 1.5, 2, 5, 9: three of them lie between two levels.
  for (const int lb : {0, 16, 4096, 4112, 6144, 8192, 20480, 36864})
    ends.source.add({ticket(), 0, 0, 0, 0, lb, lb});
  Ticket without = ticket();
  without.valid = false;
  for (const int lb : {0, 6144}) ends.source.add({without, 0, 0, 0, 0, lb, lb - 8192});
  clock.run(20);
  ASSERT_EQ(ends.sink.taken.size(), 10u);
  expect_clocks(LevelUnit::datasheet(), clocks_of(ends.sink), 1);
  // From the first fragment's clock to that of the last one's last stage, and not beyond.
  const Cycle busy = 9 + LevelUnit::datasheet().latency.clocks;
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

// Beside the major axis the area: d_max = 8, area 16, so the minor axis is 2.
TEST(TextureRtlLevel, RatioFromAnArea) {
  check_levels(
      {{"8 by 2", 3 * 4096, 4 * 4096, kTri, 4, 0, 0, kTop, 4, 1, 0, true},
       {"area above the square", 4096, 3 * 4096, kTri, 4, 0, 0, kTop, 1, 1, 0, true},
       {"the largest area", 16 * 4096 - 1, 31 * 4096 - 1, kTri, 4, 0, 0, kTop, 1, 5, 0, true}},
      spec::texture::CountRule::kFloor, spec::texture::CountCap::kNone,
      spec::texture::Axes::kEight);
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::level_unit_test
