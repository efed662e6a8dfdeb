// SPDX-License-Identifier: MIT
// Block by block: what comes out of each unit of the texture pipeline is what the golden model's
// function says for what went in. Values only; clocks are the business of texture_rtl_*_test.
//
// Where two implementations of one rule can be compared without a clock the inputs are exhaustive
// or cover every combination of leading one, mantissa and kind of low bits. Units are fed through
// links, corners first, then at random. Every block is also run with one bit of one token wrong:
// the comparison must notice.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "golden/texture/filter.h"
#include "golden/texture/footprint.h"
#include "golden/texture/level_of_detail.h"
#include "golden/texture/sampling.h"
#include "rtl_model/texture/derivative_unit.h"
#include "rtl_model/texture/filter_pipeline.h"
#include "rtl_model/texture/footprint_unit.h"
#include "rtl_model/texture/level_unit.h"
#include "rtl_model/texture/log2_unit.h"
#include "rtl_model/texture/sample_walker.h"
#include "rtl_model/texture/texel_addresser.h"
#include "tb/harness/driver.h"
#include "tb/harness/random.h"
#include "tb/system/texture_random.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb {
namespace {

namespace gold = golden::texture;
namespace hw = rtl::texture;
using texture_rtl::period;
using texture_rtl::Store;
using texture_rtl::write_descriptor;

struct Verdict {
  std::uint64_t compared = 0, mismatches = 0, first = 0;  // first: number of the first wrong answer
};

void expect_equal(const Verdict& v, std::uint64_t at_least) {
  EXPECT_EQ(v.mismatches, 0u) << "the first at answer " << v.first;
  EXPECT_GE(v.compared, at_least);
}
// The planted fault touches one token, so it may spoil no more answers than that token gives.
void expect_noticed(const Verdict& v, std::uint64_t answers_a_token = 1) {
  EXPECT_GE(v.mismatches, 1u);
  EXPECT_LE(v.mismatches, answers_a_token);
}

// One unit between a driver and a sink; the unit's ports are bound to `in` and `out`.
template <class From, class To>
class Pair {
 public:
  rtl::ClockDomain clock{"clock", period()};
  rtl::Link<From> in{"in"};
  rtl::Link<To> out{"out"};

  Pair() {
    driver_.beats_out(in);
    sink_.beats_in(out);
    sink_.keep(false);
  }
  // Everything back to the start; descriptors are gone.
  void reset() {
    clock.set_reset_n(false);
    clock.run(2);
    clock.set_reset_n(true);
  }
  // Sends `tokens` tokens and judges `answers` answers, once after a reset.
  void run(std::uint64_t tokens, const std::function<From(std::uint64_t)>& token,
           std::uint64_t answers, const std::function<bool(std::uint64_t, const To&)>& right) {
    std::uint64_t answer = 0;
    driver_.send([&](std::uint64_t i, From& beat) {
      if (i == tokens) return false;
      beat = token(i);
      return true;
    });
    sink_.on_beat = [&](rtl::Cycle, const To& got) {
      if (!right(answer, got) && verdict.mismatches++ == 0) verdict.first = answer;
      ++answer;
      ++verdict.compared;
    };
    const bool finished =
        clock.run_until([&] { return answer >= answers; }, 100 * (tokens + answers) + 1000);
    EXPECT_TRUE(finished) << answer << " of " << answers << " answers came";
    clock.run(50);  // none too many
    EXPECT_EQ(answer, answers);
  }
  Verdict verdict;

