// SPDX-License-Identifier: MIT
// The blocks of the AddressUnit, each alone. Expected values are worked out by hand from
// docs/number_formats.md.
#include <cmath>
#include <random>

#include "rtl_model/texture/address_unit.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl {
namespace {

using namespace rtl::texture;
constexpr std::int32_t kOne = spec::texture::kCoordinateOne;

Ticket ticket(std::uint32_t tag = 0, std::uint8_t texture = 0) {
  return {tag, 0, true, true, texture};
}

// ---- DerivativeUnit -----------------------------------------------------------------------------

struct DerivativeBench {
  DerivativeBench() {
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
  FragmentProbe probe{64};
  DerivativeUnit unit{"unit", clock, store.store, probe};
  Ends<spec::texture::Quad, DerivativeToken> ends{clock};
};

TEST(TextureRtlDerivative, EachLaneTakesItsOwnRowAndColumn) {
  DerivativeBench b;
  spec::texture::Quad q;
  q.tag = 77;
  q.s = {0, 1 << 18, 3 << 18, 7 << 18};
  q.t = {-5, 1 << 17, 3, 1 << 20};
  b.ends.source.add(q);
  b.clock.run(10);
  ASSERT_EQ(b.ends.sink.taken.size(), 4u);
  const std::int64_t row_s[] = {1 << 18, 1 << 18, 4 << 18, 4 << 18};
  const std::int64_t column_s[] = {3 << 18, 6 << 18, 3 << 18, 6 << 18};
  const std::int64_t row_t[] = {(1 << 17) + 5, (1 << 17) + 5, (1 << 20) - 3, (1 << 20) - 3};
  const std::int64_t column_t[] = {8, (1 << 20) - (1 << 17), 8, (1 << 20) - (1 << 17)};
  for (std::size_t lane = 0; lane < 4; ++lane) {
    const DerivativeToken& d = b.ends.sink.taken[lane].token;
    EXPECT_EQ(d.ticket.tag, 77u);
    EXPECT_EQ(d.ticket.lane, lane);
    EXPECT_EQ(d.ticket.last, lane == 3);
    EXPECT_EQ(d.s, q.s[lane]);
    EXPECT_EQ(d.t, q.t[lane]);
    EXPECT_EQ(d.s_x, row_s[lane]);
    EXPECT_EQ(d.s_y, column_s[lane]);
    EXPECT_EQ(d.t_x, row_t[lane]);
    EXPECT_EQ(d.t_y, column_t[lane]);
  }
  // 2^18 of 2^24 is 1/64, of 256 texels 4.
  EXPECT_EQ(b.ends.sink.taken[0].token.size_s_x, 4u << 16);
  EXPECT_EQ(b.ends.sink.taken[0].token.size_s_y, 12u << 16);
  // (2^17 + 5) x 128 = 2^24 + 640, at 16 fraction bits 65536 + 2.5, rounded up.
  EXPECT_EQ(b.ends.sink.taken[0].token.size_t_x, 65539u);
}

TEST(TextureRtlDerivative, RoundsToNearestAndSaturates) {
  DerivativeBench b;
  spec::texture::Quad q;
  q.coverage = 1;
  q.s = {1, 0, 1, 0};  // -1 x 256 = 256 / 256 = 1
  q.t = {0, 0, 1, 0};  // 1 x 128 = 0.5 ulp: up
  b.ends.source.add(q);
  q.s = {INT32_MIN, INT32_MAX, INT32_MIN, 0};  // (2^32 - 1) x 256 -> 2^32 - 1 in U15.16: too much
  q.t = {0, 0, 1 << 30, 0};                    // 64 x 128 = 8192 texels
  b.ends.source.add(q);
  q.s = {0, INT32_MAX, 0, 0};  // (2^31 - 1) x 256 -> 2^31 - 1: just fits
  q.t = {0, 0, 0, 0};
  b.ends.source.add(q);
  b.clock.run(10);
  ASSERT_EQ(b.ends.sink.taken.size(), 3u);
  EXPECT_EQ(b.ends.sink.taken[0].token.size_s_x, 1u);
  EXPECT_EQ(b.ends.sink.taken[0].token.size_t_y, 1u);
  EXPECT_EQ(b.ends.sink.taken[1].token.size_s_x, 0x7FFFFFFFu);
  EXPECT_EQ(b.ends.sink.taken[1].token.size_t_y, 8192u << 16);
  EXPECT_EQ(b.ends.sink.taken[2].token.size_s_x, 0x7FFFFFFFu);
  EXPECT_EQ(b.unit.saturated.value(), 1u);
}

TEST(TextureRtlDerivative, OneClockACoveredLane) {
  DerivativeBench b;
  for (const std::uint8_t coverage : std::to_array<std::uint8_t>({0xF, 0x9, 0, 0, 4, 0xF})) {
    spec::texture::Quad q;
    q.coverage = coverage;
    q.clamped = 0x3;
    b.ends.source.add(q);
  }
  b.clock.run(20);
  // Quads take 4, 2, 1, 1, 1 and 4 clocks; the first is pushed in 0, taken in 1, seen in 2.
  std::vector<Cycle> when;
  for (const auto& t : b.ends.sink.taken) when.push_back(t.cycle);
  EXPECT_THAT(when, testing::ElementsAre(2, 3, 4, 5, 6, 7, 10, 11, 12, 13, 14));
  EXPECT_EQ(b.unit.quads.value(), 6u);
  EXPECT_EQ(b.unit.fragments.value(), 11u);
  EXPECT_EQ(b.unit.clamped.value(), 2u + 1 + 0 + 2);
  EXPECT_EQ(b.unit.busy_cycles(), 13u);
}

TEST(TextureRtlDerivative, WaitsForItsOutputUnlessNothingIsCovered) {
  DerivativeBench b;
  b.ends.sink.hold_to = 20;
  for (const std::uint8_t coverage : std::to_array<std::uint8_t>({1, 1, 0, 0, 1, 8, 0, 2})) {
    spec::texture::Quad q;
    q.coverage = coverage;
    b.ends.source.add(q);
  }
  b.clock.run(20);
  EXPECT_EQ(b.unit.quads.value(), 4u);  // two in the link, two without a fragment
  b.clock.run(20);
  EXPECT_EQ(b.unit.quads.value(), 8u);
  EXPECT_EQ(b.ends.sink.taken.size(), 5u);
}

TEST(TextureRtlDerivative, TakesNothingWhileDisabled) {
  DerivativeBench b;
  b.store.bus.write(spec::texture::reg::kControl, 0);
  b.ends.source.add({});
  b.clock.run(10);
  EXPECT_TRUE(b.ends.sink.taken.empty());
  b.store.bus.write(spec::texture::reg::kControl, 1);
  b.clock.run(10);
  EXPECT_EQ(b.ends.sink.taken.size(), 4u);
}

TEST(TextureRtlDerivative, InvalidDescriptorIsCountedAndNotSaturated) {
  DerivativeBench b;
  spec::texture::Quad q;
  q.texture = 3;
  q.coverage = 0x5;
  q.s = {INT32_MIN, INT32_MAX, 0, 0};
  b.ends.source.add(q);
  q.texture = 200;  // no such handle
  b.ends.source.add(q);
  b.clock.run(10);
  ASSERT_EQ(b.ends.sink.taken.size(), 4u);
  for (const auto& t : b.ends.sink.taken) EXPECT_FALSE(t.token.ticket.valid);
  EXPECT_EQ(b.unit.invalid.value(), 4u);
  EXPECT_EQ(b.unit.saturated.value(), 0u);
  EXPECT_EQ(
      b.store.bus.read(spec::texture::reg::kStatus) & spec::texture::reg::kStatusInvalidTexture,
      spec::texture::reg::kStatusInvalidTexture);
}

// ---- FootprintUnit ------------------------------------------------------------------------------

struct FootprintBench {
  FootprintBench(ClockDomain& clock, const std::string& name, spec::texture::FootprintRule rule)
      : unit((name + "unit").c_str(), clock, rule), ends(clock, name) {
    unit.derivatives_in(ends.in);
    unit.footprints_out(ends.out);
  }
  FootprintUnit unit;
  Ends<DerivativeToken, FootprintToken> ends;
};

TEST(TextureRtlFootprint, EveryRuleByHand) {
  ClockDomain clock("clock", period());
  struct Row {
    spec::texture::FootprintRule rule;
    std::uint32_t x, y;  // of (s, t) = (300, 401) and (1001, 3)
  };
  // two_segment: max(401 + 37, 401 - 50 + 150) = 501, max(1001 + 0, 1001 - 125 + 1) = 1001.
  // exact: sqrt(250801) = 500.8, sqrt(1002010) = 1001.004.
  const std::vector<Row> rows = {{spec::texture::FootprintRule::kHalf, 551, 1002},
                                 {spec::texture::FootprintRule::kQuarter, 476, 1001},
                                 {spec::texture::FootprintRule::kTwoSegment, 501, 1001},
                                 {spec::texture::FootprintRule::kExact, 500, 1001},
                                 {spec::texture::FootprintRule::kMax, 401, 1001}};
  std::vector<std::unique_ptr<FootprintBench>> benches;
  for (const Row& row : rows) {
    const auto i = static_cast<std::size_t>(row.rule);
    benches.push_back(std::make_unique<FootprintBench>(
        clock, std::string(spec::texture::kFootprintNames[i]) + "_", row.rule));
    DerivativeToken d{ticket(5), 1, 2, 10, 20, 30, 40, 300, 401, 1001, 3};
    benches.back()->ends.source.add(d);
    std::swap(d.size_s_x, d.size_s_y);
    std::swap(d.size_t_x, d.size_t_y);
    benches.back()->ends.source.add(d);
    d.size_s_y = d.size_s_x;
    d.size_t_y = d.size_t_x;
    benches.back()->ends.source.add(d);  // a tie: the x side
  }
  clock.run(30);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    SCOPED_TRACE(spec::texture::kFootprintNames[i]);
    const auto& taken = benches[i]->ends.sink.taken;
    ASSERT_EQ(taken.size(), 3u);
    EXPECT_EQ(taken[0].token.d_max, rows[i].y);
    EXPECT_EQ(taken[0].token.d_min, rows[i].x);
    EXPECT_EQ(taken[0].token.axis_s, 30);
    EXPECT_EQ(taken[0].token.axis_t, 40);
    EXPECT_EQ(taken[1].token.d_max, rows[i].y);
    EXPECT_EQ(taken[1].token.axis_s, 10);
    EXPECT_EQ(taken[1].token.axis_t, 20);
    EXPECT_EQ(taken[2].token.axis_s, 10);
    EXPECT_EQ(taken[0].token.ticket.tag, 5u);
    EXPECT_EQ(taken[0].token.s, 1);
    EXPECT_EQ(taken[0].token.t, 2);
  }
}

TEST(TextureRtlFootprint, ErrorIsAsDocumented) {
  struct Row {
    spec::texture::FootprintRule rule;
    double low, high;  // percent
  };
  const std::uint32_t a = 1 << 20;
  for (const Row& row : {Row{spec::texture::FootprintRule::kHalf, 0, 11.9},
                         Row{spec::texture::FootprintRule::kQuarter, -11.7, 3.1},
                         Row{spec::texture::FootprintRule::kTwoSegment, -2.8, 0.8},
                         Row{spec::texture::FootprintRule::kMax, -29.3, 0}}) {
    SCOPED_TRACE(spec::texture::kFootprintNames[static_cast<std::size_t>(row.rule)]);
    double low = 0, high = 0;
    for (std::uint32_t b = 0; b <= a; b += 16) {
      const double error = 100 * (FootprintUnit::side(row.rule, b, a) / std::hypot(a, b) - 1);
      low = std::min(low, error);
      high = std::max(high, error);
    }
    EXPECT_NEAR(low, row.low, 0.1);
    EXPECT_NEAR(high, row.high, 0.1);
    EXPECT_GE(low, row.low);
    EXPECT_LE(high, row.high);
  }
}

TEST(TextureRtlFootprint, LatencyOneAndSixteen) {
  ClockDomain clock("clock", period());
  FootprintBench half(clock, "half_", spec::texture::FootprintRule::kHalf);
  FootprintBench exact(clock, "exact_", spec::texture::FootprintRule::kExact);
  for (FootprintBench* b : {&half, &exact})
    for (int i = 0; i < 40; ++i) b->ends.source.add({});
  clock.run(100);
  for (const auto& [bench, latency] : {std::pair{&half, 1u}, std::pair{&exact, 16u}}) {
    ASSERT_EQ(bench->ends.sink.taken.size(), 40u);
    for (std::size_t i = 0; i < 40; ++i)  // pushed in i, taken in i + 1
      EXPECT_EQ(bench->ends.sink.taken[i].cycle, i + 1 + latency);
  }
}

TEST(TextureRtlFootprint, RootIsTheIntegerSquareRoot) {
  ClockDomain clock("clock", period());
  FootprintBench b(clock, "", spec::texture::FootprintRule::kExact);
  std::mt19937 random(7);
  std::vector<DerivativeToken> tokens;
  for (int i = 0; i < 4000; ++i) {
    const auto any = [&] { return static_cast<std::uint32_t>(random() >> (1 + random() % 31)); };
    tokens.push_back({ticket(), 0, 0, 0, 0, 0, 0, any(), any(), any(), any()});
  }
  tokens.push_back({ticket(), 0, 0, 0, 0, 0, 0, 0x7FFFFFFF, 0x7FFFFFFF, 0, 0});
  tokens.push_back({ticket(), 0, 0, 0, 0, 0, 0, 3 << 16, 4 << 16, 5 << 16, 12 << 16});
  for (const DerivativeToken& t : tokens) b.ends.source.add(t);
  // The consumer stops now and then: nothing may get lost or be worked on twice.
  b.ends.sink.hold_from = 100;
  b.ends.sink.hold_to = 140;
  clock.run(tokens.size() + 100);
  ASSERT_EQ(b.ends.sink.taken.size(), tokens.size());
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    const DerivativeToken& t = tokens[i];
    const FootprintToken& r = b.ends.sink.taken[i].token;
    const auto square = [](std::uint64_t v) { return v * v; };
    const std::uint64_t x = square(t.size_s_x) + square(t.size_t_x),
                        y = square(t.size_s_y) + square(t.size_t_y);
    EXPECT_LE(square(r.d_max), std::max(x, y));
    EXPECT_GT(square(std::uint64_t{r.d_max} + 1), std::max(x, y));
    EXPECT_LE(square(r.d_min), std::min(x, y));
    EXPECT_GT(square(std::uint64_t{r.d_min} + 1), std::min(x, y));
  }
  EXPECT_EQ(b.ends.sink.taken.back().token.d_max, 13u << 16);
  EXPECT_EQ(b.ends.sink.taken.back().token.d_min, 5u << 16);
}

