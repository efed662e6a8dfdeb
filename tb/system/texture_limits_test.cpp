// SPDX-License-Identifier: MIT
// Limits of direction, level and count: candidates of equal length, axes of zero length,
// derivatives and lengths that saturate, levels of detail at their clamps, counts at N_max.
// Directed quads, hardware model against golden; each limit is a bin that must be hit, for each
// number of directions.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "golden/texture/footprint.h"
#include "golden/texture/sampling.h"
#include "spec/texture/tables.h"
#include "tb/base/forked.h"
#include "tb/base/random.h"
#include "tb/system/texture_quad_bench.h"

namespace deburr::tb::texture_limits_test {
namespace {

namespace gold = golden::texture;
using spec::texture::Axes;
using spec::texture::CountCap;
using spec::texture::CountRule;
using spec::texture::Descriptor;
using spec::texture::FootprintRule;
using spec::texture::Log2Rule;
using spec::texture::Parameters;

enum Bin : std::size_t {
  kTieOfTwo,             // candidates of equal measure, longer than the rest: the smallest k wins
  kTieOfMore,            // four or more, also all of zero length
  kSquare,               // both axes equally long to the precision of the logarithms: one sample
  kMinorLonger,          // the logarithms say that the minor axis is longer: L = 0
  kLine,                 // no minor axis: L has its maximum
  kNothing,              // no axis at all
  kDerivativeSaturated,  // a derivative in texels
  kAxisSaturated,        // a candidate whose derivatives do not saturate
  kWithinTexel,          // a long footprint within a texel takes one sample
  kCountAtLimit1,        // L above lb N_max
  kCountAtLimit2,
  kCountAtLimit4,
  kCountAtLimit8,
  kCountAtLimit16,
  kCountCapped,  // by texels
  kLodRaised,    // to min_lod
  kLodLowered,   // to max_lod
  kLodCrossed,   // min_lod above max_lod
  kBins
};
constexpr std::array<std::string_view, kBins> kBinNames = {
    "tie of two",
    "tie of four and more",
    "square",
    "minor axis longer",
    "line",
    "nothing",
    "derivative saturated",
    "axis saturated",
    "within a texel",
    "count at N_max 1",
    "count at N_max 2",
    "count at N_max 4",
    "count at N_max 8",
    "count at N_max 16",
    "count capped by texels",
    "level of detail raised",
    "level of detail lowered",
    "clamps crossed",
};
using Bins = std::array<std::uint64_t, kBins>;

// Row and column vectors of a pixel, in texels.
struct Shape {
  double row_s, row_t, column_s, column_t;
};

std::vector<Shape> shapes() {
  std::vector<Shape> all = {
      {4, 0, 0, 4},        {0, 4, 4, 0},      {3, 3, -3, 3},     {0, 0, 0, 0},     {4, 0, 0, 0},
      {0, 0, 0, 4},        {4, 0, 4, 0},      {3, 2, -3, -2},    {4, 0, 0, 2},     {8, 0, 0, 1},
      {0, 1, 16, 0},       {40, 0, 0, 1},     {6, 0, 0, 1},      {1.5, 0, 0, 0.1}, {0.5, 0, 0, 0.1},
      {0.1, 0.02, 0, 0.7}, {300, 0, 0, 0.25}, {300, 0, 300, 0.5}};
  // Rotated circles and ellipses of many sizes: tests logarithms of equal axes.
  for (int i = 0; i < 60; ++i) {
    const double length = 2 + 0.1 * i, ratio = i % 3 == 0 ? 1 : 1 + 0.2 * i;
    const double angle = std::numbers::pi * i / 16;
    all.push_back({length * ratio * std::cos(angle), -length * std::sin(angle),
                   length * ratio * std::sin(angle), length * std::cos(angle)});
  }
  return all;
}

// Textures of 64 x 64 texels with each N_max and some clamps, and a wide one whose derivatives can
// saturate.
QuadInput directed() {
  QuadInput input;
  std::uint32_t end = 0;
  const auto add = [&](std::uint16_t width, std::uint16_t height, int lb_n_max, double min_lod = 0,
                       double max_lod = 12) {
    Descriptor d;
    d.width = width;
    d.height = height;
    d.levels = static_cast<std::uint8_t>(std::bit_width(std::max<unsigned>(width, height)));
    d.max_anisotropy_log2 = static_cast<std::uint8_t>(lb_n_max);
    d.min_lod = static_cast<std::uint16_t>(min_lod * 256);
    d.max_lod = static_cast<std::uint16_t>(max_lod * 256);
    for (int k = 0; k < d.levels; ++k) {
      d.base[static_cast<std::size_t>(k)] = end;
      end += static_cast<std::uint32_t>((gold::level_bytes(d, k) + 127) / 128 * 128);
    }
    input.textures.push_back(d);
  };
  for (int lb = 0; lb <= 4; ++lb) add(64, 64, lb);
  add(64, 64, 4, 1.5);
  add(64, 64, 4, 0, 0.75);
  add(64, 64, 4, 3.25, 1.125);
  add(4096, 4, 4);
  input.memory.resize(end);
  Random random(1, "texture limits");
  for (std::uint8_t& byte : input.memory) byte = static_cast<std::uint8_t>(random.next());

  const auto send = [&](std::uint8_t texture, const Shape& shape) {
    const Descriptor& d = input.textures[texture];
    const auto fixed = [](double texels, unsigned size) {
      return static_cast<std::int32_t>(std::lround(texels / size * spec::texture::kCoordinateOne));
    };
    spec::texture::Quad quad;
    quad.tag = static_cast<std::uint32_t>(input.quads.size());
    quad.texture = texture;
    const std::int32_t s_x = fixed(shape.row_s, d.width), t_x = fixed(shape.row_t, d.height),
                       s_y = fixed(shape.column_s, d.width), t_y = fixed(shape.column_t, d.height);
    const std::int32_t s = fixed(7.3, d.width), t = fixed(11.6, d.height);
    quad.s = {s, s + s_x, s + s_y, s + s_x + s_y};
    quad.t = {t, t + t_x, t + t_y, t + t_x + t_y};
    input.quads.push_back(quad);
  };
  const auto wide = static_cast<std::uint8_t>(input.textures.size() - 1);
  for (std::uint8_t texture = 0; texture < wide; ++texture)
    for (const Shape& shape : shapes()) send(texture, shape);
  send(wide, {24'576, 0, 24'576, 0});  // both 33 900 texels or more, above 32 768
  send(wide, {40'000, 0, 0, 1});
  send(wide, {3, 1, -40'000, 0});
  return input;
}

Bins met(const QuadInput& input, const Parameters& p) {
  gold::TextureGolden golden(p, input.memory, gold::TextureGolden::Traffic::kIgnore);
  for (std::size_t h = 0; h < input.textures.size(); ++h)
    golden.set_texture(static_cast<int>(h), input.textures[h]);
  Bins bins{};
  const auto hit = [&](Bin bin, bool condition) { bins[bin] += condition ? 1 : 0; };
  for (const spec::texture::Quad& quad : input.quads) {
    const Descriptor& d = input.textures[quad.texture];
    for (int lane = 0; lane < 4; ++lane) {
      const gold::FragmentAnalysis a = golden.analyse(quad, lane);
      std::vector<std::uint64_t> lengths;
      bool axis_saturated = false;
      for (int k = 0; k < gold::candidates(p.axes); ++k) {
        const auto [s, t] = gold::candidate_in_texels(p.axes, k, a.p_x, a.p_y);
        lengths.push_back(p.footprint == FootprintRule::kExact
                              ? std::uint64_t{s} * s + std::uint64_t{t} * t
                              : gold::footprint_side(p.footprint, s, t));
        axis_saturated = axis_saturated || s == 0x7FFFFFFF || t == 0x7FFFFFFF;
      }
      const std::uint64_t most = *std::max_element(lengths.begin(), lengths.end());
      const auto equals = std::count(lengths.begin(), lengths.end(), most);
      const bool first =
          lengths[static_cast<std::size_t>(a.footprint.major)] == most &&
          std::find(lengths.begin(), lengths.end(), most) - lengths.begin() == a.footprint.major;
      EXPECT_TRUE(first) << quad.tag;
      const bool minor = p.axes == Axes::kTwo ? a.footprint.d_min != 0 : a.footprint.area != 0;
      const std::int32_t limit = d.max_anisotropy_log2 << 12;
      const std::int32_t free = a.lod.lb_d_max - a.lod.sampled;
      hit(kTieOfTwo, equals == 2 && most != 0);
      hit(kTieOfMore, equals >= 4 || (equals == 2 && p.axes == Axes::kTwo));
      hit(kSquare, minor &&
                       std::abs(a.lod.lb_d_max - a.lod.lb_d_min) <= spec::texture::kLog2Count[1] &&
                       a.lod.samples == 1);
      hit(kMinorLonger, a.lod.lb_d_min > a.lod.lb_d_max);
      hit(kLine, a.footprint.d_max != 0 && !minor);
      hit(kNothing, a.footprint.d_max == 0);
      hit(kDerivativeSaturated, a.saturated);
      hit(kAxisSaturated, axis_saturated && !a.saturated);
      hit(kWithinTexel, a.lod.lb_d_max <= 0 && a.lod.anisotropy > 4096 && a.lod.samples == 1);
      hit(static_cast<Bin>(kCountAtLimit1 + d.max_anisotropy_log2),
          a.lod.anisotropy > limit && a.lod.sampled == limit &&
              a.lod.samples == 1 << d.max_anisotropy_log2);
      hit(kCountCapped, p.count_cap == CountCap::kTexel && a.lod.lb_d_max > 0 &&
                            a.lod.sampled < std::min(a.lod.anisotropy, limit) >> 12 << 12);
      hit(kLodRaised, d.min_lod <= d.max_lod && free < d.min_lod * 16 && a.lod.l == d.min_lod * 16);
      hit(kLodLowered,
          d.min_lod <= d.max_lod && free > d.max_lod * 16 && a.lod.l == d.max_lod * 16);
      hit(kLodCrossed, d.min_lod > d.max_lod && a.lod.l == d.max_lod * 16);
    }
  }
  return bins;
}

// Bins that a configuration cannot hit.
bool possible(Bin bin, Axes axes) {
  // With two axes, these are P_x and P_y, and their logarithms have the order of their lengths.
  return axes != Axes::kTwo || (bin != kAxisSaturated && bin != kMinorLonger);
}

class TextureLimits : public testing::TestWithParam<int> {};

TEST_P(TextureLimits, QuadsMatchGoldenAndHitEveryLimit) {
  const auto axes = static_cast<Axes>(GetParam());
  const QuadInput input = directed();
  Bins all{};
  for (const bool own : {false, true})
    for (const CountCap cap : {CountCap::kNone, CountCap::kTexel}) {
      Parameters p;
      p.axes = axes;
      p.footprint = own ? FootprintRule::kExact : FootprintRule::kHalf;
      p.log2 = own ? Log2Rule::kSegments : Log2Rule::kMitchell;
      p.count = own ? CountRule::kAny : CountRule::kFloor;
      p.count_cap = cap;
      const bool equal = forked<bool>([&] {
        QuadBench bench(input, p);
        bench.reset();
        const QuadOutcome outcome = bench.run();
        const std::string differences = bench.check(input, outcome);
        if (!differences.empty()) std::fputs(differences.c_str(), stderr);
        return differences.empty();
      });
      EXPECT_TRUE(equal);
      const Bins bins = met(input, p);
      for (std::size_t i = 0; i < kBins; ++i) all[i] += bins[i];
    }
  for (std::size_t i = 0; i < kBins; ++i) {
    if (!possible(static_cast<Bin>(i), axes)) {
      EXPECT_EQ(all[i], 0u) << kBinNames[i];
      continue;
    }
    EXPECT_GT(all[i], 0u) << "hole: " << kBinNames[i];
  }
}

INSTANTIATE_TEST_SUITE_P(Texture, TextureLimits, testing::Range(0, 3), [](const auto& axes) {
  return std::string(spec::texture::kAxesNames[static_cast<std::size_t>(axes.param)]);
});

}  // namespace
}  // namespace deburr::tb::texture_limits_test
