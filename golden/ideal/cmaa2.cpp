// SPDX-License-Identifier: MIT
#include "golden/ideal/cmaa2.h"

#include <algorithm>
#include <cstdlib>
#include <initializer_list>

#include "spec/poll.h"

namespace deburr::golden::ideal {
namespace {

// ---- edges --------------------------------------------------------------------------------------

// Differences of the channels, weighted as in luma; 0 if a pixel is outside the frame.
double channel_step(const ColourFrame& frame, int x, int y, int to_x, int to_y) {
  const auto outside = [&](int px, int py) {
    return px < 0 || py < 0 || px >= frame.width || py >= frame.height;
  };
  if (outside(x, y) || outside(to_x, to_y)) return 0;
  const Rgba8 &a = frame.at(x, y), &b = frame.at(to_x, to_y);
  Rgba8 difference{};
  for (std::size_t i = 0; i < 3; ++i)
    difference[i] = static_cast<std::uint8_t>(std::abs(a[i] - b[i]));
  return luma_of(difference) / 255000.0;
}

// ---- shapes -------------------------------------------------------------------------------------

// The edges of an axis: `along` is below a pixel, `across` to its right. `turned` exchanges rows
// and columns.
struct Cmaa2Axis {
  const Cmaa2Edges& edges;
  bool turned;
  bool along(int x, int y) const { return turned ? edges.has_right(y, x) : edges.has_below(x, y); }
  bool across(int x, int y) const { return turned ? edges.has_below(y, x) : edges.has_right(x, y); }
};

// Number of pixels from x on, up to the first edge that crosses the edge below row y.
int arm(const Cmaa2Axis& axis, int x, int y, int direction, int longest) {
  int length = 0;
  while (length < longest && axis.along(x + direction * length, y)) {
    ++length;
    const int end = direction > 0 ? x + length - 1 : x - length;
    if (axis.across(end, y) || axis.across(end, y + 1)) break;
  }
  return length;
}

// Sums of the colours that a pixel receives, for their mean. Colours of long steps replace others.
class Samples {
 public:
  explicit Samples(std::size_t pixels) : simple_(pixels), steps_(pixels) {}
  void add_simple(std::size_t pixel, const Rgb& colour) { simple_[pixel].add(colour); }
  void add_step(std::size_t pixel, const Rgb& colour) { steps_[pixel].add(colour); }
  bool any(std::size_t pixel) const { return chosen(pixel).count > 0; }
  Rgb mean(std::size_t pixel) const {
    Rgb result = chosen(pixel).sum;
    for (double& channel : result) channel /= chosen(pixel).count;
    return result;
  }

 private:
  struct Sum {
    Rgb sum{};
    int count = 0;
    void add(const Rgb& colour) {
      for (std::size_t i = 0; i < colour.size(); ++i) sum[i] += colour[i];
      ++count;
    }
  };
  const Sum& chosen(std::size_t pixel) const {
    return steps_[pixel].count > 0 ? steps_[pixel] : simple_[pixel];
  }
  std::vector<Sum> simple_, steps_;
};

class Filter {
 public:
  Filter(const ColourFrame& frame, const Cmaa2Settings& settings)
      : frame_(frame),
        settings_(settings),
        edges_(cmaa2_edges(frame, settings)),
        scale_(settings.linear_light),
        samples_(frame.pixels.size()) {}

  std::vector<Rgba8> run() {
    for (int y = 0; y < frame_.height; ++y) {
      spec::poll();
      for (int x = 0; x < frame_.width; ++x) blend_corner(x, y);
    }
    for (const bool turned : {false, true}) {
      const Cmaa2Axis axis{edges_, turned};
      const int width = turned ? frame_.height : frame_.width,
                height = turned ? frame_.width : frame_.height;
      for (int y = 0; y < height; ++y) {
        spec::poll();
        for (int x = 0; x < width; ++x)
          for (const int side : {-1, 1}) blend_step(axis, x, y, side);
      }
    }
    std::vector<Rgba8> result = frame_.pixels;
    for (std::size_t i = 0; i < result.size(); ++i)
      if (samples_.any(i)) result[i] = scale_.encoded(samples_.mean(i), result[i][3]);
    return result;
  }

 private:
  Rgb colour(int x, int y) const { return scale_.decoded(frame_.at(x, y)); }

