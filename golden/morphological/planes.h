// SPDX-License-Identifier: MIT
// Data between the blocks of the morphological golden model: views of images, planes of values and
// bits, and the edge planes seen along either axis.
//
// Coordinates: x to the right, y downwards, top row first. A bit plane reads as 0 outside the frame
// (docs/reference/morphological/algorithm.md). Rows of bits are 64-bit words, so that runs are
// found word by word.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"

namespace deburr::golden::morphological {

// A frame that is not owned. Pixel (x, y) is pixels[y * stride + x].
template <class Pixel>
struct ViewOf {
  std::span<const Pixel> pixels;
  int width = 0, height = 0;
  std::size_t stride = 0;  // pixels per row, at least width

  ViewOf() = default;
  ViewOf(std::span<const Pixel> p, int w, int h) : ViewOf(p, w, h, static_cast<std::size_t>(w)) {}
  ViewOf(std::span<const Pixel> p, int w, int h, std::size_t s)
      : pixels(p), width(w), height(h), stride(s) {}
  bool empty() const { return pixels.empty(); }
  const Pixel* row(int y) const { return pixels.data() + static_cast<std::size_t>(y) * stride; }
  const Pixel& at(int x, int y) const { return row(y)[x]; }
};
using ImageView = ViewOf<spec::morphological::Rgba8>;
using DepthView = ViewOf<std::uint32_t>;  // U24, grows towards the eye

// One value per pixel, rows without padding.
template <class Value>
struct PlaneOf {
  int width = 0, height = 0;
  std::vector<Value> values;

  PlaneOf() = default;
  PlaneOf(int w, int h) { resize(w, h); }
  // The contents are unspecified afterwards.
  void resize(int w, int h) {
    width = w;
    height = h;
    values.resize(static_cast<std::size_t>(w) * static_cast<std::size_t>(h));
  }
  Value* row(int y) { return values.data() + static_cast<std::size_t>(y) * stride(); }
  const Value* row(int y) const { return values.data() + static_cast<std::size_t>(y) * stride(); }
  const Value& at(int x, int y) const { return row(y)[x]; }
  std::size_t stride() const { return static_cast<std::size_t>(width); }
};

class BitPlane {
 public:
  BitPlane() = default;
  BitPlane(int width, int height) { resize(width, height); }
  void resize(int width, int height);  // clears all bits

  int width() const { return width_; }
  int height() const { return height_; }
  bool at(int x, int y) const {
    if (static_cast<unsigned>(x) >= static_cast<unsigned>(width_) ||
        static_cast<unsigned>(y) >= static_cast<unsigned>(height_)) {
      return false;
    }
    return (row(y)[x >> 6] >> (x & 63) & 1) != 0;
  }
  // Border::kClamp: pixels outside the frame have the bit of the nearest pixel.
  bool at(spec::morphological::Border border, int x, int y) const {
    if (border == spec::morphological::Border::kEnd) return at(x, y);
    return at(std::clamp(x, 0, width_ - 1), std::clamp(y, 0, height_ - 1));
  }
  void set(int x, int y) { row(y)[x >> 6] |= std::uint64_t{1} << (x & 63); }

  // Bit x % 64 of word x / 64 is pixel x. At least one bit after the last pixel exists; it is 0.
  int words() const { return words_; }
  std::uint64_t* row(int y) { return bits_.data() + static_cast<std::ptrdiff_t>(y) * words_; }
  const std::uint64_t* row(int y) const {
    return bits_.data() + static_cast<std::ptrdiff_t>(y) * words_;
  }

  std::uint64_t count() const;  // bits that are 1
  BitPlane transposed() const;
  friend bool operator==(const BitPlane&, const BitPlane&) = default;

 private:
  int width_ = 0, height_ = 0, words_ = 0;
  std::vector<std::uint64_t> bits_;
};

// Packs 64 flags of 0 or 1 into bits, the first one lowest.
std::uint64_t packed_flags(const std::uint8_t* flags);

// left(x, y): edge between (x - 1, y) and (x, y). top(x, y): between (x, y - 1) and (x, y).
struct EdgePlanes {
  BitPlane left, top;
  friend bool operator==(const EdgePlanes&, const EdgePlanes&) = default;
};

// The edges of horizontal runs: `along` forms runs, `across` crosses them. Vertical runs use the
// transposed planes, where a position is a row and a line is a column.
struct AxisEdges {
  spec::morphological::Axis axis = spec::morphological::Axis::kHorizontal;
  BitPlane along, across;
  spec::morphological::Border border = spec::morphological::Border::kEnd;  // for the ends of runs

  static AxisEdges horizontal(const EdgePlanes& edges, spec::morphological::Border border =
                                                           spec::morphological::Border::kEnd) {
    return {spec::morphological::Axis::kHorizontal, edges.top, edges.left, border};
  }
  static AxisEdges vertical(const EdgePlanes& edges, spec::morphological::Border border =
                                                         spec::morphological::Border::kEnd) {
    return {spec::morphological::Axis::kVertical, edges.left.transposed(), edges.top.transposed(),
            border};
  }

  // The crossings at a lattice corner: bit 0 first side (N), bit 1 second side (S).
  int crossings(int position, int line) const {
    return (across.at(position, line - 1) ? 1 : 0) | (across.at(position, line) ? 2 : 0);
  }
  // The same at an end of a run, which may be on the border.
  int end_crossings(int position, int line) const {
    return (across.at(border, position, line - 1) ? 1 : 0) |
           (across.at(border, position, line) ? 2 : 0);
  }
  // The edges one pixel further on either side: whether the crossings continue.
  int far_crossings(int position, int line) const {
    return (across.at(border, position, line - 2) ? 1 : 0) |
           (across.at(border, position, line + 1) ? 2 : 0);
  }
  // The complete code of a corner: N, S, W, E in bits 0 to 3.
  int corner(int position, int line) const {
    return crossings(position, line) | (along.at(position - 1, line) ? 4 : 0) |
           (along.at(position, line) ? 8 : 0);
  }
};

}  // namespace deburr::golden::morphological
