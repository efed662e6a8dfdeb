// SPDX-License-Identifier: MIT
#include "tb/scene/setup.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "spec/error.h"
#include "tb/scene/exact_math.h"
#include "tb/scene/image_io.h"

namespace deburr::tb {
namespace {

using Imath::V3d;

struct ClipVertex {
  V3d position;  // x, y, w
  V3d weights;   // barycentric weights of the mesh triangle's corners, sum 1
};
using Polygon = std::vector<ClipVertex>;

// Clips to the side where distance >= 0. The crossing is always computed from the inner end to the
// outer end, so that triangles that share an edge get the same point and no gap appears between
// them.
template <class Distance>
void clip(Polygon& polygon, Polygon& scratch, Distance&& distance) {
  scratch.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const ClipVertex& here = polygon[i];
    const ClipVertex& next = polygon[(i + 1) % polygon.size()];
    const double d_here = distance(here.position), d_next = distance(next.position);
    if (d_here >= 0.0) scratch.push_back(here);
    if ((d_here >= 0.0) == (d_next >= 0.0)) continue;
    const ClipVertex& inner = d_here >= 0.0 ? here : next;
    const ClipVertex& outer = d_here >= 0.0 ? next : here;
    const double d_inner = std::max(d_here, d_next), d_outer = std::min(d_here, d_next);
    const double t = d_inner / (d_inner - d_outer);
    scratch.push_back({inner.position + (outer.position - inner.position) * t,
                       inner.weights + (outer.weights - inner.weights) * t});
  }
  polygon.swap(scratch);
}

// The guard band's four sides and the near plane, as distances that are linear in (x, y, w).
struct ClipSpace {
  double near_plane;
  double behind(const V3d& p) const { return p.z - near_plane; }
  double left(const V3d& p) const { return p.x + kGuardBand * p.z; }
  double right(const V3d& p) const { return kGuardBand * p.z - p.x; }
  double above(const V3d& p) const { return p.y + kGuardBand * p.z; }
  double below(const V3d& p) const { return kGuardBand * p.z - p.y; }
  bool inside(const V3d& p) const {
    return behind(p) >= 0 && left(p) >= 0 && right(p) >= 0 && above(p) >= 0 && below(p) >= 0;
  }
};

// Whether all three corners are outside the same plane of the picture, so that the triangle is
// invisible.
bool outside_picture(const std::array<V3d, 3>& p, const View& view) {
  auto all = [&](auto&& test) { return test(p[0]) && test(p[1]) && test(p[2]); };
  return all([&](const V3d& v) { return v.z < view.near_plane(); }) ||
         all([&](const V3d& v) { return v.x < 0.0; }) ||
         all([&](const V3d& v) { return v.y < 0.0; }) ||
         all([&](const V3d& v) { return v.x > view.width() * v.z; }) ||
         all([&](const V3d& v) { return v.y > view.height() * v.z; });
}

struct Snapped {
  std::int64_t x, y;
};

Snapped snap(const V3d& position) {
  return {static_cast<std::int64_t>(std::floor(position.x / position.z * kSubpixelOne + 0.5)),
          static_cast<std::int64_t>(std::floor(position.y / position.z * kSubpixelOne + 0.5))};
}

// The first and the last cell that can have a sample in [low, high]; a sample is up to half a cell
// from the centre of its cell.
int first_cell(std::int64_t low) {
  return static_cast<int>(std::max<std::int64_t>(0, (low - 128) >> 8));
}
int last_cell(std::int64_t high, int cells) {
  return static_cast<int>(std::min<std::int64_t>(cells - 1, (high - 128 + 255) >> 8));
}

// Empty if the corners are collinear after snapping.
std::optional<Primitive> make_primitive(std::array<const ClipVertex*, 3> corner, const View& view) {
  std::array<Snapped, 3> p{snap(corner[0]->position), snap(corner[1]->position),
                           snap(corner[2]->position)};
  auto twice_area = [&] {
    return (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
  };
  std::int64_t area = twice_area();
  if (area == 0) return std::nullopt;
  if (area < 0) {  // both faces are drawn: make every triangle clockwise on the screen
    std::swap(p[1], p[2]);
    std::swap(corner[1], corner[2]);
    area = -area;
  }
  Primitive primitive;
  for (std::size_t i = 0; i < 3; ++i) {
    const Snapped &from = p[(i + 1) % 3], &to = p[(i + 2) % 3];
    const std::int64_t dx = to.x - from.x, dy = to.y - from.y;
    primitive.a[i] = -dy;
    primitive.b[i] = dx;
    primitive.c[i] = dy * from.x - dx * from.y;
    primitive.bias[i] =
        dy < 0 || (dy == 0 && dx > 0) ? 0 : -1;  // left edge goes up, top edge right
    primitive.inverse_w[i] = 1.0 / (corner[i]->position.z * static_cast<double>(area));
    primitive.weight[i] = corner[i]->weights * primitive.inverse_w[i];
  }
  const auto [low_x, high_x] = std::minmax({p[0].x, p[1].x, p[2].x});
  const auto [low_y, high_y] = std::minmax({p[0].y, p[1].y, p[2].y});
  primitive.left = first_cell(low_x);
  primitive.right = last_cell(high_x, view.width());
  primitive.top = first_cell(low_y);
  primitive.bottom = last_cell(high_y, view.height());
  return primitive;
}

struct Span {
  int first, last;  // steps of one cell; empty if first > last
};

// The covered steps among 0..last, starting at the sample with edge values `e`. A triangle is
// convex, so they are one interval, and each edge limits one end.
Span covered_span(const Primitive& p, const std::array<std::int64_t, 3>& e, int last) {
  std::int64_t low = 0, high = last;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t value = e[i] + p.bias[i], step = p.a[i] * kSubpixelOne;
    if (value >= 0 && value + step * last >= 0) continue;
    if (value < 0 && value + step * last < 0) return {1, 0};
    if (step > 0)
      low = std::max(low, (-value + step - 1) / step);
    else
      high = std::min(high, value / -step);
  }
  return {static_cast<int>(low), static_cast<int>(high)};
}

}  // namespace

