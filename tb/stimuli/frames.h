// SPDX-License-Identifier: MIT
// Pictures from formulas, the same on every machine: the contract's test images, patterns with a
// given share of edges, and pictures turned round.
#pragma once

#include <cstdint>

#include "tb/base/random.h"
#include "tb/scene/image.h"

namespace deburr::tb::stimuli {

inline Rgba8 grey(int code) {
  const auto c = static_cast<std::uint8_t>(code);
  return {c, c, c, 255};
}

// Rgba8 picture(x, y), called in raster order.
template <class Picture>
Image draw(int width, int height, Picture&& picture) {
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.at(x, y) = picture(x, y);
  return image;
}

// ---- the contract's test images (docs/reference/morphological/vectors.md, "Test vectors") ------

// Their generator, advanced before it is read.
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

// R, G, B of all pixels, as the contract adds them up.
std::uint64_t hash(const Image& image);

// ---- patterns -----------------------------------------------------------------------------------

Image checkerboard(int width, int height);

// Black and white at random, so that `permille` of all pixels, on average, have an edge to the left
// or above; 750 at most, which is noise.
Image random_edges(int width, int height, int permille, std::uint64_t seed = 1);

// Diagonals of `thickness` pixels side by side: one pixel in `thickness` has an edge, to the left
// and above, and every run is a pixel long and extended to the full N. Of two pixels, the worst
// that predictors can meet; of one it would be a checkerboard, which no run follows.
Image diagonals(int width, int height, int thickness = 2);

// Bands of three rows, of darker and of brighter greys in turn, cut at random and often where the
// band above is cut as well: runs end at every crossing code, at any distance.
Image bands(int width, int height, Random& random);

// A horizontal run of `length` pixels between two steps of a stair; the same between both ends of a
// bar on a floor.
Image long_step(int length);
Image long_bar(int length);

// Like a rendered picture: pieces of discs of flat colours over a gradient.
Image rendered_like(int width, int height, int shapes);

// ---- pictures turned round ----------------------------------------------------------------------

Image mirrored_x(const Image& image);
Image mirrored_y(const Image& image);
Image transposed(const Image& image);
Image inverted(const Image& image);  // 255 - R, G, B

}  // namespace deburr::tb::stimuli
