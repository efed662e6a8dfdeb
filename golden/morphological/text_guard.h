// SPDX-License-Identifier: MIT
// Which pixels the text guard leaves as they are, and which situations of this the frames so far
// contained.
//
// docs/reference/morphological/algorithm.md, "Text guard". A set of colours is a word of 64 bits,
// one for each hash, so that the colours of a window are an OR. Bins, of all pixels of frames with
// the guard:
//   text/guarded                 all conditions hold
//   text/one-colour              the window has one colour
//   text/more-colours            the window has three or more, and all else holds
//   text/few-in-rows             all holds but the number of strokes in rows
//   text/few-in-columns          all holds but the number of strokes in columns
//   text/few                     all holds but the sum of both
//   text/just/<which>            guarded with the least number in rows, in columns, of both; not
//                                guarded for one fewer
//   text/kept/<which>            guarded with a weight: by the guard alone, by `leave` as well
//   text-border/<border>         guarded on the frame's border
// Every bin can be reached (tb/unit/golden/morphological/text_guard_test.cpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "golden/morphological/planes.h"
#include "golden/morphological/run_coverage.h"
#include "spec/morphological/packets.h"

namespace deburr::golden::morphological {

// Six bits.
int colour_hash(const spec::morphological::Rgba8& pixel);

inline constexpr int kGuardSearchRange = 5;  // pixels from the middle of a window to its sides
inline constexpr int kMostStroke = 3;        // pixels
inline constexpr int kLeastStrokes = 3;      // pixels of a window in strokes, each way
inline constexpr int kLeastOfBoth = 24;      // the sum of both ways

// What decides about a pixel, of its window.
struct GuardedPixel {
  std::uint8_t colours = 0;
  std::uint8_t row_strokes = 0;     // h
  std::uint8_t column_strokes = 0;  // v
  int of_both() const { return row_strokes + column_strokes; }
  bool two_colours() const { return colours == 2; }
  bool enough_in_rows() const { return row_strokes >= kLeastStrokes; }
  bool enough_in_columns() const { return column_strokes >= kLeastStrokes; }
  bool enough() const { return of_both() >= kLeastOfBoth; }
  bool guarded() const {
    return two_colours() && enough_in_rows() && enough_in_columns() && enough();
  }
  friend bool operator==(const GuardedPixel&, const GuardedPixel&) = default;
};

class TextGuard {
 public:
  TextGuard() = default;  // of no frame
  explicit TextGuard(const ImageView& image);
  const GuardedPixel& at(int x, int y) const { return pixels_.at(x, y); }

 private:
  PlaneOf<GuardedPixel> pixels_;
};

class GuardCoverage {
 public:
  void count_frame(const TextGuard& guard, int width, int height);
  // A guarded pixel that has a weight; `left`: `leave` leaves it, too.
  void count_kept(bool left) { ++kept_[left ? 1 : 0]; }
  // Every bin, hit or not, always in the same order.
  std::vector<CoverageBin> bins() const;

 private:
  void count_pixel(const GuardedPixel& pixel);
  std::array<std::uint64_t, 6> causes_{};
  std::array<std::uint64_t, 6> just_{};
  std::array<std::uint64_t, 2> kept_{};
  std::array<std::uint64_t, 4> borders_{};
};

}  // namespace deburr::golden::morphological
