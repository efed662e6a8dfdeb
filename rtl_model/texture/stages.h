// SPDX-License-Identifier: MIT
// The registers of a unit that works in several stages, one clock each, and holds still as a whole
// when its last stage cannot leave.
//
// Latency kStages: stages 1..kStages - 1 end in registers, the last one in the output link. An
// entry stays where it is and is renamed from clock to clock, so that nothing is copied.
//
//   if (stages_.empty() && !arrives) return kIdle;
//   if (stages_.leaving() && !out.can_push(cycle)) return kStalledDownstream;
//   stages_.step();
//   if (stages_.works(3)) deliver(stages_.leave(), out.emplace(cycle));
//   if (stages_.works(2)) multiply(stages_.at(2));
//   if (arrives) start(stages_.enter(), in.take(cycle));
//
// A unit may work an entry out in one clock and only delay it in the others, where nobody outside
// can tell; its header says what hardware does in each stage.
//
// Made for the clock of its unit; longest path: a valid bit and the output link's ready, one gate,
// then the enable of all registers. Cost: kStages - 1 sets of registers with a valid bit.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace deburr::rtl::texture {

template <class Entry, int kStages>
class Stages {
  static_assert(kStages >= 2 && kStages <= 31);

 public:
  bool empty() const { return occupied_ == 0; }
  bool full() const { return occupied_ == (1U << (kStages - 1)) - 1; }
  // Something is in the last set of registers and leaves with the next step.
  bool leaving() const { return occupied_ >> (kStages - 2) & 1; }

  // One clock: what stage k worked on is now before stage k + 1.
  void step() {
    head_ = (head_ - 1) & kMask;
    occupied_ <<= 1;
  }
  // --- After step() ---
  bool works(int stage) const { return occupied_ >> (stage - 1) & 1; }
  Entry& at(int stage) { return entries_[(head_ + static_cast<unsigned>(stage - 1)) & kMask]; }
  Entry& enter() {
    occupied_ |= 1;
    return at(1);
  }
  Entry& leave() {
    occupied_ &= ~(1U << (kStages - 1));
    return at(kStages);
  }
  void reset() { occupied_ = 0; }

 private:
  static constexpr unsigned kMask = std::bit_ceil(unsigned{kStages}) - 1;
  std::array<Entry, kMask + 1> entries_{};
  unsigned head_ = 0;
  std::uint32_t occupied_ = 0;  // bit k: the registers after stage k + 1 hold an entry
};

}  // namespace deburr::rtl::texture
