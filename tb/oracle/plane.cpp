// SPDX-License-Identifier: MIT
#include "tb/oracle/plane.h"

#include <cmath>

#include "spec/error.h"

namespace deburr::tb::texture {

std::int32_t fixed(double coordinate) {
  return static_cast<std::int32_t>(std::lround(coordinate * spec::texture::kCoordinateOne));
}

spec::texture::Quad CoordinateImage::quad(int x, int y) const {
  spec::texture::Quad quad;
  quad.x = static_cast<std::uint16_t>(x);
  quad.y = static_cast<std::uint16_t>(y);
  for (std::size_t lane = 0; lane < 4; ++lane) {
    const std::size_t i =
        (static_cast<std::size_t>(y) + (lane >> 1)) * static_cast<std::size_t>(width) +
        static_cast<std::size_t>(x) + (lane & 1);
    quad.s[lane] = s[i];
    quad.t[lane] = t[i];
  }
  return quad;
}

void PlaneView::coordinates(double x, double y, double& s_out, double& t_out) const {
  const double depth = (height + horizon) / (y + horizon);  // 1 at the nearest row
  const double across = repeats * depth * (x - 0.5 * width) / width;
  const double away = repeats * depth;
  s_out = s + std::cos(turn) * across + std::sin(turn) * away;
  t_out = t - std::sin(turn) * across + std::cos(turn) * away;
}

CoordinateImage plane(const PlaneView& view) {
  DEBURR_CHECK(view.width % 2 == 0 && view.height % 2 == 0, "an image is made of 2 x 2 quads");
  CoordinateImage image{view.width, view.height, {}, {}};
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      double s = 0.0;
      double t = 0.0;
      view.coordinates(x + 0.5, y + 0.5, s, t);
      image.s.push_back(fixed(s));
      image.t.push_back(fixed(t));
    }
  }
  return image;
}

CoordinateImage quads_image(const std::vector<spec::texture::Quad>& quads) {
  constexpr std::size_t kQuadsInRow = 32;
  DEBURR_CHECK(quads.size() % kQuadsInRow == 0, "the last row of quads must be full");
  CoordinateImage image{
      2 * static_cast<int>(kQuadsInRow), 2 * static_cast<int>(quads.size() / kQuadsInRow),
      std::vector<std::int32_t>(4 * quads.size()), std::vector<std::int32_t>(4 * quads.size())};
  for (std::size_t i = 0; i < quads.size(); ++i) {
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const std::size_t x = 2 * (i % kQuadsInRow) + (lane & 1);
      const std::size_t y = 2 * (i / kQuadsInRow) + (lane >> 1);
      image.s[y * 2 * kQuadsInRow + x] = quads[i].s[lane];
      image.t[y * 2 * kQuadsInRow + x] = quads[i].t[lane];
    }
  }
  return image;
}

Pixels filter_image(const CoordinateImage& image, const QuadFilter& filter) {
  Pixels pixels(image.s.size());
  for (int y = 0; y < image.height; y += 2) {
    for (int x = 0; x < image.width; x += 2) {
      const auto colours = filter(image.quad(x, y));
      for (std::size_t lane = 0; lane < 4; ++lane)
        pixels[(static_cast<std::size_t>(y) + (lane >> 1)) * static_cast<std::size_t>(image.width) +
               static_cast<std::size_t>(x) + (lane & 1)] = colours[lane];
    }
  }
  return pixels;
}

std::vector<golden::ideal::Rgba> plane_reference(const PlaneView& view,
                                                 const golden::ideal::Texture& texture, int n) {
  golden::ideal::Sampler sampler;
  sampler.min_filter = spec::texture::MinFilter::kLinear;
  std::vector<golden::ideal::Rgba> reference;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      golden::ideal::Rgba sum{};
      for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
          golden::ideal::Fragment f;
          view.coordinates(x + (i + 0.5) / n, y + (j + 0.5) / n, f.s, f.t);
          const golden::ideal::Rgba colour = exact_colour(texture, sampler, f);
          for (std::size_t c = 0; c < 4; ++c) sum[c] += colour[c] / (n * n);
        }
      }
      reference.push_back(sum);
    }
  }
  return reference;
}

double rms(const Pixels& pixels, const std::vector<golden::ideal::Rgba>& reference) {
  DEBURR_CHECK(pixels.size() == reference.size() && !reference.empty(), "images differ in size");
  double sum = 0.0;
  for (std::size_t i = 0; i < pixels.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      sum += (pixels[i][c] - reference[i][c]) * (pixels[i][c] - reference[i][c]);
  return std::sqrt(sum / (3.0 * static_cast<double>(pixels.size())));
}

}  // namespace deburr::tb::texture