// ---- Log2Unit -----------------------------------------------------------------------------------

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

// ---- LevelUnit ----------------------------------------------------------------------------------

struct LevelCase {
  const char* name;
  std::int32_t lb_max, lb_min;  // 1/4096
  spec::texture::MinFilter filter;
  std::uint8_t max_log2;
  std::int16_t bias;  // 1/256
  std::uint16_t min_lod, max_lod;
  int count_log2, level, fraction;
  bool linear;
};

void check_levels(const std::vector<LevelCase>& cases, spec::texture::CountRule count,
                  spec::texture::CountCap cap) {
  ClockDomain clock("clock", period());
  Store store(clock);
  LevelUnit unit("unit", clock, store.store, count, cap);
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
    ends.source.add({ticket(), 1, 2, 3, 4, c.lb_max, c.lb_min});
    clock.run(5);
    const LevelToken& r = ends.sink.taken.back().token;
    EXPECT_EQ(r.count_log2, c.count_log2);
    EXPECT_EQ(r.level, c.level);
    EXPECT_EQ(r.fraction, c.fraction);
    EXPECT_EQ(r.linear, c.linear);
    EXPECT_EQ(r.s, 1);
    EXPECT_EQ(r.axis_t, 4);
  }
  EXPECT_EQ(ends.sink.taken.size(), cases.size());
  EXPECT_EQ(ends.sink.taken.front().cycle, 2u);
}

