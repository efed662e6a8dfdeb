// SPDX-License-Identifier: MIT
#include "tb/stimuli/frames.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "spec/error.h"
#include "tb/base/random.h"
#include "tb/stimuli/vector_hash.h"

namespace deburr::tb::stimuli {

Image noise_image(int width, int height) {
  Sequence s;
  return draw(width, height, [&](int, int) { return grey(s.next() >> 31 != 0 ? 255 : 0); });
}

Image line_image(int width, int height) {
  return draw(width, height, [](int x, int y) {
    const int dx = 2 * x - 300, dy = 2 * y - 120;
    if (dx * dx + dy * dy < 6400) return grey(90);
    return grey(7 * (2 * x + 1) > 31 * (2 * y - 99) ? 255 : 0);
  });
}

Image blocks_image(int width, int height) {
  Sequence s;
  return draw(width, height, [&](int x, int y) {
    const std::uint32_t random = s.next();
    const int speck = (random >> 20 & 31) == 0 ? static_cast<int>(random >> 30) : 0;
    const int e = x / 23 + 2 * (y / 17) + ((x + 3 * y) % 41 < 9 ? 1 : 0) + speck;
    const int v = std::array<int, 4>{0, 60, 130, 255}[static_cast<std::size_t>(e & 3)];
    return Rgba8{static_cast<std::uint8_t>(v), static_cast<std::uint8_t>(255 - v),
                 static_cast<std::uint8_t>(3 * v % 256), 255};
  });
}

Image shades_image(int width, int height) {
  Sequence s;
  return draw(width, height, [&](int x, int y) {
    const int e = x / 11 + 2 * (y / 9) + ((x + 3 * y) % 41 < 9 ? 1 : 0);
    const int v = std::array<int, 8>{0, 1, 3, 7, 20, 24, 90, 110}[static_cast<std::size_t>(e & 7)];
    return grey(v + static_cast<int>(s.next() >> 31));
  });
}

Image text_image(int width, int height) {
  Sequence s;
  return draw(width, height, [&](int x, int y) {
    const std::uint32_t random = s.next();
    const int k = y < 70 ? 1 : 4, u = x / k, w = y / k, i = u % 6, j = w % 9, a = u / 6, b = w / 9;
    const bool letter = i < 5 && j < 7 && (i == (a + 2 * b) % 5 || j == (2 * a + b) % 7);
    Rgba8 pixel = {250, 240, 230, 255};
    if (x < 96 ? letter : y % 4 == 0) pixel = {30, 50, 70, 255};
    if (35 <= y && y < 70 && (random >> 20 & 31) == 0)
      pixel[0] = static_cast<std::uint8_t>(pixel[0] + (random >> 30));
    return pixel;
  });
}

std::uint64_t hash(const Image& image) {
  VectorHash hash;
  for (const Rgba8& pixel : image.pixels)
    for (std::size_t c = 0; c < 3; ++c) hash.byte(pixel[c]);
  return hash.value();
}

Image checkerboard(int width, int height) {
  return draw(width, height, [](int x, int y) { return grey((x + y) % 2 != 0 ? 255 : 0); });
}

Image random_edges(int width, int height, int permille, std::uint64_t seed) {
  DEBURR_CHECK(permille >= 0 && permille <= 750, "at most 750 of 1000 pixels can have an edge");
  // A pixel is white with probability w and has an edge unless its left and upper neighbours have
  // its colour: 1 - w^3 - (1 - w)^3 = 3 w (1 - w) of all pixels.
  const double white = (1 - std::sqrt(1 - permille / 750.0)) / 2;
  const auto limit = static_cast<std::uint64_t>(std::llround(std::ldexp(white, 32)));
  Random random(seed);
  return draw(width, height, [&](int, int) { return grey(random.word() < limit ? 255 : 0); });
}

Image diagonals(int width, int height, int thickness) {
  return draw(width, height,
              [=](int x, int y) { return grey((x + y) / thickness % 2 != 0 ? 255 : 0); });
}

Image bands(int width, int height, Random& random) {
  Image image(width, height);
  std::vector<bool> above(static_cast<std::size_t>(width)), cuts = above;
  for (int y0 = 0; y0 < height; y0 += 3) {
    const std::uint32_t rare = 1 + random.below(60);
    int code = 0;
    for (int x = 0; x < width; ++x) {
      const auto i = static_cast<std::size_t>(x);
      cuts[i] = (above[i] && random.chance(500)) || random.below(rare) == 0;
      if (x == 0 || cuts[i]) code = (code + 1 + static_cast<int>(random.below(2))) % 3;
      for (int y = y0; y < std::min(y0 + 3, height); ++y)
        image.at(x, y) = grey(40 * code + (y0 / 3 % 2 == 0 ? 0 : 135));
    }
    above = cuts;
  }
  return image;
}

Image long_step(int length) {
  return draw(length + 2, 4, [length](int x, int y) {
    return grey(y == 3 || (y == 2 && x > 0) || (y == 1 && x > length) ? 255 : 0);
  });
}

Image long_bar(int length) {
  return draw(length + 2, 3, [length](int x, int y) {
    return grey(y == 2 || (y == 1 && x > 0 && x <= length) ? 255 : 0);
  });
}

Image rendered_like(int width, int height, int shapes) {
  struct Shape {
    std::int64_t x, y, radius, nx, ny;
    Rgba8 colour;
  };
  Sequence s;
  const auto below = [&](int n) { return static_cast<std::int64_t>(s.next() >> 8) % n; };
  Image image = draw(width, height, [&](int x, int y) {
    return Rgba8{static_cast<std::uint8_t>(64 + 64 * x / width),
                 static_cast<std::uint8_t>(64 + 64 * y / height), 96, 255};
  });
  for (int i = 0; i < shapes; ++i) {
    Shape shape{below(width), below(height), 5 + below(30), below(41) - 20, below(41) - 20, {}};
    for (std::size_t c = 0; c < 3; ++c) shape.colour[c] = static_cast<std::uint8_t>(s.next() >> 24);
    shape.colour[3] = 255;
    const std::int64_t r = shape.radius;
    for (std::int64_t y = std::max<std::int64_t>(0, shape.y - r);
         y < std::min<std::int64_t>(height, shape.y + r); ++y) {
      for (std::int64_t x = std::max<std::int64_t>(0, shape.x - r);
           x < std::min<std::int64_t>(width, shape.x + r); ++x) {
        const std::int64_t dx = x - shape.x, dy = y - shape.y;
        if (dx * dx + dy * dy < r * r && dx * shape.nx + dy * shape.ny >= 0)
          image.at(static_cast<int>(x), static_cast<int>(y)) = shape.colour;
      }
    }
  }
  return image;
}

Image mirrored_x(const Image& image) {
  return draw(image.width, image.height,
              [&](int x, int y) { return image.at(image.width - 1 - x, y); });
}
Image mirrored_y(const Image& image) {
  return draw(image.width, image.height,
              [&](int x, int y) { return image.at(x, image.height - 1 - y); });
}
Image transposed(const Image& image) {
  return draw(image.height, image.width, [&](int x, int y) { return image.at(y, x); });
}
Image inverted(const Image& image) {
  return draw(image.width, image.height, [&](int x, int y) {
    Rgba8 p = image.at(x, y);
    for (std::size_t c = 0; c < 3; ++c) p[c] = static_cast<std::uint8_t>(255 - p[c]);
    return p;
  });
}

}  // namespace deburr::tb::stimuli
