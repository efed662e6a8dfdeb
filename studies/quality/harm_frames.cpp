// SPDX-License-Identifier: MIT
#include "studies/quality/harm_frames.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include "spec/error.h"
#include "tb/base/random.h"
#include "tb/scene/compose.h"
#include "tb/scene/convolution.h"
#include "tb/scene/image_io.h"
#include "tb/scene/label.h"
#include "tb/scene/reference.h"
#include "tb/scene/textures.h"
#include "tb/stimuli/frames.h"

namespace deburr::studies::harm {

using tb::Image;
using tb::ImageOf;
using tb::Random;
using tb::Rgba8;

namespace {

using Imath::V2d;
using Imath::V3d;

std::uint8_t code(double value) {
  return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
}

// ---- the hall -----------------------------------------------------------------------------------

class Hall {
 public:
  Hall() {
    mesh_.name = "hall";
    const int stones = texture("stones", 3), bricks = texture("brick", 5),
              planks = texture("road", 7);
    const int tiles =
        add({"tiles", tb::checkerboard(256, 256, 16, {170, 150, 130, 255}, {140, 125, 112, 255})});
    const int marble = texture("stones", 11);
    const std::uint32_t floor = material({0.9, 0.9, 0.9}, stones),
                        wall = material({1, 0.95, 0.9}, bricks),
                        pillar = material({0.9, 0.95, 1}, marble),
                        crate = material({1, 0.8, 0.6}, planks), ledge = material({1, 1, 1}, tiles);
    const double w = 8, d = 12, h = 5;
    quad({-w, 0, d}, {2 * w, 0, 0}, {0, 0, -2 * d}, floor, 6, 9);
    quad({-w, 0, -d}, {2 * w, 0, 0}, {0, h, 0}, wall, 5, 1.6);
    quad({-w, 0, d}, {0, 0, -2 * d}, {0, h, 0}, wall, 8, 1.6);
    quad({w, 0, -d}, {0, 0, 2 * d}, {0, h, 0}, wall, 8, 1.6);
    for (const int row : {-1, 1})
      for (int i = 0; i < 5; ++i)
        prism({row * 4.5, 0, 8.0 - 4 * i}, 0.45, 4.4, 14, 0.1 * i, pillar, ledge);
    for (const auto& [x, z, size, turn] : {std::array{-1.5, 4.0, 1.3, 0.4},
                                           {1.9, 1.0, 1.0, 1.1},
                                           {-0.4, -3.2, 1.6, 0.75},
                                           {2.6, -6.0, 1.2, 0.2},
                                           {-2.8, -1.0, 0.8, 1.3}})
      prism({x, 0, z}, size * 0.7, size, 4, turn, crate, crate);
  }
  tb::Mesh mesh() && { return std::move(mesh_); }

 private:
  int add(tb::Texture texture) {
    mesh_.textures.push_back(std::move(texture));
    return static_cast<int>(mesh_.textures.size()) - 1;
  }
  int texture(const std::string& name, std::uint32_t seed) {
    return add({name, tb::make_texture(name, 512, 512, seed)});
  }
  std::uint32_t material(const V3d& colour, int texture) {
    mesh_.materials.push_back({"", colour, texture});
    return static_cast<std::uint32_t>(mesh_.materials.size() - 1);
  }
  // Corners counter-clockwise; texture repeats along both sides.
  void quad(const V3d& corner, const V3d& along, const V3d& up, std::uint32_t of, double repeats_s,
            double repeats_t) {
    const V3d normal = along.cross(up).normalized();
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (const auto& [s, t] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}})
      mesh_.vertices.push_back(
          {corner + along * s + up * t, normal, V2d(repeats_s * s, repeats_t * (1 - t))});
    mesh_.triangles.push_back({{first, first + 1, first + 2}, of});
    mesh_.triangles.push_back({{first, first + 2, first + 3}, of});
  }
  // Upright, with a lid.
  void prism(const V3d& foot, double radius, double height, int sides, double turn,
             std::uint32_t side, std::uint32_t lid) {
    const auto corner = [&](int i) {
      const double angle = turn + 2 * std::numbers::pi * i / sides;
      return foot + V3d(radius * std::sin(angle), 0, radius * std::cos(angle));
    };
    const V3d up(0, height, 0), middle = foot + up;
    for (int i = 0; i < sides; ++i) {
      const V3d along = corner(i + 1) - corner(i);
      quad(corner(i), along, up, side, along.length(), height);
      const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
      for (const V3d& at : {middle, corner(i) + up, corner(i + 1) + up})
        mesh_.vertices.push_back({at, V3d(0, 1, 0), V2d(at.x, at.z)});
      mesh_.triangles.push_back({{first, first + 1, first + 2}, lid});
    }
  }

