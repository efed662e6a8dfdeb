// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/front/edge_detector.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace deburr::rtl::morphological {
namespace {

constexpr std::uint32_t distance(std::uint32_t a, std::uint32_t b) { return a > b ? a - b : b - a; }

// Largest step of the three codes, U8.16.
constexpr std::uint32_t colour_distance(std::uint32_t a, std::uint32_t b) {
  if (a == b) return 0;  // true in most of a frame
  const auto of = [&](int shift) { return distance(a >> shift & 0xFF, b >> shift & 0xFF); };
  return std::max({of(0), of(8), of(16)}) << 16;
}

std::uint64_t words_for(std::int32_t columns, std::uint32_t lanes) {
  return (static_cast<std::uint64_t>(columns) + lanes - 1) / lanes * lanes;
}

}  // namespace

EdgeDetector::Lines::Lines(const char* name, const MemoryShape& shape, std::size_t lanes)
    : lanes_(lanes), span_(shape.span), memory_(name, shape) {
  rows_.fill(std::vector<std::uint32_t>(shape.words + spec::morphological::kMaxLanes));
}

// The memory first checks that the columns are valid. Lanes that are not built are also written;
// the next beat overwrites them before they are read.
inline void EdgeDetector::Lines::take(Cycle cycle, const Slot& slot, const Lanes32& pixels) {
  const std::uint64_t x = slot.beat * lanes_;
  above_.read(cycle, x, std::min(span_, memory_.words() - x));
  std::memcpy(&rows_[slot.row % rows_.size()][x], pixels.data(), sizeof pixels);
}

EdgeDetector::EdgeDetector(const sc_core::sc_module_name& name, ClockDomain& clock,
                           const spec::morphological::Parameters& p)
    : Unit(name, clock),
      lanes_(static_cast<std::uint32_t>(built_lanes(p))),
      // The columns of a beat and the adjacent one are in different banks.
      luma_("luma_lines",
            {.words = std::max<std::uint64_t>(words_for(p.line_pixels, lanes_),
                                              std::uint64_t{2} * lanes_),
             .word_bits = 3 * 25,
             // In a row of one beat, the read and the write are in the same cycle.
             .read_during_write = ReadDuringWrite::kNewWord,
             .banks = 2 * lanes_,
             .span = lanes_ + 1,
             .content = "per column, the last three rows of luma or colour, and marks",
             .columns = static_cast<std::uint64_t>(p.line_pixels)},
            lanes_) {
  if (!has_depth(p)) return;
  depth_.emplace("depth_lines",
                 MemoryShape{.words = words_for(p.line_pixels, lanes_),
                             .word_bits = 2 * 24,
                             // In a row of one beat, the read and the write are in the same cycle.
                             .read_during_write = ReadDuringWrite::kNewWord,
                             .banks = lanes_,
                             .span = lanes_,
                             .content = "per column, the last two rows of depth",
                             .columns = static_cast<std::uint64_t>(p.line_pixels)},
                 lanes_);
}

// Steps that count as edges, for `count` pixels of row y with a neighbour. plain_steps(): luma or
// colour without mask, decided by `large(pixel, neighbour)`. steps(): all other configurations.
template <class Large>
inline EdgeDetector::Edges EdgeDetector::plain_steps(std::int32_t first, std::int32_t count,
                                                     std::int32_t y, Large&& large) const {
  const std::uint32_t *const here = luma_.row(y) + first, *const above = luma_.row(y - 1) + first;
  std::uint32_t before = first == 0 ? 0 : here[-1];
  // With one lane, the loop costs as much as its pixel.
  if (count == 1) return {large(*here, before), large(*here, *above)};
  Edges edges;
  for (std::int32_t i = 0; i < count; ++i) {
    edges.left |= std::uint32_t{large(here[i], before)} << i;
    edges.top |= std::uint32_t{large(here[i], above[i])} << i;
    before = here[i];
  }
  return edges;
}

[[gnu::always_inline]] inline void EdgeDetector::decide(EdgeToken& out) {
  const FrameConfiguration& configuration = *configuration_;
  const bool colour = configuration.source == spec::morphological::EdgeSource::kColour;
  const bool plain = (configuration.source == spec::morphological::EdgeSource::kLuma || colour) &&
                     configuration.bypass != spec::morphological::Bypass::kMasked;
  const auto lanes = static_cast<std::int32_t>(lanes_);
  const std::int32_t y = out.slot.row - 1, first = out.slot.beat * lanes;
  const std::int32_t count = std::min(lanes, configuration.width - first);
  const auto fixed = [&](std::uint32_t a, std::uint32_t b) {
    return distance(a, b) >= configuration.threshold;
  };
  const auto fixed_colour = [&](std::uint32_t a, std::uint32_t b) {
    return colour_distance(a, b) >= configuration.threshold;
  };
  const auto dynamic = [&](std::uint32_t a, std::uint32_t b) {
    return is_dynamic_edge(distance(a, b), a, b);
  };
  Edges edges = !plain                  ? steps(first, count, y)
                : colour                ? plain_steps(first, count, y, fixed_colour)
                : configuration.dynamic ? plain_steps(first, count, y, dynamic)
                                        : plain_steps(first, count, y, fixed);
  if (first == 0) edges.left &= ~1u;
  if (y == 0) edges.top = 0;
  if ((edges.left | edges.top) == 0) return;
  if (configuration.local_contrast != spec::morphological::LocalContrast::kOff)
    keep_strong(edges, first, y);
  out.left = static_cast<std::uint8_t>(edges.left);
  out.top = static_cast<std::uint8_t>(edges.top);
  edge_pixels += static_cast<std::uint64_t>(std::popcount(edges.left | edges.top));
}