  // For two edges that meet, three or four. A straight edge and the two edges of a thin line are
  // not blended.
  void blend_corner(int x, int y) {
    const bool left = edges_.has_right(x - 1, y), right = edges_.has_right(x, y),
               above = edges_.has_below(x, y - 1), below = edges_.has_below(x, y);
    if ((left || right) && (above || below)) {
      const int count = left + right + above + below;
      const double share = count == 2   ? settings_.corner
                           : count == 3 ? settings_.tip
                                        : settings_.dot;
      Rgb sum{};
      const auto take = [&](const Rgb& from, double weight) {
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * from[i];
      };
      take(colour(x, y), 1 - count * share);
      if (left) take(colour(x - 1, y), share);
      if (right) take(colour(x + 1, y), share);
      if (above) take(colour(x, y - 1), share);
      if (below) take(colour(x, y + 1), share);
      samples_.add_simple(frame_.index(x, y), sum);
    }
  }

  // Blends a step to the right of pixel (x, y). Its left arm is below the row of the pixel (side 1)
  // or above it (side -1), its right arm on the other side. The line from the middle of the left
  // arm through the middle of the step to the middle of the right arm stays within the row: left of
  // the step the row takes from the side of the left arm, right of it from the other side.
  void blend_step(const Cmaa2Axis& axis, int x, int y, int side) {
    const int left_row = side > 0 ? y : y - 1, right_row = side > 0 ? y - 1 : y;
    if (!axis.across(x, y) || !axis.along(x, left_row) || !axis.along(x + 1, right_row)) return;
    const int left = arm(axis, x, left_row, -1, settings_.longest_arm),
              right = arm(axis, x + 1, right_row, 1, settings_.longest_arm);
    if (left + right < settings_.least_arms) return;
    blend_arm(axis, x, y, -1, side, (left + 1) / 2);
    blend_arm(axis, x + 1, y, 1, -side, (right + 1) / 2);
  }
  // Blends the half of an arm next to the step, starting at the pixel of the step.
  void blend_arm(const Cmaa2Axis& axis, int x, int y, int direction, int side, int half) {
    for (int i = 0; i < half; ++i) {
      const double left = half - i - 0.5 - settings_.symmetry;  // up to where line and arm meet
      add_step(axis, x + direction * i, y, side, left / (half - settings_.symmetry) / 2);
    }
  }
  void add_step(const Cmaa2Axis& axis, int x, int y, int side, double share) {
    const auto at = [&](int px, int py) { return axis.turned ? colour(py, px) : colour(px, py); };
    samples_.add_step(axis.turned ? frame_.index(y, x) : frame_.index(x, y),
                      mixed(at(x, y), at(x, y + side), share));
  }

  const ColourFrame& frame_;
  const Cmaa2Settings& settings_;
  Cmaa2Edges edges_;
  ColourScale scale_;
  Samples samples_;
};

}  // namespace

Cmaa2Edges cmaa2_edges(const ColourFrame& frame, const Cmaa2Settings& settings) {
  const auto right = [&](int x, int y) { return channel_step(frame, x, y, x + 1, y); };
  const auto below = [&](int x, int y) { return channel_step(frame, x, y, x, y + 1); };
  Cmaa2Edges edges;
  edges.width = frame.width;
  edges.height = frame.height;
  edges.right.resize(frame.pixels.size());
  edges.below.resize(frame.pixels.size());
  // Steps are multiples of 1/1000 of a code; rounding of sums must not lose an edge at the
  // threshold.
  const auto edge = [&](double own, std::initializer_list<double> crossing) {
    constexpr double kRounding = 1e-12;
    return own - settings.contrast_adaptation * std::max(crossing) > settings.threshold - kRounding;
  };
  for (int y = 0; y < frame.height; ++y) {
    spec::poll();
    for (int x = 0; x < frame.width; ++x) {
      edges.right[edges.index(x, y)] =
          edge(right(x, y), {below(x, y - 1), below(x + 1, y - 1), below(x, y), below(x + 1, y)});
      edges.below[edges.index(x, y)] =
          edge(below(x, y), {right(x - 1, y), right(x - 1, y + 1), right(x, y), right(x, y + 1)});
    }
  }
  return edges;
}

std::vector<Rgba8> cmaa2(const ColourFrame& frame, const Cmaa2Settings& settings) {
  return Filter(frame, settings).run();
}

}  // namespace deburr::golden::ideal
