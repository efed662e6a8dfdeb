// SPDX-License-Identifier: MIT
// Functional coverage of the morphological engine: which situations the frames so far contained.
//
// Counted by the golden, which knows every run and every decision. Small named bins; all of them
// can be reached (tb/unit/morphological_golden_coverage_test.cpp), some only with a suitable
// window.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "golden/morphological/blend.h"
#include "golden/morphological/predictor.h"
#include "spec/morphological.h"

namespace deburr::golden::morphological {

struct CoverageBin {
  std::string name;  // "shape/Z-first-second/horizontal/3-4"
  std::uint64_t hits = 0;
};

class RunCoverage {
 public:
  // `extent`: pixels of the frame along the run; `lines`: across it.
  void count_run(const spec::RunRecord& run, const Prediction& prediction, int extent, int lines);
  void count_pixel(Decision decision) { ++decisions_[static_cast<std::size_t>(decision)]; }
  void merge(const RunCoverage& other);
  // Every bin, hit or not, always in the same order.
  std::vector<CoverageBin> bins() const;

  static constexpr std::size_t kLengths = 6;  // 1, 2, 3-4, 5-8, 9-16, 17 and more
  static std::size_t length_bin(int length);

 private:
  using Counts = std::uint64_t;
  template <class T, std::size_t N>
  using Table = std::array<T, N>;

  Table<Table<Table<Counts, kLengths>, 2>, 16> shapes_{};  // whole runs: shape, axis, length
  Table<Table<Counts, 2>, 4> long_ends_{};                 // crossing code of an end, axis
  Table<Table<Table<Table<Counts, kLengths>, 4>, 2>, 2> outcomes_{};  // axis, side, outcome, length
  Table<Table<Table<Counts, 4>, 2>, 2> ends_{};                       // axis, side, why
  Table<Table<Counts, 4>, 2> borders_{};  // axis; start, end, first, last
  Table<Counts, 8> decisions_{};
};

}  // namespace deburr::golden::morphological
