// SPDX-License-Identifier: MIT
// SMAA 1x on luma in real numbers: edges, and the weights of every edge by searches from each
// pixel.
//
// Reference for edges, area table, diagonals and corners of golden/morphological
// (tb/oracle/smaa_test.cpp). Source: Jimenez, Echevarria, Sousa and Gutierrez, SMAA: Enhanced
// Subpixel Morphological Antialiasing, 2012, and the shader published with it. Independent of the
// engine: no runs and no descriptors; each pixel searches for its own ends, two pixels per fetch.
// The defaults differ from the shader in two points that can be switched: there are no edges
// outside the frame, where the shader's sampler clamps, and areas are not rounded to eight bits.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "golden/ideal/smaa_area.h"

namespace deburr::golden::ideal {

// Edges outside the frame: none, or those of the nearest pixel, as the shader's sampler clamps.
enum class SmaaBorder : std::uint8_t { kEnd, kClamp };

struct SmaaSettings {
  double threshold = 0.1;
  int search_steps = 16;                      // of two pixels each
  int diagonal_steps = 8;                     // 0: no diagonals
  std::optional<double> corner_keeps = 0.25;  // fraction of a weight that remains at a sharp corner
  bool bytes = false;                  // areas as in the published texture, smaa_area_bytes() / 255
  std::array<int, 2> more_steps = {};  // extra search steps: to the left (up), to the right (down)
};

// The two values of an entry of the published area texture, subsample offset 0; r is the weight of
// the second pixel. Truncated; on a diagonal, double precision decides for points on the line.
struct SmaaBytes {
  int r = 0, g = 0;
};
SmaaBytes smaa_area_bytes(int pattern, int l, int r);
SmaaBytes smaa_diagonal_bytes(int e1, int e2, int d1, int d2);
// Length that a search adds for its last fetch, 0..2, from the published search texture. Four edges
// along the line and four across it: the far pair of pixels first, the upper row first in each
// pair.
int smaa_search_length(const std::array<bool, 4>& across, const std::array<bool, 4>& along,
                       bool right);

// Pixels with an edge to their left, and pixels with an edge above them.
class SmaaEdges {
 public:
  SmaaEdges(int width, int height, SmaaBorder border = SmaaBorder::kEnd)
      : width_(width),
        height_(height),
        border_(border),
        left_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)),
        top_(left_.size()) {}
  int width() const { return width_; }
  int height() const { return height_; }
  bool left(int x, int y) const { return read(left_, x, y); }
  bool top(int x, int y) const { return read(top_, x, y); }
  void set_left(int x, int y, bool edge) { left_[index(x, y)] = edge; }
  void set_top(int x, int y, bool edge) { top_[index(x, y)] = edge; }

 private:
  bool read(const std::vector<bool>& edges, int x, int y) const {
    if (border_ == SmaaBorder::kClamp)
      return edges[index(std::clamp(x, 0, width_ - 1), std::clamp(y, 0, height_ - 1))];
    return x >= 0 && y >= 0 && x < width_ && y < height_ && edges[index(x, y)];
  }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }
  int width_, height_;
  SmaaBorder border_;
  std::vector<bool> left_, top_;
};

// Luma of a frame, 0..1, row by row.
struct SmaaLuma {
  std::vector<double> values;
  int width = 0, height = 0;
  double at(int x, int y) const {
    return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
};

// Margins of an edge decision: its step minus the threshold, and twice its step minus the largest
// step around it. It is an edge if neither is negative.
struct SmaaMargins {
  double threshold = 0, contrast = 0;
  // Tolerance for rounding errors of luma.
  bool edge() const { return threshold > -1e-12 && contrast > -1e-12; }
};
SmaaMargins left_margins(const SmaaLuma& luma, double threshold, int x, int y);
SmaaMargins top_margins(const SmaaLuma& luma, double threshold, int x, int y);
SmaaEdges smaa_edges(const SmaaLuma& luma, double threshold);

struct SmaaPixelWeights {
  SmaaWeights top, left;
  bool diagonal = false;
};
SmaaPixelWeights smaa_weights(const SmaaEdges& edges, const SmaaSettings& settings, int x, int y);

}  // namespace deburr::golden::ideal
