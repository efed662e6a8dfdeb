// SPDX-License-Identifier: MIT
// The references in real arithmetic: EWA against a brute-force sum, the box filter against areas
// known in closed form, footprints of quads, and texture images.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "golden/ideal/box.h"
#include "golden/ideal/ellipse.h"
#include "golden/ideal/ewa.h"
#include "golden/ideal/footprint.h"
#include "golden/ideal/lod.h"
#include "golden/ideal/texture_image.h"
#include "spec/error.h"
#include "tb/unit/golden/texture/support.h"

namespace deburr::ideal_test {
namespace {

using namespace golden::ideal;

TextureImage image(const tb::texture::Pyramid& picture,
                   spec::texture::Wrap wrap = spec::texture::Wrap::kRepeat) {
  const auto& base = picture.levels.front();
  return TextureImage(base.width, base.height, picture.base_bytes(), wrap, wrap);
}

tb::texture::Pyramid ramp(int size) {
  return tb::texture::Pyramid(size, size, [](int x, int y) {
    return tb::texture::Rgba{static_cast<std::uint8_t>(2 * x), static_cast<std::uint8_t>(3 * y), 10,
                             255};
  });
}

// ---- footprints ---------------------------------------------------------------------------------

// All coordinates differ, so each difference identifies the lanes that it was taken from.
TEST(IdealFootprint, DifferencesAreAlongTheLanesRowAndColumn) {
  spec::texture::Quad quad;
  constexpr std::int32_t kUnit = spec::texture::kCoordinateOne / 256;
  quad.s = {1 * kUnit, 3 * kUnit, 8 * kUnit, 21 * kUnit};
  quad.t = {2 * kUnit, 7 * kUnit, 19 * kUnit, 53 * kUnit};
  for (int lane = 0; lane < 4; ++lane) {
    const PixelFootprint f = pixel_footprint(quad, lane, 256, 256);
    const bool low = lane >= 2, right = lane % 2 == 1;
    EXPECT_DOUBLE_EQ(f.s_x, low ? 13 : 2);
    EXPECT_DOUBLE_EQ(f.t_x, low ? 34 : 5);
    EXPECT_DOUBLE_EQ(f.s_y, right ? 18 : 7);
    EXPECT_DOUBLE_EQ(f.t_y, right ? 46 : 17);
    quad.coverage = static_cast<std::uint8_t>(1 << lane);
    const auto only = pixel_footprints(std::span(&quad, 1), 256, 256);
    ASSERT_EQ(only.size(), 1u);
    EXPECT_DOUBLE_EQ(only[0].s, f.s);
  }
}

// The rule of paper 004, section 1.3, for its figure 1 and for parallel sides.
TEST(IdealFootprint, PaperRuleUsesTheLengthsOfTheSides) {
  spec::texture::Descriptor descriptor;
  descriptor.max_anisotropy_log2 = 4;
  spec::texture::Parameters paper;
  paper.axes = spec::texture::Axes::kTwo;
  paper.count = spec::texture::CountRule::kFloor;
  const PixelFootprint figure{.s_x = 6, .t_x = 3, .s_y = -1, .t_y = 2},
      line{.s_x = 3, .t_x = 4, .s_y = 6, .t_y = 8};
  EXPECT_DOUBLE_EQ(sides(figure).d_max, 3 * std::sqrt(5.0));
  EXPECT_DOUBLE_EQ(sides(figure).d_min, std::sqrt(5.0));
  for (const PixelFootprint& f : {figure, line})
    EXPECT_EQ(level_of_detail(paper, descriptor, f).samples, 2);
}

TEST(IdealLevel, BiasIsAddedIn256ths) {
  spec::texture::Descriptor descriptor;
  descriptor.levels = 9;
  const spec::texture::Parameters parameters;
  const PixelFootprint f{.s_x = 6, .t_x = 3, .s_y = -1, .t_y = 2};
  const double without = level_of_detail(parameters, descriptor, f).l;
  EXPECT_GT(without, 1);
  descriptor.lod_bias = 128;
  EXPECT_NEAR(level_of_detail(parameters, descriptor, f).l, without + 0.5, 1e-12);
  descriptor.lod_bias = -128;
  EXPECT_NEAR(level_of_detail(parameters, descriptor, f).l, without - 0.5, 1e-12);
}

// ---- ellipse ------------------------------------------------------------------------------------

// Walks around the image of the unit circle to find its farthest and its nearest point.
TEST(Ellipse, AxesAreTheExtremesOfTheRotatedStep) {
  tb::Random random(4);
  const auto any = [&] { return random.uniform(-20, 20); };
  for (int trial = 0; trial < 500; ++trial) {
    const PixelFootprint f{0, 0, any(), any(), any(), any()};
    double longest = 0, shortest = 1e9, along_s = 0, along_t = 0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
      const double angle = 3.14159265358979 * i / kSteps;
      const double s = std::cos(angle) * f.s_x + std::sin(angle) * f.s_y;
      const double t = std::cos(angle) * f.t_x + std::sin(angle) * f.t_y;
      const double length = std::hypot(s, t);
      shortest = std::min(shortest, length);
      if (length > longest) {
        longest = length;
        along_s = s;
        along_t = t;
      }
    }
    const Ellipse e = ellipse(f);
    ASSERT_NEAR(e.d_max, longest, 1e-5 * longest);
    ASSERT_NEAR(e.d_min, shortest, 2e-3 * longest);
    ASSERT_NEAR(std::hypot(e.major_s, e.major_t), e.d_max, 1e-9 * longest);
    // Parallel, in either direction.
    ASSERT_NEAR(e.major_s * along_t - e.major_t * along_s, 0, 4e-3 * longest * longest);
  }
}

// Number of samples for count = any, up to 16, without a texel cap.
int samples_without_cap(const PixelFootprint& f) {
  spec::texture::Parameters parameters;
  parameters.count = spec::texture::CountRule::kAny;
  parameters.count_cap = spec::texture::CountCap::kNone;
  spec::texture::Descriptor descriptor;
  descriptor.max_anisotropy_log2 = 4;
  return level_of_detail(parameters, descriptor, f).samples;
}

// exp2 of the difference of two logarithms may exceed the ratio by a rounding error.
TEST(Level, WholeRatioIsTheSampleCount) {
  for (int n = 1; n <= 16; ++n)
    for (const double side : {0.3, 1.0, 1.5, 3.0, 5.0, 7.0}) {
      if (n * side <= 1) continue;  // within a texel
      const PixelFootprint f{0, 0, n * side, 0, 0, side};
      EXPECT_EQ(samples_without_cap(f), n) << side;
    }
}

TEST(Level, FractionalRatioRoundsUp) {
  for (int n = 2; n <= 16; ++n) {
    const PixelFootprint f{0, 0, n - 0.75, 0, 0, 1};
    EXPECT_EQ(samples_without_cap(f), n);
  }
}

// The texel cap is lb of the longer axis: exact with count = any, rounded up with the other rules.
TEST(Level, TexelCapFollowsTheCountRule) {
  spec::texture::Parameters parameters;
  parameters.count_cap = spec::texture::CountCap::kTexel;
  spec::texture::Descriptor descriptor;
  descriptor.max_anisotropy_log2 = 4;
  const PixelFootprint f{0, 0, std::exp2(1.5), 0, 0, 1.0 / 8};
  const auto sampled = [&](spec::texture::CountRule count) {
    parameters.count = count;
    return level_of_detail(parameters, descriptor, f).sampled;
  };
  EXPECT_NEAR(sampled(spec::texture::CountRule::kAny), 1.5, 1e-12);
  EXPECT_EQ(sampled(spec::texture::CountRule::kFloor), 2);
  EXPECT_EQ(sampled(spec::texture::CountRule::kCeil), 2);
}

// ---- box ----------------------------------------------------------------------------------------

TEST(Box, CheckerboardMeanIsTheWhiteArea) {
  const TextureImage texture = image(tb::texture::checkerboard(64, 8));
  // 8 x 8 texels around a common corner of four cells, offset by (3, 2): the white part is (5 x 6 +
  // 3 x 2) / 64.
  const PixelFootprint f{7, 6, 8, 0, 0, 8};
  EXPECT_NEAR(box(texture, f, 32, Tap::kPoint)[0], 255 * 36.0 / 64, 1e-3);
  EXPECT_NEAR(box(texture, f, 64, Tap::kPoint)[0], 255 * 36.0 / 64, 1e-3);
  // A large footprint: half of it is white.
  EXPECT_NEAR(box(texture, {7, 6, 160, 3, -5, 160}, 64, Tap::kPoint)[0], 127.5, 3);
}

// A picture whose texels and channels all have different values.
tb::texture::Pyramid all_different(int size) {
  return tb::texture::Pyramid(size, size, [](int x, int y) {
    const auto value = [&](int by) { return static_cast<std::uint8_t>((x * 37 + y * 101) * by); };
    return tb::texture::Rgba{value(1), value(3), value(7), value(13)};
  });
}

// A texel of a level, with repeat wrapping by its definition.
std::array<double, 4> texel_of(const TextureImage& texture, int k, int x, int y) {
  const TextureImage::Level& level = texture.level(k);
  const auto within = [](int i, int size) { return ((i % size) + size) % size; };
  const TextureImage::Texel& t = level.texels[static_cast<std::size_t>(
      within(y, level.height) * level.width + within(x, level.width))];
  return {t.r, t.g, t.b, t.a};
}

Colour bilinear_of(const TextureImage& texture, int k, double s, double t) {
  const double size = texture.level(k).width / static_cast<double>(texture.width());
  const double u = s * size - 0.5, v = t * size - 0.5;
  const auto x = static_cast<int>(std::floor(u)), y = static_cast<int>(std::floor(v));
  Colour sum{};
  for (std::size_t c = 0; c < 4; ++c) {
    const auto along = [&](int row) {
      return std::lerp(texel_of(texture, k, x, row)[c], texel_of(texture, k, x + 1, row)[c], u - x);
    };
    sum[c] = std::lerp(along(y), along(y + 1), v - y);
  }
  return sum;
}

void expect_near(const Colour& a, const Colour& b, double error) {
  for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(a[c], b[c], error) << "channel " << c;
}

TEST(Box, ResultIsTheMeanOfItsPoints) {
  const TextureImage texture = image(all_different(8));
  // No point is on the border of a texel, where rounding would decide.
  const PixelFootprint f{-1.2171, 0.3317, 2.5, 1.25, -0.75, 3.5};
  constexpr int kSide = 5;
  Colour bilinear{}, point{};
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const double p = (i - 2) / 5.0, q = (j - 2) / 5.0;
      const double s = f.s + p * f.s_x + q * f.s_y, t = f.t + p * f.t_x + q * f.t_y;
      const Colour smooth = bilinear_of(texture, 0, s, t);
      const auto nearest =
          texel_of(texture, 0, static_cast<int>(std::floor(s)), static_cast<int>(std::floor(t)));
      for (std::size_t c = 0; c < 4; ++c) {
        bilinear[c] += smooth[c] / (kSide * kSide);
        point[c] += nearest[c] / (kSide * kSide);
      }
    }
  }
  expect_near(box(texture, f, kSide), bilinear, 1e-3);
  expect_near(box(texture, f, kSide, Tap::kPoint), point, 1e-3);
}

