// SPDX-License-Identifier: MIT
// Sample count, level, fraction and filter against GL's formulas in real arithmetic, over every
// level of detail, mode, count rule, N_max and clamp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "golden/ideal/lod.h"
#include "golden/texture/footprint.h"
#include "golden/texture/level_of_detail.h"
#include "spec/texture/parameters.h"
#include "spec/texture/tables.h"
#include "tb/base/random.h"

namespace deburr::level_test {
namespace {

using golden::texture::LevelOfDetail;
using golden::texture::select_level;
using spec::texture::MinFilter;

constexpr MinFilter kMinFilters[] = {MinFilter::kNearest,
                                     MinFilter::kLinear,
                                     MinFilter::kNearestMipmapNearest,
                                     MinFilter::kLinearMipmapNearest,
                                     MinFilter::kNearestMipmapLinear,
                                     MinFilter::kLinearMipmapLinear};

spec::texture::Descriptor descriptor(MinFilter filter, int levels = 11) {
  spec::texture::Descriptor d;
  d.width = d.height = static_cast<std::uint16_t>(1 << (levels - 1));
  d.levels = static_cast<std::uint8_t>(levels);
  d.min_filter = filter;
  d.mag_filter = spec::texture::MagFilter::kNearest;
  return d;
}

// The contract as GL's formulas in real arithmetic; all values are exact here.
LevelOfDetail by_formula(const spec::texture::Parameters& p, const spec::texture::Descriptor& d,
                         std::int32_t lb_max, std::int32_t lb_min) {
  LevelOfDetail r;
  r.lb_d_max = lb_max;
  r.lb_d_min = lb_min;
  r.anisotropy = std::max(0, lb_max - lb_min);
  const double big_l = r.anisotropy / 4096.0, lb_d_max = lb_max / 4096.0;
  const bool any = p.count == spec::texture::CountRule::kAny;
  double e = any                                          ? big_l
             : p.count == spec::texture::CountRule::kCeil ? std::ceil(big_l)
                                                          : std::floor(big_l);
  e = std::min(e, static_cast<double>(d.max_anisotropy_log2));
  if (p.count_cap == spec::texture::CountCap::kTexel) {
    e = std::min(e, std::max(0.0, any ? lb_d_max : std::ceil(lb_d_max)));
  }
  if (lb_d_max <= 0) e = 0;
  r.sampled = static_cast<std::int32_t>(4096 * e);
  // The ratio, rounded up to whole samples. Its logarithm is accurate to half a unit in the last
  // place, and an excess of up to 72 units is ignored.
  r.samples = 1;
  while (4096 * std::log2(r.samples) + 72.5 < r.sampled) ++r.samples;
  const double l =
      std::min(std::max(lb_d_max - e + d.lod_bias / 256.0, d.min_lod / 256.0), d.max_lod / 256.0);
  r.l = static_cast<std::int32_t>(4096 * l);
  const auto has_one_texel = [&](int level) { return std::max(d.width, d.height) < 2 << level; };
  if (l <= 0) {
    if (has_one_texel(0)) r.samples = 1;
    r.magnified = true;
    r.linear = d.mag_filter == spec::texture::MagFilter::kLinear;
    return r;
  }
  const double q = d.levels - 1;
  switch (d.min_filter) {
    case MinFilter::kLinear:
    case MinFilter::kLinearMipmapNearest:
    case MinFilter::kLinearMipmapLinear:
      r.linear = true;
      break;
    default:
      break;
  }
  if (d.min_filter == MinFilter::kNearestMipmapNearest ||
      d.min_filter == MinFilter::kLinearMipmapNearest) {
    r.level = l <= 0.5 ? 0 : static_cast<int>(std::min(std::ceil(l + 0.5) - 1, q));
  } else if (d.min_filter == MinFilter::kNearestMipmapLinear ||
             d.min_filter == MinFilter::kLinearMipmapLinear) {
    const double rounded = std::floor(256 * l + 0.5) / 256;
    r.level = static_cast<int>(std::min(std::floor(rounded), q));
    r.fraction = rounded >= q ? 0 : static_cast<std::uint32_t>(256 * (rounded - r.level));
  }
  if (has_one_texel(r.level)) r.samples = 1;
  return r;
}

using Select =
    std::function<LevelOfDetail(const spec::texture::Parameters&, const spec::texture::Descriptor&,
                                std::int32_t, std::int32_t)>;

// Whether the anisotropy is less than 2/4096 from a threshold of the sample count.
bool near_a_count(std::int32_t anisotropy) {
  const double ratio = std::exp2((anisotropy - 72) / 4096.0);
  return std::abs(anisotropy - 72 - 4096 * std::log2(std::round(ratio))) < 2;
}

// Number of differences from the formula, over every l from -3 to 14 and many combinations of
// parameters.
int differences(const Select& select) {
  int count = 0;
  spec::texture::Parameters p;
  for (const MinFilter filter : kMinFilters) {
    for (const int levels : {1, 2, 11}) {
      for (std::int32_t lb_max = -3 * 4096; lb_max <= 14 * 4096; ++lb_max) {
        const auto d = descriptor(filter, levels);
        if (!(select(p, d, lb_max, lb_max) == by_formula(p, d, lb_max, lb_max))) ++count;
      }
    }
  }
  for (const auto rule : {spec::texture::CountRule::kFloor, spec::texture::CountRule::kCeil,
                          spec::texture::CountRule::kAny}) {
    for (const auto cap : {spec::texture::CountCap::kNone, spec::texture::CountCap::kTexel}) {
      for (int n = 0; n <= 4; ++n) {
        for (std::int32_t lb_max = -2 * 4096; lb_max <= 6 * 4096; lb_max += 1024) {
          for (std::int32_t anisotropy = -130; anisotropy <= 6 * 4096; anisotropy += 1) {
            if (anisotropy % 4096 > 3 && anisotropy % 4096 < 4093 && anisotropy % 97 != 0 &&
                !near_a_count(anisotropy))
              continue;
            p.count = rule;
            p.count_cap = cap;
            auto d = descriptor(MinFilter::kLinearMipmapLinear);
            d.max_anisotropy_log2 = static_cast<std::uint8_t>(n);
            const std::int32_t lb_min = lb_max - anisotropy;
            if (!(select(p, d, lb_max, lb_min) == by_formula(p, d, lb_max, lb_min))) ++count;
          }
        }
      }
    }
  }
  return count;
}

TEST(Level, MatchesGlFormulasForEveryModeAndCount) { EXPECT_EQ(differences(select_level), 0); }

TEST(Level, CheckFindsInjectedFaults) {
  // Faults: l truncated to 8 bits instead of rounded, the nearest level off by one at a tie, N_max
  // ignored.
  EXPECT_GT(differences([](const auto& p, const auto& d, std::int32_t a, std::int32_t b) {
              return select_level(p, d, a - 8, b - 8);
            }),
            0);
  EXPECT_GT(differences([](const auto& p, const auto& d, std::int32_t a, std::int32_t b) {
              LevelOfDetail r = select_level(p, d, a, b);
              if (d.min_filter == MinFilter::kLinearMipmapNearest && r.l % 4096 == 2048) ++r.level;
              return r;
            }),
            0);
  EXPECT_GT(differences([](const auto& p, auto d, std::int32_t a, std::int32_t b) {
              d.max_anisotropy_log2 = 4;
              return select_level(p, d, a, b);
            }),
            0);
  // A threshold of the sample count that is one unit too high.
  EXPECT_GT(differences([](const auto& p, const auto& d, std::int32_t a, std::int32_t b) {
              LevelOfDetail r = select_level(p, d, a, b);
              if (r.sampled == spec::texture::kLog2Count[11] + 1) r.samples = 11;
              return r;
            }),
            0);
}

TEST(Level, BiasAndClampsMatchTheFormulas) {
  tb::Random random(3);
  const auto pick = [&](int low, int high) { return random.between(low, high); };
  spec::texture::Parameters p;
  for (int i = 0; i < 300000; ++i) {
    const int levels = pick(1, 13);
    auto d = descriptor(kMinFilters[pick(0, 5)], levels);
    d.max_anisotropy_log2 = static_cast<std::uint8_t>(pick(0, 4));
    d.mag_filter =
        pick(0, 1) == 0 ? spec::texture::MagFilter::kNearest : spec::texture::MagFilter::kLinear;
    // The full range of S7.8 and U8.8, and often limits that take effect.
    d.lod_bias = static_cast<std::int16_t>(pick(0, 1) == 0 ? pick(-32768, 32767) : pick(-900, 900));
    d.min_lod = static_cast<std::uint16_t>(pick(0, 2) == 0 ? pick(0, 65535) : 0);
    d.max_lod = static_cast<std::uint16_t>(pick(0, 2) == 0 ? pick(0, 65535) : 12 << 8);
    p.count = static_cast<spec::texture::CountRule>(pick(0, 2));
    const std::int32_t lb_max = pick(-16 * 4096, 16 * 4096), lb_min = lb_max - pick(-118, 70000);
    ASSERT_EQ(select_level(p, d, lb_max, lb_min), by_formula(p, d, lb_max, lb_min)) << i;
  }
}

// Paper 004, Fig. 1: s_x = 6, t_x = 3, sides 3 sqrt 5 and sqrt 5.
TEST(Level, PaperFigureOneTakesTwoSamples) {
  const auto paper = spec::texture::preset_parameters(spec::texture::Preset::kPaper);
  const auto f = golden::texture::footprint(paper.axes, paper.footprint, {6 << 16, 3 << 16},
                                            {1 << 16, 2 << 16});
  auto d = descriptor(MinFilter::kLinearMipmapLinear);
  d.max_anisotropy_log2 = 4;
  const auto log2 = [](std::uint32_t x) {
    return golden::texture::log2_fixed(spec::texture::Log2Rule::kMitchell, x);
  };
  const LevelOfDetail r = select_level(paper, d, log2(f.d_max), log2(f.d_min));
  EXPECT_EQ(r.anisotropy, 1.625 * 4096);
  EXPECT_EQ(r.samples, 2);
  EXPECT_EQ(r.l, 1.875 * 4096);
}

}  // namespace
}  // namespace deburr::level_test
