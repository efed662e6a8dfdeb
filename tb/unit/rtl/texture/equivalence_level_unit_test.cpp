// SPDX-License-Identifier: MIT
// The LevelUnit against the functions of the golden model.
#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "golden/texture/level_of_detail.h"
#include "rtl_model/texture/level_unit.h"
#include "tb/unit/rtl/texture/equivalence.h"

namespace deburr::tb::equivalence_level_unit_test {
namespace {

namespace gold = golden::texture;

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
  spec::texture::Descriptor d = stimuli::random_texture(random, kMemoryBytes);
  if (number < kSystematic) {
    d = {};
    d.width = d.height = 4096;
    d.min_filter = static_cast<spec::texture::MinFilter>(number % 6);
    d.mag_filter = static_cast<spec::texture::MagFilter>(number / 6 % 2);
    d.levels = kLevels[static_cast<std::size_t>(number / 12 % 4)];
    d.max_anisotropy_log2 = static_cast<std::uint8_t>(number / 48);
  } else if (random.chance(300)) {
    d.lod_bias =
        stimuli::any_of(random, std::array<std::int16_t, 6>{-32768, 32767, -1, 1, -256, 4096});
    d.min_lod = stimuli::any_of(random, std::array<std::uint16_t, 5>{0, 1, 4096, 32768, 65535});
    d.max_lod = stimuli::any_of(random, std::array<std::uint16_t, 5>{0, 1, 3072, 32768, 65535});
  }
  return d;
}

Verdict compare_level(spec::texture::Axes axes, spec::texture::CountRule count,
                      spec::texture::CountCap cap, bool fault) {
  Pair<hw::Log2Token, hw::LevelToken> bench;
  Store store(bench.clock);
  hw::LevelUnit unit("unit", bench.clock, store.descriptors.for_levels, axes, count, cap);
  unit.logs_in(bench.in);
  unit.levels_out(bench.out);
  spec::texture::Parameters rules;
  rules.axes = axes;
  rules.count = count;
  rules.count_cap = cap;

  const bool with_area = axes != spec::texture::Axes::kTwo;  // lb A is the sum of both
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
    for (std::size_t h = 0; h < d.size(); ++h) {
      hw::Ticket ticket = kTicket;
      ticket.texture = static_cast<std::uint8_t>(h);
      for (const std::int32_t lb_max : corners) {
        const std::int32_t near = lb_max - static_cast<std::int32_t>(random.below(5 * 4096));
        for (const std::int32_t lb_min :
             {lb_max, near, stimuli::any_of(random, std::array{-65536, 0, 4096}),
              lb_max - 4096 * static_cast<std::int32_t>(random.below(6))})
          tokens.push_back({ticket, 1, 2, 3, 4, lb_max, with_area ? lb_max + lb_min : lb_min});
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
              gold::select_level(rules, d[in.ticket.texture], in.lb_max,
                                 with_area ? in.lb_minor - in.lb_max : in.lb_minor);
          magnified += want.magnified;
          two_levels += want.fraction != 0;
          return got.last_index + 1 == want.samples && got.level == want.level &&
                 got.fraction == want.fraction && got.linear == want.linear && got.s == in.s &&
                 got.t == in.t && got.axis_s == in.axis_s && got.axis_t == in.axis_t &&
                 got.ticket.tag == in.ticket.tag && got.ticket.texture == in.ticket.texture;
        });
    EXPECT_EQ(unit.magnified.value(), magnified);
    EXPECT_EQ(unit.two_levels.value(), two_levels);
  }
  return bench.verdict;
}

class LevelEquivalence : public testing::TestWithParam<std::tuple<int, int, int>> {};

TEST_P(LevelEquivalence, UnitIsTheFunction) {
  const auto [axes, count, cap] = GetParam();
  expect_equal(compare_level(static_cast<spec::texture::Axes>(axes),
                             static_cast<spec::texture::CountRule>(count),
                             static_cast<spec::texture::CountCap>(cap), false),
               800'000);
}

INSTANTIATE_TEST_SUITE_P(Texture, LevelEquivalence,
                         testing::Combine(testing::Values(0, 2), testing::Range(0, 3),
                                          testing::Range(0, 2)),
                         [](const auto& p) {
                           const auto i = [](int v) { return static_cast<std::size_t>(v); };
                           return fmt::format(
                               "{}_{}_{}", spec::texture::kAxesNames[i(std::get<0>(p.param))],
                               spec::texture::kCountNames[i(std::get<1>(p.param))],
                               spec::texture::kCountCapNames[i(std::get<2>(p.param))]);
                         });

TEST(LevelEquivalence, NoticesAWrongBit) {
  expect_noticed(compare_level(spec::texture::Axes::kTwo, spec::texture::CountRule::kFloor,
                               spec::texture::CountCap::kNone, true));
}

}  // namespace
}  // namespace deburr::tb::equivalence_level_unit_test