  tb::Mesh mesh_;
};

// ---- noise --------------------------------------------------------------------------------------

// Smooth noise over the plane, 0..1: one octave, and several with halving amplitude.
double lattice(int x, int y, std::uint64_t seed) {
  Random random(seed + static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) * 0x1F123BB5ULL +
                static_cast<std::uint64_t>(static_cast<std::uint32_t>(y)) * 0x9E3779B97F4AULL);
  return random.uniform(0, 1);
}
double smooth_noise(double x, double y, std::uint64_t seed) {
  const double fx = std::floor(x), fy = std::floor(y);
  const auto ease = [](double t) { return t * t * (3 - 2 * t); };
  const int i = static_cast<int>(fx), j = static_cast<int>(fy);
  const double u = ease(x - fx), v = ease(y - fy);
  return std::lerp(std::lerp(lattice(i, j, seed), lattice(i + 1, j, seed), u),
                   std::lerp(lattice(i, j + 1, seed), lattice(i + 1, j + 1, seed), u), v);
}
double fractal(double x, double y, int octaves, std::uint64_t seed) {
  double sum = 0, all = 0, weight = 1;
  for (int i = 0; i < octaves; ++i, weight *= 0.6) {
    sum += weight * smooth_noise(x, y, seed + static_cast<std::uint64_t>(i) * 7919);
    all += weight;
    x *= 2;
    y *= 2;
  }
  return sum / all;
}

// ---- a camera -----------------------------------------------------------------------------------

using Light = std::array<double, 3>;  // as codes, 0..255, linear up to white

// The picture light(x, y) with 4 x 4 samples per pixel, a lens blur and sensor noise.
template <class Scenery>
Image photo(int width, int height, std::uint64_t seed, Scenery light) {
  constexpr int kSamples = 4;
  std::array<ImageOf<double>, 3> planes;
  for (ImageOf<double>& plane : planes) plane = ImageOf<double>(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int j = 0; j < kSamples; ++j)
        for (int i = 0; i < kSamples; ++i) {
          const Light one = light(x + (i + 0.5) / kSamples, y + (j + 0.5) / kSamples);
          for (std::size_t c = 0; c < 3; ++c) planes[c].at(x, y) += one[c] / (kSamples * kSamples);
        }
  tb::Kernel<double> lens;
  double sum = 0;
  for (int k = 0; k <= 2; ++k) {
    lens.taps.push_back(std::exp(-k * k / (2 * 0.6 * 0.6)));
    sum += (k == 0 ? 1 : 2) * lens.taps.back();
  }
  for (double& tap : lens.taps) tap /= sum;
  Random random(seed);
  const auto noise = [&] {  // approximately normal, standard deviation 2 codes
    double all = 0;
    for (int i = 0; i < 4; ++i) all += random.uniform(-1, 1);
    return all * 2 / std::sqrt(4.0 / 3);
  };
  Image image(width, height, {0, 0, 0, 255});
  for (std::size_t c = 0; c < 3; ++c) {
    ImageOf<double> rows, blurred;
    convolve_along_rows(planes[c], lens, rows);
    // The outermost rows are repeated for the lens.
    ImageOf<double> framed(width, height + 4);
    for (int y = 0; y < height + 4; ++y)
      std::copy_n(&rows.at(0, std::clamp(y - 2, 0, height - 1)), width, &framed.at(0, y));
    convolve_along_columns(framed, lens, 2, height, blurred);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      image.pixels[i][c] = code(blurred.pixels[i] + noise());
  }
  return image;
}

Light mixed(const Light& a, const Light& b, double t) {
  return {std::lerp(a[0], b[0], t), std::lerp(a[1], b[1], t), std::lerp(a[2], b[2], t)};
}

