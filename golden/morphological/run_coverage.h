// SPDX-License-Identifier: MIT
// Functional coverage of the morphological engine: the situations that occurred in the frames so
// far.
//
// The golden model counts, since it knows every run and every decision. Bins:
//   shape/<axis>/<shape>/<length>      whole runs
//   long-end/<axis>/<crossing>         ends of runs longer than the search range
//   prediction/<axis>/<side>/<outcome>/<length>
//                                      none, exact (all steps L), early (L - 1), late (L + 1)
//   prediction-end/<axis>/<why>        why the extension of a side ended
//   border/<axis>/<border>             runs that touch the border of the frame
//   decision/<rule>                    decisions of the blender
// Every bin is reachable (tb/unit/golden/morphological/coverage_test.cpp); a run of 17 pixels with
// extensions needs a search range of 34.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "golden/morphological/blend.h"
#include "golden/morphological/predictor.h"
#include "spec/morphological/packets.h"

namespace deburr::golden::morphological {

struct CoverageBin {
  std::string name;
  std::uint64_t hits = 0;
};

class RunCoverage {
 public:
  // `extent`: pixels of the frame along the run; `lines`: across it.
  void count_run(const spec::morphological::RunDescriptor& run, const Prediction& prediction,
                 int extent, int lines);
  void count_pixel(Decision decision) { count_pixels(decision, 1); }
  void count_pixels(Decision decision, std::uint64_t pixels) {
    decisions_[static_cast<std::size_t>(decision)] += pixels;
  }
  // Every bin, hit or not, always in the same order; bins of several runs add up by name.
  std::vector<CoverageBin> bins() const;

  static constexpr std::size_t kLengths = 6;  // 1, 2, 3-4, 5-8, 9-16, 17 and more
  static std::size_t length_bin(int length);
  static constexpr std::size_t kEnds = 5;  // SideEnd without kUntried

 private:
  using BinSink = std::function<void(std::string name, std::uint64_t hits)>;
  void for_each_bin(const BinSink& sink) const;

  using ByLength = std::array<std::uint64_t, kLengths>;
  template <class T>
  using ByAxis = std::array<T, 2>;
  std::array<ByAxis<ByLength>, 16> shapes_{};
  std::array<ByAxis<std::uint64_t>, 4> long_ends_{};           // by crossing code
  ByAxis<std::array<std::array<ByLength, 4>, 2>> outcomes_{};  // axis, side, outcome
  ByAxis<std::array<std::uint64_t, kEnds>> ends_{};            // axis, why
  ByAxis<std::array<std::uint64_t, 4>> borders_{};             // start, end, first, last
  std::array<std::uint64_t, 8> decisions_{};
};

}  // namespace deburr::golden::morphological
