// SPDX-License-Identifier: MIT
#include "tb/oracle/plain_sampler.h"

#include <algorithm>
#include <cmath>

namespace deburr::tb::texture {
namespace {

using Colour = std::array<double, 4>;

std::size_t wrapped(spec::texture::Wrap wrap, std::int64_t i, std::int64_t size) {
  if (wrap == spec::texture::Wrap::kClampToEdge)
    return static_cast<std::size_t>(std::min(std::max<std::int64_t>(i, 0), size - 1));
  const std::int64_t period = wrap == spec::texture::Wrap::kRepeat ? size : 2 * size;
  while (i < 0) i += period;
  i %= period;
  return static_cast<std::size_t>(i < size ? i : period - 1 - i);
}

Colour blend(const Colour& a, const Colour& b, double f) {
  Colour result;
  for (std::size_t c = 0; c < 4; ++c) result[c] = (1.0 - f) * a[c] + f * b[c];
  return result;
}

// Widens narrow channels with zeros, keeping their highest bits in place.
Colour with_zeros(spec::texture::Format format, Colour colour) {
  const auto widen = [](double value, int bits) {
    const double code = std::round(value / 255.0 * ((1 << bits) - 1));
    return code * (1 << (8 - bits));
  };
  if (format == spec::texture::Format::kRgb565)
    return {widen(colour[0], 5), widen(colour[1], 6), widen(colour[2], 5), colour[3]};
  if (format == spec::texture::Format::kRgba4444)
    for (double& c : colour) c = widen(c, 4);
  return colour;
}

}  // namespace

spec::texture::Wrap PlainSampler::wrap(spec::texture::Wrap asked) const {
  if (fault_ != Fault::kWrongWrap) return asked;
  return asked == spec::texture::Wrap::kRepeat ? spec::texture::Wrap::kMirroredRepeat
                                               : spec::texture::Wrap::kRepeat;
}

std::int64_t PlainSampler::to_index(double position) const {
  return static_cast<std::int64_t>(fault_ == Fault::kTruncatedIndex ? std::trunc(position)
                                                                    : std::floor(position));
}

double PlainSampler::weight(double fraction) const {
  switch (fault_) {
    case Fault::kFiveBitWeights:
      return std::round(fraction * 32.0) / 32.0;
    case Fault::kFiveBitTruncatedWeights:
      return std::floor(fraction * 32.0) / 32.0;
    case Fault::kThreeBitWeights:
      return std::round(fraction * 8.0) / 8.0;
    case Fault::kThreeBitTruncatedWeights:
      return std::floor(fraction * 8.0) / 8.0;
    default:
      return std::round(fraction * 256.0) / 256.0;
  }
}

PlainSampler::Colour PlainSampler::texel(const EncodedLevel& level, std::int64_t x,
                                         std::int64_t y) const {
  const std::size_t column = wrapped(wrap(sampler_.wrap_s), x, level.width);
  const std::size_t row = wrapped(wrap(sampler_.wrap_t), y, level.height);
  Colour colour =
      channels(texture_.format, level.codes[row * static_cast<std::size_t>(level.width) + column]);
  if (fault_ == Fault::kUnreplicatedChannels) colour = with_zeros(texture_.format, colour);
  if (texture_.format == spec::texture::Format::kSrgb8A8 && fault_ != Fault::kEncodedSrgb) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double v = colour[c] / 255.0;
      colour[c] = 255.0 * (v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
    }
  }
  return colour;
}

PlainSampler::Colour PlainSampler::nearest(const EncodedLevel& level, double s, double t) const {
  const double shift = fault_ == Fault::kNearestHalfTexelShift ? 0.5 : 0.0;
  return texel(level, to_index(s * level.width + shift), to_index(t * level.height + shift));
}

