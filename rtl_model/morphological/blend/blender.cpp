// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/blender.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <string>

#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"
#include "spec/morphological/tables.h"

namespace deburr::rtl::morphological {
namespace {

using spec::morphological::Bypass;

template <class Visit>
void for_each_lane(std::uint8_t lanes, Visit&& visit) {
  for (std::uint32_t left = lanes; left != 0; left &= left - 1)
    visit(static_cast<std::size_t>(std::countr_zero(left)));
}

// Mark set by the geometric engine.
bool is_marked(const spec::morphological::Rgba8& pixel) { return (pixel[3] & 1) == 0; }

// Fraction bits added to the weights for blending: U0.12.
constexpr int kMoreBits = 4;
constexpr int kBlendBits = 8 + kMoreBits;
// R(s), U1.20: normalises squared weights to the sum s.
constexpr std::uint32_t kMixBits = 21;
std::vector<std::uint32_t> mix_words() {
  std::vector<std::uint32_t> words(spec::morphological::kMixSums);
  for (std::uint32_t s = 1; s < words.size(); ++s) words[s] = ((2u << 20) + s) / (2 * s);
  return words;
}

}  // namespace

Blender::Blender(const sc_core::sc_module_name& name, ClockDomain& clock,
                 const spec::morphological::Parameters& p, LatencyProbe& probe)
    : Unit(name, clock),
      lanes_(built_lanes(p)),
      first_row_(search_range_rows_of(p) + spec::morphological::kRowLag),
      probe_(probe),
      mix_rom_("mix_rom",
               {.words = spec::morphological::kMixSums,
                .word_bits = kMixBits,
                .kind = MemoryKind::kRom,
                .read_ports = static_cast<std::uint32_t>(lanes_),
                .write_ports = 0,
                .content = "2^20 / sum of weights"},
               mix_words()),
      linear_rom_("linear_rom",
                  {.words = spec::morphological::kLinear12FromSrgb.size(),
                   .word_bits = 12,
                   .kind = MemoryKind::kRom,
                   .read_ports = static_cast<std::uint32_t>(9 * lanes_),
                   .write_ports = 0,
                   .content = "sRGB code to linear light"},
                  spec::morphological::kLinear12FromSrgb),
      encode_rom_("encode_rom",
                  {.words = spec::morphological::kSrgbFromLinear12.size(),
                   .word_bits = 8,
                   .kind = MemoryKind::kRom,
                   .read_ports = static_cast<std::uint32_t>(3 * lanes_),
                   .write_ports = 0,
                   .content = "linear light to sRGB code"},
                  spec::morphological::kSrgbFromLinear12) {
  for (int lane = 0; lane < lanes_; ++lane) {
    mix_.emplace_back(mix_rom_, std::to_string(lane));
    for (const char* const channel : {"r", "g", "b"}) {
      const std::string at = std::to_string(lane) + "." + channel;
      for (const char* const operand : {" centre", " first", " second"})
        light_.emplace_back(linear_rom_, at + operand);
      codes_.emplace_back(encode_rom_, at);
    }
  }
  if (p.text_guard) guards_in.emplace("guards_in");
}

// Stage 1.
void Blender::choose(Cycle cycle, const FrameConfiguration& configuration, const WeightToken& token,
                     const PixelToken& around, Beat& beat) {
  const Slot slot = token.slot;
  const bool end = slot.beat + 1u == configuration.beats;
  const auto count = static_cast<std::size_t>(end ? configuration.last_count : lanes_);
  beat.slot = slot.number;
  beat.last = end && slot.row + 1u == configuration.rows;
  beat.blend = beat.left = 0;
  spec::morphological::BlendedBeat& result = beat.result;
  result = {};  // defines every lane of the output
  result.count = static_cast<std::uint8_t>(count);
  result.end_of_row = end;
  result.start_of_frame = slot.row == first_row_ && slot.beat == 0;
  for (std::size_t i = 0; i < count; ++i) {
    result.pixel[i] = around.centre[i];
    result.probe[i].edges =
        static_cast<std::uint8_t>((token.left >> i & 1) | (token.top >> i & 1) << 1);
  }
  std::uint32_t guarded = 0;
  if (configuration.text_guard) [[unlikely]]
    guarded = guards_in->take(cycle).guarded;
  if (token.any) choose_axes(cycle, token, around, guarded, beat);
}

// By the pixel's own mark, or with bypass = beside also those of its neighbours in the frame.
bool Blender::is_bypassed(const FrameConfiguration& configuration, const Slot& slot,
                          const PixelToken& around, std::size_t lane, std::size_t count) const {
  if (is_marked(around.centre[lane])) return true;
  if (configuration.bypass != Bypass::kBeside) return false;
  const bool first_row = slot.row == first_row_, last_row = slot.row + 1u == configuration.rows,
             first_column = slot.beat == 0 && lane == 0, last_lane = lane + 1 == count,
             last_column = last_lane && slot.beat + 1u == configuration.beats;
  return (!first_row && is_marked(around.above[lane])) ||
         (!last_row && is_marked(around.below[lane])) ||
         (!first_column && is_marked(lane == 0 ? around.before : around.centre[lane - 1])) ||
         (!last_column && is_marked(last_lane ? around.after : around.centre[lane + 1]));
}

void Blender::choose_axes(Cycle cycle, const WeightToken& token, const PixelToken& around,
                          std::uint32_t guarded, Beat& beat) {
  const FrameConfiguration& configuration = configuration_in.read(cycle);
  const bool strongest = configuration.strongest;
  const Bypass bypass = configuration.bypass;
  const bool by_marks = bypass != Bypass::kNone && bypass != Bypass::kMasked,
             leaves = by_marks || guarded != 0;
  const std::size_t count = beat.result.count;
  for (std::size_t i = 0; i < count; ++i) {
    const Weights& s = token.weights[i];
    const int vertical_sum = s.up + s.down, horizontal_sum = s.left + s.right;
    if (vertical_sum + horizontal_sum == 0) continue;
    if (leaves && ((guarded >> i & 1) != 0 ||
                   (by_marks && is_bypassed(configuration, token.slot, around, i, count)))) {
      beat.left = static_cast<std::uint8_t>(beat.left | 1u << i);
      continue;
    }
    bool horizontal;
    if (strongest) {
      horizontal = std::max(s.left, s.right) > std::max(s.up, s.down);
    } else if (vertical_sum == 0 || horizontal_sum == 0) {
      horizontal = vertical_sum == 0;
    } else {
      const int span_h = std::max(s.up ? s.span_up : 0, s.down ? s.span_down : 0);
      const int span_v = std::max(s.left ? s.span_left : 0, s.right ? s.span_right : 0);
      horizontal = span_h != span_v ? span_h < span_v : vertical_sum < horizontal_sum;
    }
    const spec::morphological::Rgba8& first = !horizontal ? around.above[i]
                                              : i == 0    ? around.before
                                                          : around.centre[i - 1];
    const spec::morphological::Rgba8& second = !horizontal      ? around.below[i]
                                               : i + 1 == count ? around.after
                                                                : around.centre[i + 1];
    std::uint8_t first_weight = horizontal ? s.left : s.up,
                 second_weight = horizontal ? s.right : s.down;
    if (bypass == Bypass::kHalf) {
      first_weight = static_cast<std::uint8_t>(first_weight >> is_marked(first));
      second_weight = static_cast<std::uint8_t>(second_weight >> is_marked(second));
      if (first_weight + second_weight == 0) {
        beat.left = static_cast<std::uint8_t>(beat.left | 1u << i);
        continue;
      }
    }
    spec::morphological::BlendProbe& probe = beat.result.probe[i];
    probe.horizontal = horizontal;
    probe.first = first_weight;
    probe.second = second_weight;
    Operands& operands = beat.operands[i];
    operands.code = {around.centre[i], first, second};
    operands.weight = {static_cast<std::uint16_t>(first_weight << kMoreBits),
                       static_cast<std::uint16_t>(second_weight << kMoreBits)};
    beat.blend = static_cast<std::uint8_t>(beat.blend | 1u << i);
    if (strongest) mix_[i].read(cycle, std::uint64_t{probe.first} + probe.second);
  }
  blending_ += beat.blend != 0;
}

// Stages 2 and 3: each weight becomes its square divided by the sum of both.
void Blender::mix(Cycle cycle, Beat& beat) {
  for_each_lane(beat.blend, [&](std::size_t lane) {
    const spec::morphological::BlendProbe& probe = beat.result.probe[lane];
    const std::uint32_t word = mix_[lane].at(cycle, std::uint64_t{probe.first} + probe.second);
    const auto mixed = [&](std::uint32_t weight) {
      return static_cast<std::uint16_t>((std::uint64_t{weight} * weight * word + (1u << 15)) >> 16);
    };
    beat.operands[lane].weight = {mixed(probe.first), mixed(probe.second)};
  });
}

// Stage 2.
void Blender::address_light(Cycle cycle, const Beat& beat) {
  if (!configuration_in.read(cycle).linear_light) return;
  for_each_lane(beat.blend, [&](std::size_t lane) {
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t operand = 0; operand < 3; ++operand)
        light_[light_port(lane, c, operand)].read(cycle, beat.operands[lane].code[operand][c]);
  });
}

