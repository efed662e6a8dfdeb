// SPDX-License-Identifier: MIT
// The FootprintUnit against the functions of the golden model.
#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <vector>

#include "golden/texture/footprint.h"
#include "rtl_model/texture/footprint_unit.h"
#include "tb/unit/rtl/texture/equivalence.h"

namespace deburr::tb::equivalence_footprint_unit_test {
namespace {

namespace gold = golden::texture;

constexpr std::uint32_t kLargestSide = 0x7FFFFFFF;  // U15.16

std::vector<std::uint32_t> side_corners() {
  std::vector<std::uint32_t> all = {0, kLargestSide, kLargestSide - 1};
  for (int bit = 0; bit < 31; ++bit)
    for (const int offset : {-1, 0, 1})
      all.push_back(((1u << bit) + static_cast<std::uint32_t>(offset)) & kLargestSide);
  return all;
}

class FootprintEquivalence : public testing::TestWithParam<int> {};
// `exact` has no combinational part and is only fed through the pipeline below.
class FootprintSideEquivalence : public testing::TestWithParam<int> {};

TEST_P(FootprintSideEquivalence, SideIsTheRule) {
  const auto rule = static_cast<spec::texture::FootprintRule>(GetParam());
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
            gold::footprint(spec::texture::Axes::kTwo, rule, {in.size_s_x, in.size_t_x},
                            {in.size_s_y, in.size_t_y});
        return got.d_max == f.d_max && got.minor == f.d_min &&
               got.axis_s == (f.major == 0 ? in.s_x : in.s_y) &&
               got.axis_t == (f.major == 0 ? in.t_x : in.t_y) && got.s == in.s && got.t == in.t;
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

std::string name_of_rule(const testing::TestParamInfo<int>& info) {
  return std::string(spec::texture::kFootprintNames[static_cast<std::size_t>(info.param)]);
}

constexpr auto rule_number(spec::texture::FootprintRule rule) { return static_cast<int>(rule); }

INSTANTIATE_TEST_SUITE_P(Texture, FootprintEquivalence, testing::Range(0, 5), name_of_rule);
INSTANTIATE_TEST_SUITE_P(Texture, FootprintSideEquivalence,
                         testing::Values(rule_number(spec::texture::FootprintRule::kHalf),
                                         rule_number(spec::texture::FootprintRule::kQuarter),
                                         rule_number(spec::texture::FootprintRule::kTwoSegment),
                                         rule_number(spec::texture::FootprintRule::kMax)),
                         name_of_rule);

}  // namespace
}  // namespace deburr::tb::equivalence_footprint_unit_test