Activity EdgeDetector::tick(Cycle cycle) {
  const bool arrives = lumas_in.can_pop(cycle);
  if (pipe_.empty() && !arrives) return kIdle;
  if (pipe_.leaves() && !edges_out.can_push(cycle)) return kStalledDownstream;
  pipe_.move();
  if (const EdgeToken* edges = pipe_.at(4)) edges_out.push(cycle, *edges);
  configuration_ = &configuration_in.read(cycle);
  const std::int32_t height = configuration_->height;
  if (EdgeToken* edges = pipe_.at(2)) {
    edges->left = edges->top = 0;
    if (edges->slot.row <= height) {
      luma_.shift(cycle, edges->slot);
      if (depth_) depth_->shift(cycle, edges->slot);
      if (edges->slot.row >= 1) decide(*edges);
    }
  }
  if (!arrives) return kBusy;
  const LumaToken& token = lumas_in.take(cycle);
  pipe_.enter().slot = token.slot;
  if (token.slot.row <= height) {
    luma_.take(cycle, token.slot, token.luma);
    if (depth_) depth_->take(cycle, token.slot, token.depth);
  }
  return kBusy;
}

EdgeDetector::Edges EdgeDetector::steps(std::int32_t first, std::int32_t count,
                                        std::int32_t y) const {
  Edges edges;
  for (std::int32_t i = 0; i < count; ++i) {
    const std::int32_t x = first + i;
    if (x > 0 && is_edge({x, y}, {x - 1, y})) edges.left |= 1u << i;
    if (y > 0 && is_edge({x, y}, {x, y - 1})) edges.top |= 1u << i;
  }
  return edges;
}

void EdgeDetector::keep_strong(Edges& edges, std::int32_t first, std::int32_t y) const {
  for (std::uint32_t left = edges.left | edges.top; left != 0; left &= left - 1) {
    const std::int32_t lane = std::countr_zero(left), x = first + lane;
    const Position p{x, y}, l{x - 1, y}, t{x, y - 1};
    if (edges.left >> lane & 1 && !survives(p, l, t)) edges.left ^= 1u << lane;
    if (edges.top >> lane & 1 && !survives(p, t, l)) edges.top ^= 1u << lane;
  }
}

// Both pixels are inside the frame.
bool EdgeDetector::is_edge(Position p, Position q) const {
  const FrameConfiguration& configuration = *configuration_;
  const std::uint32_t c = contrast(p, q);
  switch (configuration.source) {
    case spec::morphological::EdgeSource::kDepth:
      return depth_edge(p, q);
    case spec::morphological::EdgeSource::kPredicated:
      return c >= (depth_edge(p, q) ? configuration.threshold_on : configuration.threshold_off);
    case spec::morphological::EdgeSource::kLuma:
    case spec::morphological::EdgeSource::kColour:
      if (!configuration.dynamic) return c >= configuration.threshold;
  }
  return is_dynamic_edge(c, luma_[p], luma_[q]);
}

// Compares U9.40 products with U0.24, both for twice the luma.
bool EdgeDetector::is_dynamic_edge(std::uint32_t c, std::uint32_t here,
                                   std::uint32_t across) const {
  const FrameConfiguration& configuration = *configuration_;
  return c >= configuration.floor &&
         (std::uint64_t{c} << 25) > std::uint64_t{configuration.alpha} * doubled_luma(here, across);
}

// Twice the luma that alpha multiplies, U9.16: doubled so that the mean is exact.
std::uint32_t EdgeDetector::doubled_luma(std::uint32_t here, std::uint32_t across) const {
  switch (configuration_->dynamic_luma) {
    case spec::morphological::DynamicLuma::kMax:
      return 2 * std::max(here, across);
    case spec::morphological::DynamicLuma::kMin:
      return 2 * std::min(here, across);
    case spec::morphological::DynamicLuma::kMean:
      return here + across;
    case spec::morphological::DynamicLuma::kCurrent:
      break;
  }
  return 2 * here;
}

bool EdgeDetector::depth_edge(Position p, Position q) const {
  if (!depth_) return false;  // not built: reads as 0
  if ((luma_[p] | luma_[q]) & kMarkedLuma) return false;
  const std::uint32_t a = (*depth_)[p], b = (*depth_)[q];
  return a != b && (std::uint64_t{distance(a, b)} << 16) >=
                       std::uint64_t{configuration_->depth_threshold} * std::max(a, b);
}

