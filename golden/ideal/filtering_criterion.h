// SPDX-License-Identifier: MIT
// Checks a filtered colour as the Khronos conformance tests do: it is right when SOME sub-texel
// weights and SOME level of detail inside the tolerated intervals explain all four channels
// together. Real arithmetic; written from the description in
// docs/measurements/filtering_conformance.md.
//
// Where it sits: above the golden model. The golden and the hardware model are compared bit for
// bit; whether the bits are a legal texture filter at all is decided here.
//
// The question "does a legal point exist" is answered by interval bounding: a box of weights is
// dropped only when no colour in it can be the result, accepted only when a colour in it is, and
// split otherwise. Both answers are therefore certain, to within kResolution of an 8-bit step; the
// test filtering_criterion_test compares them with brute force.
//
// Units: coordinates and derivatives are normalised (1 = the whole texture), a derivative is per
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

// One fragment: its coordinates and the four derivatives.
struct Fragment {
  double s = 0.0, t = 0.0;
  double ds_dx = 0.0, dt_dx = 0.0, ds_dy = 0.0, dt_dy = 0.0;
};

// Accuracy that a filter must have. Coordinates and derivatives are relative (a mantissa of so many
// bits), sub-texel position and level of detail are absolute: 2^-bits.
struct Precision {
  std::string_view name;
  int coordinate_bits, subtexel_bits, derivative_bits, lod_bits;
};
inline constexpr Precision kPrecisionHigh{"high", 20, 7, 18, 6};  // OpenGL ES 3, Vulkan
inline constexpr Precision kPrecisionLow{"low", 20, 4, 18, 4};    // the same, "quality warning"
inline constexpr Precision kPrecisionGles2{"gles2", 9, 5, 7, 4};

// Colours: N - 1 accurate bits of 8 where nothing is interpolated, else N - 2.
inline constexpr double kNearestTolerance = 255.0 / 128.0;
inline constexpr double kFilteredTolerance = 255.0 / 64.0;
double colour_tolerance(const Sampler& sampler);

struct Interval {
  double low, high;
};

// The level of detail that a legal filter may use, before the choice of magnification or
// minification: lb rho for rho between max(m_u, m_v) and sqrt(2) (m_u + m_v), where m_u and m_v are
// the larger of the x and y derivatives in texels of level 0; biased, widened by the precision's
// derivative and LOD bits, and clamped. -infinity where the derivatives vanish.
Interval legal_lod(const Texture& texture, const Sampler& sampler, const Fragment& fragment,
                   const Precision& precision);

// Largest error of an answer of `Criterion`, in 8-bit steps.
inline constexpr double kResolution = 1.0 / 1024.0;

class Criterion {
 public:
  // Keeps references: texture and sampler must outlive it.
  Criterion(const Texture& texture, const Sampler& sampler, const Precision& precision)
      : texture_(texture), sampler_(sampler), precision_(precision) {}

  // Whether a legal colour lies within `tolerance` of `colour` in every channel.
  bool reachable(const Fragment& fragment, const Rgba& colour, double tolerance) const;

  // The distance (largest channel) from `colour` to the nearest legal colour, or `floor` when that
  // is larger; correct to 1/64 step.
  double deviation(const Fragment& fragment, const Rgba& colour, double floor = 0.0) const;

  // Questions given up (and answered "not reachable") after kMaxBoxes boxes; expected to stay 0.
  std::int64_t undecided() const { return undecided_; }
  static constexpr int kMaxBoxes = 1 << 20;

 private:
  const Texture& texture_;
  const Sampler& sampler_;
  Precision precision_;
  mutable std::int64_t undecided_ = 0;
};

// The colour of an ideal filter: exact weights, rho = max of the two exact footprint lengths, the
// switch to magnification at 0. One sample, no anisotropy.
Rgba exact_colour(const Texture& texture, const Sampler& sampler, const Fragment& fragment);

enum class Verdict { kHigh, kLow, kFail };
std::string_view verdict_name(Verdict verdict);

// Checks many fragments of one texture and sampler.
class Checker {
 public:
  // Keeps references: texture and sampler must outlive it.
  Checker(const Texture& texture, const Sampler& sampler);

  void add(const Fragment& fragment, const Rgba& colour);

  // kHigh when every colour was within tolerance at high precision, else kLow when every one was at
  // low precision, else kFail.
  Verdict verdict() const;
  // Largest distance to the nearest legal colour at high precision, in 8-bit steps; at least 1/2
  // where any fragment was added, since finer differences are rounding.
  double deviation() const { return high_worst_; }
  // The same at low precision, over the fragments that high precision rejected; 0 when there are
  // none.
  double low_deviation() const { return low_worst_; }
  const Fragment& worst() const { return worst_; }
  const Rgba& worst_colour() const { return worst_colour_; }
  std::int64_t fragments() const { return fragments_; }
  std::int64_t rejected() const { return rejected_; }  // fragments that high precision rejected
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
