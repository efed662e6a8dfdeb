// SPDX-License-Identifier: MIT
#include "tb/scene/flip.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <utility>

#include "tb/scene/convolution.h"
#include "tb/scene/quality.h"

namespace deburr::tb {
namespace {

using Plane = ImageOf<float>;
using Triple = std::array<double, 3>;

// ---- colours (section 4.1) ----------------------------------------------------------------------

// XYZ of linear R, G and B; their sum is the XYZ of white.
constexpr std::array<Triple, 3> kXyzFromRgb = {
    {{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
     {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
     {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}}};

// Linear RGB to XYZ relative to white: each row sums to 1.
std::array<Triple, 3> relative_xyz() {
  std::array<Triple, 3> rows = kXyzFromRgb;
  for (Triple& row : rows) {
    const double white = row[0] + row[1] + row[2];
    for (double& value : row) value /= white;
  }
  return rows;
}

std::array<Triple, 3> inverse(const std::array<Triple, 3>& m) {
  std::array<Triple, 3> result{};
  const auto cofactor = [&](std::size_t r, std::size_t c) {
    const std::size_t r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
    return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
  };
  const double determinant =
      m[0][0] * cofactor(0, 0) + m[0][1] * cofactor(0, 1) + m[0][2] * cofactor(0, 2);
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) result[c][r] = cofactor(r, c) / determinant;
  return result;
}

// Linear light of a code, by sRGB's curve.
std::array<float, 256> linear_of_codes() {
  std::array<float, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i) {
    const double v = static_cast<double>(i) / 255;
    linear[i] = static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
  }
  return linear;
}

// Branch-free cube root for values above (6/29)^3 = 0.00886, accurate to one bit of single
// precision.
float cube_root(float value) {
  // Divides exponent and mantissa by three in one integer division, with the error centred.
  auto bits = std::bit_cast<std::uint32_t>(value);
  bits = bits / 3 + 709921077u;
  const auto closer = [value](float root) {
    return (2 * root + value / (root * root)) * (1.0f / 3);
  };
  return closer(closer(closer(std::bit_cast<float>(bits))));
}

// The curve of L*a*b*, without a branch.
float lab_curve(float value) {
  constexpr float kDelta = 6.0f / 29;
  const float above = cube_root(std::max(value, kDelta * kDelta * kDelta)),
              below = value / (3 * kDelta * kDelta) + 4.0f / 29;
  return value > kDelta * kDelta * kDelta ? above : below;
}

// L*a*b* from XYZ relative to white, with the Hunt effect: chroma weighs less in dark colours.
std::array<float, 3> hunt_lab(float x, float y, float z) {
  const float lightness = 116 * y - 16;
  return {lightness, 0.01f * lightness * 500 * (x - y), 0.01f * lightness * 200 * (y - z)};
}

// ---- colour error (section 4.1.3)
// ----------------------------------------------------------------

constexpr float kColourExponent = 0.7f;           // q_c
constexpr float kKneeAt = 0.4f, kKneeTo = 0.95f;  // p_c, p_t

float hyab(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

// The largest possible error: pure green against pure blue.
float largest_colour_error() {
  const std::array<Triple, 3> xyz = relative_xyz();
  const auto pure = [&](std::size_t channel) {
    return hunt_lab(lab_curve(static_cast<float>(xyz[0][channel])),
                    lab_curve(static_cast<float>(xyz[1][channel])),
                    lab_curve(static_cast<float>(xyz[2][channel])));
  };
  return std::pow(hyab(pure(1), pure(2)), kColourExponent);
}

// Result in 0..1; the first 40 % of the error range maps to 95 % of the output range.
float redistributed(float error, float largest) {
  const float knee = kKneeAt * largest;
  return error < knee ? error * kKneeTo / knee
                      : kKneeTo + (error - knee) / (largest - knee) * (1 - kKneeTo);
}

// ---- contrast sensitivity (section 4.1.1)
// --------------------------------------------------------

// a sqrt(pi / b) exp(-pi^2 r^2 / b), r in degrees.
struct Sensitivity {
  double a, b;
};
constexpr Sensitivity kAchromatic = {1, 0.0047}, kRedGreen = {1, 0.0053};
constexpr std::array<Sensitivity, 2> kBlueYellow = {{{34.1, 0.04}, {13.5, 0.025}}};
constexpr double kWidestB = 0.04;

// Three standard deviations of the widest Gaussian.
int sensitivity_reach(double pixels_per_degree) {
  return static_cast<int>(std::ceil(
      3 * std::sqrt(kWidestB / (2 * std::numbers::pi * std::numbers::pi)) * pixels_per_degree));
}

Kernel<double> gaussian_of(double b, double pixels_per_degree) {
  Kernel<double> kernel;
  for (int k = 0; k <= sensitivity_reach(pixels_per_degree); ++k) {
    const double degrees = k / pixels_per_degree;
    kernel.taps.push_back(std::exp(-std::numbers::pi * std::numbers::pi * degrees * degrees / b));
  }
  return kernel;
}

double sum_of(const Kernel<double>& kernel) {
  return 2 * std::accumulate(kernel.taps.begin(), kernel.taps.end(), 0.0) - kernel.taps[0];
}

// The kernel in single precision, without taps that are too small to change a sum.
Kernel<float> scaled(const Kernel<double>& kernel, double factor) {
  constexpr double kNothing = 1e-10;
  Kernel<float> result{{}, kernel.odd};
  for (const double tap : kernel.taps) result.taps.push_back(static_cast<float>(tap * factor));
  while (result.taps.size() > 1 && std::abs(result.taps.back()) < kNothing) result.taps.pop_back();
  return result;
}

// The two Gaussians of the blue-yellow channel, with weights that normalise the tap sum to 1.
std::array<double, 2> blue_yellow_shares(double pixels_per_degree) {
  std::array<double, 2> shares{};
  for (std::size_t i = 0; i < 2; ++i) {
    const double sum = sum_of(gaussian_of(kBlueYellow[i].b, pixels_per_degree));
    shares[i] = kBlueYellow[i].a * std::sqrt(std::numbers::pi / kBlueYellow[i].b) * sum * sum;
  }
  const double both = shares[0] + shares[1];
  return {shares[0] / both, shares[1] / both};
}

Kernel<float> passing(const Sensitivity& sensitivity, double pixels_per_degree) {
  const Kernel<double> kernel = gaussian_of(sensitivity.b, pixels_per_degree);
  return scaled(kernel, 1 / sum_of(kernel));
}

// ---- edges and points (section 4.2)
// --------------------------------------------------------------

constexpr double kFeatureWidth = 0.082;   // w, degrees: width of a visible edge
constexpr float kFeatureExponent = 0.5f;  // q_f

struct FeatureKernels {
  Kernel<float> smooth, edge, point;
};

// A Gaussian and its derivatives, scaled so that positive taps sum to 1 and negative ones to -1.
FeatureKernels feature_kernels(double pixels_per_degree) {
  const double deviation = 0.5 * kFeatureWidth * pixels_per_degree;
  Kernel<double> smooth, edge{{}, true}, point;
  for (int k = 0; k <= static_cast<int>(std::ceil(3 * deviation)); ++k) {
    const double g = std::exp(-k * k / (2 * deviation * deviation));
    smooth.taps.push_back(g);
    edge.taps.push_back(k * g);
    point.taps.push_back((k * k / (deviation * deviation) - 1) * g);
  }
  double positive = 0, negative = 0;
  for (std::size_t k = 0; k < point.taps.size(); ++k)
    (point.taps[k] > 0 ? positive : negative) += (k == 0 ? 1 : 2) * std::abs(point.taps[k]);
  for (double& tap : point.taps) tap /= tap > 0 ? positive : negative;
  return {scaled(smooth, 1 / sum_of(smooth)),
          scaled(edge, 1 / std::accumulate(edge.taps.begin(), edge.taps.end(), 0.0)),
          scaled(point, 1)};
}

// ---- images
// --------------------------------------------------------------------------------------

// The perceived colours and features of some rows of an image.
struct Seen {
  std::array<Plane, 3> colour;  // L*a*b* with the Hunt effect
  Plane edge, point;            // feature strengths
};

class Eye {
 public:
  explicit Eye(double pixels_per_degree)
      : achromatic_(passing(kAchromatic, pixels_per_degree)),
        red_green_(passing(kRedGreen, pixels_per_degree)),
        blue_yellow_{passing(kBlueYellow[0], pixels_per_degree),
                     passing(kBlueYellow[1], pixels_per_degree)},
        features_(feature_kernels(pixels_per_degree)) {
    const std::array<double, 2> shares = blue_yellow_shares(pixels_per_degree);
    for (std::size_t i = 0; i < 2; ++i) blue_yellow_shares_[i] = static_cast<float>(shares[i]);
    for (const Kernel<float>* kernel :
         {&achromatic_, &red_green_, &blue_yellow_[0], &blue_yellow_[1], &features_.smooth})
      reach_ = std::max(reach_, kernel->reach());
  }

  // Rows from..from + rows - 1.
  void look(const Image& image, int from, int rows, Seen& seen) {
    convert(image, from, rows);
    convolve_along_rows(y_, features_.smooth, along_);
    convolve_along_columns(y_, features_.smooth, reach_, rows, across_);
    see_feature(features_.edge, rows, seen.edge);
    see_feature(features_.point, rows, seen.point);
    see_through(y_, achromatic_, rows, seen.colour[0]);
    see_through(cx_, red_green_, rows, seen.colour[1]);
    see_through(cz_, blue_yellow_[0], rows, seen.colour[2]);
    see_through(cz_, blue_yellow_[1], rows, across_);
    for (std::size_t i = 0; i < across_.pixels.size(); ++i)
      seen.colour[2].pixels[i] = blue_yellow_shares_[0] * seen.colour[2].pixels[i] +
                                 blue_yellow_shares_[1] * across_.pixels[i];
    colours(seen.colour);
  }

 private:
  using Matrix = std::array<std::array<float, 3>, 3>;
  static Matrix single(const std::array<Triple, 3>& m) {
    Matrix result{};
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c) result[r][c] = static_cast<float>(m[r][c]);
    return result;
  }
  static float times(const std::array<float, 3>& row, float a, float b, float c) {
    return row[0] * a + row[1] * b + row[2] * c;
  }

  // Y, X - Y and Y - Z relative to white: YCxCz without its factors and offset, which averaging
  // preserves. Rows beyond the border repeat the outermost row.
  void convert(const Image& image, int from, int rows) {
    for (Plane* plane : {&y_, &cx_, &cz_}) resize(*plane, image.width, rows + 2 * reach_);
    float *const first = y_.pixels.data(), *const second = cx_.pixels.data(),
                 *const third = cz_.pixels.data();
    std::size_t n = 0;
    for (int row = from - reach_; row < from + rows + reach_; ++row) {
      const Rgba8* pixel = &image.at(0, std::clamp(row, 0, image.height - 1));
      for (int x = 0; x < image.width; ++x, ++n, ++pixel) {
        first[n] = linear_[(*pixel)[0]];
        second[n] = linear_[(*pixel)[1]];
        third[n] = linear_[(*pixel)[2]];
      }
    }
    const Matrix to_xyz = to_xyz_;
    for (std::size_t i = 0; i < n; ++i) {
      const float r = first[i], g = second[i], b = third[i], y = times(to_xyz[1], r, g, b);
      first[i] = y;
      second[i] = times(to_xyz[0], r, g, b) - y;
      third[i] = y - times(to_xyz[2], r, g, b);
    }
  }

  void see_through(const Plane& plane, const Kernel<float>& kernel, int rows, Plane& to) {
    convolve_along_columns(plane, kernel, reach_, rows, columns_);
    convolve_along_rows(columns_, kernel, to);
  }

  // Magnitude of the kernel's responses along x and y, each smoothed along the other axis.
  void see_feature(const Kernel<float>& kernel, int rows, Plane& length) {
    convolve_along_columns(along_, kernel, reach_, rows, columns_);
    convolve_along_rows(across_, kernel, length);
    for (std::size_t i = 0; i < length.pixels.size(); ++i)
      length.pixels[i] =
          std::sqrt(length.pixels[i] * length.pixels[i] + columns_.pixels[i] * columns_.pixels[i]);
  }

  // Converts filtered planes to L*a*b*. Colours out of gamut are clamped per channel. Each step
  // processes many pixels, so that the compiler can vectorise it.
  void colours(std::array<Plane, 3>& planes) const {
    const std::size_t n = planes[0].pixels.size();
    float *const first = planes[0].pixels.data(), *const second = planes[1].pixels.data(),
                 *const third = planes[2].pixels.data();
    const Matrix to_rgb = to_rgb_, to_xyz = to_xyz_;
    for (std::size_t i = 0; i < n; ++i) {
      const float y = first[i], x = y + second[i], z = y - third[i];
      const auto shown = [&](std::size_t c) {
        return std::clamp(times(to_rgb[c], x, y, z), 0.0f, 1.0f);
      };
      const float r = shown(0), g = shown(1), b = shown(2);
      first[i] = times(to_xyz[0], r, g, b);
      second[i] = times(to_xyz[1], r, g, b);
      third[i] = times(to_xyz[2], r, g, b);
    }
    for (Plane& plane : planes)
      for (float& value : plane.pixels) value = lab_curve(value);
    for (std::size_t i = 0; i < n; ++i) {
      const std::array<float, 3> lab = hunt_lab(first[i], second[i], third[i]);
      first[i] = lab[0];
      second[i] = lab[1];
      third[i] = lab[2];
    }
  }

  const std::array<float, 256> linear_ = linear_of_codes();
  const Matrix to_xyz_ = single(relative_xyz()), to_rgb_ = single(inverse(relative_xyz()));
  const Kernel<float> achromatic_, red_green_;
  const std::array<Kernel<float>, 2> blue_yellow_;
  std::array<float, 2> blue_yellow_shares_{};
  const FeatureKernels features_;
  int reach_ = 0;
  Plane y_, cx_, cz_, along_, across_, columns_;
};

float error_of(const Seen& a, const Seen& b, std::size_t i, float largest) {
  const auto lab = [i](const Seen& of) {
    return std::array<float, 3>{of.colour[0].pixels[i], of.colour[1].pixels[i],
                                of.colour[2].pixels[i]};
  };
  const float distance = hyab(lab(a), lab(b));
  if (distance == 0) return 0;
  const float colour = redistributed(std::pow(distance, kColourExponent), largest);
  const float features = std::max(std::abs(a.edge.pixels[i] - b.edge.pixels[i]),
                                  std::abs(a.point.pixels[i] - b.point.pixels[i]));
  return std::pow(colour, 1 - std::pow(features / std::numbers::sqrt2_v<float>, kFeatureExponent));
}

// Calls each(test, pixel, error) for every pixel of every test image.
template <class Each>
void for_each_error(const Image& reference, std::span<const Image* const> tests,
                    double pixels_per_degree, Each each) {
  for (const Image* test : tests) require_same_size(reference, *test);
  const float largest = largest_colour_error();
  Eye eye(pixels_per_degree);
  Seen a, b;
  for (int from = 0; from < reference.height; from += kBandRows) {
    const int rows = std::min(kBandRows, reference.height - from);
    const std::size_t first = reference.index(0, from);
    eye.look(reference, from, rows, a);
    for (std::size_t t = 0; t < tests.size(); ++t) {
      eye.look(*tests[t], from, rows, b);
      for (std::size_t i = 0; i < b.edge.pixels.size(); ++i)
        each(t, first + i, error_of(a, b, i, largest));
    }
  }
}

}  // namespace

std::vector<double> flip(const Image& reference, std::span<const Image* const> tests,
                         double pixels_per_degree) {
  std::vector<double> means(tests.size());
  for_each_error(reference, tests, pixels_per_degree,
                 [&](std::size_t test, std::size_t, float error) {
                   means[test] += static_cast<double>(error);
                 });
  for (double& mean : means) mean /= static_cast<double>(reference.pixels.size());
  return means;
}

double flip(const Image& reference, const Image& test, double pixels_per_degree) {
  const Image* const tests[] = {&test};
  return flip(reference, tests, pixels_per_degree).front();
}

ImageOf<float> flip_map(const Image& reference, const Image& test, double pixels_per_degree) {
  ImageOf<float> map(reference.width, reference.height);
  const Image* const tests[] = {&test};
  for_each_error(reference, tests, pixels_per_degree,
                 [&](std::size_t, std::size_t pixel, float error) { map.pixels[pixel] = error; });
  return map;
}

}  // namespace deburr::tb
