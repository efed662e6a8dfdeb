// SPDX-License-Identifier: MIT
#include "tb/scene/ssim.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "tb/scene/convolution.h"
#include "tb/scene/quality.h"

namespace deburr::tb {
namespace {

using LumaPlane = ImageOf<double>;

constexpr int kSsimReach = kSsimWindow / 2;
constexpr double kSigma = 1.5, kRange = 255;
constexpr double kC1 = (0.01 * kRange) * (0.01 * kRange), kC2 = (0.03 * kRange) * (0.03 * kRange);

Kernel<double> ssim_window() {
  Kernel<double> gaussian;
  double sum = 0;
  for (int k = 0; k <= kSsimReach; ++k) {
    gaussian.taps.push_back(std::exp(-k * k / (2 * kSigma * kSigma)));
    sum += (k == 0 ? 1 : 2) * gaussian.taps.back();
  }
  for (double& tap : gaussian.taps) tap /= sum;
  return gaussian;
}

// Rows from..from + rows - 1 of an image, and `rows` rows of window means.
struct Moments {
  LumaPlane luma, mean, square;
};

class Windows {
 public:
  void look(const Image& image, int from, int rows, Moments& of) {
    resize(of.luma, image.width, rows + 2 * kSsimReach);
    const std::size_t first = image.index(0, from);
    for (std::size_t i = 0; i < of.luma.pixels.size(); ++i) {
      const Rgba8& p = image.pixels[first + i];
      of.luma.pixels[i] = 0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2];
    }
    average(of.luma, rows, of.mean);
    average_product(of, of, rows, of.square);
  }
  void average_product(const Moments& a, const Moments& b, int rows, LumaPlane& to) {
    resize(product_, a.luma.width, a.luma.height);
    for (std::size_t i = 0; i < product_.pixels.size(); ++i)
      product_.pixels[i] = a.luma.pixels[i] * b.luma.pixels[i];
    average(product_, rows, to);
  }

 private:
  void average(const LumaPlane& plane, int rows, LumaPlane& to) {
    convolve_along_columns(plane, window_, kSsimReach, rows, columns_);
    convolve_along_rows(columns_, window_, to);
  }

  Kernel<double> window_ = ssim_window();
  LumaPlane product_, columns_;
};

double sum_of_indices(const Moments& a, const Moments& b, const LumaPlane& both) {
  double sum = 0;
  for (int y = 0; y < both.height; ++y) {
    for (int x = kSsimReach; x < both.width - kSsimReach; ++x) {
      const std::size_t i = both.index(x, y);
      const double mean_a = a.mean.pixels[i], mean_b = b.mean.pixels[i];
      const double squares = mean_a * mean_a + mean_b * mean_b;
      const double variances = a.square.pixels[i] + b.square.pixels[i] - squares,
                   covariance = both.pixels[i] - mean_a * mean_b;
      sum += (2 * mean_a * mean_b + kC1) * (2 * covariance + kC2) /
             ((squares + kC1) * (variances + kC2));
    }
  }
  return sum;
}

}  // namespace

std::vector<double> ssim(const Image& reference, std::span<const Image* const> tests) {
  for (const Image* test : tests) require_same_size(reference, *test);
  const int width = reference.width - 2 * kSsimReach, height = reference.height - 2 * kSsimReach;
  if (width < 1 || height < 1)
    return std::vector<double>(tests.size(), std::numeric_limits<double>::quiet_NaN());
  std::vector<double> means(tests.size());
  Windows windows;
  Moments a, b;
  LumaPlane both;
  for (int from = 0; from < height; from += kBandRows) {
    const int rows = std::min(kBandRows, height - from);
    windows.look(reference, from, rows, a);
    for (std::size_t i = 0; i < tests.size(); ++i) {
      windows.look(*tests[i], from, rows, b);
      windows.average_product(a, b, rows, both);
      means[i] += sum_of_indices(a, b, both);
    }
  }
  for (double& mean : means) mean /= static_cast<double>(width) * height;
  return means;
}

double ssim(const Image& reference, const Image& test) {
  const Image* const tests[] = {&test};
  return ssim(reference, tests).front();
}

}  // namespace deburr::tb
