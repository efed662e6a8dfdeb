// SPDX-License-Identifier: MIT
#include "rtl_model/texture/sample_walker.h"

#include <algorithm>

namespace deburr::rtl::texture {

SampleWalker::SampleWalker(const sc_core::sc_module_name& name, ClockDomain& clock,
                           spec::texture::Kernel kernel, std::int32_t spread)
    : Unit(name, clock), kernel_(kernel), spread_(spread) {}

// From the last stage to the first: each takes what its predecessor left in the clock before.
Activity SampleWalker::tick(Cycle cycle) {
  const bool arrives = levels_in.can_pop(cycle);
  if (!walking_ && !scaled_.occupied && !arrives) return kIdle;
  const bool stalled = walking_ && !samples_out.can_push(cycle);
  if (walking_ && !stalled) emit(cycle);
  if (scaled_.occupied && !walking_) start();
  if (arrives && !scaled_.occupied) {
    scale(levels_in.front(cycle));
    levels_in.pop(cycle);
  }
  return stalled ? kStalledDownstream : kBusy;
}

// Stage 1.
void SampleWalker::scale(const LevelToken& fragment) {
  scaled_.occupied = true;
  scaled_.fragment = fragment;
  scaled_.step_s = fragment.axis_s * spread_;
  scaled_.step_t = fragment.axis_t * spread_;
}

// Stage 2.
void SampleWalker::start() {
  scaled_.occupied = false;
  fragment_ = scaled_.fragment;
  walking_ = true;
  second_level_ = false;
  index_ = 0;
  step_s_ = scaled_.step_s;
  step_t_ = scaled_.step_t;
  walk_s_ = step_s_ - (step_s_ << fragment_.count_log2);  // (1 - N) x spread x axis
  walk_t_ = step_t_ - (step_t_ << fragment_.count_log2);
}

// Weights of the tent: 1, 3, 5, ... and back.
unsigned SampleWalker::kernel_weight() const {
  if (!fragment_.ticket.valid) return 0;
  if (kernel_ == spec::texture::Kernel::kBox) return 1;
  const unsigned mirrored = (1u << fragment_.count_log2) - 1 - index_;
  return 2 * std::min(index_, mirrored) + 1;
}

// Stage 3.
void SampleWalker::emit(Cycle cycle) {
  const unsigned n = fragment_.count_log2;
  const unsigned drop = 7 + n;
  const std::int64_t half = std::int64_t{1} << (drop - 1);
  const bool blends = fragment_.fraction != 0;
  const bool last_of_sample = second_level_ || !blends;
  const bool last = last_of_sample && (index_ + 1) >> n != 0;

  SampleToken& out = samples_out.emplace(cycle);
  out.ticket = fragment_.ticket;
  out.s = fragment_.s + ((walk_s_ + half) >> drop);
  out.t = fragment_.t + ((walk_t_ + half) >> drop);
  out.level_weight =
      static_cast<std::uint16_t>(second_level_ ? fragment_.fraction : 256 - fragment_.fraction);
  out.kernel_weight = static_cast<std::uint8_t>(kernel_weight());
  out.sum_log2 =
      static_cast<std::uint8_t>(kernel_ == spec::texture::Kernel::kBox || n == 0 ? n : 2 * n - 1);
  out.level = static_cast<std::uint8_t>(fragment_.level + (second_level_ ? 1 : 0));
  out.linear = fragment_.linear;
  out.last_of_sample = last_of_sample;
  out.last_of_fragment = last;

  second_level_ = !last_of_sample;
  if (!last_of_sample) return;
  ++samples;
  ++index_;
  walk_s_ += step_s_ << 1;
  walk_t_ += step_t_ << 1;
  walking_ = !last;
}

}  // namespace deburr::rtl::texture
