// SPDX-License-Identifier: MIT
#include "tb/scene/rasteriser.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "spec/error.h"
#include "tb/scene/setup.h"

namespace deburr::tb {
namespace {

constexpr int kTile = 8;

// Texture coordinates at a triangle's corners, moved by whole repeats towards zero so that S7.24
// keeps its precision anywhere on an endless floor.
struct Mapping {
  Imath::V3d s, t;
  std::uint8_t texture = 0;
  bool repeats_s = false, repeats_t = false;
};

// Whole repeats of a coordinate; even for mirrored wrap, where every other repeat is mirrored.
double whole_repeats(double coordinate, spec::texture::Wrap wrap) {
  if (wrap == spec::texture::Wrap::kClampToEdge || !std::isfinite(coordinate)) return 0.0;
  return wrap == spec::texture::Wrap::kRepeat ? std::floor(coordinate)
                                              : 2.0 * std::floor(0.5 * coordinate);
}

Imath::V3d towards_zero(const Imath::V3d& corners, spec::texture::Wrap wrap) {
  const auto [low, high] = std::minmax({corners.x, corners.y, corners.z});
  const double shift = whole_repeats(0.5 * (low + high), wrap);
  return corners - Imath::V3d(shift, shift, shift);
}

Mapping map_triangle(const Mesh& mesh, const Triangle& triangle) {
  const int texture = mesh.materials[triangle.material].texture;
  DEBURR_CHECK(texture >= 0 && texture < spec::texture::kMaxTextures,
               fmt::format("material {} has texture {}: call texture_everything first",
                           triangle.material, texture));
  const Texture& state = mesh.textures[static_cast<std::size_t>(texture)];
  std::array<Imath::V2d, 3> uv;
  for (std::size_t i = 0; i < 3; ++i) uv[i] = mesh.vertices[triangle.vertex[i]].uv;
  Mapping mapping;
  mapping.s = towards_zero({uv[0].x, uv[1].x, uv[2].x}, state.wrap_s);
  mapping.t = towards_zero({uv[0].y, uv[1].y, uv[2].y}, state.wrap_t);
  mapping.texture = static_cast<std::uint8_t>(texture);
  mapping.repeats_s = state.wrap_s != spec::texture::Wrap::kClampToEdge;
  mapping.repeats_t = state.wrap_t != spec::texture::Wrap::kClampToEdge;
  return mapping;
}

// For a triangle that spans more repeats than S7.24 holds: moves the whole quad, so that
// differences are preserved.
void move_into_range(std::array<double, 4>& values, std::uint8_t coverage) {
  const double reference = values[static_cast<std::size_t>(std::countr_zero(coverage))];
  if (std::abs(reference) < 64.0 || !std::isfinite(reference)) return;
  const double shift = 2.0 * std::floor(0.5 * reference);
  for (double& value : values) value -= shift;
}

// numerator / inverse_w. A helper lane can lie beyond the horizon of the triangle's plane
// (inverse_w <= 0), where the coordinate has passed through infinity.
double divide(double numerator, double inverse_w) {
  if (inverse_w > 0.0) return numerator / inverse_w;
  return numerator == 0.0 ? 0.0 : std::copysign(std::numeric_limits<double>::infinity(), numerator);
}

class QuadMaker {
 public:
  QuadMaker(const Primitive& primitive, const Mapping& mapping)
      : primitive_(primitive), mapping_(mapping) {}

  spec::texture::Quad make(int x, int y, std::uint8_t coverage) const {
    spec::texture::Quad quad;
    quad.x = static_cast<std::uint16_t>(x);
    quad.y = static_cast<std::uint16_t>(y);
    quad.texture = mapping_.texture;
    quad.coverage = coverage;
    std::array<double, 4> s{}, t{};
    for (int lane = 0; lane < 4; ++lane) {
      const auto weights = primitive_.corner_weights(
          primitive_.edges(cell_centre(x + (lane & 1)), cell_centre(y + (lane >> 1))));
      const double inverse_w = weights.x + weights.y + weights.z;
      s[static_cast<std::size_t>(lane)] = divide(weights.dot(mapping_.s), inverse_w);
      t[static_cast<std::size_t>(lane)] = divide(weights.dot(mapping_.t), inverse_w);
    }
    if (mapping_.repeats_s) move_into_range(s, coverage);
    if (mapping_.repeats_t) move_into_range(t, coverage);
    for (std::size_t lane = 0; lane < 4; ++lane) {
      bool clamped = false;
      quad.s[lane] = snap_coordinate(s[lane], clamped);
      quad.t[lane] = snap_coordinate(t[lane], clamped);
      if (clamped) quad.clamped = static_cast<std::uint8_t>(quad.clamped | 1u << lane);
    }
    return quad;
  }