 private:
  Driver<From> driver_{"driver", clock};
  Sink<To> sink_{"sink", clock};
};

constexpr hw::Ticket kTicket = {7, 1, true, true, 0};
constexpr std::uint64_t kFaultyToken = 1000;

// ---- Log2Unit -----------------------------------------------------------------------------------

class Log2Equivalence : public testing::TestWithParam<int> {};

TEST_P(Log2Equivalence, EveryLeadingOneEveryMantissa) {
  const auto rule = static_cast<spec::texture::Log2Rule>(GetParam());
  Verdict v;
  const auto compare = [&](std::uint32_t d) {
    ++v.compared;
    if (hw::Log2Unit::log2(rule, d) != gold::log2_fixed(rule, d) && v.mismatches++ == 0)
      v.first = d;
  };
  for (std::uint32_t d = 0; d < 1u << 21; ++d) compare(d);  // below it everything
  Random random(1);
  for (int p = 12; p < 32; ++p) {
    const std::uint32_t below = (1u << (p - 12)) - 1;  // bits that are cut off
    for (std::uint32_t y = 0; y < 4096; ++y) {
      const std::uint32_t d = (4096u | y) << (p - 12);
      for (const std::uint32_t low : {0u, 1u & below, below, below >> 1, below ^ (below >> 1),
                                      static_cast<std::uint32_t>(random.next()) & below}) {
        compare(d | low);
      }
    }
  }
  expect_equal(v, 2'000'000);
}

INSTANTIATE_TEST_SUITE_P(Texture, Log2Equivalence, testing::Range(0, 4), [](const auto& p) {
  return std::string(spec::texture::kLog2Names[static_cast<std::size_t>(p.param)]);
});

// No rule passes for another.
TEST(Log2Equivalence, TellsRulesApart) {
  for (std::size_t a = 0; a < spec::texture::kLog2Names.size(); ++a) {
    for (std::size_t b = 0; b < spec::texture::kLog2Names.size(); ++b) {
      std::uint64_t different = 0;
      for (std::uint32_t d = 0; d < 1u << 16; ++d) {
        different += hw::Log2Unit::log2(static_cast<spec::texture::Log2Rule>(a), d) !=
                     gold::log2_fixed(static_cast<spec::texture::Log2Rule>(b), d);
      }
      EXPECT_EQ(different == 0, a == b)
          << spec::texture::kLog2Names[a] << " " << spec::texture::kLog2Names[b];
    }
  }
}

// ---- FootprintUnit ------------------------------------------------------------------------------

constexpr std::uint32_t kLargestSide = 0x7FFFFFFF;  // U15.16

std::vector<std::uint32_t> side_corners() {
  std::vector<std::uint32_t> all = {0, kLargestSide, kLargestSide - 1};
  for (int bit = 0; bit < 31; ++bit)
    for (const int offset : {-1, 0, 1})
      all.push_back(((1u << bit) + static_cast<std::uint32_t>(offset)) & kLargestSide);
  return all;
}

class FootprintEquivalence : public testing::TestWithParam<int> {};

// The combinational part; `exact` has none and is only fed through the pipeline below.
TEST_P(FootprintEquivalence, SideIsTheRule) {
  const auto rule = static_cast<spec::texture::FootprintRule>(GetParam());
  if (rule == spec::texture::FootprintRule::kExact) return;
  Verdict v;
  const auto compare = [&](std::uint32_t s, std::uint32_t t) {
    ++v.compared;
    if (hw::FootprintUnit::side(rule, s, t) != gold::footprint_side(rule, s, t)) ++v.mismatches;
  };
  for (std::uint32_t s = 0; s < 1024; ++s)
    for (std::uint32_t t = 0; t < 1024; ++t) compare(s, t);
  const std::vector<std::uint32_t> corners = side_corners();
  for (const std::uint32_t s : corners)
    for (const std::uint32_t t : corners) compare(s, t);
  Random random(2);
  for (int i = 0; i < 500'000; ++i) {
    const std::uint64_t bits = random.next();
    compare(static_cast<std::uint32_t>(bits) & kLargestSide,
            static_cast<std::uint32_t>(bits >> 32) & kLargestSide >> random.below(31));
  }
  expect_equal(v, 1'500'000);
}

Verdict compare_footprint(spec::texture::FootprintRule rule, bool fault) {
  Pair<hw::DerivativeToken, hw::FootprintToken> bench;
  hw::FootprintUnit unit("unit", bench.clock, rule);
  unit.derivatives_in(bench.in);
  unit.footprints_out(bench.out);

  std::vector<hw::DerivativeToken> tokens;
  Random random(3);
  const auto add = [&](std::uint32_t s_x, std::uint32_t t_x, std::uint32_t s_y, std::uint32_t t_y) {
    const auto i = static_cast<std::int64_t>(tokens.size());
    tokens.push_back({kTicket, 1, 2, i, i + 1, -i, -i - 1, s_x, t_x, s_y, t_y});
  };
  const std::vector<std::uint32_t> corners = side_corners();
  for (const std::uint32_t s : corners)
    for (const std::uint32_t t : corners) {
      add(s, t, t, s);  // equal sides: the row is the major axis
      add(s, t, corners[random.below(static_cast<std::uint32_t>(corners.size()))], s);
    }
  for (std::uint32_t s = 0; s < 128; ++s)
    for (std::uint32_t t = 0; t < 128; ++t) add(s, t, t / 2, 2 * s);
  for (std::uint32_t n = 2; n < 40'000; n += 3) {
    // sqrt(s^2 + 0) = s: next to a perfect square in the sum of both.
    const std::uint32_t s = n * (kLargestSide / 40'000);
    add(s, 0, s, 1);
  }
  for (int i = 0; i < 60'000; ++i) {
    const auto any = [&] {
      return static_cast<std::uint32_t>(random.next()) & kLargestSide >> random.below(31);
    };
    const std::uint32_t s_x = any(), t_x = any(), s_y = any();
    add(s_x, t_x, s_y, any());
  }

  bench.run(
      tokens.size(),
      [&](std::uint64_t i) {
        hw::DerivativeToken token = tokens[i];
        if (fault && i == kFaultyToken) token.size_s_x ^= 1u << 20;
        return token;
      },
      tokens.size(),
      [&](std::uint64_t i, const hw::FootprintToken& got) {
        const hw::DerivativeToken& in = tokens[i];
        const gold::Footprint f =
            gold::footprint(rule, in.size_s_x, in.size_t_x, in.size_s_y, in.size_t_y);
        return got.d_max == f.d_max && got.d_min == f.d_min &&
               got.axis_s == (f.major_is_x ? in.s_x : in.s_y) &&
               got.axis_t == (f.major_is_x ? in.t_x : in.t_y) && got.s == in.s && got.t == in.t;
      });
  return bench.verdict;
}

TEST_P(FootprintEquivalence, UnitIsTheFunction) {
  expect_equal(compare_footprint(static_cast<spec::texture::FootprintRule>(GetParam()), false),
               100'000);
}
TEST_P(FootprintEquivalence, NoticesAWrongBit) {
  expect_noticed(compare_footprint(static_cast<spec::texture::FootprintRule>(GetParam()), true));
}

INSTANTIATE_TEST_SUITE_P(Texture, FootprintEquivalence, testing::Range(0, 5), [](const auto& p) {
  return std::string(spec::texture::kFootprintNames[static_cast<std::size_t>(p.param)]);
});

// ---- DerivativeUnit -----------------------------------------------------------------------------

constexpr std::uint32_t kMemoryBytes = 1u << 20;

// Writes 16 descriptors; the golden functions are given the same.
using Descriptors = std::array<spec::texture::Descriptor, spec::texture::kMaxTextures>;
void write(Store& store, const Descriptors& descriptors) {
  for (std::uint32_t h = 0; h < descriptors.size(); ++h)
    write_descriptor(store.bus, h, descriptors[h]);
}

Verdict compare_derivative(bool fault) {
  Pair<spec::texture::Quad, hw::DerivativeToken> bench;
  Store store(bench.clock);
  hw::FragmentProbe probe(64);
  hw::DerivativeUnit unit("unit", bench.clock, store.store, probe);
  unit.quads_in(bench.in);
  unit.derivatives_out(bench.out);
  Random random(4);
  for (int batch = 0; batch < 8; ++batch) {
    Descriptors d;
    for (auto& one : d) one = random_texture(random, kMemoryBytes);
    bench.reset();
    write(store, d);
    struct Lane {
      std::size_t quad, lane;
      bool last;
    };
    std::vector<spec::texture::Quad> quads;
    std::vector<Lane> lanes;
    std::uint64_t saturated = 0, clamped = 0;
    for (std::uint32_t tag = 0; tag < 4000; ++tag) {
      quads.push_back(random_quad(random, tag, static_cast<std::uint8_t>(random.below(16))));
      for (std::size_t lane = 0; lane < 4; ++lane)
        if (quads.back().coverage >> lane & 1) {
          lanes.push_back({tag, lane, quads.back().coverage >> (lane + 1) == 0});
          clamped += quads.back().clamped >> lane & 1;
        }
    }
    bench.run(
        quads.size(),
        [&](std::uint64_t i) {
          spec::texture::Quad q = quads[i];
          if (fault && batch == 0 && i == kFaultyToken) {
            q.coverage = quads[i].coverage;
            q.tag ^= 1;
          }
          return q;
        },
        lanes.size(),
        [&](std::uint64_t i, const hw::DerivativeToken& got) {
          probe.left(bench.clock.cycle());
          const Lane& at = lanes[i];
          const spec::texture::Quad& q = quads[at.quad];
          const spec::texture::Descriptor& t = d[q.texture];
          const std::size_t row = at.lane & 2, column = at.lane & 1;
          const auto minus = [](std::int32_t a, std::int32_t b) { return std::int64_t{a} - b; };
          const std::int64_t s_x = minus(q.s[row + 1], q.s[row]),
                             t_x = minus(q.t[row + 1], q.t[row]),
                             s_y = minus(q.s[column + 2], q.s[column]),
                             t_y = minus(q.t[column + 2], q.t[column]);
          const gold::Derivative size_s_x = gold::derivative_in_texels(s_x, t.width),
                                 size_t_x = gold::derivative_in_texels(t_x, t.height),
                                 size_s_y = gold::derivative_in_texels(s_y, t.width),
                                 size_t_y = gold::derivative_in_texels(t_y, t.height);
          saturated +=
              size_s_x.saturated || size_t_x.saturated || size_s_y.saturated || size_t_y.saturated;
          return got.ticket.tag == q.tag && got.ticket.lane == at.lane &&
                 got.ticket.last == at.last && got.ticket.valid &&
                 got.ticket.texture == q.texture && got.s == q.s[at.lane] &&
                 got.t == q.t[at.lane] && got.s_x == s_x && got.t_x == t_x && got.s_y == s_y &&
                 got.t_y == t_y && got.size_s_x == size_s_x.texels &&
                 got.size_t_x == size_t_x.texels && got.size_s_y == size_s_y.texels &&
                 got.size_t_y == size_t_y.texels;
        });
    EXPECT_EQ(unit.saturated.value(), saturated);
    EXPECT_EQ(unit.clamped.value(), clamped);
    EXPECT_GT(saturated, 0u);
  }
  return bench.verdict;
}

TEST(DerivativeEquivalence, UnitIsTheFunction) { expect_equal(compare_derivative(false), 80'000); }
TEST(DerivativeEquivalence, NoticesAWrongBit) { expect_noticed(compare_derivative(true), 4); }

// ---- LevelUnit ----------------------------------------------------------------------------------

// Logarithms next to every threshold of a level: whole numbers, halves, rounding of the fraction.
std::vector<std::int32_t> log_corners() {
  std::vector<std::int32_t> all;
  for (std::int32_t whole = -16; whole <= 16; ++whole)
    for (const std::int32_t offset : {-2049, -2048, -2047, -9, -8, -7, -1, 0, 1, 7, 8, 9})
      all.push_back(whole * 4096 + offset);
  return all;
}

// Batch by batch: all modes, magnification filters, numbers of levels and N_max in turn, then
// descriptors at random with any bias and any clamps.
spec::texture::Descriptor level_texture(Random& random, int number) {
  constexpr std::array<std::uint8_t, 4> kLevels = {1, 2, 7, 13};
  constexpr int kSystematic = 6 * 2 * 4 * 5;
  spec::texture::Descriptor d = random_texture(random, kMemoryBytes);
  if (number < kSystematic) {
    d = {};
    d.width = d.height = 4096;
    d.min_filter = static_cast<spec::texture::MinFilter>(number % 6);
    d.mag_filter = static_cast<spec::texture::MagFilter>(number / 6 % 2);
    d.levels = kLevels[static_cast<std::size_t>(number / 12 % 4)];
    d.max_anisotropy_log2 = static_cast<std::uint8_t>(number / 48);
  } else if (random.chance(300)) {
    d.lod_bias = any_of(random, std::array<std::int16_t, 6>{-32768, 32767, -1, 1, -256, 4096});
    d.min_lod = any_of(random, std::array<std::uint16_t, 4>{0, 1, 4096, 65535});
    d.max_lod = any_of(random, std::array<std::uint16_t, 4>{0, 1, 3072, 65535});
  }
  return d;
}

Verdict compare_level(spec::texture::CountRule count, spec::texture::CountCap cap, bool fault) {
  Pair<hw::Log2Token, hw::LevelToken> bench;
  Store store(bench.clock);
  hw::LevelUnit unit("unit", bench.clock, store.store, count, cap);
  unit.logs_in(bench.in);
  unit.levels_out(bench.out);
  spec::texture::Parameters rules;
  rules.count = count;
  rules.count_cap = cap;

  const std::vector<std::int32_t> corners = log_corners();
  Random random(5);
  int number = 0;
  constexpr int kBatches = 35;
  for (int batch = 0; batch < kBatches; ++batch) {
    Descriptors d;
    for (auto& one : d) one = level_texture(random, number++);
    bench.reset();
    write(store, d);
    std::vector<hw::Log2Token> tokens;
    for (std::uint8_t h = 0; h < d.size(); ++h) {
      hw::Ticket ticket = kTicket;
      ticket.texture = h;
      for (const std::int32_t lb_max : corners) {
        const std::int32_t near = lb_max - static_cast<std::int32_t>(random.below(5 * 4096));
        for (const std::int32_t lb_min :
             {lb_max, near, any_of(random, std::array{-65536, 0, 4096}),
              lb_max - 4096 * static_cast<std::int32_t>(random.below(6))})
          tokens.push_back({ticket, 1, 2, 3, 4, lb_max, lb_min});
      }
    }
    std::uint64_t magnified = 0, two_levels = 0;
    bench.run(
        tokens.size(),
        [&](std::uint64_t i) {
          hw::Log2Token token = tokens[i];
          if (fault && batch == 0 && i == kFaultyToken) token.ticket.tag ^= 1u << 31;
          return token;
        },
        tokens.size(),
        [&](std::uint64_t i, const hw::LevelToken& got) {
          const hw::Log2Token& in = tokens[i];
          const gold::LevelOfDetail want =
              gold::select_level(rules, d[in.ticket.texture], in.lb_max, in.lb_min);
          magnified += want.magnified;
          two_levels += want.fraction != 0;
          return got.count_log2 == want.lb_n && got.level == want.level &&
                 got.fraction == want.fraction && got.linear == want.linear && got.s == in.s &&
                 got.t == in.t && got.axis_s == in.axis_s && got.axis_t == in.axis_t &&
                 got.ticket.tag == in.ticket.tag && got.ticket.texture == in.ticket.texture;
        });
    EXPECT_EQ(unit.magnified.value(), magnified);
    EXPECT_EQ(unit.two_levels.value(), two_levels);
  }
  return bench.verdict;
}

class LevelEquivalence : public testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(LevelEquivalence, UnitIsTheFunction) {
  const auto [count, cap] = GetParam();
  expect_equal(compare_level(static_cast<spec::texture::CountRule>(count),
                             static_cast<spec::texture::CountCap>(cap), false),
               800'000);
}

INSTANTIATE_TEST_SUITE_P(Texture, LevelEquivalence,
                         testing::Combine(testing::Range(0, 2), testing::Range(0, 2)),
                         [](const auto& p) {
                           const auto i = [](int v) { return static_cast<std::size_t>(v); };
                           return fmt::format(
                               "{}_{}", spec::texture::kCountNames[i(std::get<0>(p.param))],
                               spec::texture::kCountCapNames[i(std::get<1>(p.param))]);
                         });

TEST(LevelEquivalence, NoticesAWrongBit) {
  expect_noticed(
      compare_level(spec::texture::CountRule::kFloor, spec::texture::CountCap::kNone, true));
}

// ---- SampleWalker -------------------------------------------------------------------------------

constexpr std::array<std::int64_t, 7> kAxisCorners = {
    0, 1, -1, (std::int64_t{1} << 32) - 1, 1 - (std::int64_t{1} << 32), 1 << 20, -(1 << 23)};

Verdict compare_walker(spec::texture::Kernel kernel, std::int32_t spread, bool fault) {
  Pair<hw::LevelToken, hw::SampleToken> bench;
  hw::SampleWalker unit("unit", bench.clock, kernel, spread);
  unit.levels_in(bench.in);
  unit.samples_out(bench.out);

  std::vector<hw::LevelToken> tokens;
  struct Request {
    std::size_t token;
    int sample;
    bool second;
  };
  std::vector<Request> requests;
  Random random(6);
  for (std::size_t i = 0; i < 30'000; ++i) {
    const auto axis = [&] {
      if (random.chance(300)) return any_of(random, kAxisCorners);
      return static_cast<std::int64_t>(random.next()) >> (31 + random.below(30));
    };
    const std::int64_t axis_s = axis(), axis_t = axis();
    hw::LevelToken t = {kTicket,
                        any_of(random, kCoordinateCorners),
                        static_cast<std::int32_t>(random.next()),
                        axis_s,
                        axis_t,
                        static_cast<std::uint8_t>(random.below(5)),
                        static_cast<std::uint8_t>(random.below(12)),
                        static_cast<std::uint8_t>(random.chance(300) ? 0 : random.below(256)),
                        random.chance(500)};
    t.ticket.tag = static_cast<std::uint32_t>(i);
    for (int sample = 0; sample < 1 << t.count_log2; ++sample) {
      requests.push_back({i, sample, false});
      if (t.fraction != 0) requests.push_back({i, sample, true});
    }
    tokens.push_back(t);
  }
  bench.run(
      tokens.size(),
      [&](std::uint64_t i) {
        hw::LevelToken token = tokens[i];
        if (fault && i == kFaultyToken) token.s ^= 1 << 10;
        return token;
      },
      requests.size(),
      [&](std::uint64_t i, const hw::SampleToken& got) {
        const Request& r = requests[i];
        const hw::LevelToken& t = tokens[r.token];
        const int n = t.count_log2;
        const bool last_of_sample = r.second || t.fraction == 0;
        return got.s == t.s + gold::sample_offset(r.sample, n, spread, t.axis_s) &&
               got.t == t.t + gold::sample_offset(r.sample, n, spread, t.axis_t) &&
               got.kernel_weight == gold::sample_weight(kernel, r.sample, n) &&
               got.sum_log2 == gold::kernel_log2_sum(kernel, n) &&
               got.level_weight == (r.second ? t.fraction : 256 - t.fraction) &&
               got.level == t.level + (r.second ? 1 : 0) && got.linear == t.linear &&
               got.last_of_sample == last_of_sample &&
               got.last_of_fragment == (last_of_sample && r.sample == (1 << n) - 1) &&
               got.ticket.tag == t.ticket.tag;
      });
  return bench.verdict;
}

class WalkerEquivalence : public testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(WalkerEquivalence, UnitIsTheFunction) {
  const auto [kernel, spread] = GetParam();
  expect_equal(compare_walker(static_cast<spec::texture::Kernel>(kernel), spread, false), 200'000);
}

INSTANTIATE_TEST_SUITE_P(
    Texture, WalkerEquivalence,
    testing::Combine(testing::Range(0, 2), testing::Values(0, 1, 64, 102, 128)), [](const auto& p) {
      const auto k = static_cast<std::size_t>(std::get<0>(p.param));
      return fmt::format("{}_{}", spec::texture::kKernelNames[k], std::get<1>(p.param));
    });

TEST(WalkerEquivalence, NoticesAWrongBit) {
  expect_noticed(compare_walker(spec::texture::Kernel::kBox, 64, true), 32);
}

// ---- TexelAddresser -----------------------------------------------------------------------------

Verdict compare_addresser(bool fault) {
  Pair<hw::SampleToken, hw::TexelToken> bench;
  Store store(bench.clock);
  hw::TexelAddresser unit("unit", bench.clock, store.store);
  unit.samples_in(bench.in);
  unit.texels_out(bench.out);
  Random random(7);
  constexpr std::int64_t kOne = spec::texture::kCoordinateOne;
  constexpr std::int64_t kFurthest = (std::int64_t{1} << 33) - 1;  // S9.24
  for (int batch = 0; batch < 40; ++batch) {
    Descriptors d;
    for (auto& one : d) one = random_texture(random, kMemoryBytes);
    bench.reset();
    write(store, d);
    std::vector<hw::SampleToken> tokens;
    for (std::uint8_t h = 0; h < d.size(); ++h) {
      for (int i = 0; i < 1500; ++i) {
        const auto level = static_cast<std::uint8_t>(random.below(d[h].levels));
        const auto position = [&](std::uint16_t size) -> std::int64_t {
          switch (random.below(4)) {
            case 0:  // by a border of a texel, where the fraction and the pair of texels change
              return any_of(random,
                            std::array<std::int64_t, 5>{-2 * kOne, -kOne, 0, kOne, 3 * kOne}) +
                     kOne * random.below(2u * size + 1) / (2 * gold::level_size(size, level)) +
                     any_of(random, std::array<std::int64_t, 5>{-32768, -1, 0, 1, 32767});
            case 1:
              return any_of(random, std::array<std::int64_t, 4>{kFurthest, -kFurthest - 1, -1, 0});
            case 2:
              return static_cast<std::int64_t>(random.next()) >> 30;
            default:
              return static_cast<std::int64_t>(random.below(1u << 25)) - kOne / 2;
          }
        };
        const std::int64_t s = position(d[h].width), t = position(d[h].height);
        hw::Ticket ticket = kTicket;
        ticket.texture = h;
        tokens.push_back({ticket, s, t, static_cast<std::uint16_t>(random.below(257)),
                          static_cast<std::uint8_t>(random.below(32)),
                          static_cast<std::uint8_t>(random.below(8)), level, random.chance(700),
                          random.chance(500), random.chance(200)});
      }
    }
    bench.run(
        tokens.size(),
        [&](std::uint64_t i) {
          hw::SampleToken token = tokens[i];
          if (fault && batch == 0 && i == kFaultyToken) token.kernel_weight ^= 1;
          return token;
        },
        tokens.size(),
        [&](std::uint64_t i, const hw::TexelToken& got) {
          const hw::SampleToken& in = tokens[i];
          const spec::texture::Descriptor& t = d[in.ticket.texture];
          const auto place = in.linear ? gold::linear_position : gold::nearest_position;
          const gold::TexelPosition x = place(t.wrap_s, in.s, gold::level_size(t.width, in.level)),
                                    y = place(t.wrap_t, in.t, gold::level_size(t.height, in.level));
          const auto address = [&](std::int32_t column, std::int32_t row) {
            return gold::texel_address(t, in.level, column, row);
          };
          const hw::FilterControl& c = got.control;
          return got.address == std::array{address(x.i0, y.i0), address(x.i1, y.i0),
                                           address(x.i0, y.i1), address(x.i1, y.i1)} &&
                 c.fraction_u == x.fraction && c.fraction_v == y.fraction &&
                 c.level_weight == in.level_weight && c.kernel_weight == in.kernel_weight &&
                 c.sum_log2 == in.sum_log2 && c.format == static_cast<std::uint8_t>(t.format) &&
                 c.last_of_sample == in.last_of_sample && c.last_of_fragment == in.last_of_fragment;
        });
  }
  return bench.verdict;
}

TEST(AddresserEquivalence, UnitIsTheFunction) { expect_equal(compare_addresser(false), 900'000); }
TEST(AddresserEquivalence, NoticesAWrongBit) { expect_noticed(compare_addresser(true)); }

// ---- FilterPipeline -----------------------------------------------------------------------------

// Requests and the colours that the golden arithmetic makes of them.
struct FilterWork {
  std::vector<hw::TexelQuadToken> tokens;
  std::vector<spec::texture::Colour> colours;

  using Requests = std::vector<std::array<std::uint32_t, 4>>;  // texels as stored
  // N = 2^lb_n samples of one or, with a level fraction, two requests each.
  void fragment(spec::texture::Format format, spec::texture::Kernel kernel, int lb_n,
                std::uint32_t fraction, const std::function<hw::TexelQuadToken()>& request) {
    spec::texture::Colour colour;
    colour.tag = static_cast<std::uint32_t>(colours.size());
    colour.lane = static_cast<std::uint8_t>(colour.tag & 3);
    colour.last = (colour.tag & 5) != 0;
    const int lb_sum = gold::kernel_log2_sum(kernel, lb_n);
    std::array<std::uint32_t, 4> sum{};
    for (int sample = 0; sample < 1 << lb_n; ++sample) {
      const std::uint32_t weight = gold::sample_weight(kernel, sample, lb_n);
      std::array<std::array<std::uint32_t, 4>, 2> level{};
      for (std::uint32_t k = 0; k < (fraction ? 2u : 1u); ++k) {
        hw::TexelQuadToken token = request();
        const bool last_of_sample = k == 1 || fraction == 0;
        token.ticket = {colour.tag, colour.lane, colour.last, true, 0};
        token.control.level_weight = static_cast<std::uint16_t>(k ? fraction : 256 - fraction);
        token.control.kernel_weight = static_cast<std::uint8_t>(weight);
        token.control.sum_log2 = static_cast<std::uint8_t>(lb_sum);
        token.control.format = static_cast<std::uint8_t>(format);
        token.control.last_of_sample = last_of_sample;
        token.control.last_of_fragment = last_of_sample && sample == (1 << lb_n) - 1;
        const std::uint32_t u = token.control.fraction_u, v = token.control.fraction_v;
        std::array<gold::Texel, 4> texel;
        for (std::size_t i = 0; i < 4; ++i) texel[i] = gold::decode_texel(format, token.texel[i]);
        for (std::size_t c = 0; c < 4; ++c)
          level[k][c] = gold::vertical_lerp(gold::horizontal_lerp(texel[0][c], texel[1][c], u),
                                            gold::horizontal_lerp(texel[2][c], texel[3][c], u), v);
        tokens.push_back(token);
      }
      for (std::size_t c = 0; c < 4; ++c)
        sum[c] += weight *
                  (fraction ? gold::level_lerp(level[0][c], level[1][c], fraction) : level[0][c]);
    }
    for (std::size_t c = 0; c < 4; ++c) colour.rgba[c] = gold::round_result(sum[c], lb_sum);
    colours.push_back(colour);
  }
};

FilterWork filter_work() {
  FilterWork work;
  // Every value of every format, unfiltered.
  const auto plain = [&](spec::texture::Format format, std::uint32_t word) {
    work.fragment(format, spec::texture::Kernel::kBox, 0, 0, [word] {
      hw::TexelQuadToken t{};
      t.texel.fill(word);
      return t;
    });
  };
  for (std::uint32_t word = 0; word < 65536; ++word) {
    plain(spec::texture::Format::kRgb565, word);
    plain(spec::texture::Format::kRgba4444, word);
  }
  for (const auto format :
       {spec::texture::Format::kRgba8, spec::texture::Format::kSrgb8A8, spec::texture::Format::kL8})
    for (std::uint32_t value = 0; value < 256; ++value)
      plain(format, value * (format == spec::texture::Format::kL8 ? 1u : 0x01010101u));
  // Every combination of fractions at full contrast, both signs.
  for (std::uint32_t u = 0; u < 256; ++u)
    for (std::uint32_t v = 0; v < 256; v += 3)
      work.fragment(spec::texture::Format::kRgba8, spec::texture::Kernel::kBox, 0, 0, [u, v] {
        hw::TexelQuadToken t{};
        t.texel = {0xFF00FF01, 0x00FF02FF, 0x7F80FF00, 0xFFFF00FF};
        t.control.fraction_u = static_cast<std::uint8_t>(u);
        t.control.fraction_v = static_cast<std::uint8_t>(v);
        return t;
      });
  // Whole fragments at random, extremes often.
  Random random(8);
  constexpr std::array<std::uint32_t, 5> kExtremes = {0, 0xFFFFFFFF, 0x00FF00FF, 0x01010101,
                                                      0x80808080};
  constexpr std::array<std::uint8_t, 5> kFractions = {0, 1, 128, 254, 255};
  for (int i = 0; i < 12'000; ++i) {
    const auto format = any_code<spec::texture::Format>(random, spec::texture::kFormatNames);
    const std::uint32_t mask =
        spec::texture::kFormatBytes[static_cast<std::size_t>(format)] == 4   ? 0xFFFFFFFF
        : spec::texture::kFormatBytes[static_cast<std::size_t>(format)] == 2 ? 0xFFFF
                                                                             : 0xFF;
    const bool extreme = random.chance(400);
    const auto fraction = [&] {
      return extreme ? any_of(random, kFractions) : static_cast<std::uint8_t>(random.below(256));
    };
    const int lb_n = static_cast<int>(random.below(5));
    const auto kernel = any_code<spec::texture::Kernel>(random, spec::texture::kKernelNames);
    work.fragment(format, kernel, lb_n, fraction(), [&] {
      hw::TexelQuadToken t{};
      for (std::uint32_t& texel : t.texel)
        texel = mask &
                (extreme ? any_of(random, kExtremes) : static_cast<std::uint32_t>(random.next()));
      t.control.fraction_u = fraction();
      t.control.fraction_v = fraction();
      return t;
    });
  }
  return work;
}

Verdict compare_filter(bool fault) {
  const FilterWork work = filter_work();
  Pair<hw::TexelQuadToken, spec::texture::Colour> bench;
  hw::FragmentProbe probe(64);
  hw::FilterPipeline unit("unit", bench.clock, probe);
  unit.texels_in(bench.in);
  unit.colours_out(bench.out);
  bench.run(
      work.tokens.size(),
      [&](std::uint64_t i) {
        hw::TexelQuadToken token = work.tokens[i];
        if (token.control.last_of_fragment) probe.entered(bench.clock.cycle());
        if (fault && i == kFaultyToken) token.texel[0] ^= 0x8000;
        return token;
      },
      work.colours.size(),
      [&](std::uint64_t i, const spec::texture::Colour& got) { return got == work.colours[i]; });
  return bench.verdict;
}

TEST(FilterEquivalence, UnitIsTheArithmetic) { expect_equal(compare_filter(false), 160'000); }
TEST(FilterEquivalence, NoticesAWrongBit) { expect_noticed(compare_filter(true)); }

}  // namespace
}  // namespace deburr::tb
