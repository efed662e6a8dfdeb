// SPDX-License-Identifier: MIT
#include "golden/morphological/edges.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <vector>

#include "golden/morphological/bypass.h"
#include "golden/morphological/colour.h"
#include "spec/poll.h"

namespace deburr::golden::morphological {
namespace {

using Parameters = spec::morphological::Parameters;

std::int32_t step(const PixelPair& pair) { return std::abs(pair.luma_p - pair.luma_q); }

// One type per rule of the table "Raw edges", so that the common one becomes a plain loop.
struct FixedRule {
  std::int32_t limit;  // U8.16
  explicit FixedRule(const Parameters& p) : limit(p.threshold) {}
  bool operator()(const PixelPair& pair) const { return step(pair) >= limit; }
};

// Twice the luma that is multiplied by alpha, so that a mean is not rounded.
template <spec::morphological::DynamicLuma luma>
std::int32_t twice_reference(const PixelPair& pair) {
  using spec::morphological::DynamicLuma;
  if constexpr (luma == DynamicLuma::kCurrent) return 2 * pair.luma_p;
  if constexpr (luma == DynamicLuma::kMax) return 2 * std::max(pair.luma_p, pair.luma_q);
  if constexpr (luma == DynamicLuma::kMin) return 2 * std::min(pair.luma_p, pair.luma_q);
  if constexpr (luma == DynamicLuma::kMean) return pair.luma_p + pair.luma_q;
}

template <spec::morphological::DynamicLuma luma>
struct DynamicRule {
  std::int64_t alpha;  // U0.24
  std::int32_t floor;  // U8.16
  explicit DynamicRule(const Parameters& p) : alpha(p.alpha), floor(p.floor) {}
  bool operator()(const PixelPair& pair) const {
    const std::int64_t c = step(pair);
    return (c << 25) > alpha * twice_reference<luma>(pair) && c >= floor;
  }
};

struct DepthRule {
  std::uint64_t threshold;
  explicit DepthRule(const Parameters& p)
      : threshold(static_cast<std::uint64_t>(p.depth_threshold)) {}
  bool operator()(const PixelPair& pair) const {
    const std::uint64_t nearer = std::max(pair.depth_p, pair.depth_q);
    const std::uint64_t farther = std::min(pair.depth_p, pair.depth_q);
    return nearer != farther && (nearer - farther) << 16 >= threshold * nearer;
  }
};

struct PredicatedRule {
  DepthRule depth;
  std::int32_t on, off;  // U8.16
  explicit PredicatedRule(const Parameters& p)
      : depth(p), on(p.threshold_on_depth_edge), off(p.threshold_off_depth_edge) {}
  bool operator()(const PixelPair& pair) const { return step(pair) >= (depth(pair) ? on : off); }
};

// Calls use(rule) with the rule selected by the parameters.
template <class Use>
decltype(auto) with_rule(const Parameters& p, Use&& use) {
  switch (p.edge_source) {
    case spec::morphological::EdgeSource::kDepth:
      return use(DepthRule(p));
    case spec::morphological::EdgeSource::kPredicated:
      return use(PredicatedRule(p));
    case spec::morphological::EdgeSource::kLuma:
    case spec::morphological::EdgeSource::kColour:  // colour.h
      break;
  }
  if (p.threshold_mode == spec::morphological::ThresholdMode::kFixed) return use(FixedRule(p));
  using spec::morphological::DynamicLuma;
  switch (p.dynamic_luma) {
    case DynamicLuma::kCurrent:
      return use(DynamicRule<DynamicLuma::kCurrent>(p));
    case DynamicLuma::kMin:
      return use(DynamicRule<DynamicLuma::kMin>(p));
    case DynamicLuma::kMean:
      return use(DynamicRule<DynamicLuma::kMean>(p));
    case DynamicLuma::kMax:
      break;
  }
  return use(DynamicRule<DynamicLuma::kMax>(p));
}

struct Row {
  const std::int32_t* luma;
  const std::uint32_t* depth;
};

// Writes the edge bits of pairs (p[x], q[x]), x = 0..width-1, to `bits`. `flags`: size is a
// multiple of 64.
template <class Rule>
void raw_row(const Rule& rule, Row p, Row q, int width, std::uint8_t* flags, std::uint64_t* bits) {
  for (int x = 0; x < width; ++x) {
    flags[x] = rule(PixelPair{p.luma[x], q.luma[x], p.depth[x], q.depth[x]}) ? 1 : 0;
  }
  for (std::ptrdiff_t i = 0; i < width / 64 + 1; ++i) bits[i] = packed_flags(flags + 64 * i);
}

// Luma steps of rows y - 1, y, y + 1; 0 outside the frame. across(dy, x) = c((x, y+dy), its left
// neighbour), down(dy, x) = c((x, y+dy), its upper neighbour), x from -1 to width.
class StepRows {
 public:
  // `mask`: pixels without steps, or empty.
  StepRows(const LumaPlane& luma, const BitPlane& mask) : luma_(luma), mask_(mask) {
    for (auto* rows : {&across_, &down_}) {
      for (auto& row : *rows) row.assign(static_cast<std::size_t>(luma.width) + 2, 0);
    }
    fill(0);
  }
  // Moves to row y; call with y = 0, 1, 2, ... in order.
  void advance_to(int y) {
    y_ = y;
    fill(y + 1);
  }
  std::int32_t across(int dy, int x) const { return at(across_, y_ + dy, x); }
  std::int32_t down(int dy, int x) const { return at(down_, y_ + dy, x); }

