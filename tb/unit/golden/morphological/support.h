// SPDX-License-Identifier: MIT
// What the tests, the oracle and the benchmark of the morphological golden share: frames made from
// formulas, the contract's test images and hash, and frames turned round.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "golden/morphological/morphological_golden.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"

namespace deburr::tb::morphological {

using spec::morphological::Rgba8;

struct Frame {
  int width = 0, height = 0;
  std::vector<Rgba8> pixels;

  Frame() = default;
  Frame(int w, int h)
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  template <class Picture>  // Rgba8 picture(x, y), called in raster order
  Frame(int w, int h, Picture&& picture) : width(w), height(h) {
    for (int y = 0; y < h; ++y) {
      for (int x = 0; x < w; ++x) pixels.push_back(picture(x, y));
    }
  }

  Rgba8& at(int x, int y) {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
  const Rgba8& at(int x, int y) const { return const_cast<Frame*>(this)->at(x, y); }
  golden::morphological::ImageView view() const { return {pixels, width, height}; }
  friend bool operator==(const Frame&, const Frame&) = default;
};

inline Rgba8 grey(int code) {
  const auto c = static_cast<std::uint8_t>(code);
  return {c, c, c, 255};
}

inline Frame smooth(const spec::morphological::Parameters& parameters, const Frame& frame) {
  Frame result(frame.width, frame.height);
  golden::morphological::MorphologicalGolden golden(
      parameters, golden::morphological::MorphologicalGolden::Detail::kPixels);
  result.pixels = golden.process(frame.view());
  return result;
}

// ---- frames turned round ------------------------------------------------------------------------

inline Frame mirrored_x(const Frame& f) {
  return Frame(f.width, f.height, [&](int x, int y) { return f.at(f.width - 1 - x, y); });
}
inline Frame mirrored_y(const Frame& f) {
  return Frame(f.width, f.height, [&](int x, int y) { return f.at(x, f.height - 1 - y); });
}
inline Frame transposed(const Frame& f) {
  return Frame(f.height, f.width, [&](int x, int y) { return f.at(y, x); });
}
inline Frame inverted(const Frame& f) {
  return Frame(f.width, f.height, [&](int x, int y) {
    Rgba8 p = f.at(x, y);
    for (std::size_t c = 0; c < 3; ++c) p[c] = static_cast<std::uint8_t>(255 - p[c]);
    return p;
  });
}

// ---- the contract's test images (docs/number_formats_morphological.md, "Test vectors")
// -----------

class Sequence {
 public:
  std::uint32_t next() { return state_ = 1664525u * state_ + 1013904223u; }

 private:
  std::uint32_t state_ = 1;
};

inline Frame noise_image(int width = 97, int height = 61) {
  Sequence s;
  return Frame(width, height, [&](int, int) { return grey(s.next() >> 31 != 0 ? 255 : 0); });
}

inline Frame line_image() {
  return Frame(200, 150, [](int x, int y) {
    const int dx = 2 * x - 300, dy = 2 * y - 120;
    if (dx * dx + dy * dy < 6400) return grey(90);
    return grey(7 * (2 * x + 1) > 31 * (2 * y - 99) ? 255 : 0);
  });
}

inline Frame blocks_image(int width = 90, int height = 80) {
  Sequence s;
  return Frame(width, height, [&](int x, int y) {
    const std::uint32_t random = s.next();
    const int speck = (random >> 20 & 31) == 0 ? static_cast<int>(random >> 30) : 0;
    const int e = x / 23 + 2 * (y / 17) + ((x + 3 * y) % 41 < 9 ? 1 : 0) + speck;
    const int v = std::array<int, 4>{0, 60, 130, 255}[static_cast<std::size_t>(e & 3)];
    return Rgba8{static_cast<std::uint8_t>(v), static_cast<std::uint8_t>(255 - v),
                 static_cast<std::uint8_t>(3 * v % 256), 255};
  });
}

// R, G, B of all pixels.
inline std::uint64_t hash(const Frame& frame) {
  std::uint64_t h = 1469598103934665603u;
  for (const Rgba8& pixel : frame.pixels) {
    for (std::size_t c = 0; c < 3; ++c) h = (h ^ pixel[c]) * 1099511628211u;
  }
  return h;
}

// ---- a frame like a rendered one: discs and half-planes of flat colours over a gradient
// -----------

inline Frame rendered_like(int width, int height, int shapes) {
  struct Shape {
    std::int64_t x, y, radius, nx, ny;
    Rgba8 colour;
  };
  Sequence s;
  const auto below = [&](int n) { return static_cast<std::int64_t>(s.next() >> 8) % n; };
  Frame frame(width, height, [&](int x, int y) {
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
        if (dx * dx + dy * dy < r * r && dx * shape.nx + dy * shape.ny >= 0) {
          frame.at(static_cast<int>(x), static_cast<int>(y)) = shape.colour;
        }
      }
    }
  }
  return frame;
}

}  // namespace deburr::tb::morphological