// ---- letters ------------------------------------------------------------------------------------

struct Stroke {
  double x0, y0, x1, y1;
};

// Strokes that join the dots of a line of text, in dots.
std::vector<Stroke> strokes_of(const std::string& text) {
  const Image dots = tb::label(text, 1);
  const auto dot = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < dots.width && y < dots.height && dots.at(x, y)[0] == 0;
  };
  std::vector<Stroke> strokes;
  const auto join = [&](int x, int y, int to_x, int to_y) {
    strokes.push_back({x + 0.5, y + 0.5, to_x + 0.5, to_y + 0.5});
  };
  for (int y = 0; y < dots.height; ++y) {
    for (int x = 0; x < dots.width; ++x) {
      if (!dot(x, y)) continue;
      const bool right = dot(x + 1, y), down = dot(x, y + 1);
      if (right) join(x, y, x + 1, y);
      if (down) join(x, y, x, y + 1);
      if (!right && !down && dot(x + 1, y + 1)) join(x, y, x + 1, y + 1);
      if (!dot(x - 1, y) && !down && dot(x - 1, y + 1)) join(x, y, x - 1, y + 1);
      join(x, y, x, y);  // isolated dots
    }
  }
  return strokes;
}

// Coverage by strokes of this thickness, with 64 samples per pixel.
class Coverage {
 public:
  Coverage(int width, int height) : samples_(width, height) {}
  void draw(const Stroke& s, double thickness) {
    const double reach = thickness / 2;
    const auto first = [&](double a, double b) {
      return static_cast<int>(std::floor(std::min(a, b) - reach));
    };
    const auto last = [&](double a, double b) {
      return static_cast<int>(std::floor(std::max(a, b) + reach));
    };
    for (int y = std::max(0, first(s.y0, s.y1));
         y <= std::min(samples_.height - 1, last(s.y0, s.y1)); ++y)
      for (int x = std::max(0, first(s.x0, s.x1));
           x <= std::min(samples_.width - 1, last(s.x0, s.x1)); ++x)
        for (int k = 0; k < 64; ++k) {
          const int column = k % 8, row = k / 8;
          if (distance(s, x + (column + 0.5) / 8, y + (row + 0.5) / 8) <= reach)
            samples_.at(x, y) |= std::uint64_t{1} << k;
        }
  }
  double at(std::size_t i) const { return std::popcount(samples_.pixels[i]) / 64.0; }

 private:
  static double distance(const Stroke& s, double x, double y) {
    const double dx = s.x1 - s.x0, dy = s.y1 - s.y0, length2 = dx * dx + dy * dy;
    const double t =
        length2 > 0 ? std::clamp(((x - s.x0) * dx + (y - s.y0) * dy) / length2, 0.0, 1.0) : 0.0;
    return std::hypot(x - s.x0 - t * dx, y - s.y0 - t * dy);
  }
  ImageOf<std::uint64_t> samples_;
};

// Words of one to nine letters.
std::string line_of_words(std::size_t letters, Random& random) {
  std::string line;
  while (line.size() < letters) {
    for (int i = random.between(1, 9); i > 0; --i)
      line += static_cast<char>('a' + static_cast<char>(random.below(26)));
    line += ' ';
  }
  line.resize(letters);
  return line;
}

// ---- pixel art ----------------------------------------------------------------------------------

constexpr std::array<Rgba8, 16> kPalette = {{{12, 16, 20, 255},
                                             {56, 28, 44, 255},
                                             {36, 44, 96, 255},
                                             {80, 80, 84, 255},
                                             {120, 72, 40, 255},
                                             {40, 92, 44, 255},
                                             {196, 60, 64, 255},
                                             {112, 112, 104, 255},
                                             {76, 116, 196, 255},
                                             {204, 132, 52, 255},
                                             {140, 152, 164, 255},
                                             {100, 160, 56, 255},
                                             {204, 160, 140, 255},
                                             {96, 184, 196, 255},
                                             {220, 204, 88, 255},
                                             {232, 232, 220, 255}}};

constexpr int kTile = 16;
using Tile = std::array<std::array<std::uint8_t, kTile>, kTile>;  // colours of the palette

