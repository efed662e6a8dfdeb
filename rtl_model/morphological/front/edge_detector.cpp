// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/front/edge_detector.h"

#include <algorithm>

namespace deburr::rtl::morphological {
namespace {

constexpr std::uint32_t distance(std::uint32_t a, std::uint32_t b) { return a > b ? a - b : b - a; }

std::uint64_t words_for(std::int32_t columns, std::uint32_t lanes) {
  return (static_cast<std::uint64_t>(columns) + lanes - 1) / lanes * lanes;
}

}  // namespace

EdgeDetector::DepthLines::DepthLines(std::int32_t columns, std::uint32_t lanes)
    : lines("depth_lines", {.words = words_for(columns, lanes),
                            .word_bits = 2 * 24,
                            .read_during_write = ReadDuringWrite::kNewWord,
                            .banks = lanes,
                            .span = lanes,
                            .content = "a column of the last two rows of depth",
                            .columns = static_cast<std::uint64_t>(columns)}) {}

EdgeDetector::EdgeDetector(const sc_core::sc_module_name& name, ClockDomain& clock,
                           const spec::morphological::Parameters& p, const ParameterStore& store)
    : Unit(name, clock),
      store_(store),
      lanes_(static_cast<std::size_t>(store.lanes())),
      // The columns of a beat and the one beside it lie in banks of their own.
      luma_lines_("luma_lines",
                  {.words = std::max<std::uint64_t>(
                       words_for(p.line_pixels, static_cast<std::uint32_t>(lanes_)), 2 * lanes_),
                   .word_bits = 3 * 24,
                   .read_during_write = ReadDuringWrite::kNewWord,
                   .banks = static_cast<std::uint32_t>(2 * lanes_),
                   .span = static_cast<std::uint32_t>(lanes_ + 1),
                   .content = "a column of the last three rows of luma",
                   .columns = static_cast<std::uint64_t>(p.line_pixels)}) {
  if (p.edge_source != spec::morphological::EdgeSource::kLuma)
    depth_.emplace(p.line_pixels, static_cast<std::uint32_t>(lanes_));
}

Activity EdgeDetector::tick(Cycle cycle) {
  const bool arrives = lumas_in.can_pop(cycle);
  if (pipe_.empty() && !arrives) return kIdle;
  if (pipe_.leaves() && !edges_out.can_push(cycle)) return kStalledDownstream;
  pipe_.move();
  if (const Beat* beat = pipe_.at(4)) edges_out.push(cycle, beat->out);
  const std::int32_t height = store_.rules().height;
  if (Beat* beat = pipe_.at(2)) {
    const Slot& slot = beat->in.slot;
    beat->out.slot = slot;
    beat->out.left = beat->out.top = 0;
    if (slot.row <= height) {
      gather(cycle, beat->in);
      if (slot.row >= 1) decide(beat->in, beat->out);
    }
  }
  if (!arrives) return kBusy;
  Beat& beat = pipe_.enter();
  beat.in = lumas_in.take(cycle);
  if (beat.in.slot.row <= height) address(cycle, beat.in.slot);
  return kBusy;
}

void EdgeDetector::address(Cycle cycle, const Slot& slot) {
  const std::size_t x = slot.beat * lanes_;
  const std::size_t words = luma_lines_.words();
  read_luma_.read(cycle, x, static_cast<std::uint32_t>(std::min(lanes_ + 1, words - x)));
  if (depth_) depth_->read.read(cycle, x, static_cast<std::uint32_t>(lanes_));
}

// The words on the output registers and the beat that has come, beside the columns before; then the
// words go back, a row on.
void EdgeDetector::gather(Cycle cycle, const LumaToken& token) {
  const std::size_t x = token.slot.beat * lanes_;
  const auto shift = [&](auto& around) {
    for (auto& row : around)
      for (std::size_t i = 0; i < kBefore; ++i) row[i] = row[i + lanes_];
  };
  shift(around_);
  row_ = token.slot.row;
  column_ = static_cast<std::int32_t>(x) - static_cast<std::int32_t>(kBefore);
  std::array<LumaWord, spec::morphological::kMaxLanes> back;
  for (std::size_t i = 0; i < lanes_; ++i) {
    const LumaWord& word = read_luma_.at(cycle, x + i);
    around_[0][kBefore + i] = token.luma[i];
    for (std::size_t row = 0; row < 3; ++row) around_[row + 1][kBefore + i] = word[row];
    back[i] = {token.luma[i], word[0], word[1]};
  }
  if (x + lanes_ < luma_lines_.words()) {
    const LumaWord& word = read_luma_.at(cycle, x + lanes_);
    for (std::size_t row = 0; row < 3; ++row) around_[row + 1][kBefore + lanes_] = word[row];
  }
  write_luma_.write(cycle, x, std::span<const LumaWord>(back.data(), lanes_));
  if (!depth_) return;
  shift(depth_->around);
  std::array<DepthWord, spec::morphological::kMaxLanes> depth_back;
  for (std::size_t i = 0; i < lanes_; ++i) {
    const DepthWord& word = depth_->read.at(cycle, x + i);
    depth_->around[0][kBefore + i] = token.depth[i];
    for (std::size_t row = 0; row < 2; ++row) depth_->around[row + 1][kBefore + i] = word[row];
    depth_back[i] = {token.depth[i], word[0]};
  }
  depth_->write.write(cycle, x, std::span<const DepthWord>(depth_back.data(), lanes_));
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