// A point at an integer position belongs to the texel that starts there, on both sides of the
// origin.
TEST(Box, BorderPointBelongsToTheTexelStartingThere) {
  const TextureImage texture = image(all_different(8));
  for (const int at : {-9, -8, -1, 0, 1, 7, 8}) {
    const double place = at;
    expect_near(box(texture, {place, 3, 0, 0, 0, 0}, 1, Tap::kPoint), texel_of(texture, 0, at, 3),
                0);
  }
}

TEST(Ellipse, TrilinearMixesTwoLevelsInEveryChannel) {
  const TextureImage texture = image(all_different(8));
  for (const double s : {-2.3, 0.0, 0.5, 3.7, 9.1}) {
    for (const double t : {-1.1, 0.2, 6.9}) {
      for (const double l : {-1.0, 0.0, 0.25, 1.0, 1.5, 2.75, 3.0, 8.0}) {
        const double level = std::clamp(l, 0.0, 3.0);
        const int k = static_cast<int>(level);
        const Colour sharp = bilinear_of(texture, k, s, t),
                     smooth = bilinear_of(texture, std::min(k + 1, 3), s, t);
        Colour mixed{};
        for (std::size_t c = 0; c < 4; ++c) mixed[c] = std::lerp(sharp[c], smooth[c], level - k);
        expect_near(trilinear(texture, s, t, l), mixed, 1e-9);
      }
    }
  }
}