Tile tile_of(int kind, Random& random) {
  Tile tile{};
  for (int y = 0; y < kTile; ++y) {
    for (int x = 0; x < kTile; ++x) {
      int colour = 0;
      switch (kind) {
        case 0:  // grass
          colour = random.chance(120) ? 11 : 5;
          break;
        case 1:  // water
          colour = (x + 2 * (y / 4)) % 8 < 3 && y % 4 == 1 ? 13 : 8;
          break;
        case 2:  // bricks
          colour = y % 5 == 4 || (x + (y / 5 % 2) * 4) % 8 == 7 ? 3 : 9;
          break;
        default:  // a slope, dithered
          colour = x + y > 18 + ((x ^ y) & 1) * 3 ? 4 : 12;
          break;
      }
      tile[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] =
          static_cast<std::uint8_t>(colour);
    }
  }
  return tile;
}

// A random half figure, mirrored, with an outline.
void draw_figure(ImageOf<std::uint8_t>& canvas, int left, int top, Random& random) {
  constexpr int kSide = 12;
  std::array<std::array<bool, kSide>, kSide> body{};
  for (std::size_t y = 1; y + 1 < kSide; ++y)
    for (std::size_t x = 1; x < kSide / 2; ++x)
      body[y][x] = body[y][kSide - 1 - x] =
          random.chance(static_cast<std::uint32_t>(400 + 100 * x));
  const auto set = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < kSide && y < kSide &&
           body[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
  };
  const std::uint8_t light = static_cast<std::uint8_t>(6 + random.below(10)),
                     dark = static_cast<std::uint8_t>(1 + random.below(5));
  for (int y = -1; y <= kSide; ++y)
    for (int x = -1; x <= kSide; ++x) {
      const int px = left + x, py = top + y;
      if (px < 0 || py < 0 || px >= canvas.width || py >= canvas.height) continue;
      if (set(x, y))
        canvas.at(px, py) = y < kSide / 2 ? light : dark;
      else if (set(x - 1, y) || set(x + 1, y) || set(x, y - 1) || set(x, y + 1))
        canvas.at(px, py) = 0;
    }
}

}  // namespace

// ---- frames -------------------------------------------------------------------------------------

tb::Scene textured_hall(int view) {
  tb::Scene scene;
  scene.name = "hall";
  scene.mesh = Hall().mesh();
  const std::array<std::pair<V3d, V3d>, 3> cameras = {{{{0.6, 1.7, 10.5}, {-0.5, 1.4, -4}},
                                                       {{-6.5, 3.6, 6}, {3, 0.6, -4}},
                                                       {{5.8, 0.9, -9}, {-3, 1.6, 5}}}};
  const auto& [eye, target] = cameras.at(static_cast<std::size_t>(view));
  scene.camera.eye = eye;
  scene.camera.target = target;
  return scene;
}

Textured textured_frame(int view, int width, int height) {
  const tb::Scene scene = textured_hall(view);
  return {tb::render_covered(scene, width, height, 1), tb::render_covered(scene, width, height, 8)};
}

Image smoothed_hall(int width, int height) {
  tb::RenderOptions options;
  options.width = width;
  options.height = height;
  options.samples = 8;
  options.shading = tb::Shading::kLit;
  options.averaging = tb::Averaging::kLinear;
  return render(textured_hall(0), options);
}

Image landscape_photo(int width, int height) {
  const double w = width, h = height;
  return photo(width, height, 17, [&](double x, double y) {
    const double u = x / w, v = y / h;
    Light light = mixed({70, 120, 200}, {205, 220, 235}, v * 1.6);
    light = mixed(light, {245, 245, 245},
                  std::clamp(3 * (fractal(4 * u, 8 * v, 6, 41) - 0.5), 0.0, 1.0));
    for (int ridge = 0; ridge < 4; ++ridge) {
      const double top =
          0.42 + 0.11 * ridge + 0.16 * (fractal((3 + 2 * ridge) * u, 0.5, 7, 100u + ridge) - 0.5);
      if (v < top) continue;
      const double grain = fractal(40 * (1 + ridge) * u, 60 * (1 + ridge) * v, 5, 200u + ridge);
      const Light ground = mixed({40, 60, 35}, {150, 150, 95}, grain);
      light = mixed({150, 170, 190}, ground, 0.4 + 0.2 * ridge);
    }
    return light;
  });
}

