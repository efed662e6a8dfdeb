// SPDX-License-Identifier: MIT
#include "golden/ideal/filtering_criterion.h"

#include <algorithm>
#include <cmath>

namespace deburr::golden::ideal {
namespace {

bool interpolates_texels(spec::texture::MinFilter filter) {
  return filter == spec::texture::MinFilter::kLinear ||
         filter == spec::texture::MinFilter::kLinearMipmapNearest ||
         filter == spec::texture::MinFilter::kLinearMipmapLinear;
}

bool interpolates_levels(spec::texture::MinFilter filter) {
  return filter == spec::texture::MinFilter::kNearestMipmapLinear ||
         filter == spec::texture::MinFilter::kLinearMipmapLinear;
}

bool uses_base_level(spec::texture::MinFilter filter) {
  return filter == spec::texture::MinFilter::kNearest ||
         filter == spec::texture::MinFilter::kLinear;
}

// GL's address of texel index i in a row of `size`.
int wrap_index(spec::texture::Wrap wrap, std::int64_t i, int size) {
  const auto modulo = [](std::int64_t value, std::int64_t period) {
    const std::int64_t r = value % period;
    return r < 0 ? r + period : r;
  };
  switch (wrap) {
    case spec::texture::Wrap::kRepeat:
      return static_cast<int>(modulo(i, size));
    case spec::texture::Wrap::kMirroredRepeat: {
      const std::int64_t r = modulo(i, 2 * std::int64_t{size});
      return static_cast<int>(r < size ? r : 2 * std::int64_t{size} - 1 - r);
    }
    case spec::texture::Wrap::kClampToEdge:
      return static_cast<int>(std::clamp<std::int64_t>(i, 0, size - 1));
  }
  return 0;
}

// ceil(l + 1/2) - 1, GL's rounding for *_MIPMAP_NEAREST, limited to the existing levels.
int nearest_level(double lod, int last) {
  const double level = std::ceil(std::max(lod, 0.0) + 0.5) - 1.0;
  return static_cast<int>(std::clamp(level, 0.0, static_cast<double>(last)));
}

Rgba lerp(const Rgba& a, const Rgba& b, double f) {
  Rgba r;
  for (std::size_t c = 0; c < 4; ++c) r[c] = a[c] + (b[c] - a[c]) * f;
  return r;
}

// Four texels around a sample and the range of the two fractions allowed between them.
struct Cell {
  std::array<Rgba, 4> texel;  // 00, 10, 01, 11
  Interval a{0.0, 0.0}, b{0.0, 0.0};

  Rgba at(double fraction_a, double fraction_b) const {
    return lerp(lerp(texel[0], texel[1], fraction_a), lerp(texel[2], texel[3], fraction_a),
                fraction_b);
  }
};

// The positions in texels that a sampler of the given accuracy may compute for a coordinate.
Interval texel_positions(double coordinate, int size, double relative, double absolute) {
  const double error = std::abs(coordinate) * relative;
  return {(coordinate - error) * size - absolute, (coordinate + error) * size + absolute};
}

// Every cell within the coordinate error, with the possible fractions in each.
std::vector<Cell> cells_in_reach(const Level& level, const Sampler& sampler,
                                 const Fragment& fragment, const Precision& precision,
                                 bool linear) {
  const double relative = std::ldexp(1.0, -precision.coordinate_bits);
  const double absolute = linear ? std::ldexp(1.0, -precision.subtexel_bits) : 0.0;
  const double half = linear ? 0.5 : 0.0;
  const Interval u = texel_positions(fragment.s, level.width, relative, absolute);
  const Interval v = texel_positions(fragment.t, level.height, relative, absolute);
  const auto index = [&](double position) {
    return static_cast<std::int64_t>(std::floor(position - half));
  };
  const auto fractions = [&](const Interval& p, std::int64_t i) -> Interval {
    if (!linear) return {0.0, 0.0};
    const double origin = static_cast<double>(i) + half;
    return {std::clamp(p.low - origin, 0.0, 1.0), std::clamp(p.high - origin, 0.0, 1.0)};
  };
  std::vector<Cell> cells;
  for (std::int64_t j = index(v.low); j <= index(v.high); ++j) {
    for (std::int64_t i = index(u.low); i <= index(u.high); ++i) {
      Cell cell;
      for (std::size_t k = 0; k < 4; ++k) {
        const std::int64_t di = linear ? static_cast<std::int64_t>(k & 1) : 0;
        const std::int64_t dj = linear ? static_cast<std::int64_t>(k >> 1) : 0;
        const int x = wrap_index(sampler.wrap_s, i + di, level.width);
        const int y = wrap_index(sampler.wrap_t, j + dj, level.height);
        cell.texel[k] =
            level.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width) +
                         static_cast<std::size_t>(x)];
      }
      cell.a = fractions(u, i);
      cell.b = fractions(v, j);
      cells.push_back(cell);
    }
  }
  return cells;
}

