// SPDX-License-Identifier: MIT
#include "tb/engines/morphological/morphological_coverage.h"

#include <array>
#include <string>
#include <vector>

namespace deburr::tb {
namespace {

using golden::morphological::CoverageBin;

constexpr std::array kGroups = {
    CoverageGroup{"morphological/shape", "Runs by axis, shape and length."},
    CoverageGroup{"morphological/long-end",
                  "Ends of runs longer than the search range, by axis and crossing."},
    CoverageGroup{"morphological/prediction",
                  "Predictions of a step by axis, side, outcome (late, early: by one pixel) and "
                  "length of the run."},
    CoverageGroup{"morphological/prediction-end", "Extension ends, by axis and reason."},
    CoverageGroup{"morphological/border", "Runs that touch the frame's border."},
    CoverageGroup{"morphological/decision", "Decisions of the blender."},
    CoverageGroup{"morphological/table",
                  "Pixels by axis, shape within the searches and the longer of their distances."},
    CoverageGroup{"morphological/table-entry",
                  "Distances of 0, and above the second-last root, by tile of the table."},
    CoverageGroup{"morphological/search", "Searches that end at their limit, and beyond."},
    CoverageGroup{"morphological/endless",
                  "Runs that continue outside the frame (border = clamp), by axis and end; "
                  "repeated: runs of one pixel whose crossings the border repeats."},
    CoverageGroup{"morphological/corner",
                  "Pixels of runs with sharp corners, by axis and nearer end; cut: the corners are "
                  "beyond the search limit."},
    CoverageGroup{"morphological/diagonal", "Diagonals by direction and end codes."},
    CoverageGroup{"morphological/diagonal-ends", "Open ends of diagonals."},
    CoverageGroup{"morphological/diagonal-length", "Diagonals by direction and pixels."},
    CoverageGroup{"morphological/diagonal-beyond",
                  "Diagonals that follow repeated edges outside the frame, by direction."},
    CoverageGroup{"morphological/threshold", "Edges by the term that sets their threshold."},
    CoverageGroup{"morphological/bypass",
                  "Pixels bypassed by their marks (`morphological.bypass`)."},
    CoverageGroup{"morphological/bypass-border",
                  "Pixels on the frame's border, with bypass = beside."},
    CoverageGroup{"morphological/half", "Blend weights halved by a mark."},
    CoverageGroup{"morphological/class",
                  "Lines with learned weights, by axis, end and class of its surroundings."},
    CoverageGroup{"morphological/text",
                  "Pixels with text_guard: by the strokes that guard them, or the only condition "
                  "missing; just: by the number of strokes that decides; kept: guarded pixels that "
                  "had a blend weight. Only in tests: pixels that are bypassed too, since marked "
                  "pixels have their own colour."},
    CoverageGroup{"morphological/text-border", "Guarded pixels on the frame's border."}};

}  // namespace

std::span<const CoverageGroup> morphological_coverage_groups() { return kGroups; }

Coverage morphological_coverage(const golden::morphological::MorphologicalGolden& golden) {
  Coverage coverage;
  const auto add = [&](const std::vector<CoverageBin>& bins, auto name_of) {
    for (const CoverageBin& bin : bins) {
      const std::string name = name_of(bin.name);
      if (name.empty()) continue;
      coverage.declare("morphological/" + name);
      coverage.hit("morphological/" + name, bin.hits);
    }
  };
  const auto same = [](const std::string& name) { return name; };
  add(golden.coverage().bins(), same);
  add(golden.smaa_coverage().bins(), same);
  // Prefixed, because runs also have bins called border.
  add(golden.bypass_coverage().bins(), [](const std::string& name) {
    return name.starts_with("border/") ? "bypass-" + name : name;
  });
  add(golden.guard_coverage().bins(), same);
  add(golden.learned_coverage().bins(),
      [](const std::string& name) { return name.starts_with("class/") ? name : std::string(); });
  return coverage;
}

}  // namespace deburr::tb
