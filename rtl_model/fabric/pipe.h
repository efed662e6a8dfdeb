// SPDX-License-Identifier: MIT
// The registers between the stages of a unit, which move together: while the oldest beat cannot
// leave, none moves. A beat that enters in stage 1 is in stage k k - 1 moves later, bubbles
// included.
//
//   if (pipe_.empty() && !in.can_pop(cycle)) return kIdle;
//   if (pipe_.leaves() && !out.can_push(cycle)) return kStalledDownstream;
//   pipe_.move();
//   if (Beat* beat = pipe_.at(3)) out.push(cycle, beat->result);  // the last of three stages
//   if (Beat* beat = pipe_.at(2)) work(*beat);
//   if (in.can_pop(cycle)) pipe_.enter() = in.take(cycle);        // the first
//
// A beat stays where it is and is renamed from clock to clock, so that nothing is copied. A unit
// may work a beat out in one clock and only delay it in the others, where nobody outside can tell;
// its header says what hardware does in each stage.
//
// Made for the clock of its unit; longest path: a valid bit and the output link's ready, one gate,
// then the enable of all registers. Cost: kStages - 1 registers of a beat, each with a valid bit.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace deburr::rtl {

template <class Beat, std::size_t kStages>
class Pipe {
  static_assert(kStages >= 2 && kStages <= 31);

 public:
  // Nothing is on its way; what was in the last stage has left.
  bool empty() const { return (full_ & (kLast - 1)) == 0; }
  // No bubble between the stages.
  bool full() const { return (full_ & (kLast - 1)) == kLast - 1; }
  // The next move brings a beat into the last stage.
  bool leaves() const { return full_ & kLast >> 1; }
  // Every beat a stage on; that of the last stage has left.
  void move() {
    ++newest_;
    full_ = (full_ & (kLast - 1)) << 1;
  }
  // The beat that comes into the first stage in this clock; it holds old bits.
  Beat& enter() {
    full_ |= 1;
    return beats_[newest_ % kPlaces];
  }
  // The beat in this stage, 1..kStages; nullptr: a bubble.
  Beat* at(std::size_t stage) {
    return full_ >> (stage - 1) & 1 ? &beats_[(newest_ + 1 - stage) % kPlaces] : nullptr;
  }
  void reset() { full_ = 0; }

 private:
  static constexpr std::size_t kPlaces = std::bit_ceil(kStages);
  static constexpr std::uint32_t kLast = std::uint32_t{1} << (kStages - 1);
  std::array<Beat, kPlaces> beats_{};
  std::size_t newest_ = 0;
  std::uint32_t full_ = 0;  // bit k - 1: stage k
};

}  // namespace deburr::rtl
