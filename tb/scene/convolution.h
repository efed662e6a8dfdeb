// SPDX-License-Identifier: MIT
// One-dimensional convolutions for quality metrics. An image is processed in bands of rows, so that
// intermediate results stay in a cache, and planes are allocated once.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <vector>

#include "tb/scene/image.h"

namespace deburr::tb {

inline constexpr int kBandRows = 48;

// A symmetric or antisymmetric kernel, stored from its middle to the right. Tap -k equals tap k, or
// minus tap k.
template <class T>
struct Kernel {
  std::vector<T> taps;
  bool odd = false;
  int reach() const { return static_cast<int>(taps.size()) - 1; }
};

// New elements are left uninitialised.
template <class T>
void resize(ImageOf<T>& plane, int width, int height) {
  plane.width = width;
  plane.height = height;
  plane.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
}

// One register of neighbouring values.
template <class T>
using Lanes [[gnu::vector_size(16)]] = T;

template <class Some, class T>
Some load(const T* from) {
  Some some;
  std::memcpy(&some, from, sizeof some);
  return some;
}

// Number of values in a register; a register can be one value.
template <class Some, class T>
constexpr std::size_t lanes_of() {
  if constexpr (std::is_same_v<Some, T>)
    return 1;
  else
    return sizeof(Some) / sizeof(T);
}

// Computes kCount registers of to[x] = middle[x] * tap 0 + sum of tap k * (middle[x + k step] +-
// middle[x - k step]), and keeps them in registers (Some).
template <bool kOdd, std::size_t kCount, class Some, class T>
void convolve_some(const Kernel<T>& kernel, const T* middle, std::ptrdiff_t step, T* to) {
  constexpr std::size_t kLanes = lanes_of<Some, T>();
  std::array<Some, kCount> sum{};
  if (!kOdd)
    for (std::size_t i = 0; i < kCount; ++i)
      sum[i] = kernel.taps[0] * load<Some>(middle + i * kLanes);
  const T *left = middle, *right = middle;
  const T* const end = kernel.taps.data() + kernel.taps.size();
  for (const T* tap = kernel.taps.data() + 1; tap != end; ++tap) {
    left -= step;
    right += step;
    for (std::size_t i = 0; i < kCount; ++i) {
      const Some a = load<Some>(left + i * kLanes), b = load<Some>(right + i * kLanes);
      sum[i] += *tap * (kOdd ? b - a : b + a);
    }
  }
  std::memcpy(to, &sum, sizeof sum);
}

template <bool kOdd, class T>
void convolve_line(const Kernel<T>& kernel, std::size_t n, const T* middle, std::ptrdiff_t step,
                   T* to) {
  constexpr std::size_t kCount = 8, kMany = kCount * sizeof(Lanes<T>) / sizeof(T);
  std::size_t x = 0;
  for (; x + kMany <= n; x += kMany)
    convolve_some<kOdd, kCount, Lanes<T>>(kernel, middle + x, step, to + x);
  for (; x < n; ++x) convolve_some<kOdd, 1, T>(kernel, middle + x, step, to + x);
}

// n values along a row; neighbouring kernel samples are `step` values apart.
template <class T>
void convolve(const Kernel<T>& kernel, std::size_t n, const T* middle, std::ptrdiff_t step, T* to) {
  if (kernel.odd)
    convolve_line<true>(kernel, n, middle, step, to);
  else
    convolve_line<false>(kernel, n, middle, step, to);
}

// A row is extended by repeating its outermost pixels.
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
    convolve(kernel, width, row, 1, &out.at(0, y));
  }
}

// Processes only rows from..from + rows - 1. The kernel must not extend beyond the existing rows.
template <class T>
void convolve_along_columns(const ImageOf<T>& in, const Kernel<T>& kernel, int from, int rows,
                            ImageOf<T>& out) {
  resize(out, in.width, rows);
  for (int y = 0; y < rows; ++y)
    convolve(kernel, static_cast<std::size_t>(in.width), &in.at(0, from + y), in.width,
             &out.at(0, y));
}

}  // namespace deburr::tb
