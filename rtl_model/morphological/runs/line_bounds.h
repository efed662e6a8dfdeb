// SPDX-License-Identifier: MIT
// Tests whether one line can have produced all corners: rule `safe`, applied to every corner to be
// added at either end.
//
// Position  One in each Predictor.
// Method    All steps of a safe descriptor are L or one other value L', so corner i lies at L i
//           plus one pixel for each L' before it: only the sequence of letters L and L' matters.
//           Corners are consistent (docs/reference/morphological/algorithm.md) if and only if the
//           letters form a digital straight line, described by its slope a / b and the corners that
//           touch it. For corner i with y letters L' before it, the remainder a i - b y lies in a
//           band of b values. A new corner fits if its remainder is in the band (the line stays) or
//           adjacent to it (the line turns about the corner that it touches first). Two new corners
//           that each fit also fit together, unless both turn the line and lie on the same side: a
//           bend. A test compares this with the quadratic definition.
// Latency   Trial every four cycles. Cycle `bounds`: right(), left(), together(), each a 7-bit
//           adder and two 7-bit comparators; in parallel the new a and b for the right corner. Next
//           cycle: the remainders, two 6 x 6 products. Then the same for the left corner, in time
//           for the next trial.
// Cost      8 x 12 flip-flops for corners, 4 x 6 for slope and remainders; two 6 x 6 multipliers,
//           eight 7-bit adders.
// Path      Made for 250 MHz; longest: 6 x 6 multiply, 12-bit add. With trial_cycles below 4 two or
//           more steps share a cycle.
// Source    Debled-Rennesson and Reveilles, "A linear algorithm for segmentation of digital curves"
//           (1995), extended to growth at both ends.
#pragma once

#include <cstdint>

namespace deburr::rtl::morphological {

class LineBounds {
 public:
  // Effect of a new corner on the line.
  enum class Fit : std::uint8_t { kStays, kTurnsUp, kTurnsDown, kNone };

  // Starts with the run itself: corners 0 and 1, one step L apart.
  void begin() { *this = {}; }

  // Fit of one corner a step L or L' after the last (before the first) corner.
  Fit right(bool other) const { return fit(back_ + slope_over_ - (other ? slope_under_ : 0)); }
  Fit left(bool other) const { return fit(front_ - slope_over_ + (other ? slope_under_ : 0)); }
  // Do both fit together, given that each fits?
  static bool together(Fit right, Fit left) { return right == Fit::kStays || right != left; }

  // Adds a corner that fits. Call add_right() before add_left() in a trial with both.
  void add_right(bool other) {
    const Fit how = right(other);
    const Corner corner{last_.index + 1, last_.others + (other ? 1 : 0)};
    last_ = corner;
    switch (how) {
      case Fit::kStays:
        back_ += slope_over_ - (other ? slope_under_ : 0);
        if (back_ == 0) above_last_ = corner;
        if (back_ == slope_under_ - 1) below_last_ = corner;
        return;
      case Fit::kTurnsUp:
        turn(above_first_, corner);
        above_last_ = corner;
        below_first_ = below_last_;
        back_ = 0;
        break;
      default:
        turn(below_first_, corner);
        below_last_ = corner;
        above_first_ = above_last_;
        back_ = slope_under_ - 1;
    }
    front_ = back_ - across();
  }
  void add_left(bool other) {
    const Fit how = left(other);
    const Corner corner{first_.index - 1, first_.others - (other ? 1 : 0)};
    first_ = corner;
    switch (how) {
      case Fit::kStays:
        front_ += (other ? slope_under_ : 0) - slope_over_;
        if (front_ == 0) above_first_ = corner;
        if (front_ == slope_under_ - 1) below_first_ = corner;
        return;
      case Fit::kTurnsUp:
        turn(corner, above_last_);
        above_first_ = corner;
        below_last_ = below_first_;
        front_ = 0;
        break;
      default:
        turn(corner, below_last_);
        below_first_ = corner;
        above_last_ = above_first_;
        front_ = slope_under_ - 1;
    }
    back_ = front_ + across();
  }

 private:
  struct Corner {
    std::int32_t index = 0;   // S6, -16..17
    std::int32_t others = 0;  // S6, steps L' counted from corner 0
  };
  // The band of remainders is 0 .. b - 1; corners that touch the line from above have remainder 0.
  Fit fit(std::int32_t remainder) const {
    if (remainder == -1) return Fit::kTurnsUp;
    if (remainder == slope_under_) return Fit::kTurnsDown;
    return remainder >= 0 && remainder < slope_under_ ? Fit::kStays : Fit::kNone;
  }
  void turn(const Corner& from, const Corner& to) {
    slope_over_ = to.others - from.others;
    slope_under_ = to.index - from.index;
  }
  // Remainder of the last corner minus that of the first.
  std::int32_t across() const {
    return slope_over_ * (last_.index - first_.index) -
           slope_under_ * (last_.others - first_.others);
  }

  std::int32_t slope_over_ = 0, slope_under_ = 1;  // a / b: U6, steps L' per step
  std::int32_t front_ = 0, back_ = 0;              // U6, remainders of the first and last corner
  Corner first_{0, 0}, last_{1, 0};
  // Outermost corners on either border of the band. above_last_ and below_first_ are read only
  // after the line has turned.
  Corner above_first_{0, 0}, above_last_, below_first_, below_last_{1, 0};
};

}  // namespace deburr::rtl::morphological
