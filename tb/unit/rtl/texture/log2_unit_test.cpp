// SPDX-License-Identifier: MIT
// The Log2Unit alone: cycles and ports. Values are compared in equivalence_test.cpp.
#include "rtl_model/texture/log2_unit.h"

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::log2_unit_test {
namespace {

using namespace rtl::texture;

TEST(TextureRtlLog2, LatencyAndIntervalMatchDatasheet) {
  using spec::texture::Log2Rule;
  ClockDomain clock("clock", period());
  struct Bench {
    Bench(ClockDomain& domain, const std::string& name, Log2Rule rule)
        : unit(name.c_str(), domain, rule), ends(domain, name + "_") {
      unit.footprints_in(ends.in);
      unit.logs_out(ends.out);
      ends.source.add({ticket(9), 1, 2, 3, 4, 6u << 16, false, 1u << 16});
      ends.source.add({ticket(10), 1, 2, 3, 4, 1, true, 0});
      ends.source.add({ticket(11), 1, 2, 3, 4, 7u << 16, false, 5});
    }
    Log2Unit unit;
    Ends<FootprintToken, Log2Token> ends;
  };
  std::vector<std::unique_ptr<Bench>> benches;
  for (std::size_t rule = 0; rule < spec::texture::kLog2Names.size(); ++rule)
    benches.push_back(std::make_unique<Bench>(clock, std::string(spec::texture::kLog2Names[rule]),
                                              static_cast<Log2Rule>(rule)));
  // When the consumer stops, tokens before the correction keep their values, including the ROM's
  // words.
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
      // From the first fragment's cycle to the last fragment's last stage.
      const Cycle busy = 2 + sheet.latency.cycles;
      EXPECT_EQ(benches[rule]->unit.busy_cycles(), busy);
      EXPECT_EQ(benches[rule]->unit.idle_cycles(), 20 - busy);
    }
    EXPECT_EQ(taken[0].token.ticket.tag, 9u);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(taken[i].token.diagonal, i == 1);
  }
}

struct ExactBench {
  ExactBench() {
    unit.footprints_in(ends.in);
    unit.logs_out(ends.out);
    ends.source.add(token);
    clock.run(2);  // taken in 1
  }
  const FootprintToken token{ticket(9), 1, 2, 3, 4, 6u << 16, false, 1u << 16};
  ClockDomain clock{"clock", period()};
  Log2Unit unit{"unit", clock, spec::texture::Log2Rule::kExact};
  Ends<FootprintToken, Log2Token> ends{clock};
};

TEST(TextureRtlLog2Table, WordReadInSameCycleIsRejected) {
  ExactBench b;
  EXPECT_THAT(read_one_cycle_early(b.unit, b.clock), Rejects("table", kEarly));
}

TEST(TextureRtlLog2Table, SecondFragmentInOneCycleIsRejected) {
  ExactBench b;
  EXPECT_THAT(of_a_second_token(b.unit, b.ends.in, b.token, b.clock), Rejects("table", kTooMany));
}

TEST(TextureRtlLog2Table, RejectsExtraPort) {
  ExactBench b;
  EXPECT_THAT((of_one_port_more<rtl::ReadPort<std::uint16_t>, std::uint16_t>(b.unit, "table")),
              Rejects("table", "one port more than 4R"));
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::log2_unit_test