// Searches a box of weights for a point whose colour is in a cube around the target.
//
// The colour is bilinear in (a, b) at either level and linear in the level fraction f, so it is
// linear in each of five weights: over a box of weights it is inside the convex hull of its values
// at the corners. A box whose hull misses the cube contains no legal point.
class Search {
 public:
  Search(const Rgba& target, double tolerance, int max_boxes)
      : target_(target), tolerance_(tolerance), boxes_left_(max_boxes) {}

  bool exhausted() const { return boxes_left_ <= 0; }

  bool finds(const Cell& fine) { return search(fine, nullptr, {0.0, 0.0}); }
  bool finds(const Cell& fine, const Cell& coarse, const Interval& f) {
    return search(fine, &coarse, f);
  }

 private:
  using Weights = std::array<Interval, 5>;  // a, b of the fine level; a, b of the coarse level; f

  // Corner colours of a box: the hull is {(1 - f) p_i + f q_j}.
  struct Hull {
    std::array<Rgba, 4> p, q;
    Interval f;
  };

  static double middle(const Interval& i) { return 0.5 * (i.low + i.high); }

  static std::array<Rgba, 4> corners(const Cell& cell, const Interval& a, const Interval& b) {
    return {cell.at(a.low, b.low), cell.at(a.high, b.low), cell.at(a.low, b.high),
            cell.at(a.high, b.high)};
  }

  static Interval channel(const std::array<Rgba, 4>& corner, std::size_t c) {
    const auto [low, high] = std::minmax({corner[0][c], corner[1][c], corner[2][c], corner[3][c]});
    return {low, high};
  }

  // Range of one channel over the hull.
  static Interval channel(const Hull& hull, std::size_t c) {
    const Interval p = channel(hull.p, c);
    const Interval q = channel(hull.q, c);
    const auto mix = [](double from, double to, double f) { return from + (to - from) * f; };
    return {std::min(mix(p.low, q.low, hull.f.low), mix(p.low, q.low, hull.f.high)),
            std::max(mix(p.high, q.high, hull.f.low), mix(p.high, q.high, hull.f.high))};
  }

  double distance(const Rgba& colour) const {
    double worst = 0.0;
    for (std::size_t c = 0; c < 4; ++c) worst = std::max(worst, std::abs(colour[c] - target_[c]));
    return worst;
  }

