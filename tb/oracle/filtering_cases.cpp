// SPDX-License-Identifier: MIT
#include "tb/oracle/filtering_cases.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "tb/base/random.h"
#include "tb/oracle/plane.h"

namespace deburr::tb::texture {
namespace {

// Derivatives in texels of level 0.
struct Jacobian {
  double du_dx, dv_dx, du_dy, dv_dy;
};

Jacobian jacobian(int kind, double lod, Random& random) {
  const double d = std::exp2(lod);
  const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double c = d * std::cos(angle);
  const double s = d * std::sin(angle);
  switch (kind) {
    case 0:  // along u only
      return {d, 0.0, 0.0, 0.0};
    case 1:  // along v only
      return {0.0, 0.0, 0.0, d};
    case 2:  // square
      return {d, 0.0, 0.0, d};
    case 3:  // rotated square
      return {c, s, -s, c};
    case 4: {  // sheared, one side shorter
      const double shorter = random.uniform(0.0, 1.0);
      return {c, s, shorter * random.uniform(-d, d), shorter * random.uniform(-d, d)};
    }
    case 5:  // mirrored, quarter turn
      return {0.0, -d, -d, 0.0};
    case 6:  // mirrored along u, longer along x
      return {-d, 0.0, 0.0, random.uniform(0.0, d)};
    default:  // longer along y
      return {random.uniform(-d, d) / 4, 0.0, 0.0, -d};
  }
}

double real(std::int64_t coordinate) {
  return static_cast<double>(coordinate) / spec::texture::kCoordinateOne;
}

}  // namespace

std::vector<spec::texture::Quad> filtering_quads(const Size& size, int count, std::uint32_t seed,
                                                 double lod_bias) {
  Random random(Random::kStride * seed + 1);
  const int last = std::bit_width(static_cast<unsigned>(std::max(size.width, size.height))) - 1;
  std::vector<spec::texture::Quad> quads;
  for (int i = 0; i < count; ++i) {
    // Every fourth quad is close to a switching point of a filter: l = 0, k + 1/2.
    const double sweep = -3.0 + (last + 4.0) * (i + random.uniform(0.0, 1.0)) / count;
    const double threshold = std::max(0.0, std::floor(2.0 * sweep) / 2.0);
    const double reach = i % 8 == 3 ? 0.08 : 0.025;
    const double lod = i % 4 == 3 ? threshold + random.uniform(-reach, reach) : sweep;
    const Jacobian j = jacobian(static_cast<int>(random.word() % 8), lod - lod_bias, random);
    const double s0 = random.uniform(-2.0, 2.0);
    const double t0 = random.uniform(-2.0, 2.0);
    spec::texture::Quad quad;
    quad.tag = static_cast<std::uint32_t>(i);
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const double x = static_cast<double>(lane & 1);
      const double y = static_cast<double>(lane >> 1);
      quad.s[lane] = fixed(s0 + (j.du_dx * x + j.du_dy * y) / size.width);
      quad.t[lane] = fixed(t0 + (j.dv_dx * x + j.dv_dy * y) / size.height);
    }
    quads.push_back(quad);
  }
  return quads;
}

golden::ideal::Fragment fragment_of(const spec::texture::Quad& quad, int lane) {
  const auto row = static_cast<std::size_t>(lane & 2);
  const auto column = static_cast<std::size_t>(lane & 1);
  const auto difference = [](const std::array<std::int32_t, 4>& c, std::size_t to,
                             std::size_t from) { return real(std::int64_t{c[to]} - c[from]); };
  const auto i = static_cast<std::size_t>(lane);
  return {real(quad.s[i]),
          real(quad.t[i]),
          difference(quad.s, row + 1, row),
          difference(quad.t, row + 1, row),
          difference(quad.s, column + 2, column),
          difference(quad.t, column + 2, column)};
}

golden::ideal::Sampler sampler_of(const spec::texture::Descriptor& descriptor) {
  return {descriptor.wrap_s,         descriptor.wrap_t,           descriptor.min_filter,
          descriptor.mag_filter,     descriptor.lod_bias / 256.0, descriptor.min_lod / 256.0,
          descriptor.max_lod / 256.0};
}

}  // namespace deburr::tb::texture
