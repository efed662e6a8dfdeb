// SPDX-License-Identifier: MIT
#include "rtl_model/texture/sample_walker.h"

#include <algorithm>
#include <bit>
#include <span>

#include "rtl_model/texture/datasheets.h"
#include "spec/texture/tables.h"

namespace deburr::rtl::texture {
namespace {

constexpr int kReciprocalBits = 16;  // fraction bits
constexpr int kRoundedBits = 23;     // from half an axis, S10.46, to a coordinate, S9.24
constexpr std::int64_t kHalf = std::int64_t{1} << (kRoundedBits - 1);
constexpr std::int32_t kWholeAxis = 64;  // U2.6
constexpr std::uint8_t kNoTent = 16;     // above every N - 1

using spec::texture::Kernel;

std::uint8_t first_tent(Kernel kernel) {
  return kernel == Kernel::kTent ? 3 : kernel == Kernel::kAxis ? 4 : kNoTent;
}

}  // namespace

template <class Width>
SampleWalkerOf<Width>::SampleWalkerOf(const sc_core::sc_module_name& name, ClockDomain& clock,
                                      spec::texture::CountRule count, spec::texture::Kernel kernel,
                                      std::int32_t spread, spec::texture::Blend blend,
                                      const spec::texture::Build& build)
    : SampleWalkerBase(name, clock),
      box_spread_(kernel == Kernel::kTent ? std::min(spread, kWholeAxis) : spread),
      tent_spread_(kernel == Kernel::kAxis ? tent_spread(spread) : spread),
      first_tent_(first_tent(kernel)),
      by_axis_(kernel == Kernel::kAxis),
      by_level_(blend == spec::texture::Blend::kLevel),
      width_(static_cast<std::size_t>(build.width)),
      fragments_(static_cast<std::size_t>(build.fragments)) {
  if (count != spec::texture::CountRule::kAny) return;
  constexpr std::size_t kLargestCount = spec::texture::kReciprocal.size() - 1;
  reciprocal_ = std::make_unique<Memory<std::uint32_t>>(
      "reciprocal",
      MemoryShape{.words = kLargestCount,
                  .word_bits = kReciprocalBits + 1,
                  .kind = MemoryKind::kRom,
                  .read_ports = static_cast<std::uint32_t>(fragments_),
                  .write_ports = 0,
                  .latency = 1,
                  .content = "1/N for N from 1 to 16"},
      std::span(spec::texture::kReciprocal).subspan(1));
  for (std::size_t i = 0; i < fragments_; ++i)
    reads_.emplace_back(*reciprocal_, numbered("walker", i));
}

// Last stage first: each stage reads what its predecessor wrote in the previous cycle.
template <class Width>
Activity SampleWalkerOf<Width>::tick(Cycle cycle) {
  const bool arrives = levels_in.can_pop(cycle);
  if (walking_ == 0 && !scaled_.occupied && !divided_.occupied && !arrives) return kIdle;
  const bool stalled = walking_ != 0 && !samples_out.can_push(cycle);
  if (walking_ != 0 && !stalled) emit(cycle);
  Preparing& next = reciprocal_ ? divided_ : scaled_;
  if (next.occupied && walking_ < kWalking) start(next);
  if (reciprocal_ && scaled_.occupied && !divided_.occupied) divide(cycle);
  if (arrives && !scaled_.occupied) scale(cycle, levels_in.take(cycle));
  return stalled ? kStalledDownstream : kBusy;
}

// Stage 1.
template <class Width>
void SampleWalkerOf<Width>::scale(Cycle cycle,
                                  const typename Width::template Fragments<LevelToken>& group) {
  scaled_.occupied = true;
  each(group, scaled_.group, [&](const LevelToken& fragment, Prepared& scaled) {
    const bool tent = fragment.last_index >= first_tent_ && (!by_axis_ || fragment.diagonal);
    const std::int32_t spread = tent ? tent_spread_ : box_spread_;
    scaled.fragment = fragment;
    scaled.fragment.diagonal = tent && by_axis_;
    scaled.step_s = fragment.axis_s * spread;
    scaled.step_t = fragment.axis_t * spread;
  });
  // All fragments read in the same cycle, so one of them is enough for the check.
  if (reciprocal_) reads_[0].read(cycle, nth(group, 0).last_index);
}

// Stage 2 with `any`.
template <class Width>
void SampleWalkerOf<Width>::divide(Cycle cycle) {
  divided_.occupied = true;
  set_count(divided_.group, count_of(scaled_.group));
  for (std::size_t i = 0; i < count_of(scaled_.group); ++i) {
    const Prepared& scaled = nth(scaled_.group, i);
    const std::size_t last = scaled.fragment.last_index;
    const std::int64_t reciprocal =
        i == 0 ? reads_[0].at(cycle, last) : spec::texture::kReciprocal[last + 1];
    nth(divided_.group, i) = {scaled.fragment, scaled.step_s * reciprocal,
                              scaled.step_t * reciprocal};
  }
  scaled_.occupied = false;
}

// Last stage but one.
template <class Width>
void SampleWalkerOf<Width>::start(Preparing& next) {
  next.occupied = false;
  each(next.group, walks_[(older_ + walking_) % kWalking],
       [&](const Prepared& prepared, Walk& walk) { begin(prepared, walk); });
  ++walking_;
}

template <class Width>
inline void SampleWalkerOf<Width>::begin(const Prepared& prepared, Walk& walk) const {
  walk.fragment = prepared.fragment;
  walk.second_level = false;
  walk.index = 0;
  // If N is a power of two, N - 1 has lb N ones.
  const std::uint8_t last = prepared.fragment.last_index;
  walk.weights = static_cast<std::uint8_t>(last + (prepared.fragment.diagonal ? kTent : 0));
  const int up = reciprocal_ ? 0 : kReciprocalBits - std::bit_width(unsigned{last});
  walk.step_s = prepared.step_s << up;
  walk.step_t = prepared.step_t << up;
  walk.walk_s = -(walk.step_s * last);  // (1 - N) x spread x axis / N
  walk.walk_t = -(walk.step_t * last);
}

// Last stage.
template <class Width>
void SampleWalkerOf<Width>::emit(Cycle cycle) {
  auto& out = samples_out.emplace(cycle);
  if constexpr (Width::kMost == 1) {
    if (step(walks_[0], out)) walking_ = 0;
  } else {
    const std::size_t width = width_;
    std::size_t count = 0;
    unsigned partial = 0;
    while (count < width && walking_ != 0) {
      auto& group = walks_[older_];
      Walk& walk = group.at[fragment_];
      bool last = false;
      while (count < width && !last) last = step(walk, out.at[count++]);
      if (!last || ++fragment_ != group.count) continue;
      if (group.count < fragments_) partial |= 1U << (count - 1);
      fragment_ = 0;
      older_ = (older_ + 1) % kWalking;
      --walking_;
    }
    out.count = static_cast<std::uint8_t>(count);
    out.partial = static_cast<std::uint8_t>(partial);
  }
}

// The next request of a fragment. True: it is the last one.
template <class Width>
inline bool SampleWalkerOf<Width>::step(Walk& walk, SampleToken& out) {
  const LevelToken& fragment = walk.fragment;
  const bool last_level = walk.second_level || fragment.fraction == 0,
             last_sample = walk.index == fragment.last_index, last = last_level && last_sample;
  out.ticket = fragment.ticket;
  out.s = fragment.s + ((walk.walk_s + kHalf) >> kRoundedBits);
  out.t = fragment.t + ((walk.walk_t + kHalf) >> kRoundedBits);
  out.level_weight =
      static_cast<std::uint16_t>(walk.second_level ? fragment.fraction : 256 - fragment.fraction);
  out.index = walk.index;
  out.last_index = walk.weights;
  out.level = static_cast<std::uint8_t>(fragment.level + (walk.second_level ? 1 : 0));
  out.linear = fragment.linear;
  out.last_of_sample = last_level;
  out.last_of_fragment = last;

  if (last_level) ++samples;
  if (by_level_) [[unlikely]] {
    out.last_of_sample = last_sample;
    advance_by_level(walk, last_sample);
    return last;
  }
  walk.second_level = !last_level;
  if (walk.second_level) return false;
  ++walk.index;
  walk.walk_s += walk.step_s << 1;
  walk.walk_t += walk.step_t << 1;
  return last;
}

template <class Width>
void SampleWalkerOf<Width>::advance_by_level(Walk& walk, bool last_sample) {
  if (last_sample) {
    walk.second_level = true;
    walk.index = 0;
    walk.walk_s = -walk.walk_s;
    walk.walk_t = -walk.walk_t;
  } else {
    ++walk.index;
    walk.walk_s += walk.step_s << 1;
    walk.walk_t += walk.step_t << 1;
  }
}

template <class Width>
Datasheet SampleWalkerOf<Width>::datasheet(const spec::texture::Parameters& p) {
  const Sizes z(p);
  const bool any = p.count == spec::texture::CountRule::kAny, wide = z.width > 1;
  const bool by_level = p.blend == spec::texture::Blend::kLevel, by_axis = selects_kernel(p);
  const std::uint32_t f = z.fragments, w = z.width, walks = z.walking * f;
  // Ticket, position, count, kernel, level and filter of a fragment, and valid.
  const std::uint32_t fragment = Payload::of<LevelToken>(axis_shape(p)).bits() - 2 * z.axis + 1;
  // Significant bits of spread x axis, of a step and of a position on the axis: with N a power of
  // two, the 12 lowest of 16 fraction bits are zero.
  const std::uint32_t step = z.step + (any ? 16 : 4), walk = step + 4;
  const auto additions = [&](std::int32_t spread) {  // of a multiplication by it
    return std::max(signed_digits(static_cast<std::uint32_t>(spread)), 1U) - 1;
  };
  const std::uint32_t box = additions(p.spread),
                      tent = by_axis ? additions(tent_spread(p.spread)) : 0;
  // With `spread = 0` there is no step: every sample is in the middle.
  const std::uint32_t moves = p.spread != 0 ? 1 : 0;
  const std::uint32_t walking = fragment + moves * (2 * step + 2 * walk) + 4 + 1;
  Datasheet sheet = {
      .unit = "SampleWalker",
      .variant = chosen("count", spec::texture::kCountNames, p.count) + ", " + chosen_axes(p) +
                 (by_axis ? ", `kernel = axis`" : "") + (wide ? ", " + chosen("width", w) : ""),
      .does = "Walks N samples along the major axis and emits the bilinear requests of each.",
      .latency = any ? Cycles{4, "4 to the first request"} : Cycles{3, "3 to the first request"},
      .interval = {1,
                   "one request per cycle: N x (1 or 2) cycles per fragment (1 for an invalid "
                   "descriptor); `width` = W: W requests, of at most two groups of fragments"},
      .stages = {{.clock = "1",
                  .work = any ? "spread times axis, 1/N from ROM" : "spread times axis",
                  .registers = f * (fragment + moves * 2 * z.step)}},
      .formats =
          "axis S9.24, spread U2.6, 1/N U1.16, step S10.46, offset rounded to S9.24, position "
          "exact in S9.24 (S10.24 with `kernel = axis` and a longer tent).",
      .cost = "`spread` is a constant."};
  auto& stages = sheet.stages;
  for (const std::uint32_t constant : {box, tent})
    if (constant != 0)
      stages[0].operators.push_back(2 * f * op::multiply_constant(z.axis, constant));
  if (std::max(box, tent) != 0)
    stages[0].longest = {op::multiply_constant(z.axis, std::max(box, tent))};
  if (by_axis) {
    stages[0].work += ", kernel";
    stages[0].operators.insert(stages[0].operators.end(),
                               {moves * 2 * f * op::mux(z.step, 2), f * op::compare(4)});
    stages[0].longest.push_back(moves * op::mux(z.step, 2));
  }
  if (any) {
    stages[0].longest.push_back(op::rom_read(17, 16));
    stages.push_back({.clock = "2",
                      .work = "times 1/N",
                      .operators = {moves * 2 * f * op::multiply(z.step, 17)},
                      .longest = {moves * op::multiply(z.step, 17)},
                      .registers = f * (fragment + moves * 2 * step)});
    stages.push_back({.clock = "3",
                      .work = "offset of the first sample",
                      .operators = {moves * 2 * f * op::multiply(step, 4)},
                      .longest = {moves * op::multiply(step, 4)},
                      .registers = walks * walking});
  } else {
    stages.push_back(
        {.clock = "2",
         .work = "shift by lb N, offset of the first sample",
         .operators = {moves * 2 * f * op::mux(step, 5), moves * 2 * f * op::subtract(walk)},
         .longest = {moves * op::mux(step, 5), moves * op::subtract(walk)},
         .registers = walks * walking});
  }
  // A request rounds its position and adds it. Its walk moves on, or the next fragment comes.
  Stage request = {.clock = any ? "4" : "3",
                   .work = wide ? std::to_string(w) + " bilinear requests per cycle"
                                : "one bilinear request per cycle",
                   .operators = {moves * 4 * w * op::add(z.position), 2 * w * op::add(4),
                                 w * op::equal(4), w * op::subtract(9), w * op::mux(9, 2)},
                   .longest = {moves != 0 ? 2 * op::add(z.position) : op::add(4)}};
  auto& operators = request.operators;
  if (wide) {
    // The requests left of each fragment, and before it; the fragment of each request.
    const auto levels = static_cast<std::uint32_t>(std::bit_width(walks - 1));
    operators.insert(
        operators.end(),
        {walks * op::add(6), walks / 2 * levels * op::add(3), w * walks * op::compare(3),
         w * op::mux(fragment + 4 + 1, walks), 2 * w * op::mux(step, walks),
         2 * (w + 1) * op::mux(walk, walks), 2 * (w - 1) * op::add(step), 2 * w * op::mux(step, w),
         2 * w * op::add(walk), 2 * walks * op::mux(walk, 2)});
    request.longest = {op::add(6),           levels * op::add(3), op::compare(3),
                       op::mux(walk, walks), op::add(walk),       2 * op::add(z.position)};
  } else {
    operators.insert(operators.end(), {moves * 2 * op::add(walk), moves * 2 * op::mux(walk, 2)});
  }
  if (by_level && moves != 0) operators.push_back(op::logic(2 * 2 * walks * walk));  // negated
  stages.push_back(request);
  return sheet;
}

template class SampleWalkerOf<Narrow>;
template class SampleWalkerOf<Wide>;

}  // namespace deburr::rtl::texture
