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

SampleWalker::SampleWalker(const sc_core::sc_module_name& name, ClockDomain& clock,
                           spec::texture::CountRule count, spec::texture::Kernel kernel,
                           std::int32_t spread, spec::texture::Blend blend)
    : Unit(name, clock),
      spread_(spread),
      narrow_spread_(kernel == spec::texture::Kernel::kTent ? std::min(spread, kWholeAxis)
                                                            : spread),
      by_level_(blend == spec::texture::Blend::kLevel) {
  if (count != spec::texture::CountRule::kAny) return;
  constexpr std::size_t kLargestCount = spec::texture::kReciprocal.size() - 1;
  reciprocal_ =
      std::make_unique<Memory<std::uint32_t>>("reciprocal",
                                              MemoryShape{.words = kLargestCount,
                                                          .word_bits = kReciprocalBits + 1,
                                                          .kind = MemoryKind::kRom,
                                                          .read_ports = 1,
                                                          .write_ports = 0,
                                                          .latency = 1,
                                                          .content = "1/N for N from 1 to 16"},
                                              std::span(spec::texture::kReciprocal).subspan<1>());
  read_.emplace(*reciprocal_, "walker");
}

// Last stage first: each stage reads what its predecessor wrote in the previous cycle.
Activity SampleWalker::tick(Cycle cycle) {
  const bool arrives = levels_in.can_pop(cycle);
  if (!walking_ && !scaled_.occupied && !divided_.occupied && !arrives) return kIdle;
  const bool stalled = walking_ && !samples_out.can_push(cycle);
  if (walking_ && !stalled) emit(cycle);
  Prepared& next = reciprocal_ ? divided_ : scaled_;
  if (next.occupied && !walking_) start(next);
  if (reciprocal_ && scaled_.occupied && !divided_.occupied) divide(cycle);
  if (arrives && !scaled_.occupied) scale(cycle, levels_in.take(cycle));
  return stalled ? kStalledDownstream : kBusy;
}

// Stage 1.
void SampleWalker::scale(Cycle cycle, const LevelToken& fragment) {
  const std::int32_t spread = fragment.last_index < kLastOfFour ? narrow_spread_ : spread_;
  scaled_.occupied = true;
  scaled_.fragment = fragment;
  scaled_.step_s = fragment.axis_s * spread;
  scaled_.step_t = fragment.axis_t * spread;
  if (read_) read_->read(cycle, fragment.last_index);
}

// Stage 2 with `any`.
void SampleWalker::divide(Cycle cycle) {
  const std::int64_t reciprocal = read_->at(cycle, scaled_.fragment.last_index);
  divided_.occupied = true;
  divided_.fragment = scaled_.fragment;
  divided_.step_s = scaled_.step_s * reciprocal;
  divided_.step_t = scaled_.step_t * reciprocal;
  scaled_.occupied = false;
}

// Last stage but one.
void SampleWalker::start(Prepared& next) {
  next.occupied = false;
  fragment_ = next.fragment;
  walking_ = true;
  second_level_ = false;
  index_ = 0;
  // If N is a power of two, N - 1 has lb N ones.
  const int up = reciprocal_ ? 0 : kReciprocalBits - std::bit_width(unsigned{fragment_.last_index});
  step_s_ = next.step_s << up;
  step_t_ = next.step_t << up;
  walk_s_ = -(step_s_ * fragment_.last_index);  // (1 - N) x spread x axis / N
  walk_t_ = -(step_t_ * fragment_.last_index);
}

// Last stage.
void SampleWalker::emit(Cycle cycle) {
  const bool last_level = second_level_ || fragment_.fraction == 0,
             last_sample = index_ == fragment_.last_index, last = last_level && last_sample;

  SampleToken& out = samples_out.emplace(cycle);
  out.ticket = fragment_.ticket;
  out.s = fragment_.s + ((walk_s_ + kHalf) >> kRoundedBits);
  out.t = fragment_.t + ((walk_t_ + kHalf) >> kRoundedBits);
  out.level_weight =
      static_cast<std::uint16_t>(second_level_ ? fragment_.fraction : 256 - fragment_.fraction);
  out.index = index_;
  out.last_index = fragment_.last_index;
  out.level = static_cast<std::uint8_t>(fragment_.level + (second_level_ ? 1 : 0));
  out.linear = fragment_.linear;
  out.last_of_sample = by_level_ ? last_sample : last_level;
  out.last_of_fragment = last;

  walking_ = !last;
  if (last_level) ++samples;
  if (!by_level_) {
    second_level_ = !last_level;
    if (second_level_) return;
  } else if (last_sample) {
    second_level_ = true;
    index_ = 0;
    walk_s_ = -walk_s_;
    walk_t_ = -walk_t_;
    return;
  }
  ++index_;
  walk_s_ += step_s_ << 1;
  walk_t_ += step_t_ << 1;
}

Datasheet SampleWalker::datasheet(const spec::texture::Parameters& p) {
  const Stage request = {"", "one bilinear request per cycle",
                         "57-bit rounding addition, then a 34-bit addition"};
  Datasheet sheet = {
      .unit = "SampleWalker",
      .does = "Walks N samples along the major axis and emits the bilinear requests of each.",
      .interval = {1,
                   "one request per cycle: N x (1 or 2) cycles per fragment (1 for an invalid "
                   "descriptor)"},
      .formats =
          "axis S9.24, spread U2.6, 1/N U1.16, step S10.46, offset rounded to S9.24, position "
          "exact in S9.24.",
      .cost =
          "two 34 x 8 multipliers, two shifters and two subtractors (`any`: two 41 x 17 and two "
          "57 x 4 multipliers, and ROM `reciprocal`, 16 x 17 bits), two 61-bit accumulators, four "
          "adders, registers for three fragments (`any`: four)."};
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

}  // namespace deburr::rtl::texture
