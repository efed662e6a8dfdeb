// SPDX-License-Identifier: MIT
#include "rtl_model/texture/sample_walker.h"

#include <algorithm>
#include <bit>
#include <span>

#include "spec/texture/tables.h"

namespace deburr::rtl::texture {
namespace {

constexpr int kReciprocalBits = 16;  // fraction bits
constexpr int kRoundedBits = 23;     // from half an axis, S10.46, to a coordinate, S9.24
constexpr std::int64_t kHalf = std::int64_t{1} << (kRoundedBits - 1);
constexpr std::uint8_t kLastOfFour = 3;
constexpr std::int32_t kWholeAxis = 64;  // U2.6

}  // namespace

template <class Width>
SampleWalkerOf<Width>::SampleWalkerOf(const sc_core::sc_module_name& name, ClockDomain& clock,
                                      spec::texture::CountRule count, spec::texture::Kernel kernel,
                                      std::int32_t spread, spec::texture::Blend blend,
                                      const spec::texture::Build& build)
    : SampleWalkerBase(name, clock),
      spread_(spread),
      narrow_spread_(kernel == spec::texture::Kernel::kTent ? std::min(spread, kWholeAxis)
                                                            : spread),
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
    const std::int32_t spread = fragment.last_index < kLastOfFour ? narrow_spread_ : spread_;
    scaled.fragment = fragment;
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
  out.last_index = fragment.last_index;
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
  const Stage request = {"", "one bilinear request per cycle",
                         "57-bit rounding addition, then a 34-bit addition"};
  Datasheet sheet = {
      .unit = "SampleWalker",
      .does = "Walks N samples along the major axis and emits the bilinear requests of each.",
      .interval = {1,
                   "one request per cycle: N x (1 or 2) cycles per fragment (1 for an invalid "
                   "descriptor); `width` = W: W requests, of at most two groups of fragments"},
      .formats =
          "axis S9.24, spread U2.6, 1/N U1.16, step S10.46, offset rounded to S9.24, position "
          "exact in S9.24.",
      .cost =
          "two 34 x 8 multipliers, two shifters and two subtractors (`any`: two 41 x 17 and two "
          "57 x 4 multipliers, and ROM `reciprocal`, 16 x 17 bits), two 61-bit accumulators, four "
          "adders, registers for three fragments (`any`: four); `width` = W, `fragments` = F: "
          "registers for four groups of F fragments (`any`: five), F copies of multipliers, "
          "shifters, subtractors and accumulators, the ROM F R, W copies of the adders of a "
          "request, and adders of up to 2 W multiples of a step."};
  if (p.count == spec::texture::CountRule::kAny) {
    sheet.variant = "`count = any`";
    sheet.latency = {4, "4 to the first request"};
    sheet.stages = {
        {"1", "spread times axis, 1/N from ROM", "34 x 8 multiply"},
        {"2", "times 1/N", "41 x 17 multiply (17 rows of partial products; 24 x 24 has 24)"},
        {"3", "offset of the first sample", "57 x 4 multiply: 1.18 x the 24 x 24 multiply"},
        {"4", request.work, request.path}};
  } else {
    sheet.variant = "other `count`";
    sheet.latency = {3, "3 to the first request"};
    sheet.stages = {{"1", "spread times axis", "34 x 8 multiply"},
                    {"2", "shift by lb N, offset of the first sample",
                     "5 : 1 mux of shifts, then a 57-bit subtraction"},
                    {"3", request.work, request.path}};
  }
  return sheet;
}

template class SampleWalkerOf<Narrow>;
template class SampleWalkerOf<Wide>;

}  // namespace deburr::rtl::texture