 private:
  const Primitive& primitive_;
  const Mapping& mapping_;
};

// Calls visit(x, y) for the even corner of every quad that touches the primitive's bounding box.
template <class Visit>
void for_each_quad(const Primitive& p, Traversal traversal, Visit&& visit) {
  const int left = p.left & ~1, top = p.top & ~1;
  if (traversal == Traversal::kRaster) {
    for (int y = top; y <= p.bottom; y += 2)
      for (int x = left; x <= p.right; x += 2) visit(x, y);
    return;
  }
  for (int tile_y = p.top & ~(kTile - 1); tile_y <= p.bottom; tile_y += kTile)
    for (int tile_x = p.left & ~(kTile - 1); tile_x <= p.right; tile_x += kTile)
      for (int y = std::max(tile_y, top); y <= std::min(tile_y + kTile - 1, p.bottom); y += 2)
        for (int x = std::max(tile_x, left); x <= std::min(tile_x + kTile - 1, p.right); x += 2)
          visit(x, y);
}

}  // namespace

std::int32_t snap_coordinate(double coordinate, bool& clamped) {
  constexpr double kLimit = 2147483648.0;  // 128 in S7.24
  const double scaled = std::floor(coordinate * spec::texture::kCoordinateOne + 0.5);
  if (scaled >= -kLimit && scaled < kLimit) return static_cast<std::int32_t>(scaled);
  clamped = true;
  if (std::isnan(coordinate)) return 0;
  return coordinate < 0.0 ? std::numeric_limits<std::int32_t>::min()
                          : std::numeric_limits<std::int32_t>::max();
}

FragmentStream rasterise(const Scene& scene, const RasterOptions& options) {
  FragmentStream stream;
  stream.width = options.width;
  stream.height = options.height;
  const View view(scene.camera, options.width, options.height, 1);
  const std::vector<Primitive> primitives = set_up(scene.mesh, view, &stream.counts);

  ImageOf<std::int32_t> owners(options.width, options.height, kNobody);
  stream.depth = DepthImage(options.width, options.height);
  for_each_resolved_pixel(
      primitives, view, [&](int x, int y, std::int32_t owner, double inverse_w) {
        owners.at(x, y) = owner;
        stream.depth.at(x, y) = static_cast<float>(scene.camera.near_plane * inverse_w);
      });

  const bool overdraw = options.visibility == Visibility::kOverdraw;
  Mapping mapping;
  std::uint32_t mapped = 0;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const Primitive& primitive = primitives[i];
    if (i == 0 || primitive.triangle != mapped) {
      mapped = primitive.triangle;
      mapping = map_triangle(scene.mesh, scene.mesh.triangles[mapped]);
    }
    const QuadMaker maker(primitive, mapping);
    for_each_quad(primitive, options.traversal, [&](int x, int y) {
      unsigned covered = 0, seen = 0;
      for (int lane = 0; lane < 4; ++lane) {
        const int px = x + (lane & 1), py = y + (lane >> 1);
        if (px >= options.width || py >= options.height) continue;
        if (owners.at(px, py) == static_cast<std::int32_t>(i)) seen |= 1u << lane;
        if (overdraw && primitive.covers(primitive.edges(cell_centre(px), cell_centre(py))))
          covered |= 1u << lane;
      }
      if (!overdraw) covered = seen;
      if (covered == 0) return;
      spec::texture::Quad quad = maker.make(x, y, static_cast<std::uint8_t>(covered));
      quad.tag = static_cast<std::uint32_t>(stream.quads.size());
      stream.counts.fragments += static_cast<std::uint64_t>(std::popcount(covered));
      stream.counts.clamped_lanes += static_cast<std::uint64_t>(std::popcount(quad.clamped));
      stream.quads.push_back(quad);
      stream.visible.push_back(static_cast<std::uint8_t>(seen));
    });
  }
  stream.counts.quads = stream.quads.size();
  return stream;
}

Rgba8 sky(const Scene& scene, double y, int height) {
  const double blend = std::clamp(y / height, 0.0, 1.0);
  Rgba8 colour;
  for (std::size_t c = 0; c < 4; ++c)
    colour[c] = static_cast<std::uint8_t>(
        std::lround(scene.sky_top[c] + (scene.sky_bottom[c] - scene.sky_top[c]) * blend));
  return colour;
}

FrameAssembler::FrameAssembler(const FragmentStream& stream, const Scene& scene)
    : stream_(stream), frame_(stream.width, stream.height) {
  for (int y = 0; y < frame_.height; ++y)
    std::fill_n(&frame_.at(0, y), frame_.width, sky(scene, y + 0.5, frame_.height));
  pending_.reserve(stream.quads.size());
  for (const spec::texture::Quad& quad : stream.quads) {
    pending_.push_back(quad.coverage);
    missing_ += static_cast<std::uint64_t>(std::popcount(quad.coverage));
  }
}

void FrameAssembler::put(const spec::texture::Colour& colour) {
  DEBURR_CHECK(colour.tag < pending_.size() && colour.lane < 4,
               fmt::format("colour with tag {} lane {}, the stream has {} quads", colour.tag,
                           colour.lane, pending_.size()));
  const auto bit = static_cast<std::uint8_t>(1u << colour.lane);
  DEBURR_CHECK((pending_[colour.tag] & bit) != 0,
               fmt::format("colour for tag {} lane {}, which is not covered or already has one",
                           colour.tag, colour.lane));
  pending_[colour.tag] = static_cast<std::uint8_t>(pending_[colour.tag] & ~bit);
  --missing_;
  if ((stream_.visible[colour.tag] & bit) == 0) return;
  const auto [x, y] = stream_.pixel(colour.tag, colour.lane);
  frame_.at(x, y) = colour.rgba;
}

}  // namespace deburr::tb