constexpr auto kTri = spec::texture::MinFilter::kLinearMipmapLinear;
constexpr std::uint16_t kTop = 12 << 8;

TEST(TextureRtlLevel, PaperRule) {
  using F = spec::texture::MinFilter;
  check_levels(
      {
          {"isotropic, l = 1.5", 6144, 6144, kTri, 4, 0, 0, kTop, 0, 1, 128, true},
          {"ratio 2^1.99 gives N = 2", 3 * 4096, 4096 + 41, kTri, 4, 0, 0, kTop, 1, 2, 0, true},
          {"ratio 4", 3 * 4096, 4096, kTri, 4, 0, 0, kTop, 2, 1, 0, true},
          {"N at most 2", 4 * 4096, 0, kTri, 1, 0, 0, kTop, 1, 3, 0, true},
          {"N at most 16", 8 * 4096, -8 * 4096, kTri, 4, 0, 0, kTop, 4, 4, 0, true},
          {"footprint of one texel: N = 1, magnified", 0, -16 * 4096, kTri, 4, 0, 0, kTop, 0, 0, 0,
           false},
          {"just above a texel: N = 16", 1, -16 * 4096, kTri, 4, 0, 0, kTop, 4, 0, 0, false},
          {"l = 1/4096 minifies, rounds to level 0, f = 0", 1, 1, kTri, 4, 0, 0, kTop, 0, 0, 0,
           true},
          {"l = 8/4096 rounds up to 1/256", 8, 8, kTri, 4, 0, 0, kTop, 0, 0, 1, true},
          {"f rounds up to the next level", 8191, 8191, kTri, 4, 0, 0, kTop, 0, 2, 0, true},
          {"just below the coarsest", 5 * 4096 - 16, 5 * 4096, kTri, 4, 0, 0, kTop, 0, 4, 255,
           true},
          {"beyond the coarsest", 7 * 4096 + 9, 7 * 4096, kTri, 4, 0, 0, kTop, 0, 5, 0, true},
          {"L not below 0", 4096, 8192, kTri, 4, 0, 0, kTop, 0, 1, 0, true},
          {"bias +1.5", 4096, 4096, kTri, 4, 384, 0, kTop, 0, 2, 128, true},
          {"bias -1", 4096, 4096, kTri, 4, -256, 0, kTop, 0, 0, 0, false},
          {"min_lod 2.25", 4096, 4096, kTri, 4, 0, 576, kTop, 0, 2, 64, true},
          {"max_lod 0.5", 4096, 4096, kTri, 4, 0, 0, 128, 0, 0, 128, true},
          {"limits crossed: the upper one", 4096, 4096, kTri, 4, 0, 768, 512, 0, 2, 0, true},
          {"nearest: level 0", 9 * 4096, 9 * 4096, F::kNearest, 4, 0, 0, kTop, 0, 0, 0, false},
          {"linear: level 0", 9 * 4096, 9 * 4096, F::kLinear, 4, 0, 0, kTop, 0, 0, 0, true},
          {"mipmap nearest, 1.5: down", 6144, 6144, F::kLinearMipmapNearest, 4, 0, 0, kTop, 0, 1, 0,
           true},
          {"mipmap nearest, above 1.5: up", 6145, 6145, F::kNearestMipmapNearest, 4, 0, 0, kTop, 0,
           2, 0, false},
          {"mipmap nearest, beyond", 9 * 4096, 9 * 4096, F::kNearestMipmapNearest, 4, 0, 0, kTop, 0,
           5, 0, false},
          {"nearest mipmap linear", 6144, 6144, F::kNearestMipmapLinear, 4, 0, 0, kTop, 0, 1, 128,
           false},
      },
      spec::texture::CountRule::kFloor, spec::texture::CountCap::kNone);
}