Image foliage_photo(int width, int height) {
  struct Leaf {
    double x, y, length, thin, cosine, sine;
    Light light;
  };
  Random random(29);
  std::vector<Leaf> leaves;
  for (int i = 0; i < width * height / 60; ++i) {
    const double x = random.uniform(-10, width + 10), y = random.uniform(-10, height + 10);
    const double length = random.uniform(4, 16), thin = random.uniform(0.2, 0.5),
                 angle = random.uniform(0, std::numbers::pi), bright = random.uniform(0.15, 1);
    leaves.push_back({x,
                      y,
                      length,
                      thin,
                      std::cos(angle),
                      std::sin(angle),
                      {110 * bright, 170 * bright, 60 * bright * bright}});
  }
  // Leaves that can be visible in a cell of 16 x 16 pixels.
  const int columns = width / 16 + 1, rows = height / 16 + 1;
  std::vector<std::vector<std::size_t>> cells(static_cast<std::size_t>(columns * rows));
  const auto cell = [&](int column, int row) -> std::vector<std::size_t>& {
    return cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                 static_cast<std::size_t>(column)];
  };
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const Leaf& leaf = leaves[i];
    const auto at = [](double value, int count) {
      return std::clamp(static_cast<int>(std::floor(value / 16)), 0, count - 1);
    };
    for (int row = at(leaf.y - 16, rows); row <= at(leaf.y + 16, rows); ++row)
      for (int column = at(leaf.x - 16, columns); column <= at(leaf.x + 16, columns); ++column)
        cell(column, row).push_back(i);
  }
  return photo(width, height, 31, [&](double x, double y) {
    const std::vector<std::size_t>& near = cell(static_cast<int>(x) / 16, static_cast<int>(y) / 16);
    for (auto i = near.rbegin(); i != near.rend(); ++i) {
      const Leaf& leaf = leaves[*i];
      const double dx = x - leaf.x, dy = y - leaf.y;
      const double along = (dx * leaf.cosine + dy * leaf.sine) / leaf.length,
                   across = (dy * leaf.cosine - dx * leaf.sine) / (leaf.length * leaf.thin);
      if (along * along + across * across > 1) continue;
      return mixed(leaf.light, {leaf.light[0] * 1.3, leaf.light[1] * 1.2, leaf.light[2]},
                   std::abs(across) < 0.12 ? 1 : 0.5 * (1 + along));
    }
    return Light{14, 18, 10};
  });
}

Image text_page(Text kind, int width, int height) {
  constexpr Rgba8 kInk = {20, 20, 24, 255}, kPaper = {255, 255, 255, 255};
  Random random(5);
  if (kind == Text::kBitmapFont) {
    Image page(width, height, kPaper);
    for (int y = 6; y + 11 < height; y += 11) {
      const Image line = tb::label(line_of_words(static_cast<std::size_t>(width - 12) / 6, random),
                                   1, kInk, kPaper);
      paste(page, line, 6, y);
    }
    return page;
  }
  constexpr double kScale = 1.56, kThickness = 1.5;  // pixels per dot; nine dots are 14 pixels
  Coverage coverage(width, height);
  for (double y = 8; y + 9 * kScale < height - 4; y += 11.5 * kScale) {
    const auto letters = static_cast<std::size_t>((width - 16) / (6 * kScale));
    for (const Stroke& s : strokes_of(line_of_words(letters, random)))
      coverage.draw({8 + s.x0 * kScale, y + s.y0 * kScale, 8 + s.x1 * kScale, y + s.y1 * kScale},
                    kThickness);
  }
  const bool dark = kind == Text::kLightOnDark;
  const Rgba8 ink = dark ? Rgba8{225, 228, 220, 255} : kInk,
              paper = dark ? Rgba8{24, 26, 32, 255} : kPaper;
  Image page(width, height, paper);
  for (std::size_t i = 0; i < page.pixels.size(); ++i) {
    double share = coverage.at(i);
    if (kind != Text::kSmoothed) share = share >= 0.5 ? 1 : 0;
    for (std::size_t c = 0; c < 3; ++c)
      page.pixels[i][c] =
          code(std::lerp(static_cast<double>(paper[c]), static_cast<double>(ink[c]), share));
  }
  return page;
}

