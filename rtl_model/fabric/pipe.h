// SPDX-License-Identifier: MIT
// Function  Pipeline registers between the stages of a unit, which advance together: while the
//           oldest beat cannot leave, none moves. A beat that enters stage 1 is in stage k after
//           k-1 moves, including bubbles.
// Cost      kStages - 1 registers of a beat, each with a valid bit. Longest path: a valid bit and
//           the output link's ready, one gate, then the enable of all registers.
//
//   if (pipe_.empty() && !in.can_pop(cycle)) return kIdle;
//   if (pipe_.leaves() && !out.can_push(cycle)) return kStalledDownstream;
//   pipe_.move();
//   if (Beat* beat = pipe_.at(3)) out.push(cycle, beat->result);  // the last of three stages
//   if (Beat* beat = pipe_.at(2)) work(*beat);
//   if (in.can_pop(cycle)) pipe_.enter() = in.take(cycle);        // the first
//
// The model does not copy beats: they stay in place and their stage number changes. A unit may
// compute a beat in one cycle and only delay it in the others where this is unobservable; its
// header says what the hardware does in each stage.
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
  // No beat is in stages 1 to kStages - 1; the beat of the last stage has left.
  bool empty() const { return (full_ & (kLast - 1)) == 0; }
  // No bubble in these stages.
  bool full() const { return (full_ & (kLast - 1)) == kLast - 1; }
  // The next move brings a beat into the last stage.
  bool leaves() const { return full_ & kLast >> 1; }
  // Advances every beat by one stage; the beat of the last stage has left.
  void move() {
    ++newest_;
    full_ = (full_ & (kLast - 1)) << 1;
  }
  // The beat that enters the first stage in this cycle; it initially holds old data.
  Beat& enter() {
    full_ |= 1;
    return beats_[newest_ % kPlaces];
  }
  // The beat in this stage, 1..kStages; nullptr for a bubble.
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