// The N samples are in the middle of N equal parts of the major axis.
TEST(Ellipse, FilteringIsTheMeanOfItsSamples) {
  const TextureImage texture = image(all_different(32));
  spec::texture::Descriptor descriptor;
  descriptor.max_anisotropy_log2 = 4;
  descriptor.levels = 6;
  const spec::texture::Parameters parameters;
  const PixelFootprint f{12.3, 10.1, 5, 2, -0.3, 0.7};
  const Ellipse axes = ellipse(f);
  const LevelOfDetail lod = level_of_detail(parameters, descriptor, f);
  ASSERT_GT(lod.samples, 2);
  Colour mean{};
  for (int i = 0; i < lod.samples; ++i) {
    const double place = (2 * i + 1 - lod.samples) / (2.0 * lod.samples);
    const Colour sample =
        trilinear(texture, f.s + place * axes.major_s, f.t + place * axes.major_t, lod.l);
    for (std::size_t c = 0; c < 4; ++c) mean[c] += sample[c] / lod.samples;
  }
  expect_near(along_ellipse(texture, parameters, descriptor, f), mean, 1e-9);
}

// ---- EWA ----------------------------------------------------------------------------------------

// EWA by its definition: sums every texel of a large area; the conic is the inverse of J J^T + V.
Colour brute_force_ewa(const tb::texture::Pyramid& picture, const PixelFootprint& f,
                       const EwaOptions& options) {
  const auto& base = picture.levels.front();
  const double a = f.s_x * f.s_x + f.s_y * f.s_y + options.reconstruction;
  const double b = f.s_x * f.t_x + f.s_y * f.t_y;
  const double c = f.t_x * f.t_x + f.t_y * f.t_y + options.reconstruction;
  const double determinant = a * c - b * b;
  Colour sum{};
  double weights = 0;
  for (int y = -100; y < 200; ++y) {
    for (int x = -100; x < 200; ++x) {
      const double u = x + 0.5 - f.s, v = y + 0.5 - f.t;
      const double r2 = (c * u * u - 2 * b * u * v + a * v * v) / determinant;
      if (r2 > options.radius * options.radius) continue;
      double weight = std::exp(-options.alpha * r2);
      if (options.taper) weight -= std::exp(-options.alpha * options.radius * options.radius);
      const auto wrapped = [](int i, int size) { return ((i % size) + size) % size; };
      const auto& texel = base.at(wrapped(x, base.width), wrapped(y, base.height));
      weights += weight;
      for (std::size_t k = 0; k < 4; ++k) sum[k] += weight * texel[k];
    }
  }
  for (double& channel : sum) channel /= weights;
  return sum;
}

