// SPDX-License-Identifier: MIT
// Checks a filtered colour by the rule of the Khronos conformance tests: it is right if SOME
// sub-texel weights and SOME level of detail within the tolerated intervals explain all four
// channels together. Real arithmetic; written from the description in
// docs/measurements/filtering_conformance.md.
//
// It checks the golden model: the RTL model is compared with the golden model bit for bit, and this
// criterion decides whether those bits are a legal texture filter.
//
// Interval bounding decides whether a legal point exists: a box of weights is dropped only if no
// colour in it can be the result, accepted only if a colour in it is, and split otherwise. So both
// answers are certain, to within kResolution of an 8-bit step; filtering_criterion_test compares
// them with brute force.
//
// Units: coordinates and derivatives are normalised (1 = the whole texture), derivatives are per
// pixel; colours are 0..255, linear light; tolerances are in 8-bit steps.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "spec/texture/descriptor.h"

namespace deburr::golden::ideal {

using Rgba = std::array<double, 4>;  // R, G, B, A in 0..255, linear light

struct Level {
  int width = 0, height = 0;
  std::vector<Rgba> texels;  // row-major, width x height
};

struct Texture {
  std::vector<Level> levels;  // level 0 first
};

struct Sampler {
  spec::texture::Wrap wrap_s = spec::texture::Wrap::kRepeat, wrap_t = spec::texture::Wrap::kRepeat;
  spec::texture::MinFilter min_filter = spec::texture::MinFilter::kLinearMipmapLinear;
  spec::texture::MagFilter mag_filter = spec::texture::MagFilter::kLinear;
  double lod_bias = 0.0, min_lod = 0.0, max_lod = 12.0;
};

// The coordinates and the four derivatives of a fragment.
struct Fragment {
  double s = 0.0, t = 0.0;
  double ds_dx = 0.0, dt_dx = 0.0, ds_dy = 0.0, dt_dy = 0.0;
};

// Required accuracy of a filter. Coordinates and derivatives are relative (bits of the mantissa),
// sub-texel position and level of detail are absolute: 2^-bits.
struct Precision {
  std::string_view name;
  int coordinate_bits, subtexel_bits, derivative_bits, lod_bits;
};
inline constexpr Precision kPrecisionHigh{"high", 20, 7, 18, 6};  // OpenGL ES 3, Vulkan
inline constexpr Precision kPrecisionLow{"low", 20, 4, 18, 4};    // the same, "quality warning"
inline constexpr Precision kPrecisionGles2{"gles2", 9, 5, 7, 4};

// N - 1 of 8 bits accurate without interpolation, else N - 2.
inline constexpr double kNearestTolerance = 255.0 / 128.0;
inline constexpr double kFilteredTolerance = 255.0 / 64.0;
double colour_tolerance(const Sampler& sampler);

struct Interval {
  double low, high;
};

// Range of legal levels of detail, before the choice of magnification or minification: lb rho for
// rho between max(m_u, m_v) and sqrt(2) (m_u + m_v), where m_u and m_v are the larger of the x and
// y derivatives in texels of level 0; then biased, widened by the derivative and LOD bits of the
// precision, and clamped. -infinity if the derivatives are zero.
Interval legal_lod(const Texture& texture, const Sampler& sampler, const Fragment& fragment,
                   const Precision& precision);

// Maximum error of an answer of `Criterion`, in 8-bit steps.
inline constexpr double kResolution = 1.0 / 1024.0;

class Criterion {
 public:
  // Keeps references: texture and sampler must outlive it.
  Criterion(const Texture& texture, const Sampler& sampler, const Precision& precision)
      : texture_(texture), sampler_(sampler), precision_(precision) {}

  // Whether a legal colour lies within `tolerance` of `colour` in every channel.
  bool reachable(const Fragment& fragment, const Rgba& colour, double tolerance) const;

  // The distance (largest channel) from `colour` to the nearest legal colour, but at least `floor`;
  // accurate to 1/64 step.
  double deviation(const Fragment& fragment, const Rgba& colour, double floor = 0.0) const;

  // Number of searches that gave up after kMaxBoxes boxes and returned "not reachable"; expected:
  // 0.
  std::int64_t undecided() const { return undecided_; }
  static constexpr int kMaxBoxes = 1 << 20;

 private:
  const Texture& texture_;
  const Sampler& sampler_;
  Precision precision_;
  mutable std::int64_t undecided_ = 0;
};

// The colour of an ideal filter: exact weights, rho = maximum of the two exact footprint lengths,
// magnification from 0 on. One sample, no anisotropy.
Rgba exact_colour(const Texture& texture, const Sampler& sampler, const Fragment& fragment);

enum class Verdict { kHigh, kLow, kFail };
std::string_view verdict_name(Verdict verdict);

// Checks many fragments of one texture and sampler.
class Checker {
 public:
  // Keeps references: texture and sampler must outlive it.
  Checker(const Texture& texture, const Sampler& sampler);

  void add(const Fragment& fragment, const Rgba& colour);

  // kHigh if every colour was within tolerance at high precision, else kLow if every one was at low
  // precision, else kFail.
  Verdict verdict() const;
  // Largest distance to the nearest legal colour at high precision, in 8-bit steps; at least 1/2 if
  // a fragment was added, since smaller differences are rounding.
  double deviation() const { return high_worst_; }
  // The same at low precision, over the fragments rejected at high precision; 0 without any.
  double low_deviation() const { return low_worst_; }
  const Fragment& worst() const { return worst_; }
  const Rgba& worst_colour() const { return worst_colour_; }
  std::int64_t fragments() const { return fragments_; }
  std::int64_t rejected() const { return rejected_; }  // fragments rejected at high precision
  std::int64_t undecided() const { return high_.undecided() + low_.undecided(); }

 private:
  Criterion high_, low_;
  double tolerance_;
  double high_worst_ = 0.0, low_worst_ = 0.0;
  std::int64_t fragments_ = 0, rejected_ = 0, low_rejected_ = 0;
  Fragment worst_{};
  Rgba worst_colour_{};
};

}  // namespace deburr::golden::ideal
