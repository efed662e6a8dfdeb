// SPDX-License-Identifier: MIT
// The AxisUnit against the functions of the golden model.
#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <vector>

#include "golden/texture/footprint.h"
#include "rtl_model/texture/axis_unit.h"
#include "tb/unit/rtl/texture/equivalence.h"

namespace deburr::tb::equivalence_axis_unit_test {
namespace {

namespace gold = golden::texture;

Verdict compare_axis(spec::texture::Axes axes, spec::texture::FootprintRule rule, bool fault) {
  Pair<hw::DerivativeToken, hw::FootprintToken> bench;
  hw::AxisUnit unit("unit", bench.clock, axes, rule, 1);
  unit.derivatives_in(bench.in);
  unit.footprints_out(bench.out);
  std::vector<hw::DerivativeToken> tokens;
  Random random(3);
  const auto size_of = [&](std::int64_t difference, unsigned width) {
    return gold::derivative_in_texels(difference, width).texels;
  };
  const auto magnitude = [](std::int32_t v) { return static_cast<std::uint32_t>(v < 0 ? -v : v); };
  for (int i = 0; i < 120'000; ++i) {
    const auto any = [&] {
      if (random.chance(100)) {
        const std::int64_t a = stimuli::any_of(random, stimuli::kCoordinateCorners);
        return a - stimuli::any_of(random, stimuli::kCoordinateCorners);
      }
      const auto v = static_cast<std::int64_t>(random.next() >> (32 + random.below(32)));
      return random.chance(500) ? -v : v;
    };
    const unsigned width = 1 + random.below(4096),
                   height = random.chance(500) ? width : 1 + random.below(4096);
    hw::DerivativeToken t{kTicket, 1, 2, any(), any(), any(), any(), 0, 0, 0, 0};
    if (random.chance(200)) t.s_y = t.s_x;  // ties
    if (random.chance(200)) t.t_y = random.chance(500) ? t.t_x : -t.t_x;
    t.size_s_x = magnitude(size_of(t.s_x, width));
    t.size_t_x = magnitude(size_of(t.t_x, height));
    t.size_s_y = magnitude(size_of(t.s_y, width));
    t.size_t_y = magnitude(size_of(t.t_y, height));
    tokens.push_back(t);
  }
  bench.run(
      tokens.size(),
      [&](std::uint64_t i) {
        hw::DerivativeToken token = tokens[i];
        if (fault && i == kFaultyToken) token.s ^= 1 << 20;
        return token;
      },
      tokens.size(),
      [&](std::uint64_t i, const hw::FootprintToken& got) {
        const hw::DerivativeToken& in = tokens[i];
        const auto texels = [](std::uint32_t size, std::int64_t difference) {
          return difference < 0 ? -std::int64_t{size} : std::int64_t{size};
        };
        const gold::Footprint f =
            gold::footprint(axes, rule, {texels(in.size_s_x, in.s_x), texels(in.size_t_x, in.t_x)},
                            {texels(in.size_s_y, in.s_y), texels(in.size_t_y, in.t_y)});
        const gold::Step axis =
            gold::candidate_in_coordinates(axes, f.major, {in.s_x, in.t_x}, {in.s_y, in.t_y});
        return got.d_max == f.d_max && got.minor == f.area && got.axis_s == axis.s &&
               got.axis_t == axis.t && got.s == in.s && got.t == in.t;
      });
  return bench.verdict;
}

class AxisEquivalence : public testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(AxisEquivalence, UnitIsTheFunction) {
  const auto [axes, rule] = GetParam();
  expect_equal(compare_axis(static_cast<spec::texture::Axes>(axes),
                            static_cast<spec::texture::FootprintRule>(rule), false),
               120'000);
}
INSTANTIATE_TEST_SUITE_P(Texture, AxisEquivalence,
                         testing::Combine(testing::Range(1, 3), testing::Range(0, 5)),
                         [](const auto& p) {
                           const auto i = [](int v) { return static_cast<std::size_t>(v); };
                           return fmt::format(
                               "{}_{}", spec::texture::kAxesNames[i(std::get<0>(p.param))],
                               spec::texture::kFootprintNames[i(std::get<1>(p.param))]);
                         });

TEST(AxisEquivalence, NoticesAWrongBit) {
  expect_noticed(
      compare_axis(spec::texture::Axes::kEight, spec::texture::FootprintRule::kHalf, true));
}

}  // namespace
}  // namespace deburr::tb::equivalence_axis_unit_test