TEST(TextureRtlLevel, CeilAndTexelCap) {
  check_levels(
      {
          {"ratio 2^1.01 gives N = 4, the cap allows 8", 3 * 4096 - 1, 2 * 4096 - 42, kTri, 4, 0, 0,
           kTop, 2, 1, 0, true},
          {"cap: lb d = 0.5 allows N = 2", 2048, -8 * 4096, kTri, 4, 0, 0, kTop, 1, 0, 0, false},
          {"cap: lb d = 1 allows N = 2", 4096, -8 * 4096, kTri, 4, 0, 0, kTop, 1, 0, 0, false},
          {"cap: lb d = 1.1 allows N = 4", 4506, -8 * 4096, kTri, 4, 0, 0, kTop, 2, 0, 0, false},
      },
      spec::texture::CountRule::kCeil, spec::texture::CountCap::kTexel);
}

// ---- SampleWalker -------------------------------------------------------------------------------

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

// ---- TexelAddresser -----------------------------------------------------------------------------

struct AddresserBench {
  AddresserBench() {
    unit.samples_in(ends.in);
    unit.texels_out(ends.out);
  }
  // The request for one sample of the descriptor.
  TexelToken address(const spec::texture::Descriptor& d, std::int64_t s, std::int64_t t,
                     bool linear, std::uint8_t level = 0) {
    write_descriptor(store.bus, 0, d);
    ends.source.add({ticket(), s, t, 256, 1, 0, level, linear, true, true});
    clock.run(6);
    return ends.sink.taken.back().token;
  }
  ClockDomain clock{"clock", period()};
  Store store{clock};
  TexelAddresser unit{"unit", clock, store.store};
  Ends<SampleToken, TexelToken> ends{clock};
};

