// SPDX-License-Identifier: MIT
// Can one line have produced these corners? The rule `safe` asks it of every corner that is to be
// added, at either end.
//
// Where: one in each Predictor. All steps of a safe record are L or the one L', so corner i lies at
// L i, and one pixel further for each L' before it: only the letters count, L or L'. Corners are
// consistent (docs/reference/morphological/algorithm.md) if and only if the letters are those of a
// digital straight line, and that is known from its slope a / b and from where the corners touch
// it: Debled-Rennesson and Reveilles, "A linear algorithm for segmentation of digital curves"
// (1995), for growth at both ends. With i the number of a corner and y the letters L' up to it, the
// remainder a i - b y lies in a band of b values. A new corner fits if its remainder is in the band
// (the line stays) or beside it (the line turns about the corner that it touches first). Two new
// corners that fit alone fit together, unless both turn it and lie on the same side: a bend. The
// quadratic definition says the same in every case (test).
//
// Schedule, of a trial every four cycles: in the clock `bounds` right(), left() and together(),
// each an adder and two comparators of 7 bits; beside them the new a and b of the right corner. In
// the next clock the remainders, two products of 6 x 6 bits; then the same for the left corner. The
// state is there for the next trial's `bounds`.
// Cost: 8 x 12 flip-flops of corners, 4 x 6 of slope and remainders; 2 products of 6 x 6 bits, 8
// adders of 7. (By the definition: 34 products of 13 x 6 bits and a running maximum and minimum
// over them, a corner.) Made for 250 MHz; longest path: 6 x 6 multiply, 12-bit add; with
// trial_cycles below 4 two and more of these steps weight a clock.
#pragma once

#include <cstdint>

namespace deburr::rtl::morphological {

class LineBounds {
 public:
  // What the line does for a new corner.
  enum class Fit : std::uint8_t { kStays, kTurnsUp, kTurnsDown, kNone };

  // The run itself: corners 0 and 1, a step L between them.
  void begin() { *this = {}; }

  // The corner behind the last (before the first) one, a step L or L' away, alone.
  Fit right(bool other) const { return fit(back_ + slope_over_ - (other ? slope_under_ : 0)); }
  Fit left(bool other) const { return fit(front_ - slope_over_ + (other ? slope_under_ : 0)); }
  // Both, each of which fits alone.
  static bool together(Fit right, Fit left) { return right == Fit::kStays || right != left; }

  // Takes a corner that fits. Both of a trial: the right one first.
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
    std::int32_t others = 0;  // S6, steps L' from corner 0 on
  };
  // The band of remainders is 0..b - 1, counted from the corners that touch the line from above.
  Fit fit(std::int32_t remainder) const {
    if (remainder == -1) return Fit::kTurnsUp;
    if (remainder == slope_under_) return Fit::kTurnsDown;
    return remainder >= 0 && remainder < slope_under_ ? Fit::kStays : Fit::kNone;
  }
  void turn(const Corner& from, const Corner& to) {
    slope_over_ = to.others - from.others;
    slope_under_ = to.index - from.index;
  }
  // From the first corner's remainder to the last one's.
  std::int32_t across() const {
    return slope_over_ * (last_.index - first_.index) -
           slope_under_ * (last_.others - first_.others);
  }

  std::int32_t slope_over_ = 0, slope_under_ = 1;  // a / b: U6, steps L' of all steps
  std::int32_t front_ = 0, back_ = 0;              // U6, remainders of the first and last corner
  Corner first_{0, 0}, last_{1, 0};
  // The outermost corners on either border of the band.
  // The line has turned before above_last_ or below_first_ is looked at.
  Corner above_first_{0, 0}, above_last_, below_first_, below_last_{1, 0};
};

}  // namespace deburr::rtl::morphological
