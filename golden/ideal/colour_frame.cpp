// SPDX-License-Identifier: MIT
#include "golden/ideal/colour_frame.h"

#include <cmath>

namespace deburr::golden::ideal {

ColourScale::ColourScale(bool linear_light) : linear_light_(linear_light) {
  for (std::size_t code = 0; code < values_.size(); ++code) {
    const double stored = static_cast<double>(code) / 255;
    values_[code] = !linear_light       ? stored
                    : stored <= 0.04045 ? stored / 12.92
                                        : std::pow((stored + 0.055) / 1.055, 2.4);
  }
}

Rgb ColourScale::decoded(const Rgba8& pixel) const {
  return {values_[pixel[0]], values_[pixel[1]], values_[pixel[2]]};
}

Rgba8 ColourScale::encoded(const Rgb& colour, std::uint8_t alpha) const {
  Rgba8 pixel{0, 0, 0, alpha};
  for (std::size_t i = 0; i < 3; ++i) {
    const double stored = !linear_light_           ? colour[i]
                          : colour[i] <= 0.0031308 ? colour[i] * 12.92
                                                   : 1.055 * std::pow(colour[i], 1 / 2.4) - 0.055;
    pixel[i] = static_cast<std::uint8_t>(std::lround(std::clamp(stored, 0.0, 1.0) * 255));
  }
  return pixel;
}

Rgb mixed(const Rgb& a, const Rgb& b, double share) {
  return {std::lerp(a[0], b[0], share), std::lerp(a[1], b[1], share), std::lerp(a[2], b[2], share)};
}

}  // namespace deburr::golden::ideal
