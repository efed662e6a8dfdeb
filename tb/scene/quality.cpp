// SPDX-License-Identifier: MIT
#include "tb/scene/quality.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "spec/error.h"

namespace deburr::tb {

void reject_sizes(int width, int height, int other_width, int other_height) {
  throw spec::ConfigError(
      fmt::format("pictures of different size cannot be compared: {} x {} and {} x {}", width,
                  height, other_width, other_height));
}

namespace {

int squared_difference(const Rgba8& a, const Rgba8& b) {
  int sum = 0;
  for (std::size_t c = 0; c < 3; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
  return sum;
}

int largest_difference(const Rgba8& a, const Rgba8& b) {
  int largest = 0;
  for (std::size_t c = 0; c < 3; ++c) largest = std::max(largest, std::abs(a[c] - b[c]));
  return largest;
}

// Maps NaN and infinity to the background, 0; others are ordered by distance from it.
float surface(float depth) { return std::isfinite(depth) && depth > 0.0f ? depth : 0.0f; }

bool is_step(float a, float b, double relative_step) {
  const double low = std::min(surface(a), surface(b));
  const double high = std::max(surface(a), surface(b));
  return high > (1.0 + relative_step) * low;
}

}  // namespace

double mean_squared_error(const Image& a, const Image& b) {
  require_same_size(a, b);
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    sum += squared_difference(a.pixels[i], b.pixels[i]);
  return static_cast<double>(sum) / (3.0 * static_cast<double>(a.pixels.size()));
}

double mean_squared_error(const Image& a, const Image& b, const Mask& mask) {
  require_same_size(a, b);
  require_same_size(a, mask);
  std::int64_t sum = 0, selected = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    if (mask.pixels[i] == 0) continue;
    sum += squared_difference(a.pixels[i], b.pixels[i]);
    ++selected;
  }
  return selected == 0 ? std::numeric_limits<double>::quiet_NaN()
                       : static_cast<double>(sum) / (3.0 * static_cast<double>(selected));
}

double flicker_square(const Image& before, const Image& after, const Image& reference_before,
                      const Image& reference_after, const Mask& mask) {
  for (const Image* image : {&after, &reference_before, &reference_after})
    require_same_size(before, *image);
  require_same_size(before, mask);
  std::int64_t sum = 0, selected = 0;
  for (std::size_t i = 0; i < before.pixels.size(); ++i) {
    if (mask.pixels[i] == 0) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::int64_t error = (after.pixels[i][c] - before.pixels[i][c]) -
                                 (reference_after.pixels[i][c] - reference_before.pixels[i][c]);
      sum += error * error;
    }
    ++selected;
  }
  return selected == 0 ? std::numeric_limits<double>::quiet_NaN()
                       : static_cast<double>(sum) / (3.0 * static_cast<double>(selected));
}

double psnr_from_mse(double mse) {
  return mse == 0.0 ? std::numeric_limits<double>::infinity()
                    : 10.0 * std::log10(255.0 * 255.0 / mse);
}

double psnr(const Image& a, const Image& b) { return psnr_from_mse(mean_squared_error(a, b)); }

double psnr(const Image& a, const Image& b, const Mask& mask) {
  return psnr_from_mse(mean_squared_error(a, b, mask));
}

Mask FlickerMeter::everywhere(const Image& image) { return Mask(image.width, image.height, 1); }

void FlickerMeter::add(Image picture, Image reference, Mask drawn) {
  if (frames_ > 0) {
    require_same_size(drawn, drawn_);
    Mask both = drawn;
    for (std::size_t i = 0; i < both.pixels.size(); ++i)
      both.pixels[i] = drawn.pixels[i] != 0 && drawn_.pixels[i] != 0;
    if (count(both) > 0) {
      const double square = flicker_square(picture_, picture, reference_, reference, both);
      sum_ += square;
      ++pairs_;
      if (std::sqrt(square) > worst_) {
        worst_ = std::sqrt(square);
        worst_frame_ = frames_;
      }
    }
  }
  picture_ = std::move(picture);
  reference_ = std::move(reference);
  drawn_ = std::move(drawn);
  ++frames_;
}

double FlickerMeter::mean() const { return pairs_ > 0 ? std::sqrt(sum_ / pairs_) : 0; }

std::int64_t count(const Mask& mask) {
  return std::count_if(mask.pixels.begin(), mask.pixels.end(),
                       [](auto value) { return value != 0; });
}

std::int64_t count_different(const Image& a, const Image& b, int tolerance) {
  require_same_size(a, b);
  std::int64_t different = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    different += largest_difference(a.pixels[i], b.pixels[i]) > tolerance ? 1 : 0;
  return different;
}

std::int64_t count_different(const Image& a, const Image& b, const Mask& mask, int tolerance) {
  require_same_size(a, b);
  require_same_size(a, mask);
  std::int64_t different = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    if (mask.pixels[i] != 0)
      different += largest_difference(a.pixels[i], b.pixels[i]) > tolerance ? 1 : 0;
  return different;
}

int max_difference(const Image& a, const Image& b) {
  require_same_size(a, b);
  int largest = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    largest = std::max(largest, largest_difference(a.pixels[i], b.pixels[i]));
  return largest;
}

Mask edge_mask(const Image& reference, const Image& input, int threshold) {
  require_same_size(reference, input);
  Mask mask(reference.width, reference.height);
  for (std::size_t i = 0; i < mask.pixels.size(); ++i)
    mask.pixels[i] = largest_difference(reference.pixels[i], input.pixels[i]) > threshold ? 1 : 0;
  return mask;
}

Mask inverted(const Mask& mask) {
  Mask result(mask.width, mask.height);
  std::transform(mask.pixels.begin(), mask.pixels.end(), result.pixels.begin(),
                 [](std::uint8_t value) { return static_cast<std::uint8_t>(value == 0 ? 1 : 0); });
  return result;
}

Mask without(const Mask& mask, const Mask& other) {
  require_same_size(mask, other);
  Mask result = mask;
  for (std::size_t i = 0; i < result.pixels.size(); ++i)
    if (other.pixels[i] != 0) result.pixels[i] = 0;
  return result;
}

Mask silhouette_mask(const Mask& edges, const DepthImage& depth, double relative_step) {
  require_same_size(edges, depth);
  Mask mask(edges.width, edges.height);
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      if (edges.at(x, y) == 0) continue;
      const float here = depth.at(x, y);
      const bool silhouette =
          (x > 0 && is_step(here, depth.at(x - 1, y), relative_step)) ||
          (x + 1 < mask.width && is_step(here, depth.at(x + 1, y), relative_step)) ||
          (y > 0 && is_step(here, depth.at(x, y - 1), relative_step)) ||
          (y + 1 < mask.height && is_step(here, depth.at(x, y + 1), relative_step));
      mask.at(x, y) = silhouette ? 1 : 0;
    }
  }
  return mask;
}

}  // namespace deburr::tb