// Stage 3.
void Blender::subtract(Cycle cycle, Beat& beat) {
  const bool linear = configuration_in.read(cycle).linear_light;
  for_each_lane(beat.blend, [&](std::size_t lane) {
    Operands& o = beat.operands[lane];
    for (std::size_t c = 0; c < 3; ++c) {
      const auto light = [&](std::size_t operand) -> std::int32_t {
        const std::uint8_t code = o.code[operand][c];
        return linear ? light_[light_port(lane, c, operand)].at(cycle, code) : code;
      };
      o.centre[c] = light(0);
      o.first[c] = light(1) - o.centre[c];
      o.second[c] = light(2) - o.centre[c];
    }
  });
}

// Stage 4. A neighbour with weight 0 may lie outside the frame.
void Blender::multiply(Beat& beat) {
  for_each_lane(beat.blend, [&](std::size_t lane) {
    Operands& o = beat.operands[lane];
    for (std::size_t c = 0; c < 3; ++c)
      o.sum[c] = o.weight[0] * o.first[c] + o.weight[1] * o.second[c];
  });
}

// Stage 5.
void Blender::round(Cycle cycle, Beat& beat) {
  const bool linear = configuration_in.read(cycle).linear_light;
  for_each_lane(beat.blend, [&](std::size_t lane) {
    Operands& o = beat.operands[lane];
    for (std::size_t c = 0; c < 3; ++c) {
      const std::int32_t v = o.sum[c],
                         moved = (std::abs(v) + (1 << (kBlendBits - 1))) >> kBlendBits;
      o.value[c] = static_cast<std::uint16_t>(v < 0 ? o.centre[c] - moved : o.centre[c] + moved);
      if (linear) codes_[lane * 3 + c].read(cycle, o.value[c]);
    }
  });
}

