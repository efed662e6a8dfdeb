// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/front/edge_detector.h"

#include <algorithm>

namespace deburr::rtl::morphological {
namespace {

constexpr std::uint32_t distance(std::uint32_t a, std::uint32_t b) { return a > b ? a - b : b - a; }

}  // namespace

EdgeDetector::EdgeDetector(const sc_core::sc_module_name& name, ClockDomain& clock,
                           const spec::morphological::Parameters& p, const ParameterStore& store)
    : Unit(name, clock),
      store_(store),
      stride_(static_cast<std::size_t>(p.line_pixels)),
      luma_("luma_lines", p.line_pixels, 3 * 24, "1R1W", kRows * stride_) {
  if (p.edge_source != spec::morphological::EdgeSource::kLuma)
    depth_lines_ = std::make_unique<LineMemory<std::uint32_t>>("depth_lines", p.line_pixels, 2 * 24,
                                                               "1R1W", kRows * stride_);
}

Activity EdgeDetector::tick(Cycle cycle) {
  if (!lumas_in.can_pop(cycle)) return kIdle;
  if (!edges_out.can_push(cycle)) return kStalledDownstream;
  const LumaToken& token = lumas_in.front(cycle);
  EdgeToken& out = edges_out.emplace(cycle);
  out.slot = token.slot;
  out.left = out.top = 0;
  const std::int32_t height = store_.rules().height;
  if (token.slot.row < height) store_row(token);
  if (token.slot.row >= 1 && token.slot.row <= height) decide(token, out);
  lumas_in.pop(cycle);
  return kBusy;
}

void EdgeDetector::store_row(const LumaToken& token) {
  const auto lanes = static_cast<std::size_t>(store_.lanes());
  const std::size_t x = token.slot.beat * lanes;
  const std::size_t at = place({static_cast<std::int32_t>(x), token.slot.row});
  const std::size_t count = std::min(lanes, stride_ - x);
  for (std::size_t i = 0; i < count; ++i) luma_[at + i] = token.luma[i];
  if (depth_lines_)
    for (std::size_t i = 0; i < count; ++i) (*depth_lines_)[at + i] = token.depth[i];
}

void EdgeDetector::decide(const LumaToken& token, EdgeToken& out) {
  const FrameRules& rules = store_.rules();
  const bool plain = rules.source == spec::morphological::EdgeSource::kLuma && !rules.dynamic;
  const bool contrast = rules.local_contrast != spec::morphological::LocalContrast::kOff;
  const std::int32_t lanes = store_.lanes(), y = token.slot.row - 1;
  const std::int32_t first = token.slot.beat * lanes, end = std::min(first + lanes, rules.width);
  for (std::int32_t x = first; x < end; ++x) {
    const Position p{x, y}, l{x - 1, y}, t{x, y - 1};
    bool left, top;
    if (plain) {
      const std::uint32_t luma_p = luma(p);
      left = x > 0 && distance(luma_p, luma(l)) >= rules.threshold;
      top = y > 0 && distance(luma_p, luma(t)) >= rules.threshold;
    } else {
      left = x > 0 && is_edge(p, l);
      top = y > 0 && is_edge(p, t);
    }
    if (contrast) {
      left = left && survives(p, l, t);
      top = top && survives(p, t, l);
    }
    const int lane = x - first;
    out.left = static_cast<std::uint8_t>(out.left | int{left} << lane);
    out.top = static_cast<std::uint8_t>(out.top | int{top} << lane);
    if (left || top) ++edge_pixels;
  }
}

// Both pixels are inside.
bool EdgeDetector::is_edge(Position p, Position q) const {
  const FrameRules& rules = store_.rules();
  const std::uint32_t c = distance(luma(p), luma(q));
  switch (rules.source) {
    case spec::morphological::EdgeSource::kDepth:
      return depth_edge(p, q);
    case spec::morphological::EdgeSource::kPredicated:
      return c >= (depth_edge(p, q) ? rules.threshold_on : rules.threshold_off);
    case spec::morphological::EdgeSource::kLuma:
      break;
  }
  if (!rules.dynamic) return c >= rules.threshold;
  const std::uint32_t reference = rules.dynamic_max ? std::max(luma(p), luma(q)) : luma(p);
  // U8.32: both sides are products with U0.16.
  return (std::uint64_t{c} << 16) > std::uint64_t{rules.alpha} * reference && c >= rules.floor;
}

bool EdgeDetector::depth_edge(Position p, Position q) const {
  const std::uint32_t a = depth(p), b = depth(q);
  return a != b && (std::uint64_t{distance(a, b)} << 16) >=
                       std::uint64_t{store_.rules().depth_threshold} * std::max(a, b);
}

std::uint32_t EdgeDetector::step(Position p, Position q) const {
  return inside(p) && inside(q) ? distance(luma(p), luma(q)) : 0;
}

// Is the step from p to its neighbour `across` (left or top) more than half of the largest step
// near it? `along` is the other one of the two neighbours.
bool EdgeDetector::survives(Position p, Position across, Position along) const {
  const std::int32_t ax = p.x - across.x, ay = p.y - across.y;  // from `across` to p
  const std::int32_t bx = p.x - along.x, by = p.y - along.y;
  const Position opposite{p.x + ax, p.y + ay}, after{p.x + bx, p.y + by};
  const Position beyond{across.x - ax, across.y - ay};
  const std::uint32_t c = step(p, across);
  std::uint32_t most = std::max({c, step(p, opposite), step(across, beyond)});
  const std::uint32_t beside = std::max(step(p, along), step(p, after));
  if (store_.rules().local_contrast == spec::morphological::LocalContrast::kPaper) {
    most = std::max({most, beside, step(along, {along.x - bx, along.y - by})});
  } else {
    const Position across_along{across.x - bx, across.y - by};
    const Position across_after{across.x + bx, across.y + by};
    most = std::max(
        most, std::min(beside, std::max(step(across, across_along), step(across, across_after))));
  }
  return 2 * c > most;
}

}  // namespace deburr::rtl::morphological