spec::texture::Descriptor texture(int width, int height, spec::texture::Format format,
                                  spec::texture::Layout layout, spec::texture::Wrap wrap) {
  spec::texture::Descriptor d;
  d.width = static_cast<std::uint16_t>(width);
  d.height = static_cast<std::uint16_t>(height);
  d.levels = 1;
  d.format = format;
  d.layout = layout;
  d.wrap_s = d.wrap_t = wrap;
  d.base[0] = 0x1000;
  return d;
}

using testing::ElementsAre;

TEST(TextureRtlAddresser, WrapsByHand) {
  AddresserBench b;
  using W = spec::texture::Wrap;
  // L8, 8 x 8, linear layout: address = 0x1000 + 64 y + x.
  struct Row {
    W wrap;
    std::int64_t s;
    bool linear;
    std::uint32_t x0, x1;
    int fraction;
  };
  const std::int64_t half = kOne / 2, quarter = kOne / 4;
  for (const Row& r : std::vector<Row>{
           {W::kRepeat, 0, true, 7, 0, 128},
           {W::kRepeat, kOne / 16, true, 0, 1, 0},
           {W::kRepeat, -quarter, true, 5, 6, 128},
           {W::kRepeat, 300ll * kOne - 1, true, 7, 0, 128},
           {W::kRepeat, kOne - 1, false, 7, 7, 0},
           {W::kRepeat, kOne, false, 0, 0, 0},
           {W::kMirroredRepeat, kOne + quarter, true, 5, 6, 128},
           {W::kMirroredRepeat, -1, false, 0, 0, 0},
           {W::kMirroredRepeat, kOne, false, 7, 7, 0},
           {W::kMirroredRepeat, 2ll * kOne, true, 0, 0, 128},
           {W::kMirroredRepeat, kOne, true, 7, 7, 128},
           {W::kClampToEdge, -half, true, 0, 0, 128},
           {W::kClampToEdge, 5ll * kOne, true, 7, 7, 128},
           {W::kClampToEdge, -1, false, 0, 0, 0},
           {W::kClampToEdge, half + quarter, false, 6, 6, 0},
           // 1/256 texel is 2^13 of 2^24; half of that rounds up, less does not.
           {W::kClampToEdge, kOne / 16 + 4096, true, 0, 1, 1},
           {W::kClampToEdge, kOne / 16 + 4095, true, 0, 1, 0},
       }) {
    SCOPED_TRACE(testing::Message() << "wrap " << int(r.wrap) << " s " << r.s);
    const TexelToken t =
        b.address(texture(8, 8, spec::texture::Format::kL8, spec::texture::Layout::kLinear, r.wrap),
                  r.s, kOne / 16 + 3 * kOne / 8, r.linear);
    const std::uint32_t row = 0x1000 + 3 * 64, next = r.linear ? row + 64 : row;
    EXPECT_THAT(t.address, ElementsAre(row + r.x0, row + r.x1, next + r.x0, next + r.x1));
    EXPECT_EQ(t.control.fraction_u, r.fraction);
    EXPECT_EQ(t.control.fraction_v, 0);
  }
}

