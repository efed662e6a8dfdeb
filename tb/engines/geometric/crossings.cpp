// SPDX-License-Identifier: MIT
#include "tb/engines/geometric/crossings.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

namespace deburr::tb {
namespace {

using Imath::V3d;

// Tolerance relative to the longest extent of the mesh: closer points lie in a plane. Mesh files
// keep six or seven digits.
constexpr double kOnPlane = 0x1p-20;
// Sine of the angle between two faces below which their intersection is too inexact to use.
constexpr double kParallel = 0x1p-10;
constexpr std::size_t kLeaf = 4;  // faces per leaf

struct Box {
  V3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  void add(const V3d& p) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  void add(const Box& box) {
    add(box.low);
    add(box.high);
  }
  bool meets(const Box& other) const {
    for (int i = 0; i < 3; ++i)
      if (low[i] > other.high[i] || other.low[i] > high[i]) return false;
    return true;
  }
};

// ---- boxes --------------------------------------------------------------------------------------

// A balanced binary tree over the faces; the children of node i are 2 i + 1 and 2 i + 2.
class BoxTree {
 public:
  explicit BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
    for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = i;
    if (!order_.empty()) build(0, 0, order_.size());
  }

  // Calls test(a, b) once for each pair of faces whose boxes overlap.
  template <class Test>
  void for_each_pair(Test&& test) const {
    if (order_.empty()) return;
    std::vector<std::pair<std::size_t, std::size_t>> open = {{0, 0}};
    while (!open.empty()) {
      const auto [a, b] = open.back();
      open.pop_back();
      if (a != b && !nodes_[a].box.meets(nodes_[b].box)) continue;
      const bool leaf_a = is_leaf(a), leaf_b = is_leaf(b);
      if (leaf_a && leaf_b) {
        test_leaves(a, b, test);
      } else if (a == b) {
        open.insert(open.end(), {{left(a), left(a)}, {right(a), right(a)}, {left(a), right(a)}});
      } else if (leaf_b || (!leaf_a && size(a) >= size(b))) {
        open.insert(open.end(), {{left(a), b}, {right(a), b}});
      } else {
        open.insert(open.end(), {{a, left(b)}, {a, right(b)}});
      }
    }
  }

 private:
  struct Node {
    Box box;
    std::size_t begin = 0, end = 0;  // range in order_
  };
  static std::size_t left(std::size_t node) { return 2 * node + 1; }
  static std::size_t right(std::size_t node) { return 2 * node + 2; }
  std::size_t size(std::size_t node) const { return nodes_[node].end - nodes_[node].begin; }
  bool is_leaf(std::size_t node) const { return size(node) <= kLeaf; }

  // Splits at the median of box centres along the longest axis of these centres. The face number
  // breaks ties, so that the tree is deterministic.
  void build(std::size_t node, std::size_t begin, std::size_t end) {
    if (nodes_.size() <= node) nodes_.resize(node + 1);
    Box box, middles;
    const auto middle = [&](std::size_t face) { return boxes_[face].low + boxes_[face].high; };
    for (std::size_t i = begin; i < end; ++i) {
      box.add(boxes_[order_[i]]);
      middles.add(middle(order_[i]));
    }
    nodes_[node] = {box, begin, end};
    if (end - begin <= kLeaf) return;
    const V3d extent = middles.high - middles.low;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                     : extent.y >= extent.z                       ? 1
                                                                  : 2;
    const std::size_t half = begin + (end - begin) / 2;
    const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(half), at(end), [&](std::size_t a, std::size_t b) {
      const double x = middle(a)[axis], y = middle(b)[axis];
      return x != y ? x < y : a < b;
    });
    build(left(node), begin, half);
    build(right(node), half, end);
  }

  template <class Test>
  void test_leaves(std::size_t a, std::size_t b, Test&& test) const {
    for (std::size_t i = nodes_[a].begin; i < nodes_[a].end; ++i)
      for (std::size_t k = a == b ? i + 1 : nodes_[b].begin; k < nodes_[b].end; ++k)
        if (boxes_[order_[i]].meets(boxes_[order_[k]])) test(order_[i], order_[k]);
  }

  std::vector<Box> boxes_;
  std::vector<std::size_t> order_;  // face numbers, grouped by node
  std::vector<Node> nodes_;
};

// ---- two faces ----------------------------------------------------------------------------------

