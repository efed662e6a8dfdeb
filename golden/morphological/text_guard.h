// SPDX-License-Identifier: MIT
// Which pixels the text guard leaves as they are, and which situations of this the frames so far
// contained.
//
// docs/reference/morphological/text_guard.md. A set of colours is a word of 64 bits, one for each
// hash, so that the colours of a window are an OR. Bins, of all pixels of frames with the guard:
//   text/guarded                 all conditions hold
//   text/one-colour              the window has one colour
//   text/more-colours            the window has three or more, and all else holds
//   text/wide                    all holds but that the pixel itself is in a stroke
//   text/few-in-rows             all holds but the number of strokes in rows
//   text/few-in-columns          all holds but the number of strokes in columns
//   text/stroke/<which>          guarded: in a stroke of its row, of its column, of both
//   text/just/<which>            guarded with 12 in rows, in columns; not guarded for one fewer
//   text/kept/<which>            guarded with a share: by the guard alone, by `leave` as well
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

inline constexpr int kGuardReach = 5;     // pixels from the middle of a window to its sides
inline constexpr int kMostStroke = 3;     // pixels
inline constexpr int kLeastStrokes = 12;  // pixels of a window in strokes, each way

// What decides about a pixel.
struct GuardedPixel {
  std::uint8_t colours = 0;         // of its window
  bool in_row_stroke = false;       // H
  bool in_column_stroke = false;    // V
  std::uint8_t row_strokes = 0;     // pixels of its window with H
  std::uint8_t column_strokes = 0;  // with V
  bool two_colours() const { return colours == 2; }
  bool in_stroke() const { return in_row_stroke || in_column_stroke; }
  bool enough_in_rows() const { return row_strokes >= kLeastStrokes; }
  bool enough_in_columns() const { return column_strokes >= kLeastStrokes; }
  bool guarded() const {
    return two_colours() && in_stroke() && enough_in_rows() && enough_in_columns();
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
  // A guarded pixel that has a share; `left`: `leave` leaves it, too.
  void count_kept(bool left) { ++kept_[left ? 1 : 0]; }
  // Every bin, hit or not, always in the same order.
  std::vector<CoverageBin> bins() const;

 private:
  void count_pixel(const GuardedPixel& pixel);
  std::array<std::uint64_t, 6> causes_{};
  std::array<std::uint64_t, 3> strokes_{};
  std::array<std::uint64_t, 4> just_{};
  std::array<std::uint64_t, 2> kept_{};
  std::array<std::uint64_t, 4> borders_{};
};

}  // namespace deburr::golden::morphological