// Five texels: 6710887 x 5 is the first above 2 x 2^24, so the last bit counts.
TEST(TextureRtlAddresser, WrappingKeepsEveryBit) {
  AddresserBench b;
  auto d = texture(5, 5, spec::texture::Format::kL8, spec::texture::Layout::kLinear,
                   spec::texture::Wrap::kRepeat);
  EXPECT_EQ(b.address(d, 6710886 - 3ll * kOne, 0, false).address[0], 0x1001u);
  EXPECT_EQ(b.address(d, 6710887 + 3ll * kOne, 0, false).address[0], 0x1002u);
  d.wrap_s = spec::texture::Wrap::kMirroredRepeat;
  for (const std::int64_t direct : {6710886, 6710887}) {
    const std::uint32_t expected = direct == 6710886 ? 0x1001 : 0x1002;
    EXPECT_EQ(b.address(d, direct, 0, false).address[0], expected);
    EXPECT_EQ(b.address(d, 2ll * kOne - 1 - direct, 0, false).address[0], expected);
    EXPECT_EQ(b.address(d, -1 - direct, 0, false).address[0], expected);
  }
}

TEST(TextureRtlAddresser, LayoutsByHand) {
  AddresserBench b;
  using F = spec::texture::Format;
  using L = spec::texture::Layout;
  const auto nearest = [&](const spec::texture::Descriptor& d, int x, int y) {
    // The middle of the texel.
    const std::int64_t s = (2ll * x + 1) * kOne / (2 * d.width),
                       t = (2ll * y + 1) * kOne / (2 * d.height);
    return b.address(d, s, t, false).address[0] - 0x1000;
  };
  const auto wrap = spec::texture::Wrap::kRepeat;
  // 64 x 32 RGBA8: 16 x 8 tiles; tile (9, 5) = (1001, 101): 35 of the low three bits each, 64
  // above.
  EXPECT_EQ(nearest(texture(64, 32, F::kRgba8, L::kTiled, wrap), 37, 21), 99u * 64 + 16 + 4);
  // 32 x 64 RGBA8: 8 x 16 tiles; tile (5, 9): x = 101, y = 001: 16 + 2 + 1, 64 above.
  EXPECT_EQ(nearest(texture(32, 64, F::kRgba8, L::kTiled, wrap), 21, 37), (19u + 64) * 64 + 16 + 4);
  // 64 x 32 RGB565: tiles of 8 x 4, 8 x 8 of them; tile (4, 5): 16 + 2 + 32; inside (5, 1).
  EXPECT_EQ(nearest(texture(64, 32, F::kRgb565, L::kTiled, wrap), 37, 21), 50u * 64 + 16 + 10);
  // 64 x 32 L8: tiles of 8 x 8, 8 x 4; tile (4, 2): bits 00 and 10 interleave to 8, 16 above; (5,
  // 5).
  EXPECT_EQ(nearest(texture(64, 32, F::kL8, L::kTiled, wrap), 37, 21), 24u * 64 + 40 + 5);
  // 4096 x 4096 RGBA8: the far corner is the last texel of 2^26 bytes.
  EXPECT_EQ(nearest(texture(4096, 4096, F::kRgba8, L::kTiled, wrap), 4095, 4095), (1u << 26) - 4);
  // 5 x 3 RGBA4444, rows of 10 bytes rounded up to 64; 17 x 3 RGBA8, of 68 to 128.
  EXPECT_EQ(nearest(texture(5, 3, F::kRgba4444, L::kLinear, wrap), 3, 2), 128u + 6);
  EXPECT_EQ(nearest(texture(17, 3, F::kSrgb8A8, L::kLinear, wrap), 16, 2), 256u + 64);
  // 100 x 7 RGBA8: 25 x 2 tiles, rounded to 32 x 2; tile (24, 1): bit 1, and 12 above two bits.
  EXPECT_EQ(nearest(texture(100, 7, F::kRgba8, L::kTiled, wrap), 97, 5), (2u + 48) * 64 + 16 + 4);
}