  // Whether a hyperplane certainly separates the hull from the cube. Moves a point of the hull
  // towards the cube (Frank-Wolfe) and tests the direction of each step.
  bool separated(const Hull& hull) const {
    Rgba point =
        lerp(lerp(hull.p[0], hull.p[3], 0.5), lerp(hull.q[0], hull.q[3], 0.5), middle(hull.f));
    for (int step = 0; step < 12; ++step) {
      Rgba direction;
      double cube = 0.0;  // minimum of direction . x over the cube
      double square = 0.0;
      for (std::size_t c = 0; c < 4; ++c) {
        const double nearest =
            std::clamp(point[c], target_[c] - tolerance_, target_[c] + tolerance_);
        direction[c] = nearest - point[c];
        square += direction[c] * direction[c];
        cube += direction[c] * target_[c] - std::abs(direction[c]) * tolerance_;
      }
      if (square == 0.0) return false;
      const auto dot = [&](const Rgba& x) {
        return direction[0] * x[0] + direction[1] * x[1] + direction[2] * x[2] +
               direction[3] * x[3];
      };
      const auto farthest = [&](const std::array<Rgba, 4>& corner) {
        return std::max_element(corner.begin(), corner.end(),
                                [&](const Rgba& x, const Rgba& y) { return dot(x) < dot(y); });
      };
      const Rgba& p = *farthest(hull.p);
      const Rgba& q = *farthest(hull.q);
      const Rgba near_end = lerp(p, q, hull.f.low);
      const Rgba far_end = lerp(p, q, hull.f.high);
      const Rgba& support = dot(near_end) > dot(far_end) ? near_end : far_end;
      // The margin keeps rounding errors from dropping a box that touches the cube.
      if (dot(support) < cube - 1e-9 * (1.0 + std::abs(cube))) return true;
      double along = 0.0;
      double length = 0.0;
      for (std::size_t c = 0; c < 4; ++c) {
        along += direction[c] * (support[c] - point[c]);
        length += (support[c] - point[c]) * (support[c] - point[c]);
      }
      if (length == 0.0 || along <= 0.0) return false;
      point = lerp(point, support, std::min(1.0, along / length));
    }
    return false;
  }

  // Largest change of the colour when weight `i` crosses its interval.
  static double influence(const Cell& fine, const Cell* coarse, const Hull& hull, const Weights& w,
                          std::size_t i) {
    const double width = w[i].high - w[i].low;
    if (width == 0.0) return 0.0;
    double move = 0.0;
    const auto edge = [&](const Cell& cell, std::size_t from, std::size_t to) {
      for (std::size_t c = 0; c < 4; ++c)
        move = std::max(move, std::abs(cell.texel[to][c] - cell.texel[from][c]));
    };
    if (i == 4) {
      for (std::size_t c = 0; c < 4; ++c) {
        const Interval p = channel(hull.p, c);
        const Interval q = channel(hull.q, c);
        move = std::max({move, std::abs(p.high - q.low), std::abs(q.high - p.low)});
      }
      return move * width;
    }
    const Cell& cell = i < 2 ? fine : *coarse;
    const std::size_t stride = i % 2 == 0 ? 1 : 2;
    edge(cell, 0, stride);
    edge(cell, 3 - stride, 3);
    return move * width * (i < 2 ? 1.0 - w[4].low : w[4].high);
  }

  bool search(const Cell& fine, const Cell* coarse, const Interval& f) {
    stack_.clear();
    stack_.push_back(coarse != nullptr
                         ? Weights{fine.a, fine.b, coarse->a, coarse->b, f}
                         : Weights{fine.a, fine.b, Interval{}, Interval{}, Interval{}});
    while (!stack_.empty()) {
      if (--boxes_left_ <= 0) return false;
      const Weights w = stack_.back();
      stack_.pop_back();
      Hull hull;
      hull.p = corners(fine, w[0], w[1]);
      hull.q = coarse != nullptr ? corners(*coarse, w[2], w[3]) : hull.p;
      hull.f = w[4];
      bool misses = false;
      double extent = 0.0;
      for (std::size_t c = 0; c < 4; ++c) {
        const Interval range = channel(hull, c);
        misses =
            misses || range.low > target_[c] + tolerance_ || range.high < target_[c] - tolerance_;
        extent = std::max(extent, range.high - range.low);
      }
      if (misses) continue;
      const Rgba fine_middle = fine.at(middle(w[0]), middle(w[1]));
      const Rgba centre =
          coarse == nullptr
              ? fine_middle
              : lerp(fine_middle, coarse->at(middle(w[2]), middle(w[3])), middle(w[4]));
      if (distance(centre) <= tolerance_ || extent <= kResolution) return true;
      if (separated(hull)) continue;

      std::size_t widest = 0;
      double most = -1.0;
      for (std::size_t i = 0; i < 5; ++i) {
        const double move = influence(fine, coarse, hull, w, i);
        if (move > most) {
          most = move;
          widest = i;
        }
      }
      Weights lower = w;
      Weights upper = w;
      lower[widest].high = upper[widest].low = middle(w[widest]);
      // The half whose middle is nearer is tried first, so correct colours are found quickly.
      const auto colour = [&](const Weights& x) {
        const Rgba near_colour = fine.at(middle(x[0]), middle(x[1]));
        return coarse == nullptr
                   ? near_colour
                   : lerp(near_colour, coarse->at(middle(x[2]), middle(x[3])), middle(x[4]));
      };
      const bool lower_first = distance(colour(lower)) < distance(colour(upper));
      stack_.push_back(lower_first ? upper : lower);
      stack_.push_back(lower_first ? lower : upper);
    }
    return false;
  }

