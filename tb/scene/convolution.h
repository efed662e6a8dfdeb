// SPDX-License-Identifier: MIT
// Convolutions along one axis, for measures of quality. They go through a picture in bands of rows,
// so that what lies between two steps stays in a cache, and planes are made once.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "tb/scene/image.h"

namespace deburr::tb {

inline constexpr int kBandRows = 48;

// A kernel by its middle and what is to the right of it: tap -k is tap k, or -tap k.
template <class T>
struct Kernel {
  std::vector<T> taps;
  bool odd = false;
  int reach() const { return static_cast<int>(taps.size()) - 1; }
};

// What it holds is undefined where it grows.
template <class T>
void resize(ImageOf<T>& plane, int width, int height) {
  plane.width = width;
  plane.height = height;
  plane.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
}

// to[x] = middle x tap 0 + sum of tap k x (right(k)[x] + left(k)[x]), or the difference.
template <class T, class Left, class Right>
void convolve(const Kernel<T>& kernel, std::size_t n, const T* middle, Left left, Right right,
              T* to) {
  for (std::size_t x = 0; x < n; ++x) to[x] = kernel.odd ? T{} : kernel.taps[0] * middle[x];
  for (int k = 1; k <= kernel.reach(); ++k) {
    const T tap = kernel.taps[static_cast<std::size_t>(k)];
    const T *const a = left(k), *const b = right(k);
    if (kernel.odd)
      for (std::size_t x = 0; x < n; ++x) to[x] += tap * (b[x] - a[x]);
    else
      for (std::size_t x = 0; x < n; ++x) to[x] += tap * (b[x] + a[x]);
  }
}

// A row goes on beyond its ends as its outermost pixels.
template <class T>
void convolve_along_rows(const ImageOf<T>& in, const Kernel<T>& kernel, ImageOf<T>& out) {
  resize(out, in.width, in.height);
  const auto width = static_cast<std::size_t>(in.width),
             reach = static_cast<std::size_t>(kernel.reach());
  std::vector<T> padded(width + 2 * reach);
  T* const row = padded.data() + reach;
  for (int y = 0; y < in.height; ++y) {
    const T* const from = &in.at(0, y);
    std::fill_n(padded.data(), reach, from[0]);
    std::copy_n(from, width, row);
    std::fill_n(row + width, reach, from[width - 1]);
    convolve(
        kernel, width, row, [&](int k) { return row - k; }, [&](int k) { return row + k; },
        &out.at(0, y));
  }
}

// The rows from..from + rows - 1 alone. The kernel must not reach beyond the rows that there are.
template <class T>
void convolve_along_columns(const ImageOf<T>& in, const Kernel<T>& kernel, int from, int rows,
                            ImageOf<T>& out) {
  resize(out, in.width, rows);
  for (int y = 0; y < rows; ++y)
    convolve(
        kernel, static_cast<std::size_t>(in.width), &in.at(0, from + y),
        [&](int k) { return &in.at(0, from + y - k); },
        [&](int k) { return &in.at(0, from + y + k); }, &out.at(0, y));
}

}  // namespace deburr::tb
