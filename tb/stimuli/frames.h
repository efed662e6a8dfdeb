// SPDX-License-Identifier: MIT
// Synthetic images, identical on every machine: the contract's test images, patterns with a given
// density of edges, and transformed images.
#pragma once

#include <cstdint>

#include "tb/base/random.h"
#include "tb/scene/image.h"

namespace deburr::tb::stimuli {

inline Rgba8 grey(int code) {
  const auto c = static_cast<std::uint8_t>(code);
  return {c, c, c, 255};
}

// Makes an image from Rgba8 picture(x, y), called in raster order.
template <class Picture>
Image draw(int width, int height, Picture&& picture) {
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.at(x, y) = picture(x, y);
  return image;
}

// ---- the contract's test images (docs/reference/morphological/vectors.md, "Test vectors") ------

// Generator of the contract's test images; advances before each value.
class Sequence {
 public:
  std::uint32_t next() { return state_ = 1664525u * state_ + 1013904223u; }

 private:
  std::uint32_t state_ = 1;
};

Image noise_image(int width = 97, int height = 61);
Image line_image(int width = 200, int height = 150);
Image blocks_image(int width = 90, int height = 80);
Image shades_image(int width = 90, int height = 80);
Image text_image(int width = 120, int height = 110);

// Hash of R, G and B of all pixels, as the contract defines it.
std::uint64_t hash(const Image& image);

// ---- patterns -----------------------------------------------------------------------------------

Image checkerboard(int width, int height);

// Random black and white pixels. On average `permille` of 1000 pixels have an edge to the left or
// above; at most 750, which is noise.
Image random_edges(int width, int height, int permille, std::uint64_t seed = 1);

// Adjacent diagonals of `thickness` pixels. One pixel in `thickness` has edges to the left and
// above, and every run is one pixel long and extended to the full N. Thickness 2 is the worst case
// of the predictors; thickness 1 would be a checkerboard, in which no run is followed.
Image diagonals(int width, int height, int thickness = 2);

// Bands of three rows in alternately darker and brighter greys, cut at random and often where the
// band above is cut. Runs end with every crossing code at any distance.
Image bands(int width, int height, Random& random);

// A horizontal run of `length` pixels between two steps of a stair, and one between both ends of a
// bar on a floor.
Image long_step(int length);
Image long_bar(int length);

// Resembles a rendered image: parts of flat-coloured discs over a gradient.
Image rendered_like(int width, int height, int shapes);

// ---- transformed images
// --------------------------------------------------------------------------

Image mirrored_x(const Image& image);
Image mirrored_y(const Image& image);
Image transposed(const Image& image);
Image inverted(const Image& image);  // 255 - R, G, B

}  // namespace deburr::tb::stimuli
