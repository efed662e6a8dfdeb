// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/blender.h"

#include <algorithm>

#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"
#include "spec/morphological/tables.h"

namespace deburr::rtl::morphological {

Blender::Blender(const sc_core::sc_module_name& name, ClockDomain& clock,
                 const ParameterStore& store, LatencyProbe& probe)
    : Unit(name, clock), store_(store), probe_(probe) {}

Activity Blender::tick(Cycle cycle) {
  bool did = false;
  if (stage_.full) {
    if (!pixels_out.can_push(cycle) || (stage_.last && !frames_done_out.can_push(cycle)))
      return kStalledDownstream;
    deliver(cycle);
    did = true;
  }
  if (shares_in.can_pop(cycle) && pixels_in.can_pop(cycle)) {
    choose(shares_in.front(cycle), pixels_in.front(cycle));
    shares_in.pop(cycle);
    pixels_in.pop(cycle);
    did = true;
  }
  return did ? kBusy : kIdle;
}

// Stage 1.
void Blender::choose(const ShareToken& token, const PixelToken& around) {
  const FrameRules& rules = store_.rules();
  const bool end = token.slot.beat + 1u == rules.beats;
  const auto count = static_cast<std::size_t>(end ? rules.last_count : store_.lanes());
  stage_.full = true;
  stage_.slot = token.slot;
  stage_.last = end && token.slot.row + 1u == rules.rows;
  for (std::size_t i = 0; i < count; ++i) {
    stage_.centre[i] = around.centre[i];
    spec::morphological::BlendTap& tap = stage_.tap[i];
    tap = {};
    tap.edges = static_cast<std::uint8_t>((token.left >> i & 1) | (token.top >> i & 1) << 1);
    if (!token.any) continue;

    const Shares& s = token.shares[i];
    const int vertical_sum = s.up + s.down, horizontal_sum = s.left + s.right;
    if (vertical_sum + horizontal_sum == 0) continue;
    bool horizontal;
    if (vertical_sum == 0 || horizontal_sum == 0) {
      horizontal = vertical_sum == 0;
    } else {
      const int span_h = std::max(s.up ? s.span_up : 0, s.down ? s.span_down : 0);
      const int span_v = std::max(s.left ? s.span_left : 0, s.right ? s.span_right : 0);
      horizontal = span_h != span_v ? span_h < span_v : vertical_sum < horizontal_sum;
    }
    tap.horizontal = horizontal;
    tap.first = horizontal ? s.left : s.up;
    tap.second = horizontal ? s.right : s.down;

    const spec::morphological::Rgba8& centre = around.centre[i];
    const spec::morphological::Rgba8& left = i == 0 ? around.before : around.centre[i - 1];
    const spec::morphological::Rgba8& right = i + 1 == count ? around.after : around.centre[i + 1];
    const spec::morphological::Rgba8& first = horizontal ? left : around.above[i];
    const spec::morphological::Rgba8& second = horizontal ? right : around.below[i];
    Operands& o = stage_.operands[i];
    for (std::size_t c = 0; c < 3; ++c) {
      const auto light = [&](std::uint8_t value) -> std::int32_t {
        return rules.linear_light ? spec::morphological::kLinear12FromSrgb[value] : value;
      };
      o.centre[c] = light(centre[c]);
      // A neighbour without a share may lie outside the frame.
      o.first[c] = tap.first ? light(first[c]) : o.centre[c];
      o.second[c] = tap.second ? light(second[c]) : o.centre[c];
    }
  }
}

// Stage 2.
void Blender::deliver(Cycle cycle) {
  const FrameRules& rules = store_.rules();
  const Slot slot = stage_.slot;
  const bool end = slot.beat + 1u == rules.beats;
  const auto count = static_cast<std::size_t>(end ? rules.last_count : store_.lanes());
  const std::int32_t row = slot.row - store_.reach_rows() - spec::morphological::kRowLag;
  spec::morphological::BlendedBeat& out = pixels_out.emplace(cycle);
  out = {};  // what leaves the engine is defined in every lane
  out.count = static_cast<std::uint8_t>(count);
  out.end_of_row = end;
  out.start_of_frame = row == 0 && slot.beat == 0;
  for (std::size_t i = 0; i < count; ++i) {
    const spec::morphological::BlendTap& tap = stage_.tap[i];
    out.tap[i] = tap;
    if (tap.first == 0 && tap.second == 0) {
      out.pixel[i] = stage_.centre[i];
    } else {
      out.pixel[i] = blend(stage_.operands[i], tap, stage_.centre[i][3]);
      ++blended_pixels;
    }
  }
  pixels += count;
  beat_latency.record(probe_.leaves(cycle));
  stage_.full = false;
  if (stage_.last) frames_done_out.push(cycle, {slot.number});
}

spec::morphological::Rgba8 Blender::blend(const Operands& o,
                                          const spec::morphological::BlendTap& tap,
                                          std::uint8_t alpha) const {
  spec::morphological::Rgba8 result{};
  for (std::size_t c = 0; c < 3; ++c) {
    const std::int32_t v =
        tap.first * (o.first[c] - o.centre[c]) + tap.second * (o.second[c] - o.centre[c]);
    const std::int32_t moved = ((v < 0 ? -v : v) + 128) >> 8;
    const auto value =
        static_cast<std::uint32_t>(v < 0 ? o.centre[c] - moved : o.centre[c] + moved);
    result[c] = store_.rules().linear_light ? spec::morphological::kSrgbFromLinear12[value]
                                            : static_cast<std::uint8_t>(value);
  }
  result[3] = alpha;
  return result;
}

void Blender::reset() { stage_.full = false; }

}  // namespace deburr::rtl::morphological