 private:
  using Rows = std::array<std::vector<std::int32_t>, 3>;
  static std::size_t slot(int y) { return static_cast<std::size_t>(y + 3) % 3; }
  static std::int32_t at(const Rows& rows, int y, int x) { return rows[slot(y)].begin()[x + 1]; }
  void fill(int y) {
    auto& across = across_[slot(y)];
    auto& down = down_[slot(y)];
    std::fill(down.begin(), down.end(), 0);
    if (y >= luma_.height) {
      std::fill(across.begin(), across.end(), 0);
      return;
    }
    const std::int32_t* row = luma_.row(y);
    for (int x = 1; x < luma_.width; ++x) {
      across[static_cast<std::size_t>(x) + 1] = std::abs(row[x] - row[x - 1]);
    }
    if (y == 0) return clear_masked(y);
    const std::int32_t* above = luma_.row(y - 1);
    for (int x = 0; x < luma_.width; ++x) {
      down[static_cast<std::size_t>(x) + 1] = std::abs(row[x] - above[x]);
    }
    clear_masked(y);
  }

  void clear_masked(int y) {
    if (mask_.height() == 0) return;
    for (int x = 0; x < luma_.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(x) + 1;
      if (mask_.at(x, y) || mask_.at(x - 1, y)) across_[slot(y)][i] = 0;
      if (mask_.at(x, y) || mask_.at(x, y - 1)) down_[slot(y)][i] = 0;
    }
  }