// Stage 6.
void Blender::deliver(Cycle cycle, const FrameConfiguration& configuration, const Beat& beat) {
  spec::morphological::BlendedBeat& out = pixels_out.emplace(cycle);
  out = beat.result;
  if ((beat.blend | beat.left) != 0) {
    encode(cycle, beat, out);
    bypassed_pixels += static_cast<std::uint64_t>(std::popcount(beat.left));
  }
  if (configuration.bypass != Bypass::kNone)
    for (std::size_t i = 0; i < out.count; ++i) out.pixel[i][3] |= 1;
  pixels += out.count;
  beat_latency.record(probe_.leaves(cycle));
  if (beat.last) frames_done_out.push(cycle, {beat.slot});
}

void Blender::encode(Cycle cycle, const Beat& beat, spec::morphological::BlendedBeat& out) {
  const bool linear = configuration_in.read(cycle).linear_light;
  for_each_lane(beat.blend, [&](std::size_t lane) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint16_t value = beat.operands[lane].value[c];
      out.pixel[lane][c] =
          linear ? codes_[lane * 3 + c].at(cycle, value) : static_cast<std::uint8_t>(value);
    }
    ++blended_pixels;
  });
}

// Stages 5 to 2; nothing to do for beats in which no lane blends.
void Blender::blend(Cycle cycle) {
  if (Beat* beat = pipe_.at(5); beat && beat->blend) {
    round(cycle, *beat);
    --blending_;
  }
  if (Beat* beat = pipe_.at(4)) multiply(*beat);
  if (Beat* beat = pipe_.at(3)) subtract(cycle, *beat);
  if (Beat* beat = pipe_.at(2)) {
    address_light(cycle, *beat);
    if (configuration_in.read(cycle).strongest) mix(cycle, *beat);
  }
}