class Crosser {
 public:
  Crosser(std::span<const V3d> places, std::span<const CrossingFace> faces)
      : places_(places), faces_(faces) {
    Box all;
    normals_.reserve(faces.size());
    for (const CrossingFace& face : faces) {
      for (const std::uint32_t p : face.place) all.add(places[p]);
      const V3d &a = places[face.place[0]], &b = places[face.place[1]], &c = places[face.place[2]];
      normals_.push_back((b - a).cross(c - a).normalized());
    }
    const V3d extent = all.high - all.low;
    tolerance_ = kOnPlane * std::max({extent.x, extent.y, extent.z, 0.0});
  }

  Box box_of(std::size_t face) const {
    Box box;
    for (const std::uint32_t p : faces_[face].place) box.add(places_[p]);
    return box;
  }

  std::optional<Crossing> cross(std::size_t a, std::size_t b) const {
    if (share_a_place(faces_[a], faces_[b])) return std::nullopt;
    const V3d along = normals_[a].cross(normals_[b]);
    if (!(along.length() > kParallel)) return std::nullopt;
    const auto of_a = cut(a, b), of_b = cut(b, a);
    if (!of_a || !of_b) return std::nullopt;
    int axis = 0;
    for (int i = 1; i < 3; ++i)
      if (std::abs(along[i]) > std::abs(along[axis])) axis = i;
    const auto sorted = [&](std::array<V3d, 2> ends) {
      if (ends[1][axis] < ends[0][axis]) std::swap(ends[0], ends[1]);
      return ends;
    };
    const std::array<V3d, 2> first = sorted(*of_a), second = sorted(*of_b);
    const V3d& low = first[0][axis] >= second[0][axis] ? first[0] : second[0];
    const V3d& high = first[1][axis] <= second[1][axis] ? first[1] : second[1];
    if (!(high[axis] - low[axis] > tolerance_)) return std::nullopt;
    return Crossing{{low, high}, faces_[a].face, faces_[b].face};
  }

 private:
  static bool share_a_place(const CrossingFace& a, const CrossingFace& b) {
    for (const std::uint32_t p : a.place)
      if (p == b.place[0] || p == b.place[1] || p == b.place[2]) return true;
    return false;
  }

  // Part of a face in the plane of another one. Points in that plane count as above it, so that of
  // two faces that meet in it only one is cut.
  std::optional<std::array<V3d, 2>> cut(std::size_t face, std::size_t by) const {
    const V3d& origin = places_[faces_[by].place[0]];
    std::array<double, 3> height;
    for (std::size_t i = 0; i < 3; ++i) {
      height[i] = normals_[by].dot(places_[faces_[face].place[i]] - origin);
      if (std::abs(height[i]) <= tolerance_) height[i] = 0;
    }
    std::array<V3d, 2> ends;
    std::size_t found = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      std::size_t k = (i + 1) % 3, j = i;
      if ((height[j] < 0) == (height[k] < 0)) continue;
      // Start at the vertex with the lower number, so that all faces at this edge give the same
      // point.
      if (faces_[face].place[k] < faces_[face].place[j]) std::swap(j, k);
      const V3d &p = places_[faces_[face].place[j]], &q = places_[faces_[face].place[k]];
      ends[found++] = height[j] == 0   ? p
                      : height[k] == 0 ? q
                                       : p + (q - p) * (height[j] / (height[j] - height[k]));
    }
    if (found != 2) return std::nullopt;
    return ends;
  }

  std::span<const V3d> places_;
  std::span<const CrossingFace> faces_;
  std::vector<V3d> normals_;
  double tolerance_ = 0;
};

}  // namespace

Crossings find_crossings(std::span<const V3d> places, std::span<const CrossingFace> faces) {
  const Crosser crosser(places, faces);
  std::vector<Box> boxes;
  boxes.reserve(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) boxes.push_back(crosser.box_of(i));
  Crossings result;
  BoxTree(std::move(boxes)).for_each_pair([&](std::size_t a, std::size_t b) {
    ++result.tested;
    const bool in_order = faces[a].face < faces[b].face;
    if (const auto crossing = crosser.cross(in_order ? a : b, in_order ? b : a))
      result.segments.push_back(*crossing);
  });
  std::sort(result.segments.begin(), result.segments.end(),
            [](const Crossing& a, const Crossing& b) {
              return std::pair(a.f0, a.f1) < std::pair(b.f0, b.f1);
            });
  return result;
}

}  // namespace deburr::tb