PlainSampler::Colour PlainSampler::bilinear(const EncodedLevel& level, double s, double t) const {
  const double shift = fault_ == Fault::kHalfTexelShift ? 0.0 : 0.5;
  const double u = s * level.width - shift;
  const double v = t * level.height - shift;
  const std::int64_t x = to_index(u);
  const std::int64_t y = to_index(v);
  std::int64_t right = x + 1;
  if (fault_ == Fault::kNeighbourPastEdge) {
    const std::int64_t last = level.width - 1;
    if (static_cast<std::int64_t>(wrapped(spec::texture::Wrap::kRepeat, x, level.width)) == last)
      right = x;
  }
  double a = weight(u - static_cast<double>(x));
  double b = weight(v - static_cast<double>(y));
  if (fault_ == Fault::kSwappedAxes) std::swap(a, b);
  return blend(blend(texel(level, x, y), texel(level, right, y), a),
               blend(texel(level, x, y + 1), texel(level, right, y + 1), a), b);
}

PlainSampler::Colour PlainSampler::spatial(std::size_t level, double s, double t,
                                           bool linear) const {
  return linear ? bilinear(texture_.levels[level], s, t) : nearest(texture_.levels[level], s, t);
}

std::array<std::uint8_t, 4> PlainSampler::sample(const spec::texture::Quad& quad, int lane) const {
  using spec::texture::MinFilter;
  const auto i = static_cast<std::size_t>(lane);
  const std::size_t row = i & 2;
  const std::size_t column = i & 1;
  const auto side = [&](std::size_t to, std::size_t from) {
    const double ds = static_cast<double>(std::int64_t{quad.s[to]} - quad.s[from]) * 0x1p-24;
    const double dt = static_cast<double>(std::int64_t{quad.t[to]} - quad.t[from]) * 0x1p-24;
    return std::hypot(ds * texture_.width(), dt * texture_.height());
  };
  const double rho = std::max(side(row + 1, row), side(column + 2, column));
  double lod = std::log2(rho) + sampler_.lod_bias;
  if (fault_ == Fault::kLevelTooLow) lod -= 0.125;
  if (fault_ == Fault::kLevelTooHigh) lod += 0.75;
  lod = std::min(std::max(lod, sampler_.min_lod), sampler_.max_lod);

  const double s = quad.s[i] * 0x1p-24;
  const double t = quad.t[i] * 0x1p-24;
  const double last = static_cast<double>(texture_.levels.size() - 1);
  const MinFilter filter = sampler_.min_filter;
  const bool linear = filter == MinFilter::kLinear || filter == MinFilter::kLinearMipmapNearest ||
                      filter == MinFilter::kLinearMipmapLinear;
  Colour colour;
  if (lod <= (fault_ == Fault::kLateMagnification ? 0.5 : 0.0)) {
    colour = spatial(0, s, t, sampler_.mag_filter == spec::texture::MagFilter::kLinear);
  } else if (filter == MinFilter::kNearest || filter == MinFilter::kLinear) {
    colour = spatial(0, s, t, linear);
  } else if (filter == MinFilter::kNearestMipmapNearest ||
             filter == MinFilter::kLinearMipmapNearest) {
    const double level =
        fault_ == Fault::kTruncatedLevel ? std::floor(lod) : std::ceil(lod + 0.5) - 1.0;
    colour = spatial(static_cast<std::size_t>(std::min(level, last)), s, t, linear);
  } else {
    const double level = std::min(std::floor(lod), last);
    const double steps = fault_ == Fault::kTwoBitLevelFraction ? 4.0 : 256.0;
    double f = level == last ? 0.0 : std::round((lod - level) * steps) / steps;
    if (fault_ == Fault::kSwappedLevels && f > 0.0) f = 1.0 - f;
    const auto k = static_cast<std::size_t>(level);
    colour = spatial(k, s, t, linear);
    if (f > 0.0) colour = blend(colour, spatial(k + 1, s, t, linear), f);
  }
  std::array<std::uint8_t, 4> result;
  for (std::size_t c = 0; c < 4; ++c)
    result[c] = static_cast<std::uint8_t>(
        fault_ == Fault::kTruncatedColour ? std::floor(colour[c]) : std::round(colour[c]));
  return result;
}

}  // namespace deburr::tb::texture