  Rgba target_;
  double tolerance_;
  int boxes_left_;
  std::vector<Weights> stack_;
};

}  // namespace

double colour_tolerance(const Sampler& sampler) {
  const bool nearest_only = sampler.mag_filter == spec::texture::MagFilter::kNearest &&
                            !interpolates_texels(sampler.min_filter) &&
                            !interpolates_levels(sampler.min_filter);
  return nearest_only ? kNearestTolerance : kFilteredTolerance;
}

Interval legal_lod(const Texture& texture, const Sampler& sampler, const Fragment& fragment,
                   const Precision& precision) {
  const double width = texture.levels.front().width;
  const double height = texture.levels.front().height;
  const double m_u = width * std::max(std::abs(fragment.ds_dx), std::abs(fragment.ds_dy));
  const double m_v = height * std::max(std::abs(fragment.dt_dx), std::abs(fragment.dt_dy));
  const double relative = std::ldexp(1.0, -precision.derivative_bits);
  const double absolute = std::ldexp(1.0, -precision.lod_bits);
  const double low = std::log2(std::max(m_u, m_v) * (1.0 - relative));
  const double high = std::log2(std::sqrt(2.0) * (m_u + m_v) * (1.0 + relative));
  const auto clamped = [&](double lod) {
    return std::min(std::max(lod + sampler.lod_bias, sampler.min_lod), sampler.max_lod);
  };
  return {clamped(low - absolute), clamped(high + absolute)};
}

bool Criterion::reachable(const Fragment& fragment, const Rgba& colour, double tolerance) const {
  const Interval lod = legal_lod(texture_, sampler_, fragment, precision_);
  const int last = static_cast<int>(texture_.levels.size()) - 1;
  Search search(colour, tolerance, kMaxBoxes);
  const auto cells = [&](int level, bool linear) {
    return cells_in_reach(texture_.levels[static_cast<std::size_t>(level)], sampler_, fragment,
                          precision_, linear);
  };
  const auto at_level = [&](int level, bool linear) {
    for (const Cell& cell : cells(level, linear))
      if (search.finds(cell)) return true;
    return false;
  };
  const auto found = [&] {
    if (lod.low <= 0.0 && at_level(0, sampler_.mag_filter == spec::texture::MagFilter::kLinear))
      return true;
    if (lod.high <= 0.0) return false;
    const bool linear = interpolates_texels(sampler_.min_filter);
    if (uses_base_level(sampler_.min_filter)) return at_level(0, linear);
    if (!interpolates_levels(sampler_.min_filter)) {
      for (int k = nearest_level(lod.low, last); k <= nearest_level(lod.high, last); ++k)
        if (at_level(k, linear)) return true;
      return false;
    }
    const double low = std::clamp(lod.low, 0.0, static_cast<double>(last));
    const double high = std::clamp(lod.high, 0.0, static_cast<double>(last));
    for (int k = static_cast<int>(low); k <= static_cast<int>(high); ++k) {
      const std::vector<Cell> fine = cells(k, linear);
      const Interval f{std::max(low - k, 0.0), std::min(high - k, 1.0)};
      const bool blends = f.high > 0.0 && k < last;
      const std::vector<Cell> coarse = blends ? cells(k + 1, linear) : std::vector<Cell>{};
      for (const Cell& p : fine) {
        if (!blends && search.finds(p)) return true;
        for (const Cell& q : coarse)
          if (search.finds(p, q, f)) return true;
      }
    }
    return false;
  };
  const bool answer = found();
  if (!answer && search.exhausted()) ++undecided_;
  return answer;
}