Activity Blender::tick(Cycle cycle) {
  const FrameConfiguration& configuration = configuration_in.read(cycle);
  const bool arrives = weights_in.can_pop(cycle) && pixels_in.can_pop(cycle) &&
                       (!configuration.text_guard || guards_in->can_pop(cycle));
  if (!arrives && pipe_.empty()) return kIdle;
  if (pipe_.leaves() &&
      (!pixels_out.can_push(cycle) || (pipe_.at(5)->last && !frames_done_out.can_push(cycle))))
    return kStalledDownstream;
  pipe_.move();
  if (const Beat* beat = pipe_.at(6)) deliver(cycle, configuration, *beat);
  if (blending_ != 0) blend(cycle);
  if (arrives)
    choose(cycle, configuration, weights_in.take(cycle), pixels_in.take(cycle), pipe_.enter());
  return kBusy;
}

Datasheet Blender::datasheet(const spec::morphological::Parameters& p) {
  constexpr std::uint32_t kChannels = 3, kCode = 8, kLight = 12, kDifference = 13;
  constexpr std::uint32_t kWeight = 8, kBlend = 12, kMix = kMixBits;
  // The pixel passes unchanged where it is not blended.
  constexpr std::uint32_t kPassed = 4 * kCode + 1;
  return {
      .unit = "Blender",
      .does = "Decides the axis of each pixel and blends it with its neighbours on that axis.",
      .latency = {6, "6; 5 to its push into the output link"},
      .stages =
          {// Sums of both pairs; spans, or largest weights; marks of five pixels; half weights.
           {.clock = "1",
            .work = "sums, spans, axis, neighbours, marks, text guard; mix_rom address from the "
                    "sum on the chosen axis (`strongest`: two maxima, compare, sums of both pairs)",
            .operators = {2 * op::add(kWeight), 2 * op::maximum(12), op::compare(12), op::equal(12),
                          op::compare(9), 2 * op::maximum(kWeight), op::compare(kWeight),
                          2 * op::mux(25, 2), 2 * op::mux(kWeight, 2), 2 * op::mux(kWeight, 2),
                          op::mux(9, 2), op::logic(120 + (p.text_guard ? 4 : 0))},
            .longest = {op::maximum(12), op::compare(12), op::logic(8), op::mux(25, 2),
                        op::mux(kWeight, 2)},
            .registers = kPassed + 2 * kChannels * kCode + 2 * kWeight},
           {.clock = "2",
            .work = "linear_rom address; mix_rom word, squares of both weights",
            .operators = {2 * op::square(kWeight)},
            .longest = {op::square(kWeight)},
            .registers = kPassed + 2 * kChannels * kCode + 2 * kWeight + 2 * 2 * kWeight + kMix},
           {.clock = "3",
            .work = "linear light, differences; squares x word, rounded",
            .operators = {3 * kChannels * op::mux(kLight, 2), 2 * kChannels * op::subtract(12),
                          2 * op::multiply(kMix, 2 * kWeight), 2 * op::add(37),
                          2 * op::mux(kBlend, 2)},
            .longest = {op::multiply(kMix, 2 * kWeight), op::add(37), op::mux(kBlend, 2)},
            .registers = kPassed + kChannels * (kLight + 2 * kDifference) + 2 * kBlend},
           {.clock = "4",
            .work = "products, sum",
            .operators = {2 * kChannels * op::multiply(13, kDifference), kChannels * op::add(26)},
            .longest = {op::multiply(13, kDifference), op::add(26)},
            .registers = kPassed + kChannels * (kLight + 25)},
           {.clock = "5",
            .work = "rounding, new value, encode_rom address",
            .operators = {kChannels * op::magnitude(25), kChannels * op::add(25),
                          kChannels * op::add(kDifference)},
            .longest = {op::magnitude(25), op::add(25), op::add(kDifference)},
            .registers = kPassed + kChannels * kCode},
           {.clock = "6",
            .work = "codes",
            .operators = {op::mux(kChannels * kCode, 3), op::logic(8)},
            .longest = {op::rom_read(kCode, 4096), op::mux(kChannels * kCode, 3)}}},
      .formats = "weights U0.8, blended as U0.12; linear light U0.12, differences S13.",
      .copies = lane_copies(p),
      .per = "lane",
      // Marks of the beat; ends of row and frame.
      .shared = {3 * op::equal(14), op::equal(13), op::logic(20)},
      .shared_registers = 5 * (3 + 1 + 1 + 1 + 1)};
}

}  // namespace deburr::rtl::morphological
