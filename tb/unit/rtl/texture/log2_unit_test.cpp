// SPDX-License-Identifier: MIT
// The Log2Unit alone. Expected values are worked out by hand from docs/number_formats.md.
#include "rtl_model/texture/log2_unit.h"

#include <cmath>

#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl {
namespace {

using namespace rtl::texture;

TEST(TextureRtlLog2, PowersOfTwoAndByHand) {
  using spec::texture::Log2Rule;
  for (int p = 0; p < 32; ++p) {
    EXPECT_EQ(Log2Unit::log2(Log2Rule::kMitchell, 1u << p), (p - 16) * 4096);
    EXPECT_EQ(Log2Unit::log2(Log2Rule::kCorrected, 1u << p), (p - 16) * 4096 + 92);
    EXPECT_EQ(Log2Unit::log2(Log2Rule::kSegments, 1u << p), (p - 16) * 4096 + 20);
    EXPECT_EQ(Log2Unit::log2(Log2Rule::kExact, 1u << p), (p - 16) * 4096);
  }
  for (const Log2Rule rule : {Log2Rule::kMitchell, Log2Rule::kExact})
    EXPECT_EQ(Log2Unit::log2(rule, 0), -16 * 4096);
  // 1.5: y = 2048.
  EXPECT_EQ(Log2Unit::log2(Log2Rule::kMitchell, 3u << 15), 2048);
  EXPECT_EQ(Log2Unit::log2(Log2Rule::kCorrected, 3u << 15), 2048 + 329);
  EXPECT_EQ(Log2Unit::log2(Log2Rule::kSegments, 3u << 15), 2048 + 356);
  EXPECT_EQ(Log2Unit::log2(Log2Rule::kExact, 3u << 15), 2396);
  // y = 1023, 2047 and 4095: the ends of three segments; y is truncated, so a low bit is lost.
  EXPECT_EQ(Log2Unit::log2(Log2Rule::kSegments, (4096u + 1023) << 4 | 15), 1023 + 20 + 255 + 31);
  EXPECT_EQ(Log2Unit::log2(Log2Rule::kSegments, (4096u + 2047) << 4), 2047 + 305 + 63 - 7);
  EXPECT_EQ(Log2Unit::log2(Log2Rule::kSegments, (4096u + 3071) << 4), 3071 + 356 - 127 + 15);
  EXPECT_EQ(Log2Unit::log2(Log2Rule::kSegments, (4096u + 4095) << 4), 4095 + 243 - 255 + 15);
  EXPECT_EQ(Log2Unit::log2(Log2Rule::kExact, (4096u + 4095) << 4), 4050 + ((46 * 63 + 32) >> 6));
}

// Exhaustive over y: every octave has the same fraction.
TEST(TextureRtlLog2, ErrorIsAsDocumented) {
  const double bounds[] = {0.0864, 0.0228, 0.0057, 0.0006};
  for (std::size_t rule = 0; rule < 4; ++rule) {
    double worst = 0;
    for (std::uint32_t d = 1u << 20; d < 1u << 21; ++d) {
      const double got = Log2Unit::log2(static_cast<spec::texture::Log2Rule>(rule), d) / 4096.0;
      worst = std::max(worst, std::abs(got - (std::log2(d) - 16)));
    }
    EXPECT_LE(worst, bounds[rule]) << spec::texture::kLog2Names[rule];
    EXPECT_GE(worst, 0.85 * bounds[rule]) << spec::texture::kLog2Names[rule];
  }
}

TEST(TextureRtlLog2, LatencyOne) {
  ClockDomain clock("clock", period());
  Log2Unit unit("unit", clock, spec::texture::Log2Rule::kMitchell);
  Ends<FootprintToken, Log2Token> ends(clock);
  unit.footprints_in(ends.in);
  unit.logs_out(ends.out);
  ends.source.add({ticket(9), 1, 2, 3, 4, 6u << 16, 1u << 16});
  ends.source.add({ticket(10), 1, 2, 3, 4, 1, 0});
  clock.run(10);
  ASSERT_EQ(ends.sink.taken.size(), 2u);
  EXPECT_EQ(ends.sink.taken[0].cycle, 2u);
  EXPECT_EQ(ends.sink.taken[1].cycle, 3u);
  const Log2Token& r = ends.sink.taken[0].token;
  EXPECT_EQ(r.lb_max, (2 << 12) + 2048);
  EXPECT_EQ(r.lb_min, 0);
  EXPECT_EQ(r.axis_s, 3);
  EXPECT_EQ(r.axis_t, 4);
  EXPECT_EQ(r.ticket.tag, 9u);
}

}  // namespace
}  // namespace deburr::tb::texture_rtl
