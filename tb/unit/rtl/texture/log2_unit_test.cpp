// SPDX-License-Identifier: MIT
// The Log2Unit alone. Expected values are worked out by hand from
// docs/reference/texture/formats.md.
#include "rtl_model/texture/log2_unit.h"

#include <cmath>

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::log2_unit_test {
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
  // Between entries 0 and 92, 182 and 271 of the table: 11.5 and 76.48 are rounded to the nearest.
  EXPECT_EQ(Log2Unit::log2(Log2Rule::kExact, (4096u + 8) << 4), 12);
  EXPECT_EQ(Log2Unit::log2(Log2Rule::kExact, (4096u + 183) << 4), 182 + 76);
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

TEST(TextureRtlLog2, LatencyAndIntervalOfTheDatasheet) {
  using spec::texture::Log2Rule;
  ClockDomain clock("clock", period());
  struct Bench {
    Bench(ClockDomain& domain, const std::string& name, Log2Rule rule)
        : unit(name.c_str(), domain, rule), ends(domain, name + "_") {
      unit.footprints_in(ends.in);
      unit.logs_out(ends.out);
      ends.source.add({ticket(9), 1, 2, 3, 4, 6u << 16, 1u << 16});
      ends.source.add({ticket(10), 1, 2, 3, 4, 1, 0});
      ends.source.add({ticket(11), 1, 2, 3, 4, 7u << 16, 5});
    }
    Log2Unit unit;
    Ends<FootprintToken, Log2Token> ends;
  };
  std::vector<std::unique_ptr<Bench>> benches;
  for (std::size_t rule = 0; rule < spec::texture::kLog2Names.size(); ++rule)
    benches.push_back(std::make_unique<Bench>(clock, std::string(spec::texture::kLog2Names[rule]),
                                              static_cast<Log2Rule>(rule)));
  // The consumer stops: what is on its way to a correction stays what it is, the ROM's words too.
  benches.back()->ends.sink.hold_from = 5;
  benches.back()->ends.sink.hold_to = 9;
  clock.run(20);
  for (std::size_t rule = 0; rule < benches.size(); ++rule) {
    SCOPED_TRACE(spec::texture::kLog2Names[rule]);
    const auto& taken = benches[rule]->ends.sink.taken;
    ASSERT_EQ(taken.size(), 3u);
    spec::texture::Parameters p;
    p.log2 = static_cast<Log2Rule>(rule);
    const rtl::Datasheet sheet = Log2Unit::datasheet(p);
    expect_latency(sheet, taken[0].cycle - 1);
    if (rule == 3) {
      EXPECT_EQ(taken[1].cycle, 9u);
    } else {
      expect_interval(sheet, taken[1].cycle - taken[0].cycle);
      // From the first fragment's clock to that of the last one's last stage, and not beyond.
      const Cycle busy = 2 + sheet.latency.clocks;
      EXPECT_EQ(benches[rule]->unit.busy_cycles(), busy);
      EXPECT_EQ(benches[rule]->unit.idle_cycles(), 20 - busy);
    }
    const auto log2 = [&](std::uint32_t d) {
      return Log2Unit::log2(static_cast<Log2Rule>(rule), d);
    };
    EXPECT_EQ(taken[0].token.lb_max, log2(6u << 16));
    EXPECT_EQ(taken[0].token.lb_minor, log2(1u << 16));
    EXPECT_EQ(taken[2].token.lb_max, log2(7u << 16));
    EXPECT_EQ(taken[2].token.lb_minor, log2(5));
    EXPECT_EQ(taken[0].token.axis_s, 3);
    EXPECT_EQ(taken[0].token.axis_t, 4);
    EXPECT_EQ(taken[0].token.ticket.tag, 9u);
  }
}

struct ExactBench {
  ExactBench() {
    unit.footprints_in(ends.in);
    unit.logs_out(ends.out);
    ends.source.add(token);
    clock.run(2);  // taken in 1
  }
  const FootprintToken token{ticket(9), 1, 2, 3, 4, 6u << 16, 1u << 16};
  ClockDomain clock{"clock", period()};
  Log2Unit unit{"unit", clock, spec::texture::Log2Rule::kExact};
  Ends<FootprintToken, Log2Token> ends{clock};
};

TEST(TextureRtlLog2Table, AWordIsNotThereInTheClockOfItsRead) {
  ExactBench b;
  EXPECT_THAT(of_a_stage_less(b.unit, b.clock), Rejects("table", kEarly));
}

TEST(TextureRtlLog2Table, OneFragmentAClock) {
  ExactBench b;
  EXPECT_THAT(of_a_second_token(b.unit, b.ends.in, b.token, b.clock), Rejects("table", kTooMany));
}

TEST(TextureRtlLog2Table, HasNoPortForAnybodyElse) {
  ExactBench b;
  EXPECT_THAT((of_one_port_more<rtl::ReadPort<std::uint16_t>, std::uint16_t>(b.unit, "table")),
              Rejects("table", "one port more than 4R"));
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::log2_unit_test