double Criterion::deviation(const Fragment& fragment, const Rgba& colour, double floor) const {
  if (reachable(fragment, colour, floor)) return floor;
  double low = floor;
  double high = std::max(2.0 * floor, 1.0);
  while (high < 256.0 && !reachable(fragment, colour, high)) {
    low = high;
    high *= 2.0;
  }
  while (high - low > 1.0 / 64.0) {
    const double tolerance = 0.5 * (low + high);
    (reachable(fragment, colour, tolerance) ? high : low) = tolerance;
  }
  return high;
}

Rgba exact_colour(const Texture& texture, const Sampler& sampler, const Fragment& fragment) {
  constexpr Precision kExact{"exact", 1000, 1000, 1000, 1000};
  const double width = texture.levels.front().width;
  const double height = texture.levels.front().height;
  const double rho = std::max(std::hypot(fragment.ds_dx * width, fragment.dt_dx * height),
                              std::hypot(fragment.ds_dy * width, fragment.dt_dy * height));
  const double lod =
      std::min(std::max(std::log2(rho) + sampler.lod_bias, sampler.min_lod), sampler.max_lod);
  const int last = static_cast<int>(texture.levels.size()) - 1;
  const auto at_level = [&](int level, bool linear) {
    const Cell cell = cells_in_reach(texture.levels[static_cast<std::size_t>(level)], sampler,
                                     fragment, kExact, linear)
                          .front();
    return cell.at(cell.a.low, cell.b.low);
  };
  if (lod <= 0.0) return at_level(0, sampler.mag_filter == spec::texture::MagFilter::kLinear);
  const bool linear = interpolates_texels(sampler.min_filter);
  if (uses_base_level(sampler.min_filter)) return at_level(0, linear);
  if (!interpolates_levels(sampler.min_filter)) return at_level(nearest_level(lod, last), linear);
  const double clamped = std::min(lod, static_cast<double>(last));
  const int level = static_cast<int>(clamped);
  const double f = clamped - level;
  return f == 0.0 ? at_level(level, linear)
                  : lerp(at_level(level, linear), at_level(level + 1, linear), f);
}

std::string_view verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kHigh:
      return "high";
    case Verdict::kLow:
      return "low";
    case Verdict::kFail:
      return "FAIL";
  }
  return "FAIL";
}

Checker::Checker(const Texture& texture, const Sampler& sampler)
    : high_(texture, sampler, kPrecisionHigh),
      low_(texture, sampler, kPrecisionLow),
      tolerance_(colour_tolerance(sampler)) {}

void Checker::add(const Fragment& fragment, const Rgba& colour) {
  ++fragments_;
  if (fragments_ == 1) high_worst_ = 0.5;
  const bool within_worst = high_.reachable(fragment, colour, high_worst_);
  if (!within_worst) {
    high_worst_ = high_.deviation(fragment, colour, high_worst_);
    worst_ = fragment;
    worst_colour_ = colour;
  }
  if (within_worst && high_worst_ <= tolerance_) return;
  if (high_.reachable(fragment, colour, tolerance_)) return;
  ++rejected_;
  if (!low_.reachable(fragment, colour, tolerance_)) ++low_rejected_;
  if (!low_.reachable(fragment, colour, low_worst_))
    low_worst_ = low_.deviation(fragment, colour, low_worst_);
}

Verdict Checker::verdict() const {
  if (rejected_ == 0) return Verdict::kHigh;
  return low_rejected_ == 0 ? Verdict::kLow : Verdict::kFail;
}

}  // namespace deburr::golden::ideal
