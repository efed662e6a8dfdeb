// SPDX-License-Identifier: MIT
// Transforms a mesh with a camera into clipped screen triangles on a grid, and resolves visibility.
// The rasteriser and the reference renderer share it; it is internal to tb/scene.
//
// Formats: screen positions 24.8 (1/256 of a sample cell), edge functions exact in 64 bits. A
// position lies within +-kGuardBand cells, so a coordinate has 27 bits, a difference 28 and an edge
// function 56.
#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tb/scene/image.h"
#include "tb/scene/rasteriser.h"
#include "tb/scene/scenes.h"

namespace deburr::tb {

inline constexpr int kSubpixelOne = 256;
inline constexpr int kGuardBand = 1 << 18;  // cells from the origin

// Whether all coordinates are finite.
inline bool finite(const Imath::V3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Camera and picture; every pixel is divided into grid x grid sample cells.
class View {
 public:
  View(const Camera& camera, int width, int height, int grid);  // throws ConfigError

  // (x, y, w): w is the distance along the view direction, x / w and y / w are cells.
  Imath::V3d transform(const Imath::V3d& point) const;
  // Vector from the eye through cell position (x, y), one unit long along the view direction.
  Imath::V3d ray(double x, double y) const {
    return forward_ + right_ * ((x - centre_x_) / focal_) + down_ * ((y - centre_y_) / focal_);
  }
  int width() const { return width_; }    // cells
  int height() const { return height_; }  // cells
  int grid() const { return grid_; }
  double near_plane() const { return near_; }

 private:
  Imath::V3d eye_, right_, down_, forward_;
  double focal_, centre_x_, centre_y_, near_;
  int width_, height_, grid_;
};

// A sample position: cell (x, y) at (256 x + 128 + offset) / 256.
constexpr std::int64_t cell_centre(int cell) { return std::int64_t{cell} * kSubpixelOne + 128; }

inline constexpr int kMaxTile = 64;  // cells

// One value per cell in a section of a tile row.
using CellRow = std::array<double, kMaxTile>;
using EdgeRow = std::array<CellRow, 3>;

// One triangle after clipping.
struct Primitive {
  std::uint32_t triangle = 0;                    // index into Mesh::triangles
  int left = 0, top = 0, right = 0, bottom = 0;  // bounding box in cells, inclusive
  std::array<std::int64_t, 3> a{}, b{}, c{};     // edge i is a x + b y + c, positive inside
  std::array<std::int64_t, 3> bias{};            // 0 on top and left edges, otherwise -1
  std::array<double, 3> inverse_w{};             // 1 / w at each corner, divided by twice the area
  std::array<Imath::V3d, 3>
      weight{};  // of the mesh triangle's corners, divided by w and twice the area

  std::array<std::int64_t, 3> edges(std::int64_t x, std::int64_t y) const {
    return {a[0] * x + b[0] * y + c[0], a[1] * x + b[1] * y + c[1], a[2] * x + b[2] * y + c[2]};
  }
  bool covers(const std::array<std::int64_t, 3>& e) const {
    return ((e[0] + bias[0]) | (e[1] + bias[1]) | (e[2] + bias[2])) >= 0;
  }
  double depth(double e0, double e1, double e2) const {  // 1 / w
    return e0 * inverse_w[0] + e1 * inverse_w[1] + e2 * inverse_w[2];
  }
  // Edge values at `count` cells to the right of the one with edge values `e`.
  void edges_of_row(const std::array<std::int64_t, 3>& e, int count, EdgeRow& row) const;
  // Weights of the mesh triangle's corners, each divided by w; their sum is 1 / w. Inside the
  // triangle no term is negative, so there is no cancellation even in thin triangles.
  Imath::V3d corner_weights(const std::array<std::int64_t, 3>& e) const {
    return weight[0] * static_cast<double>(e[0]) + weight[1] * static_cast<double>(e[1]) +
           weight[2] * static_cast<double>(e[2]);
  }
};

// Clips, projects and snaps; primitives keep the order of the mesh's triangles.
std::vector<Primitive> set_up(const Mesh& mesh, const View& view, RasterCounts* counts = nullptr);

inline constexpr std::int32_t kNobody = -1;

// Finds the nearest primitive at each sample of a rectangle of cells.
class Occlusion {
 public:
  // `tile` is at most kMaxTile.
  Occlusion(const std::vector<Primitive>& primitives, int width, int height, int tile);
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  int tile() const { return tile_; }
  // False if no primitive's bounding box touches the tile.
  bool occupied(int column, int row) const {
    return first_[bin(column, row)] < first_[bin(column, row) + 1];
  }

  // For tile (column, row): owner and 1 / w of the sample in each cell, at the centre of the cell +
  // (offset_x, offset_y) / 256. The order is row-major, with tile() cells per row. If depths are
  // equal, the first primitive wins. The memory of the vectors is reused.
  void resolve(int column, int row, int offset_x, int offset_y, std::vector<std::int32_t>& owners,
               std::vector<double>& depths) const;

 private:
  std::size_t bin(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  const std::vector<Primitive>& primitives_;
  int tile_, columns_, rows_;
  std::vector<std::uint32_t> first_, members_;  // members of bin i: first_[i] .. first_[i + 1]
};

// Calls visit(x, y, owner, inverse_w) for every cell with a visible surface at its centre.
template <class Visit>
void for_each_resolved_pixel(const std::vector<Primitive>& primitives, const View& view,
                             Visit&& visit) {
  constexpr int kTileCells = 32;
  const Occlusion occlusion(primitives, view.width(), view.height(), kTileCells);
  std::vector<std::int32_t> owners;
  std::vector<double> depths;
  for (int row = 0; row < occlusion.rows(); ++row) {
    for (int column = 0; column < occlusion.columns(); ++column) {
      if (!occlusion.occupied(column, row)) continue;
      occlusion.resolve(column, row, 0, 0, owners, depths);
      for (std::size_t i = 0; i < owners.size(); ++i)
        if (owners[i] != kNobody)
          visit(column * kTileCells + static_cast<int>(i % kTileCells),
                row * kTileCells + static_cast<int>(i / kTileCells), owners[i], depths[i]);
    }
  }
}

}  // namespace deburr::tb