void Primitive::edges_of_row(const std::array<std::int64_t, 3>& e, int count, EdgeRow& row) const {
  // Integers of up to 53 bits are exact in a double, so every term here is exact.
  constexpr std::int64_t kExact = std::int64_t{1} << 52;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t step = a[i] * kSubpixelOne, last = e[i] + step * (count - 1);
    if (std::max(std::abs(e[i]), std::abs(last)) < kExact) {
      const auto from = static_cast<double>(e[i]), by = static_cast<double>(step);
      for (int k = 0; k < count; ++k) row[i][static_cast<std::size_t>(k)] = from + by * k;
    } else {
      for (int k = 0; k < count; ++k)
        row[i][static_cast<std::size_t>(k)] = static_cast<double>(e[i] + step * k);
    }
  }
}

View::View(const Camera& camera, int width, int height, int grid)
    : eye_(camera.eye),
      near_(camera.near_plane),
      width_(width * grid),
      height_(height * grid),
      grid_(grid) {
  if (width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide)
    throw spec::ConfigError(
        fmt::format("an image of {} x {} pixels requested; each side must be 1 to {}", width,
                    height, kMaxImageSide));
  const V3d towards = camera.target - camera.eye, sideways = towards.cross(camera.up);
  if (!finite(camera.eye) || !finite(towards) || !finite(sideways) || !(sideways.length() > 0.0))
    throw spec::ConfigError(
        "the camera has no direction: eye, target and up must be finite, eye and target apart, and "
        "up "
        "not along the view");
  if (!(camera.fov_y > 0.0 && camera.fov_y < kPi))
    throw spec::ConfigError(fmt::format(
        "the camera's field of view is {} radian; it must lie between 0 and pi", camera.fov_y));
  if (!(camera.near_plane > 0.0 && std::isfinite(camera.near_plane)))
    throw spec::ConfigError(
        fmt::format("the camera's near plane is at {}; it must be above 0", camera.near_plane));
  forward_ = towards / towards.length();
  right_ = sideways / sideways.length();
  down_ = forward_.cross(right_);
  focal_ = 0.5 * height_ / tangent(0.5 * camera.fov_y);
  centre_x_ = 0.5 * width_;
  centre_y_ = 0.5 * height_;
}

V3d View::transform(const V3d& point) const {
  const V3d relative = point - eye_;
  const double w = relative.dot(forward_);
  return {focal_ * relative.dot(right_) + centre_x_ * w,
          focal_ * relative.dot(down_) + centre_y_ * w, w};
}

