// SPDX-License-Identifier: MIT
// The SampleWalker alone. Expected values are worked out by hand from docs/number_formats.md.
#include "rtl_model/texture/sample_walker.h"

#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl {
namespace {

using namespace rtl::texture;

struct WalkerBench {
  WalkerBench(ClockDomain& clock, const std::string& name, spec::texture::Kernel kernel,
              std::int32_t spread)
      : unit((name + "unit").c_str(), clock, kernel, spread), ends(clock, name) {
    unit.levels_in(ends.in);
    unit.samples_out(ends.out);
  }
  SampleWalker unit;
  Ends<LevelToken, SampleToken> ends;
};

TEST(TextureRtlWalker, PlacesSamplesByHand) {
  ClockDomain clock("clock", period());
  WalkerBench b(clock, "", spec::texture::Kernel::kBox, 64);
  // N = 4: (2i - 3) x 64 x axis / 2^9.
  b.ends.source.add({ticket(), 1000, -1000, 1 << 20, -(1 << 10), 2, 3, 0, true});
  // N = 2 and an axis of 3 ulp: -+192 / 256, rounded to -1 and 1; of 2 ulp: -+0.5, to 0 and 1.
  b.ends.source.add({ticket(), 0, 0, 3, 2, 1, 0, 0, true});
  clock.run(20);
  ASSERT_EQ(b.ends.sink.taken.size(), 6u);
  for (int i = 0; i < 4; ++i) {
    const SampleToken& s = b.ends.sink.taken[static_cast<std::size_t>(i)].token;
    EXPECT_EQ(s.s, 1000 + (2 * i - 3) * 131072);
    EXPECT_EQ(s.t, -1000 - (2 * i - 3) * 128);
    EXPECT_EQ(s.level_weight, 256);
    EXPECT_EQ(s.kernel_weight, 1);
    EXPECT_EQ(s.sum_log2, 2);
    EXPECT_EQ(s.level, 3);
    EXPECT_TRUE(s.last_of_sample);
    EXPECT_EQ(s.last_of_fragment, i == 3);
  }
  EXPECT_EQ(b.ends.sink.taken[4].token.s, -1);
  EXPECT_EQ(b.ends.sink.taken[5].token.s, 1);
  EXPECT_EQ(b.ends.sink.taken[4].token.t, 0);
  EXPECT_EQ(b.ends.sink.taken[5].token.t, 1);
}

TEST(TextureRtlWalker, TentAndSpread) {
  ClockDomain clock("clock", period());
  WalkerBench b(clock, "", spec::texture::Kernel::kTent, 96);
  for (std::uint8_t n = 0; n <= 4; ++n)
    b.ends.source.add({ticket(), 0, 0, 1 << 20, 0, n, 0, 0, true});
  clock.run(50);
  const std::vector<std::vector<int>> weights = {
      {1},
      {1, 1},
      {1, 3, 3, 1},
      {1, 3, 5, 7, 7, 5, 3, 1},
      {1, 3, 5, 7, 9, 11, 13, 15, 15, 13, 11, 9, 7, 5, 3, 1}};
  const int sum_log2[] = {0, 1, 3, 5, 7};
  ASSERT_EQ(b.ends.sink.taken.size(), 31u);
  std::size_t at = 0;
  for (std::size_t n = 0; n < weights.size(); ++n) {
    int sum = 0;
    const int count = 1 << n;
    for (int i = 0; i < count; ++i) {
      const SampleToken& s = b.ends.sink.taken[at++].token;
      EXPECT_EQ(s.kernel_weight, weights[n][static_cast<std::size_t>(i)]);
      EXPECT_EQ(s.sum_log2, sum_log2[n]);
      EXPECT_EQ(s.s, (2 * i + 1 - count) * 96 * (1 << 20) / (128 * count));
      sum += s.kernel_weight;
    }
    EXPECT_EQ(sum, 1 << sum_log2[n]);
  }
}

// The largest offset: 15 x 128 x (2^32 - 1) needs all of the accumulator's bits.
TEST(TextureRtlWalker, ExtremesDoNotOverflow) {
  ClockDomain clock("clock", period());
  WalkerBench b(clock, "", spec::texture::Kernel::kBox, 128);
  const std::int64_t axis = (std::int64_t{1} << 32) - 1;
  b.ends.source.add({ticket(), INT32_MAX, INT32_MIN, axis, -axis, 4, 0, 0, true});
  clock.run(30);
  ASSERT_EQ(b.ends.sink.taken.size(), 16u);
  // -+15 x 128 x (2^32 - 1) / 2^11 = -+(15 x 2^28 - 15/16), rounded.
  EXPECT_EQ(b.ends.sink.taken[0].token.s, INT32_MAX - (15ll << 28) + 1);
  EXPECT_EQ(b.ends.sink.taken[15].token.s, INT32_MAX + (15ll << 28) - 1);
  EXPECT_EQ(b.ends.sink.taken[15].token.t, INT32_MIN - (15ll << 28) + 1);
}

TEST(TextureRtlWalker, CostsNTimesLevelsClocks) {
  ClockDomain clock("clock", period());
  WalkerBench b(clock, "", spec::texture::Kernel::kBox, 64);
  Cycle at = 2;  // pushed in 0, taken in 1, to be taken in 2
  std::vector<Cycle> last;
  for (std::uint8_t n = 0; n <= 4; ++n)
    for (const std::uint8_t fraction : std::to_array<std::uint8_t>({0, 77})) {
      b.ends.source.add({ticket(), 0, 0, 0, 0, n, 1, fraction, true});
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
  EXPECT_EQ(b.ends.sink.taken.back().token.kernel_weight, 0);
  // A trilinear sample: the finer level first, with the rest of the weight.
  const SampleToken &finer = b.ends.sink.taken[1].token, &coarser = b.ends.sink.taken[2].token;
  EXPECT_EQ(finer.level, 1);
  EXPECT_EQ(finer.level_weight, 256 - 77);
  EXPECT_FALSE(finer.last_of_sample);
  EXPECT_EQ(coarser.level, 2);
  EXPECT_EQ(coarser.level_weight, 77);
  EXPECT_TRUE(coarser.last_of_sample);
}

}  // namespace
}  // namespace deburr::tb::texture_rtl