double largest_difference(const Colour& a, const Colour& b) {
  double largest = 0;
  for (std::size_t c = 0; c < 4; ++c) largest = std::max(largest, std::abs(a[c] - b[c]));
  return largest;
}

TEST(Ewa, MatchesBruteForceSum) {
  const tb::texture::Pyramid picture = tb::texture::noise(48, 40, 9);
  const TextureImage texture = image(picture);
  for (const EwaOptions& options :
       {EwaOptions{}, EwaOptions{.taper = true}, EwaOptions{.radius = 2.5},
        EwaOptions{.radius = 2.5, .taper = true},
        EwaOptions{.alpha = 4, .radius = 1.5, .reconstruction = 0.25}}) {
    for (const PixelFootprint& f :
         {PixelFootprint{20.2, 17.9, 9, 4, -2, 3}, PixelFootprint{0.5, 0.5, 0.3, 0, 0, 0.3},
          PixelFootprint{30, 3, 25, -20, 1, 1}, PixelFootprint{10.73, 11.1, 0, 12, 12, 0},
          PixelFootprint{20.2, 17.9, 1, 2, -1, 14}}) {
      EXPECT_LT(largest_difference(ewa(texture, f, options), brute_force_ewa(picture, f, options)),
                1e-6)
          << options.alpha << " " << options.radius << " at " << f.s;
    }
  }
}

TEST(Ewa, ComparisonFindsTransposedFootprint) {
  const tb::texture::Pyramid picture = tb::texture::noise(48, 40, 9);
  const PixelFootprint f{20.2, 17.9, 9, 4, -2, 3}, transposed{20.2, 17.9, 4, 9, 3, -2};
  EXPECT_GT(largest_difference(ewa(image(picture), f), brute_force_ewa(picture, transposed, {})),
            1);
}

