// SPDX-License-Identifier: MIT
#include "golden/morphological/convert.h"

#include <string>

#include "spec/error.h"

namespace deburr::golden::morphological {

std::uint8_t code_from_unsigned(std::uint32_t value, int bits) {
  const std::uint64_t full = (std::uint64_t{1} << bits) - 1;
  return static_cast<std::uint8_t>((255 * std::uint64_t{value} + full / 2) / full);
}

std::uint32_t scaled_from_binary32(std::uint32_t pattern, std::uint32_t full_scale) {
  const bool negative = pattern >> 31 != 0;
  const std::uint32_t exponent = pattern >> 23 & 0xFF, fraction = pattern & 0x7FFFFF;
  if (exponent == 0xFF && fraction != 0) return 0;  // NaN
  if (negative) return 0;
  if (exponent >= 127) return full_scale;
  // v = mantissa 2^-shift. Below 2^-37, full_scale v rounds to 0.
  const std::uint64_t mantissa = fraction | (exponent != 0 ? 1u << 23 : 0);
  const std::uint32_t shift = 150 - (exponent != 0 ? exponent : 1);
  if (shift > 60) return 0;
  const std::uint64_t half = std::uint64_t{1} << (shift - 1);
  return static_cast<std::uint32_t>((mantissa * full_scale + half) >> shift);
}

PlaneOf<spec::morphological::Rgba8> codes_from(const Samples& samples) {
  PlaneOf<spec::morphological::Rgba8> result(samples.width, samples.height);
  const auto channels = static_cast<std::size_t>(samples.channels);
  DEBURR_CHECK(samples.channels >= 1 && samples.values.size() == result.values.size() * channels,
               std::to_string(samples.values.size()) + " samples for " +
                   std::to_string(samples.width) + " x " + std::to_string(samples.height) + " x " +
                   std::to_string(samples.channels));
  const bool grey = channels < 3, alpha = channels != 1 && channels != 3;
  for (std::size_t i = 0; i < result.values.size(); ++i) {
    const auto code = [&](std::size_t channel) {
      const std::uint32_t value = samples.values[i * channels + channel];
      return samples.binary32 ? code_from_binary32(value) : code_from_unsigned(value, samples.bits);
    };
    result.values[i] = {code(0), code(grey ? 0 : 1), code(grey ? 0 : 2),
                        alpha ? code(grey ? 1 : 3) : std::uint8_t{255}};
  }
  return result;
}

}  // namespace deburr::golden::morphological
