// SPDX-License-Identifier: MIT
#include "golden/morphological/run_coverage.h"

#include <algorithm>
#include <initializer_list>
#include <string_view>

namespace deburr::golden::morphological {
namespace {

constexpr std::array<std::string_view, 2> kAxes = {"horizontal", "vertical"};
constexpr std::array<std::string_view, RunCoverage::kLengths> kLengthNames = {"1",   "2",    "3-4",
                                                                              "5-8", "9-16", "17+"};
constexpr std::array<std::string_view, 2> kSides = {"left", "right"};
constexpr std::array<std::string_view, 4> kOutcomes = {"none", "exact", "early", "late"};
constexpr std::array<std::string_view, RunCoverage::kEnds> kEndNames = {
    "all-steps", "no-hit", "out-of-reach", "inconsistent", "curve"};
constexpr std::array<std::string_view, 4> kCrossings = {"none", "first", "second", "T"};
constexpr std::array<std::string_view, 4> kBorders = {"start-on-border", "end-on-border",
                                                      "first-line", "last-line"};
constexpr std::array<std::string_view, 8> kDecisions = {"none",
                                                        "only-up-down",
                                                        "only-left-right",
                                                        "longer-up-down",
                                                        "longer-left-right",
                                                        "stronger-up-down",
                                                        "stronger-left-right",
                                                        "tie"};

template <class Enum>
std::size_t index(Enum value) {
  return static_cast<std::size_t>(value);
}

// A step of L - 1 = 0 does not exist.
bool reachable(std::size_t outcome, std::size_t length) {
  return kOutcomes[outcome] != "early" || kLengthNames[length] != "1";
}

std::string slash(std::initializer_list<std::string_view> parts) {
  std::string name;
  for (const std::string_view part : parts) {
    if (!name.empty()) name += '/';
    name += part;
  }
  return name;
}

// Counts a side that was tried, of a run in this length bin.
template <class Table, class Ends>
void count_side(const Extension& side, std::size_t length_bin, Table& outcomes, Ends& ends) {
  if (side.outcome == Outcome::kUntried) return;
  ++outcomes[index(side.outcome) - 1][length_bin];
  ++ends[index(side.why) - 1];
}

}  // namespace

std::size_t RunCoverage::length_bin(int length) {
  constexpr std::array<int, kLengths - 1> kUpTo = {1, 2, 4, 8, 16};
  return static_cast<std::size_t>(std::lower_bound(kUpTo.begin(), kUpTo.end(), length) -
                                  kUpTo.begin());
}

void RunCoverage::count_run(const spec::morphological::RunDescriptor& run,
                            const Prediction& prediction, int extent, int lines) {
  const std::size_t axis = index(run.axis), length = length_bin(run.length);
  if (run.part == spec::morphological::RunPart::kWhole) {
    ++shapes_[run.shape][axis][length];
    count_side(prediction.left, length, outcomes_[axis][0], ends_[axis]);
    count_side(prediction.right, length, outcomes_[axis][1], ends_[axis]);
  } else {
    ++long_ends_[run.part == spec::morphological::RunPart::kHead ? run.shape & 3 : run.shape >> 2]
                [axis];
  }
  auto& borders = borders_[axis];
  if (run.start == 0) ++borders[0];
  if (run.start + run.length == extent) ++borders[1];
  if (run.line == 1) ++borders[2];
  if (run.line == lines - 1) ++borders[3];
}

void RunCoverage::for_each_bin(const BinSink& sink) const {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    for (std::size_t shape = 0; shape < 16; ++shape) {
      for (std::size_t length = 0; length < kLengths; ++length) {
        sink(slash({"shape", kAxes[axis], spec::morphological::kRunShapes[shape].name,
                    kLengthNames[length]}),
             shapes_[shape][axis][length]);
      }
    }
    for (std::size_t crossing = 0; crossing < 4; ++crossing) {
      sink(slash({"long-end", kAxes[axis], kCrossings[crossing]}), long_ends_[crossing][axis]);
    }
    for (std::size_t side = 0; side < 2; ++side) {
      for (std::size_t outcome = 0; outcome < 4; ++outcome) {
        for (std::size_t length = 0; length < kLengths; ++length) {
          if (!reachable(outcome, length)) continue;
          sink(slash({"prediction", kAxes[axis], kSides[side], kOutcomes[outcome],
                      kLengthNames[length]}),
               outcomes_[axis][side][outcome][length]);
        }
      }
    }
    for (std::size_t end = 0; end < kEnds; ++end) {
      sink(slash({"prediction-end", kAxes[axis], kEndNames[end]}), ends_[axis][end]);
    }
    for (std::size_t border = 0; border < 4; ++border) {
      sink(slash({"border", kAxes[axis], kBorders[border]}), borders_[axis][border]);
    }
  }
  for (std::size_t decision = 0; decision < 8; ++decision) {
    sink(slash({"decision", kDecisions[decision]}), decisions_[decision]);
  }
}

std::vector<CoverageBin> RunCoverage::bins() const {
  std::vector<CoverageBin> result;
  for_each_bin([&](std::string name, std::uint64_t hits) {
    result.push_back({std::move(name), hits});
  });
  return result;
}

}  // namespace deburr::golden::morphological