std::vector<Primitive> set_up(const Mesh& mesh, const View& view, RasterCounts* counts) {
  RasterCounts ignored;
  RasterCounts& count = counts != nullptr ? *counts : ignored;
  std::vector<V3d> positions;
  positions.reserve(mesh.vertices.size());
  for (const Vertex& vertex : mesh.vertices) positions.push_back(view.transform(vertex.position));

  std::vector<Primitive> primitives;
  primitives.reserve(mesh.triangles.size());
  const ClipSpace space{view.near_plane()};
  Polygon polygon, scratch;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    ++count.triangles;
    const auto& corners = mesh.triangles[t].vertex;
    const std::array<V3d, 3> p{positions[corners[0]], positions[corners[1]], positions[corners[2]]};
    if (!finite(p[0]) || !finite(p[1]) || !finite(p[2])) {
      ++count.degenerate;
      continue;
    }
    if (outside_picture(p, view)) {
      ++count.outside;
      continue;
    }
    polygon = {{p[0], {1, 0, 0}}, {p[1], {0, 1, 0}}, {p[2], {0, 0, 1}}};
    if (!space.inside(p[0]) || !space.inside(p[1]) || !space.inside(p[2])) {
      ++count.clipped;
      clip(polygon, scratch, [&](const V3d& v) { return space.behind(v); });
      clip(polygon, scratch, [&](const V3d& v) { return space.left(v); });
      clip(polygon, scratch, [&](const V3d& v) { return space.right(v); });
      clip(polygon, scratch, [&](const V3d& v) { return space.above(v); });
      clip(polygon, scratch, [&](const V3d& v) { return space.below(v); });
    }
    bool any = false;
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      if (auto primitive = make_primitive({&polygon[0], &polygon[i - 1], &polygon[i]}, view)) {
        any = true;
        primitive->triangle = static_cast<std::uint32_t>(t);
        if (primitive->left <= primitive->right && primitive->top <= primitive->bottom)
          primitives.push_back(*primitive);
      }
    }
    if (!any) ++count.degenerate;
  }
  return primitives;
}

Occlusion::Occlusion(const std::vector<Primitive>& primitives, int width, int height, int tile)
    : primitives_(primitives),
      tile_(tile),
      columns_((width + tile - 1) / tile),
      rows_((height + tile - 1) / tile) {
  const auto bins = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  auto for_each_bin = [&](const Primitive& p, auto&& visit) {
    for (int row = p.top / tile_; row <= p.bottom / tile_; ++row)
      for (int column = p.left / tile_; column <= p.right / tile_; ++column)
        visit(bin(column, row));
  };
  first_.assign(bins + 1, 0);
  for (const Primitive& p : primitives) for_each_bin(p, [&](std::size_t i) { ++first_[i + 1]; });
  for (std::size_t i = 0; i < bins; ++i) first_[i + 1] += first_[i];
  members_.resize(first_[bins]);
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < primitives.size(); ++i)
    for_each_bin(primitives[i],
                 [&](std::size_t at) { members_[next[at]++] = static_cast<std::uint32_t>(i); });
}

void Occlusion::resolve(int column, int row, int offset_x, int offset_y,
                        std::vector<std::int32_t>& owners, std::vector<double>& depths) const {
  const auto samples = static_cast<std::size_t>(tile_) * static_cast<std::size_t>(tile_);
  owners.assign(samples, kNobody);
  depths.assign(samples, 0.0);
  const int x0 = column * tile_, y0 = row * tile_;
  const std::size_t here = bin(column, row);
  EdgeRow edges;
  for (std::uint32_t m = first_[here]; m < first_[here + 1]; ++m) {
    const Primitive& p = primitives_[members_[m]];
    const int left = std::max(x0, p.left), right = std::min(x0 + tile_ - 1, p.right);
    const int top = std::max(y0, p.top), bottom = std::min(y0 + tile_ - 1, p.bottom);
    for (int y = top; y <= bottom; ++y) {
      std::array<std::int64_t, 3> e =
          p.edges(cell_centre(left) + offset_x, cell_centre(y) + offset_y);
      const Span span = covered_span(p, e, right - left);
      const int count = span.last - span.first + 1;
      if (count <= 0) continue;
      for (std::size_t i = 0; i < 3; ++i) e[i] += p.a[i] * kSubpixelOne * span.first;
      p.edges_of_row(e, count, edges);
      CellRow inverse_w;
      for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
        inverse_w[k] = p.depth(edges[0][k], edges[1][k], edges[2][k]);
      const std::size_t at = static_cast<std::size_t>(y - y0) * static_cast<std::size_t>(tile_) +
                             static_cast<std::size_t>(left + span.first - x0);
      for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
        if (!(inverse_w[k] > depths[at + k])) continue;
        depths[at + k] = inverse_w[k];
        owners[at + k] = static_cast<std::int32_t>(members_[m]);
      }
    }
  }
}

}  // namespace deburr::tb
