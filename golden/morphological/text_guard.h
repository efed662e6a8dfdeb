// SPDX-License-Identifier: MIT
// Pixels that the text guard bypasses, and functional coverage of it.
//
// docs/reference/morphological/algorithm.md, "Text guard". A set of colours is a word of 64 bits,
// one bit per hash, so the colours of a window are combined by OR. Bins count all pixels of frames
// with the guard:
//   text/guarded              all conditions hold
//   text/one-colour           the window has one colour
//   text/more-colours         the window has three or more colours; all else holds
//   text/few-in-rows          all holds except the number of strokes in rows
//   text/few-in-columns       all holds except the number of strokes in columns
//   text/few                  all holds except the sum of both
//   text/just/<which>         guarded with the smallest number in rows, in columns, of both; or not
//                             guarded, with one fewer
//   text/kept/<which>         guarded with a weight: by the guard only, or by `bypass` as well
//   text-border/<border>      guarded on the border of the frame
// Every bin is reachable (tb/unit/golden/morphological/text_guard_test.cpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "golden/morphological/planes.h"
#include "golden/morphological/run_coverage.h"
#include "spec/morphological/packets.h"

namespace deburr::golden::morphological {

// Returns six bits.
int colour_hash(const spec::morphological::Rgba8& pixel);

inline constexpr int kGuardSearchRange = 5;  // pixels from the centre of a window to its sides
inline constexpr int kMostStroke = 3;        // pixels
inline constexpr int kLeastStrokes = 3;      // pixels of a window in strokes, per axis
inline constexpr int kLeastOfBoth = 24;      // sum of both axes

// The properties of a pixel's window that decide.
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
  TextGuard() = default;  // without a frame
  explicit TextGuard(const ImageView& image);
  const GuardedPixel& at(int x, int y) const { return pixels_.at(x, y); }

 private:
  PlaneOf<GuardedPixel> pixels_;
};

class GuardCoverage {
 public:
  void count_frame(const TextGuard& guard, int width, int height);
  // Counts a guarded pixel with a weight; `left`: `bypass` drops it as well.
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
