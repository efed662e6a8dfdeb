// SPDX-License-Identifier: MIT
// The DerivativeUnit alone: rounding, saturation, cycles and counters. Other values are compared in
// equivalence_test.cpp.
#include "rtl_model/texture/derivative_unit.h"

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::derivative_unit_test {
namespace {

using namespace rtl::texture;

struct DerivativeBench {
  explicit DerivativeBench(
      spec::texture::Derivatives derivatives = spec::texture::Derivatives::kFine)
      : unit("unit", clock, store.control, store.descriptors.for_derivatives, probe, derivatives) {
    unit.quads_in(ends.in);
    unit.derivatives_out(ends.out);
    spec::texture::Descriptor d;
    d.width = 256;
    d.height = 128;
    d.levels = 1;
    write_descriptor(store.bus, 0, d);
  }
  ClockDomain clock{"clock", period()};
  Store store{clock};
  rtl::LatencyProbe probe;
  DerivativeUnit unit;
  Ends<spec::texture::Quad, DerivativeToken> ends{clock};
};

TEST(TextureRtlDerivative, RoundsToNearestAndSaturates) {
  DerivativeBench b;
  spec::texture::Quad q;
  q.coverage = 1;
  q.s = {1, 0, 1, 0};  // -1 x 256 = 256 / 256 = 1
  q.t = {0, 0, 1, 0};  // 1 x 128 = 0.5 ulp: up
  b.ends.source.add(q);
  q.s = {INT32_MIN, INT32_MAX, INT32_MIN, 0};  // (2^32 - 1) x 256 -> 2^32 - 1 in U15.16: saturates
  q.t = {0, 0, 1 << 30, 0};                    // 64 x 128 = 8192 texels
  b.ends.source.add(q);
  q.s = {0, INT32_MAX, 0, 0};  // (2^31 - 1) x 256 -> 2^31 - 1: fits
  q.t = {0, 0, 0, 0};
  b.ends.source.add(q);
  b.clock.run(12);
  ASSERT_EQ(b.ends.sink.taken.size(), 3u);
  EXPECT_EQ(b.ends.sink.taken[0].token.size_s_x, 1u);
  EXPECT_EQ(b.ends.sink.taken[0].token.size_t_y, 1u);
  EXPECT_EQ(b.ends.sink.taken[1].token.size_s_x, 0x7FFFFFFFu);
  EXPECT_EQ(b.ends.sink.taken[1].token.size_t_y, 8192u << 16);
  EXPECT_EQ(b.ends.sink.taken[2].token.size_s_x, 0x7FFFFFFFu);
  EXPECT_EQ(b.unit.saturated.value(), 1u);
}

// Lanes 0 to 3 of s are 0, 1, 10 and 15, of t 0, 20, 2 and 50 coordinate units; by lane s_x, t_x,
// s_y and t_y.
using Differences = std::array<std::array<std::int64_t, 4>, 4>;
void expect_differences(spec::texture::Derivatives derivatives, const Differences& expected) {
  DerivativeBench b(derivatives);
  spec::texture::Quad q;
  q.s = {0, 1, 10, 15};
  q.t = {0, 20, 2, 50};
  b.ends.source.add(q);
  b.clock.run(12);
  ASSERT_EQ(b.ends.sink.taken.size(), 4u);
  EXPECT_EQ(b.ends.sink.taken[0].cycle, 1 + DerivativeUnit::datasheet().latency.cycles);
  for (std::size_t lane = 0; lane < 4; ++lane) {
    const DerivativeToken& d = b.ends.sink.taken[lane].token;
    EXPECT_THAT(expected[lane], testing::ElementsAre(d.s_x, d.t_x, d.s_y, d.t_y)) << lane;
    EXPECT_EQ(d.s, q.s[lane]);
  }
}
TEST(TextureRtlDerivative, FineUsesRowAndColumnOfTheLane) {
  expect_differences(spec::texture::Derivatives::kFine,
                     {{{1, 20, 10, 2}, {1, 20, 14, 30}, {5, 48, 10, 2}, {5, 48, 14, 30}}});
}
TEST(TextureRtlDerivative, CoarseUsesRow0AndColumn0) {
  expect_differences(spec::texture::Derivatives::kCoarse,
                     {{{1, 20, 10, 2}, {1, 20, 10, 2}, {1, 20, 10, 2}, {1, 20, 10, 2}}});
}

TEST(TextureRtlDerivative, TakesOneCyclePerCoveredLane) {
  DerivativeBench b;
  for (const std::uint8_t coverage : std::to_array<std::uint8_t>({0xF, 0x9, 0, 0, 4, 0xF})) {
    spec::texture::Quad q;
    q.coverage = coverage;
    q.clamped = 0x3;
    b.ends.source.add(q);
  }
  b.clock.run(20);
  // Quads take 4, 2, 1, 1, 1 and 4 cycles; the first is pushed in 0, taken in 1.
  std::vector<Cycle> when = cycles_of(b.ends.sink);
  expect_latency(DerivativeUnit::datasheet(), when.front() - 1);
  for (Cycle& clock : when) clock -= DerivativeUnit::datasheet().latency.cycles;
  EXPECT_THAT(when, testing::ElementsAre(1, 2, 3, 4, 5, 6, 9, 10, 11, 12, 13));
  EXPECT_EQ(b.unit.quads.value(), 6u);
  EXPECT_EQ(b.unit.fragments.value(), 11u);
  EXPECT_EQ(b.unit.clamped.value(), 2u + 1 + 0 + 2);
  EXPECT_EQ(b.unit.busy_cycles(), 13u + 2);  // until the last one has left
}

TEST(TextureRtlDerivative, StallsWhileOutputIsBlocked) {
  DerivativeBench b;
  b.ends.sink.hold_to = 20;
  for (const std::uint8_t coverage : std::to_array<std::uint8_t>({1, 1, 0, 0, 1, 8, 0, 2})) {
    spec::texture::Quad q;
    q.coverage = coverage;
    b.ends.source.add(q);
  }
  b.clock.run(20);
  EXPECT_EQ(b.unit.quads.value(), 6u);  // two in the link, two in stages, two without a fragment
  b.clock.run(20);
  EXPECT_EQ(b.unit.quads.value(), 8u);
  EXPECT_EQ(b.ends.sink.taken.size(), 5u);
}

TEST(TextureRtlDerivative, TakesNothingWhileDisabled) {
  DerivativeBench b;
  b.store.bus.write(spec::texture::reg::kControl, 0);
  b.ends.source.add({});
  b.clock.run(12);
  EXPECT_TRUE(b.ends.sink.taken.empty());
  b.store.bus.write(spec::texture::reg::kControl, 1);
  b.clock.run(12);
  EXPECT_EQ(b.ends.sink.taken.size(), 4u);
}

TEST(TextureRtlDerivative, InvalidDescriptorIsCountedNotSaturated) {
  DerivativeBench b;
  spec::texture::Quad q;
  q.texture = 3;
  q.coverage = 0x5;
  q.s = {INT32_MIN, INT32_MAX, 0, 0};
  b.ends.source.add(q);
  q.texture = 200;  // undefined handle
  b.ends.source.add(q);
  b.clock.run(12);
  ASSERT_EQ(b.ends.sink.taken.size(), 4u);
  for (const auto& t : b.ends.sink.taken) EXPECT_FALSE(t.token.ticket.valid);
  EXPECT_EQ(b.unit.invalid.value(), 4u);
  EXPECT_EQ(b.unit.saturated.value(), 0u);
  EXPECT_EQ(
      b.store.bus.read(spec::texture::reg::kStatus) & spec::texture::reg::kStatusInvalidTexture,
      spec::texture::reg::kStatusInvalidTexture);
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::derivative_unit_test
