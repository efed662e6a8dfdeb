// SPDX-License-Identifier: MIT
// Checks the filtering criterion itself against manually computed values and against brute force.
#include "golden/ideal/filtering_criterion.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "tb/base/random.h"

namespace deburr::filtering_criterion_test {
namespace {

using golden::ideal::Criterion;
using golden::ideal::Fragment;
using golden::ideal::Interval;
using golden::ideal::kPrecisionGles2;
using golden::ideal::kPrecisionHigh;
using golden::ideal::kPrecisionLow;
using golden::ideal::Rgba;
using golden::ideal::Sampler;
using golden::ideal::Texture;
using tb::Random;

Rgba grey(double value) { return {value, value, value, value}; }

// 4 x 1 texels 0, 100, 200, 40, and a level of 1 x 1: 250.
Texture ramp() {
  Texture texture;
  texture.levels.push_back({4, 1, {grey(0), grey(100), grey(200), grey(40)}});
  texture.levels.push_back({2, 1, {grey(250), grey(250)}});
  texture.levels.push_back({1, 1, {grey(0)}});
  return texture;
}

Sampler sampler(spec::texture::MinFilter min, spec::texture::MagFilter mag,
                spec::texture::Wrap wrap = spec::texture::Wrap::kRepeat) {
  Sampler s;
  s.min_filter = min;
  s.mag_filter = mag;
  s.wrap_s = s.wrap_t = wrap;
  return s;
}

// A fragment of `ramp` with a footprint of `texels` along u.
Fragment along_u(double s, double texels) { return {s, 0.5, texels / 4.0, 0.0, 0.0, 0.0}; }

TEST(LegalLod, LegalLodSpansLongestComponentToWeightedSum) {
  Texture texture;
  texture.levels.push_back({8, 16, std::vector<Rgba>(128, grey(0))});
  const Sampler s;
  const Fragment fragment{0.0, 0.0, 2.0 / 8, 1.0 / 16, 0.5 / 8, 4.0 / 16};  // m_u = 2, m_v = 4
  const Interval high = legal_lod(texture, s, fragment, kPrecisionHigh);
  EXPECT_NEAR(high.low, 2.0 - 1.0 / 64, 1e-4);
  EXPECT_NEAR(high.high, std::log2(6.0 * std::sqrt(2.0)) + 1.0 / 64, 1e-4);
  const Interval low = legal_lod(texture, s, fragment, kPrecisionLow);
  EXPECT_NEAR(low.low, 2.0 - 1.0 / 16, 1e-4);
  // With the derivatives' precision reduced to seven bits.
  const Interval coarse = legal_lod(texture, s, fragment, kPrecisionGles2);
  EXPECT_NEAR(coarse.low, std::log2(4.0 * (1 - 1.0 / 128)) - 1.0 / 16, 1e-9);
  EXPECT_NEAR(coarse.high, std::log2(6.0 * std::sqrt(2.0) * (1 + 1.0 / 128)) + 1.0 / 16, 1e-9);
}

TEST(LegalLod, BiasIsAddedBeforeClamping) {
  const Texture texture = ramp();
  Sampler s;
  s.lod_bias = 1.5;
  s.min_lod = 0.25;
  s.max_lod = 3.0;
  EXPECT_NEAR(legal_lod(texture, s, along_u(0, 1.0), kPrecisionHigh).low, 1.5 - 1.0 / 64, 1e-4);
  EXPECT_EQ(legal_lod(texture, s, along_u(0, 64.0), kPrecisionHigh).high, 3.0);
  EXPECT_EQ(legal_lod(texture, s, along_u(0, 0.0), kPrecisionHigh).low, 0.25);
}

TEST(Criterion, OneColourStepIsAllowedBeyondWeightTolerance) {
  const Texture texture = ramp();
  const Sampler s = sampler(spec::texture::MinFilter::kLinear, spec::texture::MagFilter::kLinear);
  const Criterion high(texture, s, kPrecisionHigh);
  // Half way between texels 0 and 100 the ideal is 50; 1/128 texel is 0.78 of a step.
  const Fragment f = along_u(1.0 / 4, 0.5);
  EXPECT_NEAR(high.deviation(f, grey(50)), 0.0, 0.02);
  EXPECT_NEAR(high.deviation(f, grey(55)), 5.0 - 100.0 / 128, 0.02);
  EXPECT_TRUE(high.reachable(f, grey(54.7), golden::ideal::kFilteredTolerance));
  EXPECT_FALSE(high.reachable(f, grey(54.8), golden::ideal::kFilteredTolerance));
  const Criterion low(texture, s, kPrecisionLow);
  EXPECT_NEAR(low.deviation(f, grey(60)), 10.0 - 100.0 / 16, 0.02);
}

TEST(Criterion, OneExplanationMustFitAllChannels) {
  Texture texture;
  texture.levels.push_back({2, 1, {Rgba{0, 255, 0, 0}, Rgba{255, 0, 0, 0}}});
  const Sampler s = sampler(spec::texture::MinFilter::kLinear, spec::texture::MagFilter::kLinear,
                            spec::texture::Wrap::kClampToEdge);
  const Criterion low(texture, s, kPrecisionLow);
  const Fragment f{0.5, 0.5, 0.1, 0, 0, 0};
  EXPECT_TRUE(low.reachable(f, {127.5 + 14, 127.5 - 14, 0, 0}, 2.0));
  // Each channel alone could be 14 higher, both together cannot.
  EXPECT_FALSE(low.reachable(f, {127.5 + 14, 127.5 + 14, 0, 0}, 2.0));
}

TEST(Criterion, NearestAcceptsOnlyTexelsWithinCoordinateError) {
  const Texture texture = ramp();
  const Sampler s = sampler(spec::texture::MinFilter::kNearest, spec::texture::MagFilter::kNearest);
  const Criterion high(texture, s, kPrecisionHigh);
  EXPECT_TRUE(high.reachable(along_u(0.3, 0.5), grey(100), 1.0));
  EXPECT_FALSE(high.reachable(along_u(0.3, 0.5), grey(0), 1.0));
  EXPECT_TRUE(high.reachable(along_u(0.25, 0.5), grey(0), 1.0));
  EXPECT_TRUE(high.reachable(along_u(0.25, 0.5), grey(100), 1.0));
  EXPECT_FALSE(high.reachable(along_u(0.25, 0.5), grey(50), 1.0));
}

TEST(Criterion, NearestUsesTheRowOfItsCoordinate) {
  Texture texture;
  texture.levels.push_back({1, 4, {grey(0), grey(100), grey(200), grey(40)}});
  const Sampler s = sampler(spec::texture::MinFilter::kNearest, spec::texture::MagFilter::kNearest);
  for (std::size_t row = 0; row < 4; ++row) {
    const Fragment f{0.5, (static_cast<double>(row) + 0.3) / 4, 0.5, 0, 0, 0};
    EXPECT_EQ(exact_colour(texture, s, f), texture.levels[0].texels[row]) << row;
  }
}

TEST(Criterion, ToleranceBoundsAreInclusive) {
  const Texture texture = ramp();
  const Sampler s = sampler(spec::texture::MinFilter::kNearest, spec::texture::MagFilter::kNearest);
  const Criterion high(texture, s, kPrecisionHigh);
  const Fragment f = along_u(0.3, 0.5);  // 100
  EXPECT_TRUE(high.reachable(f, grey(100), 0.0));
  EXPECT_TRUE(high.reachable(f, grey(99), 1.0));
  EXPECT_TRUE(high.reachable(f, grey(101), 1.0));
  EXPECT_FALSE(high.reachable(f, grey(98.99), 1.0));
  EXPECT_FALSE(high.reachable(f, grey(101.01), 1.0));
}

TEST(Criterion, NegativeAndMirroredCoordinatesWrap) {
  const Texture texture = ramp();
  const auto texel = [&](spec::texture::Wrap wrap, double s) {
    const Sampler state =
        sampler(spec::texture::MinFilter::kNearest, spec::texture::MagFilter::kNearest, wrap);
    return exact_colour(texture, state, along_u(s, 0.5))[0];
  };
  EXPECT_EQ(texel(spec::texture::Wrap::kRepeat, -0.1), 40);
  EXPECT_EQ(texel(spec::texture::Wrap::kRepeat, -1.1), 40);
  EXPECT_EQ(texel(spec::texture::Wrap::kRepeat, 2.3), 100);
  EXPECT_EQ(texel(spec::texture::Wrap::kMirroredRepeat, -0.1), 0);
  EXPECT_EQ(texel(spec::texture::Wrap::kMirroredRepeat, -0.3), 100);
  EXPECT_EQ(texel(spec::texture::Wrap::kMirroredRepeat, 1.1), 40);
  EXPECT_EQ(texel(spec::texture::Wrap::kMirroredRepeat, 1.9), 0);
  EXPECT_EQ(texel(spec::texture::Wrap::kClampToEdge, -7.0), 0);
  EXPECT_EQ(texel(spec::texture::Wrap::kClampToEdge, 7.0), 40);
  // Between the last texel and its right neighbour.
  const auto edge = [&](spec::texture::Wrap wrap) {
    const Sampler state =
        sampler(spec::texture::MinFilter::kLinear, spec::texture::MagFilter::kLinear, wrap);
    return exact_colour(texture, state, along_u(1.0, 0.5))[0];
  };
  EXPECT_EQ(edge(spec::texture::Wrap::kRepeat), 20);
  EXPECT_EQ(edge(spec::texture::Wrap::kMirroredRepeat), 40);
  EXPECT_EQ(edge(spec::texture::Wrap::kClampToEdge), 40);
}

TEST(Criterion, BothFiltersAreLegalNearTheirSwitch) {
  const Texture texture = ramp();
  const Sampler s =
      sampler(spec::texture::MinFilter::kNearestMipmapNearest, spec::texture::MagFilter::kLinear);
  const Criterion high(texture, s, kPrecisionHigh);
  const Rgba linear = grey(50);  // at 1/4; nearest gives 0 or 100
  EXPECT_TRUE(high.reachable(along_u(0.25, 0.5), linear, 2.0));
  EXPECT_TRUE(high.reachable(along_u(0.25, 1.0), linear, 2.0));
  EXPECT_FALSE(high.reachable(along_u(0.25, 1.1), linear, 2.0));
  EXPECT_TRUE(high.reachable(along_u(0.2, 1.0), grey(0), 2.0));
  EXPECT_FALSE(high.reachable(along_u(0.2, 0.5), grey(0), 2.0));  // certainly magnified
}

TEST(Criterion, LevelRoundsAsInGlAndStopsAtLast) {
  const Texture texture = ramp();
  const Sampler s =
      sampler(spec::texture::MinFilter::kNearestMipmapNearest, spec::texture::MagFilter::kNearest);
  const Criterion high(texture, s, kPrecisionHigh);
  // l between 0.3 and 0.8 + 1/64: levels 0 and 1, not 2.
  const Fragment near_base = along_u(0.4, std::exp2(0.3));
  EXPECT_TRUE(high.reachable(near_base, grey(100), 1.0));
  EXPECT_TRUE(high.reachable(near_base, grey(250), 1.0));
  EXPECT_FALSE(high.reachable(near_base, grey(0), 1.0));
  // l from 0.6 to 1.1: only level 1.
  EXPECT_FALSE(high.reachable(along_u(0.4, std::exp2(0.6)), grey(100), 1.0));
  EXPECT_TRUE(high.reachable(along_u(0.4, 1000.0), grey(0), 1.0));
  EXPECT_FALSE(high.reachable(along_u(0.4, 1000.0), grey(250), 1.0));
  // l = 1/2 exactly: only level 0.
  Sampler half = s;
  half.min_lod = half.max_lod = 0.5;
  const Criterion tie(texture, half, kPrecisionHigh);
  EXPECT_TRUE(tie.reachable(near_base, grey(100), 1.0));
  EXPECT_FALSE(tie.reachable(near_base, grey(250), 1.0));
}

TEST(Criterion, LevelFractionIsBounded) {
  Texture texture;
  texture.levels.push_back({2, 2, std::vector<Rgba>(4, grey(0))});
  texture.levels.push_back({1, 1, {grey(200)}});
  const Sampler s =
      sampler(spec::texture::MinFilter::kLinearMipmapLinear, spec::texture::MagFilter::kLinear);
  const Criterion high(texture, s, kPrecisionHigh);
  const Fragment f{0.3, 0.3, std::exp2(0.4) / 2, 0, 0, 0};  // l from 0.4 to 0.9
  EXPECT_NEAR(high.deviation(f, grey(80 - 200.0 / 64)), 0.0, 0.02);
  EXPECT_NEAR(high.deviation(f, grey(70)), 10 - 200.0 / 64, 0.02);
  EXPECT_NEAR(high.deviation(f, grey(130)), 0.0, 0.02);
  EXPECT_NEAR(high.deviation(f, grey(190)), 10 - 200.0 / 64, 0.02);
}

// Only one channel differs, along one of the five weights. The search bisects that weight and finds
// the only legal colour at the end of an interval, which is not the centre of any box.
TEST(Criterion, EveryWeightIsSearchedByEveryChannel) {
  using spec::texture::MagFilter, spec::texture::MinFilter;
  const auto level = [](int size, const auto& value) {
    golden::ideal::Level l{size, size, {}};
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) l.texels.push_back(value(x, y));
    return l;
  };
  const auto flat = [](int, int) { return grey(100); };
  for (std::size_t channel = 0; channel < 4; ++channel)
    for (std::size_t weight = 0; weight < 5; ++weight) {
      const auto ramp = [&](int x, int y) {
        Rgba colour = grey(100);
        const int along = weight % 2 == 0 ? x : y;
        colour[channel] += weight == 4 ? 64 : 64 * along;
        return colour;
      };
      Texture texture;
      texture.levels.push_back(weight < 2 ? level(4, ramp) : level(4, flat));
      texture.levels.push_back(weight >= 2 ? level(2, ramp) : level(2, flat));
      texture.levels.push_back(level(1, flat));
      Sampler s = sampler(MinFilter::kLinearMipmapLinear, MagFilter::kLinear);
      const bool fine = weight < 2, coarse = weight == 2 || weight == 3;
      // Level 0 only, half of level 1, or from half to three quarters of it.
      s.min_lod = fine ? 0.0 : 0.5;
      s.max_lod = fine ? 0.0 : coarse ? 0.5 : 0.75;
      const Criterion low(texture, s, kPrecisionLow);
      const Fragment f{0.4, 0.4, fine ? 0.1 : std::exp2(0.4) / 4, 0, 0, 0};
      // The legal maximum: 1/16 of a texel further, or the whole three quarters.
      const double position = (fine ? 1.6 - 0.5 : 0.8 - 0.5) + 1.0 / 16;
      Rgba most = grey(100);
      most[channel] += fine     ? 64 * (position + 0.4 * std::ldexp(4.0, -20))
                       : coarse ? 32 * (position + 0.4 * std::ldexp(2.0, -20))
                                : 48;
      SCOPED_TRACE("channel " + std::to_string(channel) + ", weight " + std::to_string(weight));
      EXPECT_TRUE(low.reachable(f, most, 1e-4));
      EXPECT_EQ(low.undecided(), 0);
      most[channel] += 0.01;
      EXPECT_FALSE(low.reachable(f, most, 1e-4));
      EXPECT_EQ(low.undecided(), 0);
    }
}

// All legal colours lie on the line R = G for any of the five weights. A colour next to that line
// must be rejected at once: with boxes only, their size would have to be as small as its distance.
TEST(Criterion, ColourOffTheLegalLineIsRejected) {
  Texture texture;
  for (int size = 4; size > 0; size /= 2) {
    golden::ideal::Level level{size, size, {}};
    for (int i = 0; i < size * size; ++i) {
      const double v = 120.0 * (i % size % 2 + i / size % 2);
      level.texels.push_back({v, v, 0, 0});
    }
    texture.levels.push_back(std::move(level));
  }
  const Sampler s =
      sampler(spec::texture::MinFilter::kLinearMipmapLinear, spec::texture::MagFilter::kLinear);
  const Criterion low(texture, s, kPrecisionLow);
  const Fragment f{0.4, 0.4, std::exp2(0.4) / 4, 0, 0, 0};  // l from 0.4 to 0.9
  // Level 0 gives 216, level 1 gives 72; the result is not at the centre of all intervals.
  const double v = 141.7;
  EXPECT_TRUE(low.reachable(f, {v + 0.9, v - 0.9, 0, 0}, 1.0));
  EXPECT_FALSE(low.reachable(f, {v + 1.1, v - 1.1, 0, 0}, 1.0));
  EXPECT_EQ(low.undecided(), 0);
}

// Random textures, fragments and sampler states; the level fraction and both levels' weights vary
// inside their intervals.
struct RandomCase {
  Texture texture;
  Sampler state;
  Fragment fragment;
};

RandomCase random_case(Random& random) {
  RandomCase c;
  for (int size = 8; size > 0; size /= 2) {
    golden::ideal::Level level{size, size, {}};
    for (int i = 0; i < size * size; ++i)
      level.texels.push_back({random.uniform(0, 255), random.word() % 2 * 255.0,
                              random.uniform(0, 255), random.word() % 2 * 255.0});
    c.texture.levels.push_back(std::move(level));
  }
  c.state = sampler(static_cast<spec::texture::MinFilter>(random.word() % 6),
                    static_cast<spec::texture::MagFilter>(random.word() % 2),
                    static_cast<spec::texture::Wrap>(random.word() % 3));
  const double d = std::exp2(random.uniform(-1.0, 3.5)) / 8;
  c.fragment = {random.uniform(-2, 2), random.uniform(-2, 2), d, 0, 0, random.uniform(0, d)};
  return c;
}

// A legal colour, computed directly from the definition: one l, one position error.
Rgba random_legal_colour(const RandomCase& c, const golden::ideal::Precision& precision,
                         Random& random) {
  const Interval lod = legal_lod(c.texture, c.state, c.fragment, precision);
  Fragment moved = c.fragment;
  const bool linear_min = c.state.min_filter == spec::texture::MinFilter::kLinear ||
                          c.state.min_filter == spec::texture::MinFilter::kLinearMipmapNearest ||
                          c.state.min_filter == spec::texture::MinFilter::kLinearMipmapLinear;
  const double l = random.uniform(lod.low, lod.high);
  // exact_colour() at a footprint of exactly 2^l; a position error of up to `bits` of a texel of
  // the finest level is legal at every level.
  const bool linear = l > 0 ? linear_min : c.state.mag_filter == spec::texture::MagFilter::kLinear;
  const double reach = linear ? std::ldexp(1.0, -precision.subtexel_bits) / 8 : 0.0;
  moved.s += random.uniform(-reach, reach);
  moved.t += random.uniform(-reach, reach);
  moved.ds_dx = std::exp2(l) / 8;
  moved.dt_dx = moved.ds_dy = moved.dt_dy = 0;
  return exact_colour(c.texture, c.state, moved);
}

TEST(Criterion, EveryLegalColourIsAccepted) {
  Random random(7);
  for (int i = 0; i < 20000; ++i) {
    const RandomCase c = random_case(random);
    const auto& precision = i % 2 == 0 ? kPrecisionHigh : kPrecisionLow;
    const Criterion criterion(c.texture, c.state, precision);
    const Rgba colour = random_legal_colour(c, precision, random);
    ASSERT_TRUE(criterion.reachable(c.fragment, colour, 0.01)) << "case " << i;
    ASSERT_EQ(criterion.undecided(), 0);
  }
}

// The criterion's distance to the nearest legal colour must not exceed the distance to any legal
// colour found by a random search, and must not be much less than the smallest of those.
TEST(Criterion, DistanceIsToTheNearestLegalColour) {
  Random random(11);
  double largest_gap = 0.0;
  int away = 0;
  for (int i = 0; i < 150; ++i) {
    RandomCase c = random_case(random);
    const Criterion criterion(c.texture, c.state, kPrecisionLow);
    Rgba colour = random_legal_colour(c, kPrecisionLow, random);
    for (double& channel : colour) channel += random.uniform(-30, 30);
    const double claimed = criterion.deviation(c.fragment, colour);
    double nearest = 1e9;
    for (int j = 0; j < 20000; ++j) {
      const Rgba legal = random_legal_colour(c, kPrecisionLow, random);
      double distance = 0.0;
      for (std::size_t k = 0; k < 4; ++k)
        distance = std::max(distance, std::abs(legal[k] - colour[k]));
      nearest = std::min(nearest, distance);
    }
    ASSERT_LE(claimed, nearest + 0.02) << "case " << i;
    largest_gap = std::max(largest_gap, nearest - claimed);
    if (claimed > golden::ideal::kFilteredTolerance) ++away;
  }
  EXPECT_GT(away, 50);
  // The random search moves both levels together; the criterion does not require that.
  EXPECT_LT(largest_gap, 12.0);
}

// One bad colour among many is enough to fail.
TEST(Checker, OneWrongColourIsEnough) {
  const Texture texture = ramp();
  const Sampler s = sampler(spec::texture::MinFilter::kLinear, spec::texture::MagFilter::kLinear);
  golden::ideal::Checker checker(texture, s);
  for (int i = 0; i < 100; ++i) checker.add(along_u(1.0 / 4, 0.5), grey(50));
  EXPECT_EQ(checker.verdict(), golden::ideal::Verdict::kHigh);
  checker.add(along_u(1.0 / 4, 0.5), grey(60));
  EXPECT_EQ(checker.verdict(), golden::ideal::Verdict::kLow);
  EXPECT_NEAR(checker.deviation(), 10 - 100.0 / 128, 0.02);
  EXPECT_NEAR(checker.low_deviation(), 10 - 100.0 / 16, 0.02);
  checker.add(along_u(1.0 / 4, 0.5), grey(70));
  EXPECT_EQ(checker.verdict(), golden::ideal::Verdict::kFail);
  EXPECT_EQ(checker.rejected(), 2);
  EXPECT_EQ(checker.fragments(), 102);
}

TEST(Checker, LargestDeviationIsKept) {
  const Texture texture = ramp();
  const Sampler s = sampler(spec::texture::MinFilter::kLinear, spec::texture::MagFilter::kLinear);
  golden::ideal::Checker checker(texture, s);
  checker.add(along_u(1.0 / 4, 0.5), grey(50));
  EXPECT_EQ(checker.deviation(), 0.5) << "finer ones are rounding";
  checker.add(along_u(1.0 / 4, 0.5), grey(60));
  checker.add(along_u(1.0 / 4, 0.5), grey(50));
  EXPECT_NEAR(checker.deviation(), 10 - 100.0 / 128, 0.02);
}

}  // namespace
}  // namespace deburr::filtering_criterion_test