std::uint32_t EdgeDetector::contrast(Position p, Position q) const {
  const std::uint32_t a = luma_[p], b = luma_[q];
  if ((a | b) & kMarkedLuma) return 0;
  return configuration_->source == spec::morphological::EdgeSource::kColour ? colour_distance(a, b)
                                                                            : distance(a, b);
}

std::uint32_t EdgeDetector::step(Position p, Position q) const {
  return inside(p) && inside(q) ? contrast(p, q) : 0;
}

// Keeps the edge between p and its neighbour `across` (left or top) if its step is more than half
// of the largest step nearby (`smaa`: at least half). `along` is the other neighbour.
bool EdgeDetector::survives(Position p, Position across, Position along) const {
  const std::int32_t ax = p.x - across.x, ay = p.y - across.y;  // from `across` to p
  const std::int32_t bx = p.x - along.x, by = p.y - along.y;
  const Position opposite{p.x + ax, p.y + ay}, after{p.x + bx, p.y + by};
  const Position beyond{across.x - ax, across.y - ay};
  const std::uint32_t c = step(p, across);
  std::uint32_t most = std::max({c, step(p, opposite), step(across, beyond)});
  const std::uint32_t beside = std::max(step(p, along), step(p, after));
  const spec::morphological::LocalContrast rule = configuration_->local_contrast;
  if (rule != spec::morphological::LocalContrast::kSymmetric) {
    most = std::max({most, beside, step(along, {along.x - bx, along.y - by})});
  } else {
    const Position across_along{across.x - bx, across.y - by};
    const Position across_after{across.x + bx, across.y + by};
    most = std::max(
        most, std::min(beside, std::max(step(across, across_along), step(across, across_after))));
  }
  return 2 * c > most || (rule == spec::morphological::LocalContrast::kSmaa && 2 * c == most);
}

Datasheet EdgeDetector::datasheet(const spec::morphological::Parameters& p) {
  const std::uint32_t depth = has_depth(p) ? 1 : 0;
  constexpr std::uint32_t kPixel = 25, kStep = 24, kProduct = 49;
  // Steps in luma and in colour.
  const auto with_steps = [](std::uint32_t count, std::vector<Operator> operators) {
    operators.insert(operators.begin(), {count * op::subtract(kStep), count * op::magnitude(kStep),
                                         3 * count * op::subtract(8), 3 * count * op::magnitude(8),
                                         2 * count * op::maximum(8), count * op::mux(kStep, 2)});
    return operators;
  };
  return {
      .unit = "EdgeDetector",
      .does = "Left and top edge bits of each pixel from steps in luma, colour or depth.",
      .latency = {4},
      .stages = {{.clock = "1", .work = "address", .registers = kPixel + depth * 24},
                 {.clock = "2",
                  .work = "column words, write-back",
                  .path = "SRAM read",
                  .registers = 4 * kPixel + depth * 2 * 24},
                 // Five steps per pixel: to the left, also one row above; up, one further up, down.
                 // The sign of a difference tells the larger luma. Depth shares the multipliers.
                 {.clock = "3",
                  .work = "differences, maxima of two pairs, products with the thresholds",
                  .operators = with_steps(
                      5, {3 * op::maximum(kStep), 2 * op::add(24), 2 * op::mux(25, 4),
                          2 * op::multiply(25, 24), 2 * depth * op::subtract(24),
                          2 * depth * op::magnitude(24), 2 * depth * op::mux(24 + kProduct, 2)}),
                  .longest = {op::subtract(24), op::mux(25, 4), op::multiply(25, 24)},
                  .registers = 6 * kStep + 2 * kProduct + depth * 2 * kPixel},
                 {.clock = "4",
                  .work = "last maxima, decision",
                  .operators = {6 * op::maximum(kStep), 2 * op::mux(kStep, 2), 2 * op::compare(25),
                                4 * op::compare(kStep), 2 * op::compare(kProduct),
                                2 * depth * op::compare(40), 2 * depth * op::mux(kStep, 3),
                                op::logic(40)},
                  .longest = {op::maximum(kStep), op::mux(kStep, 2), op::maximum(kStep),
                              op::compare(25)}}},
      .formats =
          "U8.16 luma or three U0.8 codes, U24 depth; thresholds U8.16, alpha U0.24, depth "
          "threshold U0.16.",
      .copies = lane_copies(p),
      .per = "lane",
      // The columns next to the beat: their steps, six pixels, two steps of stage 3.
      .shared = with_steps(
          5, {op::maximum(kStep), 3 * op::equal(14), 2 * op::compare(14), op::logic(60)}),
      .shared_registers = 3 * (kPayloadBits<Slot> + 1) + 6 * kPixel + 2 * kStep + depth * 24};
}

}  // namespace deburr::rtl::morphological