  const LumaPlane& luma_;
  const BitPlane& mask_;
  int y_ = 0;
  Rows across_, down_;
};

// The largest step of eq (2) around pixel x, for its left and its top edge.
std::int32_t contrast_of_pixel(const StepRows& c, int x) {
  return std::max({c.down(0, x), c.down(1, x), c.across(0, x), c.across(0, x + 1), c.down(-1, x),
                   c.across(0, x - 1)});
}

// The largest step around the left edge of pixel x, symmetric form.
std::int32_t contrast_left(const StepRows& c, int x) {
  const std::int32_t beside_p = std::max(c.down(0, x), c.down(1, x));
  const std::int32_t beside_q = std::max(c.down(0, x - 1), c.down(1, x - 1));
  return std::max(
      {c.across(0, x), c.across(0, x + 1), c.across(0, x - 1), std::min(beside_p, beside_q)});
}

std::int32_t contrast_top(const StepRows& c, int x) {
  const std::int32_t beside_p = std::max(c.across(0, x), c.across(0, x + 1));
  const std::int32_t beside_q = std::max(c.across(-1, x), c.across(-1, x + 1));
  return std::max({c.down(0, x), c.down(1, x), c.down(-1, x), std::min(beside_p, beside_q)});
}

// Clears the bits for which keep(x) is false.
template <class Keep>
void filter(std::uint64_t* bits, int words, Keep&& keep) {
  for (int i = 0; i < words; ++i) {
    for (std::uint64_t rest = bits[i]; rest != 0; rest &= rest - 1) {
      const int bit = std::countr_zero(rest);
      if (!keep(64 * i + bit)) bits[i] ^= std::uint64_t{1} << bit;
    }
  }
}

void apply_local_contrast(spec::morphological::LocalContrast mode, const LumaPlane& luma,
                          const BitPlane& mask, EdgePlanes& edges) {
  using spec::morphological::LocalContrast;
  StepRows c(luma, mask);
  // Keeps a bit if keeps(step of the edge, largest step around it).
  const auto apply = [&](const auto& around_left, const auto& around_top, const auto& keeps) {
    for (int y = 0; y < luma.height; ++y) {
      spec::poll();
      c.advance_to(y);
      filter(edges.left.row(y), edges.left.words(),
             [&](int x) { return keeps(c.across(0, x), around_left(c, x)); });
      filter(edges.top.row(y), edges.top.words(),
             [&](int x) { return keeps(c.down(0, x), around_top(c, x)); });
    }
  };
  const auto above_half = [](std::int32_t own, std::int32_t largest) { return 2 * own > largest; };
  const auto half_or_more = [](std::int32_t own, std::int32_t largest) {
    return 2 * own >= largest;
  };
  switch (mode) {
    case LocalContrast::kOff:
      return;
    case LocalContrast::kPaper:
      return apply(contrast_of_pixel, contrast_of_pixel, above_half);
    case LocalContrast::kSymmetric:
      return apply(contrast_left, contrast_top, above_half);
    case LocalContrast::kSmaa:
      return apply(contrast_of_pixel, contrast_of_pixel, half_or_more);
  }
}

template <class Rule>
void raw_edges(const Rule& rule, const LumaPlane& luma, const DepthView& depth, EdgePlanes& edges) {
  const std::vector<std::uint32_t> no_depth(depth.empty() ? static_cast<std::size_t>(luma.width)
                                                          : 0);
  std::vector<std::uint8_t> flags(static_cast<std::size_t>(edges.left.words()) * 64);
  const auto row = [&](int y) {
    return Row{luma.row(y), depth.empty() ? no_depth.data() : depth.row(y)};
  };
  for (int y = 0; y < luma.height; ++y) {
    spec::poll();
    const Row own = row(y);
    // Pairs (x + 1, x) give the left bits of x + 1, so the result is shifted by one bit.
    std::fill(flags.begin(), flags.end(), std::uint8_t{0});
    std::uint64_t* left = edges.left.row(y);
    raw_row(rule, Row{own.luma + 1, own.depth + 1}, own, luma.width - 1, flags.data(), left);
    std::uint64_t carry = 0;
    for (int i = 0; i < edges.left.words(); ++i) {
      const std::uint64_t word = left[i];
      left[i] = word << 1 | carry;
      carry = word >> 63;
    }
    if (y > 0) raw_row(rule, own, row(y - 1), luma.width, flags.data(), edges.top.row(y));
  }
}

BitPlane marked(const ImageView& image) {
  BitPlane result(image.width, image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (is_marked(image.at(x, y))) result.set(x, y);
  return result;
}

// Clears the edges of masked pixels.
void clear_beside(const BitPlane& mask, EdgePlanes& edges) {
  for (int y = 0; y < mask.height(); ++y) {
    std::uint64_t carry = 0;
    for (int i = 0; i < mask.words(); ++i) {
      const std::uint64_t own = mask.row(y)[i];
      edges.left.row(y)[i] &= ~(own | own << 1 | carry);
      edges.top.row(y)[i] &= ~(own | (y > 0 ? mask.row(y - 1)[i] : 0));
      carry = own >> 63;
    }
  }
}

}  // namespace

bool floor_decides(const Parameters& p, const PixelPair& pair) {
  using spec::morphological::DynamicLuma;
  const auto of = [&](std::int32_t twice_luma) {
    return std::int64_t{p.floor} << 25 >= std::int64_t{p.alpha} * twice_luma;
  };
  switch (p.dynamic_luma) {
    case DynamicLuma::kCurrent:
      return of(twice_reference<DynamicLuma::kCurrent>(pair));
    case DynamicLuma::kMax:
      return of(twice_reference<DynamicLuma::kMax>(pair));
    case DynamicLuma::kMin:
      return of(twice_reference<DynamicLuma::kMin>(pair));
    case DynamicLuma::kMean:
      break;
  }
  return of(twice_reference<DynamicLuma::kMean>(pair));
}

EdgePlanes find_edges(const Parameters& parameters, const ImageView& image,
                      const DepthView& depth) {
  if (parameters.edge_source == spec::morphological::EdgeSource::kColour)
    return colour_edges(parameters, image);
  const LumaPlane y = luma(image);
  EdgePlanes edges{BitPlane(image.width, image.height), BitPlane(image.width, image.height)};
  with_rule(parameters, [&](const auto& rule) { raw_edges(rule, y, depth, edges); });
  BitPlane mask;
  if (parameters.bypass == spec::morphological::Bypass::kMasked) {
    mask = marked(image);
    clear_beside(mask, edges);
  }
  if (parameters.edge_source != spec::morphological::EdgeSource::kDepth) {
    apply_local_contrast(parameters.local_contrast, y, mask, edges);
  }
  return edges;
}

}  // namespace deburr::golden::morphological