Image text_over_scene(int width, int height) {
  const Image page = text_page(Text::kAliased, width, height);
  Image frame = landscape_photo(width, height);
  for (std::size_t i = 0; i < page.pixels.size(); ++i)
    if (page.pixels[i][0] != 255) frame.pixels[i] = page.pixels[i];
  return frame;
}

Textured wires(double thickness, double degrees, int width, int height) {
  constexpr double kApart = 40;
  constexpr int kSide = 8;  // samples
  constexpr Rgba8 kWire = {40, 44, 52, 255}, kSky = {150, 180, 215, 255};
  const double angle = degrees * std::numbers::pi / 180, sine = std::sin(angle),
               cosine = std::cos(angle);
  const auto on_wire = [&](double x, double y) {
    return std::abs(std::remainder(y * cosine - x * sine, kApart)) < thickness / 2;
  };
  // Indexed by the number of samples that a wire covers.
  std::array<Rgba8, kSide * kSide + 1> mixes{};
  for (std::size_t samples = 0; samples < mixes.size(); ++samples) {
    const double share = static_cast<double>(samples) / (kSide * kSide);
    mixes[samples][3] = 255;
    for (std::size_t c = 0; c < 3; ++c)
      mixes[samples][c] =
          code(255 * tb::linear_to_srgb(std::lerp(tb::srgb_to_linear(kSky[c] / 255.0),
                                                  tb::srgb_to_linear(kWire[c] / 255.0), share)));
  }
  Image frame = tb::stimuli::draw(
      width, height, [&](int x, int y) { return on_wire(x + 0.5, y + 0.5) ? kWire : kSky; });
  Image reference = tb::stimuli::draw(width, height, [&](int x, int y) {
    std::size_t samples = 0;
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i)
        samples += on_wire(x + (i + 0.5) / kSide, y + (j + 0.5) / kSide) ? 1 : 0;
    return mixes[samples];
  });
  return {std::move(frame), std::move(reference)};
}

Image pixel_art(int size, int width, int height) {
  const int columns = width / size, rows = height / size;
  Random random(9);
  ImageOf<std::uint8_t> canvas(columns, rows);
  const double turn = random.uniform(0, 1);
  for (int top = 0; top < rows; top += kTile)
    for (int left = 0; left < columns; left += kTile) {
      const double height_here = smooth_noise(left / 48.0 + turn, top / 48.0, 3);
      const Tile tile = tile_of(height_here < 0.35   ? 1
                                : height_here < 0.65 ? 0
                                : height_here < 0.75 ? 3
                                                     : 2,
                                random);
      for (int y = top; y < std::min(rows, top + kTile); ++y)
        for (int x = left; x < std::min(columns, left + kTile); ++x)
          canvas.at(x, y) =
              tile[static_cast<std::size_t>(y - top)][static_cast<std::size_t>(x - left)];
    }
  for (int i = columns * rows / 900; i > 0; --i) {
    const int x = random.between(0, columns - 1), y = random.between(0, rows - 1);
    draw_figure(canvas, x, y, random);
  }
  return tb::stimuli::draw(width, height, [&](int x, int y) {
    return kPalette[canvas.at(std::min(columns - 1, x / size), std::min(rows - 1, y / size))];
  });
}

Image compressed(const Image& image, int quality) {
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("Compression", fmt::format("jpeg:{}", quality));
  const auto output = OIIO::ImageOutput::create("harm.jpg");
  if (!output || !output->set_ioproxy(&memory) || !output->open("harm.jpg", spec) ||
      !output->write_image(OIIO::TypeDesc::UINT8, image.pixels.data(), sizeof(Rgba8)) ||
      !output->close())
    throw spec::FileError(fmt::format("a JPEG cannot be written: {}",
                                      output ? output->geterror() : OIIO::geterror()));
  return tb::read_image_memory("harm.jpg",
                               {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace deburr::studies::harm
