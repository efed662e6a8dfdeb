// SPDX-License-Identifier: MIT
#include "tb/scene/polygon.h"

#include <GL/glu.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <new>
#include <utility>

namespace deburr::tb {

using Imath::V2d;
using Imath::V3d;

namespace {

using Corner = MeshBuilder::Corner;

constexpr std::size_t kAlwaysSimpleEnough = 128;  // corners
constexpr double kFlat = 1e-4;                    // height divided by the longest side

// ---- limits -------------------------------------------------------------------------------------

double turn(const V2d& a, const V2d& b, const V2d& c) { return (b - a).cross(c - a); }

std::size_t crossings(const std::vector<V2d>& points, std::size_t limit) {
  std::size_t found = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const V2d &a = points[i], &b = points[(i + 1) % points.size()];
    const auto [left, right] = std::minmax(a.x, b.x);
    const auto [low, high] = std::minmax(a.y, b.y);
    for (std::size_t j = i + 1; j < points.size() && found <= limit; ++j) {
      const V2d &c = points[j], &d = points[j + 1 < points.size() ? j + 1 : 0];
      if (std::max(c.x, d.x) < left || std::min(c.x, d.x) > right || std::max(c.y, d.y) < low ||
          std::min(c.y, d.y) > high)
        continue;
      if (turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0) ++found;
    }
  }
  return found;
}

// ---- triangles ----------------------------------------------------------------------------------

V3d normal_of(const PolygonPart& t) {
  return (t[1]->position - t[0]->position).cross(t[2]->position - t[0]->position);
}
double squared_side(const PolygonPart& t, std::size_t k) {
  return (t[(k + 1) % 3]->position - t[k]->position).length2();
}
std::size_t longest_side(const PolygonPart& t) {
  std::size_t longest = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (squared_side(t, k) > squared_side(t, longest)) longest = k;
  return longest;
}

// The tessellator leaves triangles of zero or near-zero area between collinear corners. Their sides
// would be drawn as edges that the faces do not have. To remove such a triangle, its longest side,
// which is inside the polygon, is flipped to the other diagonal of the two adjacent triangles.
class FlatTriangles {
 public:
  FlatTriangles(std::vector<PolygonPart>& triangles, const V3d& along)
      : triangles_(triangles), along_(along) {}

  void remove() {
    std::vector<std::size_t> open;
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      if (flatness(triangles_[t]) < kFlat) open.push_back(t);
    if (open.empty()) return;
    for (std::size_t t = 0; t < triangles_.size(); ++t) enter(t);
    std::vector<bool> seen(triangles_.size(), false);
    while (!open.empty()) {
      const std::size_t t = open.back();
      const std::size_t other = across_longest(t);
      // A flat neighbour with a longer side must be flipped first.
      if (!seen[t] && other != kNone && !seen[other] && flatness(triangles_[other]) < kFlat &&
          longest(other) > longest(t)) {
        seen[t] = true;
        open.push_back(other);
        continue;
      }
      seen[t] = true;
      open.pop_back();
      if (other != kNone && flatness(triangles_[t]) < kFlat) trade(t, other);
    }
  }

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};

  double flatness(const PolygonPart& t) const {
    const double longest = squared_side(t, longest_side(t));
    return longest > 0.0 ? normal_of(t).dot(along_) / longest : 0.0;
  }
  double longest(std::size_t t) const {
    return squared_side(triangles_[t], longest_side(triangles_[t]));
  }
  void enter(std::size_t t) {
    for (std::size_t k = 0; k < 3; ++k)
      triangle_at_[{triangles_[t][k], triangles_[t][(k + 1) % 3]}] = t;
  }
  std::size_t across_longest(std::size_t t) const {
    const std::size_t k = longest_side(triangles_[t]);
    const auto found = triangle_at_.find({triangles_[t][(k + 1) % 3], triangles_[t][k]});
    return found == triangle_at_.end() ? kNone : found->second;
  }
  void trade(std::size_t t, std::size_t other) {
    const std::size_t k = longest_side(triangles_[t]);
    const Corner *c = triangles_[t][k], *a = triangles_[t][(k + 1) % 3],
                 *b = triangles_[t][(k + 2) % 3], *d = nullptr;
    for (const Corner* corner : triangles_[other])
      if (corner != a && corner != c) d = corner;
    const PolygonPart first{a, b, d}, second{b, c, d};
    if (std::min(flatness(first), flatness(second)) <= flatness(triangles_[t])) return;
    triangle_at_.erase({a, c});
    triangle_at_.erase({c, a});
    triangles_[t] = first;
    triangles_[other] = second;
    enter(t);
    enter(other);
  }

  std::vector<PolygonPart>& triangles_;
  V3d along_;                                                                   // unit length
  std::map<std::pair<const Corner*, const Corner*>, std::size_t> triangle_at_;  // by its sides
};

}  // namespace

V3d area_vector(const PolygonCorners& polygon) {
  V3d sum(0, 0, 0);
  for (std::size_t k = 2; k < polygon.size(); ++k)
    sum += (polygon[k - 1].position - polygon[0].position)
               .cross(polygon[k].position - polygon[0].position);
  return sum;
}

bool is_strictly_convex(const PolygonCorners& polygon) {
  const V3d along = area_vector(polygon);
  if (!(along.length2() > 0.0)) return false;
  const std::size_t size = polygon.size();
  for (std::size_t k = 0; k < size; ++k) {
    const V3d &a = polygon[k].position, &b = polygon[(k + 1) % size].position,
              &c = polygon[(k + 2) % size].position;
    if (!((b - a).cross(c - b).dot(along) > 0.0)) return false;
  }
  return true;
}