TEST(TextureRtlAddresser, LevelsHaveTheirOwnSizeAndBase) {
  AddresserBench b;
  spec::texture::Descriptor d =
      texture(37, 5, spec::texture::Format::kRgba8, spec::texture::Layout::kLinear,
              spec::texture::Wrap::kClampToEdge);
  d.levels = 6;
  d.base[3] = 0x4000;  // 4 x 1 texels
  const TexelToken t = b.address(d, 100ll * kOne, 100ll * kOne, false, 3);
  EXPECT_EQ(t.address[0], 0x4000u + 3 * 4);
  // Addresses wrap at 2^32.
  d.base[0] = 0xFFFFFFC0;
  const TexelToken wrapped = b.address(d, 100ll * kOne, 0, false, 0);
  EXPECT_EQ(wrapped.address[0], 0xFFFFFFC0u + 36 * 4);
}

TEST(TextureRtlAddresser, BanksAndConflicts) {
  AddresserBench b;
  const auto d = [](int w, int h, spec::texture::Wrap wrap) {
    return texture(w, h, spec::texture::Format::kL8, spec::texture::Layout::kTiled, wrap);
  };
  const std::int64_t seam = 0;  // between the last and the first texel
  using W = spec::texture::Wrap;
  const TexelToken even = b.address(d(8, 8, W::kRepeat), seam, seam, true);
  EXPECT_FALSE(even.column_conflict || even.row_conflict);
  EXPECT_THAT(even.bank, ElementsAre(3, 2, 1, 0));  // (7,7) (0,7) (7,0) (0,0)
  const TexelToken odd = b.address(d(7, 8, W::kRepeat), seam, seam, true);
  EXPECT_TRUE(odd.column_conflict);
  EXPECT_FALSE(odd.row_conflict);
  EXPECT_THAT(odd.bank, ElementsAre(2, 2, 0, 0));
  const TexelToken both = b.address(d(7, 5, W::kRepeat), seam, seam, true);
  EXPECT_TRUE(both.column_conflict && both.row_conflict);
  // One texel twice is no conflict, nor is an odd size that is clamped.
  for (const auto& other : {d(1, 1, W::kRepeat), d(7, 5, W::kClampToEdge)}) {
    const TexelToken none = b.address(other, seam, seam, true);
    EXPECT_FALSE(none.column_conflict || none.row_conflict);
  }
}