TEST(Ewa, HugeEllipsesReadASmallerLevel) {
  const TextureImage texture = image(ramp(64));
  const PixelFootprint f{32, 32, 14, 3, -4, 11};
  const Colour all = ewa(texture, f), fewer = ewa(texture, f, {.most_texels = 60});
  EXPECT_LT(largest_difference(all, fewer), 0.5);
  // A pixel at the horizon is thousands of texels long; the limit keeps this fast.
  EXPECT_NEAR(ewa(image(tb::texture::checkerboard(64, 8)), {0, 0, 9000, 20, 5, 16000})[0], 127.5,
              1);
}

// On every level the ellipse covers pi texels, more than the limit, so the last level is read. It
// has one texel.
TEST(Ewa, LimitBelowEveryLevelReadsTheLastLevel) {
  const TextureImage texture = image(all_different(8));
  ASSERT_EQ(texture.levels(), 4);
  const PixelFootprint point{2.1, 1.7, 0, 0, 0, 0};
  const auto near = [&](const Colour& colour) {
    expect_near(colour, texel_of(texture, 3, 0, 0), 1e-6);
  };
  near(ewa(texture, point, {.most_texels = 1}));
  near(ewa(texture, point, {.most_texels = 3.1}));
  EXPECT_LT(largest_difference(ewa(texture, point, {.most_texels = 3.2}), ewa(texture, point)),
            1e-12);
}

// Without reconstruction the ellipse covers pi times the footprint's area of 23 texels. A limit
// just above that changes nothing; a limit just below it reads the next level.
TEST(Ewa, LimitAppliesToTheEllipseArea) {
  const TextureImage texture = image(all_different(32));
  const PixelFootprint f{12.3, 10.1, 4, 3, -1, 5};
  const double area = 3.14159265 * 23;
  const Colour all = ewa(texture, f, {.reconstruction = 0});
  const auto limited = [&](double most) {
    return largest_difference(ewa(texture, f, {.reconstruction = 0, .most_texels = most}), all);
  };
  EXPECT_EQ(limited(area + 0.1), 0);
  EXPECT_GT(limited(area - 0.1), 0.1);
}

TEST(Ewa, EllipseWithoutTexelsReadsItsCentre) {
  const Colour c = ewa(image(ramp(64)), {20, 20, 0.01, 0, 0, 0.01}, {.reconstruction = 0});
  EXPECT_NEAR(c[0], 2 * 19.5, 1e-3);
}

// A long, thin ellipse between two rows of texels gives the mean of the four texels around its
// centre.
TEST(Ewa, LongEllipseWithoutTexelsReadsItsCentre) {
  const TextureImage texture = image(all_different(32));
  const PixelFootprint between{20, 20, 12, 0, 0, 0.1};
  expect_near(ewa(texture, between, {.reconstruction = 0.01}), bilinear_of(texture, 0, 20, 20),
              1e-3);
}

// Covers every level of a texture whose levels shrink by different factors along the two axes, with
// a different wrap mode per axis.
TEST(Ewa, TransposedPictureAndFootprintGiveTheSameColour) {
  using spec::texture::Wrap;
  const tb::texture::Pyramid wide = tb::texture::noise(50, 23, 5);
  const auto& base = wide.levels.front();
  const tb::texture::Pyramid high(23, 50, [&](int x, int y) { return base.at(y, x); });
  const TextureImage a(50, 23, wide.base_bytes(), Wrap::kRepeat, Wrap::kClampToEdge);
  const TextureImage b(23, 50, high.base_bytes(), Wrap::kClampToEdge, Wrap::kRepeat);
  for (const PixelFootprint& f :
       {PixelFootprint{20.2, 7.9, 9, 4, -2, 3}, PixelFootprint{-5, 15, 25, -6, 1, 1},
        PixelFootprint{70.7, 3.1, 2, 1, -1, 14}}) {
    const PixelFootprint g{f.t, f.s, f.t_x, f.s_x, f.t_y, f.s_y};
    for (const double most : {1e6, 60.0, 8.0, 3.2})
      EXPECT_LT(
          largest_difference(ewa(a, f, {.most_texels = most}), ewa(b, g, {.most_texels = most})),
          1e-4)
          << most << " at " << f.s;
    EXPECT_LT(largest_difference(box(a, f), box(b, g)), 1e-3) << f.s;
    for (const double level : {0.0, 1.5, 4.75, 5.5})
      EXPECT_LT(largest_difference(trilinear(a, f.s, f.t, level), trilinear(b, g.s, g.t, level)),
                1e-4)
          << level;
  }
}

