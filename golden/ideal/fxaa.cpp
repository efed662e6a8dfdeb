// SPDX-License-Identifier: MIT
#include "golden/ideal/fxaa.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "spec/poll.h"

namespace deburr::golden::ideal {
namespace {

// Luma around a pixel, in the coordinates of its edge: `along` it (right; vertical edge: down) and
// `across` it (down; vertical edge: right).
class Surroundings {
 public:
  Surroundings(const ColourFrame& frame, int x, int y, bool horizontal)
      : frame_(frame), x_(x), y_(y), horizontal_(horizontal) {}
  const Rgba8& pixel(int along, int across) const {
    return horizontal_ ? frame_.clamped(x_ + along, y_ + across)
                       : frame_.clamped(x_ + across, y_ + along);
  }
  int luma(int along, int across) const { return luma_of(pixel(along, across)); }
  // Luma on the border between the pixel's row and the row on its `side`, interpolated between
  // pixels. Steps are multiples of a half, so this is exact.
  double on_the_edge(double along, int side) const {
    const int first = static_cast<int>(std::floor(along));
    const auto pair = [&](int at) { return (luma(at, 0) + luma(at, side)) / 2.0; };
    return std::lerp(pair(first), pair(first + 1), along - first);
  }
  // Bend across the edge: second differences of three columns, with the middle one weighted twice.
  int bend() const {
    const auto column = [&](int along) {
      return std::abs(luma(along, -1) + luma(along, 1) - 2 * luma(along, 0));
    };
    return column(-1) + 2 * column(0) + column(1);
  }

 private:
  const ColourFrame& frame_;
  int x_, y_;
  bool horizontal_;
};

struct End {
  double distance = 0;
  double beyond = 0;  // luma at the last position, relative to that of the edge
};
End find_end(const Surroundings& around, int direction, int side, double edge_luma, double limit,
             std::span<const double> steps) {
  End end;
  for (const double step : steps.first(steps.size() - 1)) {
    end.distance += step;
    end.beyond = around.on_the_edge(direction * end.distance, side) - edge_luma;
    if (std::abs(end.beyond) >= limit) return end;
  }
  end.distance += steps.back();
  return end;
}

// Offset of the sample across the edge, from the distances to both ends of the edge.
double offset_by_ends(const Surroundings& around, int side, int gradient,
                      std::span<const double> steps) {
  const double middle = around.luma(0, 0), edge_luma = (middle + around.luma(0, side)) / 2;
  const double limit = gradient / 4.0;
  const End back = find_end(around, -1, side, edge_luma, limit, steps),
            ahead = find_end(around, 1, side, edge_luma, limit, steps);
  const End& near = back.distance < ahead.distance ? back : ahead;
  // The other side contributes only if it continues beyond the nearer end.
  if ((near.beyond < 0) == (middle < edge_luma)) return 0;
  return 0.5 - near.distance / (back.distance + ahead.distance);
}

// Offset of the sample across the edge, from the contrast with all eight neighbours.
double offset_by_contrast(const Surroundings& around, int range, double weight) {
  const int beside =
      around.luma(-1, 0) + around.luma(1, 0) + around.luma(0, -1) + around.luma(0, 1);
  const int corners =
      around.luma(-1, -1) + around.luma(1, -1) + around.luma(-1, 1) + around.luma(1, 1);
  const double off = std::abs(2 * beside + corners - 12 * around.luma(0, 0)) / 12.0;
  const double share = std::min(off / range, 1.0);
  const double eased = share * share * (3 - 2 * share);
  return eased * eased * weight;
}

}  // namespace

std::vector<Rgba8> fxaa(const ColourFrame& frame, const FxaaSettings& settings) {
  constexpr double kFullScale = 255000;
  const ColourScale scale(settings.linear_light);
  std::vector<Rgba8> result = frame.pixels;
  for (int y = 0; y < frame.height; ++y) {
    spec::poll();
    for (int x = 0; x < frame.width; ++x) {
      const Surroundings rows(frame, x, y, true), columns(frame, x, y, false);
      const int middle = rows.luma(0, 0);
      const auto [least, most] = std::minmax(
          {middle, rows.luma(-1, 0), rows.luma(1, 0), rows.luma(0, -1), rows.luma(0, 1)});
      if (most - least < std::max(settings.least_threshold * kFullScale, settings.threshold * most))
        continue;
      const Surroundings& around = rows.bend() >= columns.bend() ? rows : columns;
      const int before = std::abs(around.luma(0, -1) - middle),
                behind = std::abs(around.luma(0, 1) - middle);
      const int side = before >= behind ? -1 : 1;
      const double offset =
          std::max(offset_by_ends(around, side, std::max(before, behind), settings.steps),
                   offset_by_contrast(around, most - least, settings.subpixel));
      if (offset == 0) continue;
      const Rgba8& own = around.pixel(0, 0);
      result[frame.index(x, y)] = scale.encoded(
          mixed(scale.decoded(own), scale.decoded(around.pixel(0, side)), offset), own[3]);
    }
  }
  return result;
}

}  // namespace deburr::golden::ideal