std::string too_complex(const PolygonCorners& polygon) {
  if (polygon.size() > kMaxPolygonCorners)
    return fmt::format("has {} corners, the limit is {}; split it", polygon.size(),
                       kMaxPolygonCorners);
  if (polygon.size() <= kAlwaysSimpleEnough) return "";
  const V3d along = area_vector(polygon);
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (std::abs(along[k]) > std::abs(along[axis])) axis = k;
  std::vector<V2d> points;
  points.reserve(polygon.size());
  for (const Corner& corner : polygon)
    points.emplace_back(corner.position[(axis + 1) % 3], corner.position[(axis + 2) % 3]);
  if (crossings(points, kMaxPolygonCrossings) <= kMaxPolygonCrossings) return "";
  return fmt::format("crosses itself more than {} times; repair it", kMaxPolygonCrossings);
}

// ---- the tessellator ----------------------------------------------------------------------------

struct PolygonSplitter::State {
  struct Delete {
    void operator()(GLUtesselator* one) const { gluDeleteTess(one); }
  };
  std::unique_ptr<GLUtesselator, Delete> tessellator{gluNewTess()};
  std::deque<Corner> made;  // corners made at crossings
  std::vector<const Corner*> corners;
  std::vector<PolygonPart> triangles;
  bool crosses = false, failed = false;

  // The tessellator is written in C, so exceptions must not pass through it.
  static void vertex(void* corner, void* state) {
    auto& self = *static_cast<State*>(state);
    try {
      self.corners.push_back(static_cast<const Corner*>(corner));
    } catch (const std::bad_alloc&) {
      self.failed = true;
    }
  }
  // Called for coincident corners, as at a bridge, which are merged, and where edges cross between
  // their corners.
  static void combine(const GLdouble* position, void* const* parts, const GLfloat* weights,
                      void** result, void* state) {
    auto& self = *static_cast<State*>(state);
    const auto part = [&](int i) { return static_cast<const Corner*>(parts[i]); };
    *result = parts[0];
    if (parts[2] == nullptr && part(0)->position == part(1)->position) return;
    self.crosses = true;
    Corner corner{V3d(position[0], position[1], position[2]), V3d(0, 0, 0), V2d(0, 0)};
    for (int i = 0; i < 4; ++i) {
      if (parts[i] == nullptr) continue;
      if (part(i)->normal && corner.normal) *corner.normal += *part(i)->normal * double{weights[i]};
      if (part(i)->uv && corner.uv) *corner.uv += *part(i)->uv * double{weights[i]};
      if (!part(i)->normal) corner.normal.reset();
      if (!part(i)->uv) corner.uv.reset();
    }
    try {
      *result = &self.made.emplace_back(corner);
    } catch (const std::bad_alloc&) {
      self.failed = true;
    }
  }
  // If there is an edge callback, the tessellator emits only triangles and no strips or fans.
  static void edge(GLboolean) {}
  static void error(GLenum, void* state) { static_cast<State*>(state)->failed = true; }

  template <class Function>
  void call_back(GLenum which, Function* function) {
    gluTessCallback(tessellator.get(), which, reinterpret_cast<_GLUfuncptr>(function));
  }
};

PolygonSplitter::PolygonSplitter() : state_(std::make_unique<State>()) {
  if (!state_->tessellator) throw std::bad_alloc();
  state_->call_back(GLU_TESS_VERTEX_DATA, State::vertex);
  state_->call_back(GLU_TESS_COMBINE_DATA, State::combine);
  state_->call_back(GLU_TESS_EDGE_FLAG, State::edge);
  state_->call_back(GLU_TESS_ERROR_DATA, State::error);
  gluTessProperty(state_->tessellator.get(), GLU_TESS_WINDING_RULE, GLU_TESS_WINDING_NONZERO);
}

PolygonSplitter::~PolygonSplitter() = default;

bool PolygonSplitter::crosses_itself() const { return state_->crosses; }

const std::vector<PolygonPart>& PolygonSplitter::split(const PolygonCorners& polygon) {
  State& state = *state_;
  state.made.clear();
  state.corners.clear();
  state.triangles.clear();
  state.crosses = state.failed = false;
  V3d along = area_vector(polygon);
  along =
      along.length() > 0.0 ? along.normalized() : V3d(0, 0, 0);  // zero: the tessellator chooses
  GLUtesselator* const tessellator = state.tessellator.get();
  gluTessNormal(tessellator, along.x, along.y, along.z);
  gluTessBeginPolygon(tessellator, &state);
  gluTessBeginContour(tessellator);
  for (const Corner& corner : polygon) {
    std::array<GLdouble, 3> position{corner.position.x, corner.position.y, corner.position.z};
    gluTessVertex(tessellator, position.data(), const_cast<Corner*>(&corner));
  }
  gluTessEndContour(tessellator);
  gluTessEndPolygon(tessellator);
  if (state.failed) throw std::bad_alloc();
  for (std::size_t k = 0; k + 2 < state.corners.size(); k += 3)
    state.triangles.push_back({state.corners[k], state.corners[k + 1], state.corners[k + 2]});
  FlatTriangles(state.triangles, along).remove();
  return state.triangles;
}

}  // namespace deburr::tb