TEST(TextureRtlAddresser, LatencyTwoAndOneAClock) {
  AddresserBench b;
  for (int i = 0; i < 5; ++i) b.ends.source.add({});
  b.ends.sink.hold_from = 6;
  b.ends.sink.hold_to = 9;
  b.clock.run(20);
  std::vector<Cycle> when;
  for (const auto& t : b.ends.sink.taken) when.push_back(t.cycle);
  EXPECT_THAT(when, ElementsAre(3, 4, 5, 9, 10));  // pushed in 0, taken in 1
  EXPECT_EQ(b.unit.bilinears.value(), 0u);         // their tickets are not valid
}

// ---- AddressUnit --------------------------------------------------------------------------------

TEST(TextureRtlAddressUnit, LatencyIsSevenAndWithExactTwentyTwo) {
  ClockDomain clock("clock", period());
  Store store(clock);
  FragmentProbe probe(256);
  for (const bool exact : {false, true}) {
    spec::texture::Parameters p;
    if (exact) p.footprint = spec::texture::FootprintRule::kExact;
    // Each stays to the end of the simulation, as modules must.
    auto* unit = new AddressUnit(exact ? "exact" : "half", clock, p, store.store, probe);
    auto* quads = new Link<spec::texture::Quad>(exact ? "exact_quads" : "half_quads");
    auto* texels = new Link<TexelToken>(exact ? "exact_texels" : "half_texels");
    unit->quads_in(*quads);
    unit->texels_out(*texels);
    quads->push(0, {});
    if (!exact) continue;
    clock.run(1);
    const Cycle taken = 1;
    const auto* half = dynamic_cast<Link<TexelToken>*>(sc_core::sc_find_object("half_texels"));
    EXPECT_EQ(ready_at(clock, *half), taken + 7);
    EXPECT_EQ(ready_at(clock, *texels), taken + 22);
  }
}

}  // namespace
}  // namespace deburr::tb::texture_rtl
