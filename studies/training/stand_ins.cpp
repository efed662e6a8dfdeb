// SPDX-License-Identifier: MIT
#include "studies/training/stand_ins.h"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <vector>

#include "spec/error.h"
#include "tb/base/random.h"
#include "tb/scene/exact_math.h"

namespace deburr::studies {
namespace {

// Written to all digits: the ROMs are trained on colours in single precision.
constexpr std::array<std::array<float, 3>, 6> kColours = {{{0.8F, 0.15F, 0.1F},
                                                           {0.15F, 0.35F, 0.7F},
                                                           {0.9F, 0.8F, 0.5F},
                                                           {0.25F, 0.55F, 0.2F},
                                                           {0.35F, 0.3F, 0.3F},
                                                           {0.9F, 0.9F, 0.9F}}};
constexpr int kGreen = 3, kBrown = 4;

struct Point {
  double x, y, z;
};

class Writer {
 public:
  explicit Writer(std::string name) : text_(fmt::format("mtllib {}.mtl\n", name)) {}

  void use(int colour) { text_ += fmt::format("usemtl c{}\n", colour); }
  // Rotated by `angle` around the vertical axis through its centre.
  void box(const Point& centre, const Point& size, double angle) {
    const auto [s, c] = tb::sin_cos(angle);
    std::array<int, 8> corner{};
    for (std::size_t i = 0; i < corner.size(); ++i) {
      const double x = (i & 1 ? 0.5 : -0.5) * size.x, y = (i & 2 ? 0.5 : -0.5) * size.y,
                   z = (i & 4 ? 0.5 : -0.5) * size.z;
      corner[i] = vertex({centre.x + c * x + s * z, centre.y + y, centre.z - s * x + c * z});
    }
    for (const auto& f : std::array<std::array<std::size_t, 4>, 6>{
             {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}})
      text_ +=
          fmt::format("f {} {} {} {}\n", corner[f[0]], corner[f[1]], corner[f[2]], corner[f[3]]);
  }
  // Upright, with radius `low` at the foot and `high` at the top (0: a cone).
  void prism(const Point& foot, double height, double low, double high, int sides) {
    std::vector<int> below, above;
    for (int i = 0; i < sides; ++i) {
      const tb::SinCos a = tb::sin_cos(2 * tb::kPi * i / sides);
      below.push_back(vertex({foot.x + low * a.cos, foot.y, foot.z + low * a.sin}));
      above.push_back(vertex({foot.x + high * a.cos, foot.y + height, foot.z + high * a.sin}));
    }
    const int tip = vertex({foot.x, foot.y + height, foot.z});
    for (std::size_t i = 0; i < below.size(); ++i) {
      const std::size_t next = (i + 1) % below.size();
      if (high > 0) {
        text_ += fmt::format("f {} {} {} {}\n", below[i], above[i], above[next], below[next]);
        text_ += fmt::format("f {} {} {}\n", above[i], tip, above[next]);
      } else {
        text_ += fmt::format("f {} {} {}\n", below[i], tip, below[next]);
      }
    }
  }
  // A wheel: an upright disc of `sides` corners, facing along z.
  void wheel(const Point& centre, double radius, double width, int sides) {
    struct Corner {
      int vertex;
      double x, y;
    };
    std::vector<Corner> disc;
    std::vector<int> front, back;
    for (int i = 0; i < sides; ++i) {
      const tb::SinCos a = tb::sin_cos(2 * tb::kPi * i / sides);
      const double x = centre.x + radius * a.cos, y = centre.y + radius * a.sin;
      front.push_back(vertex({x, y, centre.z + width / 2}));
      disc.push_back({front.back(), x, y});
      back.push_back(vertex({x, y, centre.z - width / 2}));
    }
    // Ears are cut here as in the frames that the ROMs are trained on: from another cut, texture
    // coordinates are interpolated with other rounding errors, so the importer must not choose it.
    for (std::size_t first = 0; disc.size() >= 3;) {
      const std::size_t left = disc.size();
      first = left > 3 ? first % left : 0;
      const std::size_t ear = (first + 1) % left;
      const Corner &a = disc[first], &b = disc[ear], &c = disc[(first + 2) % left];
      if (left > 3 && a.x * b.y < a.y * b.x) {  // clockwise about the origin
        ++first;
        continue;
      }
      text_ += fmt::format("f {} {} {}\n", a.vertex, b.vertex, c.vertex);
      disc.erase(disc.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    for (std::size_t i = 0; i < front.size(); ++i) {
      const std::size_t next = (i + 1) % front.size();
      text_ += fmt::format("f {} {} {} {}\n", back[i], back[next], front[next], front[i]);
    }
  }
  const std::string& text() const { return text_; }

 private:
  int vertex(const Point& p) {
    text_ += fmt::format("v {:.6f} {:.6f} {:.6f}\n", p.x, p.y, p.z);
    return ++vertices_;
  }
  std::string text_;
  int vertices_ = 0;
};

int any_colour(tb::Random& random) { return static_cast<int>(random.below(kColours.size())); }

void street(Writer& out, tb::Random& random) {
  out.use(kBrown);
  out.box({0, -0.1, 0}, {20, 0.2, 4}, 0);
  for (int i = 0; i < 9; ++i) {
    out.use(any_colour(random));
    const double height = random.uniform(1.5, 5), x = -9 + 2.2 * i;
    const double side = i % 2 != 0 ? 4.0 : -4.0;
    const double turn = random.uniform(-0.1, 0.1), width = random.uniform(1.4, 2.1);
    out.box({x, height / 2, side}, {width, height, 2.4}, turn);
    out.use(any_colour(random));
    out.box({x, height + 0.2, side}, {2.4, 0.4, 2.8}, 0);
  }
}

void vehicle(Writer& out, tb::Random& random) {
  const double length = random.uniform(4, 7);
  out.use(any_colour(random));
  out.box({0, 1.1, 0}, {length, 0.9, 2}, 0);
  out.use(any_colour(random));
  const double cabin = random.uniform(1.5, 2.5), at = random.uniform(-1, 1);
  out.box({at, 2.1, 0}, {cabin, 1.2, 1.8}, 0);
  out.use(kBrown);
  const int sides = 10 + static_cast<int>(random.below(14));
  for (const double x : {-0.35 * length, 0.35 * length})
    for (const double z : {-1.0, 1.0}) out.wheel({x, 0.6, z}, 0.6, 0.3, sides);
}

void forest(Writer& out, tb::Random& random) {
  out.use(2);
  out.box({0, -0.1, 0}, {16, 0.2, 12}, 0);
  for (int i = 0; i < 14; ++i) {
    const Point foot{random.uniform(-7, 7), 0, random.uniform(-5, 5)};
    const double height = random.uniform(2, 4.5);
    out.use(kBrown);
    out.prism(foot, 0.8, 0.15, 0.15, 6);
    out.use(kGreen);
    const int sides = 5 + static_cast<int>(random.below(8));
    out.prism({foot.x, 0.7, foot.z}, height, random.uniform(0.6, 1.2), 0, sides);
  }
}

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file);
  stream << text;
  if (!stream.flush()) throw spec::FileError("cannot write '" + file.string() + "'");
}

}  // namespace

std::filesystem::path write_stand_in(const std::filesystem::path& folder, const std::string& kind,
                                     std::uint64_t seed) {
  const std::string name = fmt::format("{}_{}", kind, seed);
  tb::Random random(seed, kind);
  Writer out(name);
  if (kind == "street")
    street(out, random);
  else if (kind == "vehicle")
    vehicle(out, random);
  else
    forest(out, random);
  std::string materials;
  for (std::size_t i = 0; i < kColours.size(); ++i)
    materials += fmt::format("newmtl c{}\nKd {} {} {}\n", i, double{kColours[i][0]},
                             double{kColours[i][1]}, double{kColours[i][2]});
  write(folder / (name + ".mtl"), materials);
  write(folder / (name + ".obj"), out.text());
  return folder / (name + ".obj");
}

}  // namespace deburr::studies