// ---- texture image ------------------------------------------------------------------------------

// Expected texels by stepping along an axis: repeat starts again, mirrored repeat reverses, clamp
// stays at the edge.
TEST(IdealTexture, WrapModesMatchAStepByStepWalk) {
  using spec::texture::Wrap;
  for (const int size : {1, 3, 5, 7, 8}) {
    for (int i = -3 * size; i < 3 * size; ++i) {
      const int cell = i + 3 * size, turn = cell / size, rest = cell % size;
      EXPECT_EQ(TextureImage::wrapped(Wrap::kRepeat, i, size), rest);
      EXPECT_EQ(TextureImage::wrapped(Wrap::kMirroredRepeat, i, size),
                turn % 2 == 1 ? rest : size - 1 - rest);
      EXPECT_EQ(TextureImage::wrapped(Wrap::kClampToEdge, i, size), std::clamp(i, 0, size - 1));
    }
  }
}

TEST(IdealTexture, LevelsAreExactAreaMeans) {
  const tb::texture::Pyramid picture = tb::texture::noise(7, 5, 3);
  const TextureImage texture = image(picture);
  ASSERT_EQ(texture.levels(), 3);  // 7x5, 3x2, 1x1
  const std::uint8_t bytes[8] = {};
  EXPECT_EQ(TextureImage(2, 1, bytes).levels(), 2);
  EXPECT_EQ(TextureImage(1, 2, bytes).levels(), 2);
  std::array<double, 4> mean{};
  for (const auto& texel : picture.levels.front().texels)
    for (std::size_t c = 0; c < 4; ++c) mean[c] += texel[c] / 35.0;
  for (int k = 1; k < 3; ++k) {
    const auto& texels = texture.level(k).texels;
    std::array<double, 4> of_level{};
    for (const TextureImage::Texel& texel : texels) {
      const std::array<double, 4> channels = {texel.r, texel.g, texel.b, texel.a};
      for (std::size_t c = 0; c < 4; ++c)
        of_level[c] += channels[c] / static_cast<double>(texels.size());
    }
    for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(of_level[c], mean[c], 1e-3) << k << ' ' << c;
  }
}

TEST(IdealTexture, SrgbIsDecodedToLinearLight) {
  const std::uint8_t bytes[] = {0, 128, 255, 77};
  const TextureImage texture(1, 1, bytes, spec::texture::Wrap::kRepeat,
                             spec::texture::Wrap::kRepeat, true);
  EXPECT_NEAR(texture.level(0).texels[0].r, 0, 1e-6);
  EXPECT_NEAR(texture.level(0).texels[0].g, 255 * 0.21586, 1e-2);
  EXPECT_NEAR(texture.level(0).texels[0].b, 255, 1e-4);
  EXPECT_NEAR(texture.level(0).texels[0].a, 77, 1e-6);
}

TEST(IdealTexture, RejectsWrongSizes) {
  const std::uint8_t bytes[16] = {};
  EXPECT_THROW(TextureImage(2, 3, bytes), spec::ConfigError);
  EXPECT_THROW(TextureImage(0, 0, {}), spec::ConfigError);
  EXPECT_THROW(TextureImage(0, 4, {}), spec::ConfigError);
  EXPECT_THROW(TextureImage(4, 0, {}), spec::ConfigError);
  EXPECT_EQ(TextureImage(2, 2, bytes).level(0).texels.size(), 4u);
  EXPECT_THAT(
      [&] { psnr(std::vector<Colour>(3), bytes); },
      ::testing::ThrowsMessage<spec::ConfigError>("pictures of 3 and 4 pixels cannot be compared"));
}

TEST(Psnr, ErrorOfOneCodeIs48Decibels) {
  const std::vector<Colour> reference(2, Colour{10, 20, 30, 40});
  const std::uint8_t equal[] = {10, 20, 30, 0, 10, 20, 30, 9},
                     off[] = {11, 19, 31, 0, 9, 21, 29, 0};
  EXPECT_EQ(psnr(reference, equal), std::numeric_limits<double>::infinity());  // alpha is ignored
  EXPECT_NEAR(psnr(reference, off), 48.13, 0.01);
}

}  // namespace
}  // namespace deburr::ideal_test
