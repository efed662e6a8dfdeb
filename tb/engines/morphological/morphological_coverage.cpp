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
    CoverageGroup{"morphological/long-end", "Ends of runs beyond the reach, by axis and crossing."},
    CoverageGroup{"morphological/prediction",
                  "Predictions of a step by axis, side, outcome (late, early: by one pixel) and "
                  "length of the run."},
    CoverageGroup{"morphological/prediction-end", "What stopped a side, by axis."},
    CoverageGroup{"morphological/border", "Runs that touch the frame's border."},
    CoverageGroup{"morphological/decision", "Decisions of the blender."},
    CoverageGroup{"morphological/table",
                  "Pixels by axis, the shape that their searches leave and the longer of their "
                  "distances."},
    CoverageGroup{"morphological/table-entry",
                  "Distances 0, and beyond the last root but one, by tile of the table."},
    CoverageGroup{"morphological/search", "Searches that end at their limit, and beyond it."},
    CoverageGroup{
        "morphological/endless",
        "Runs that go on beyond the border with border = clamp, by axis and end; repeated: "
        "runs of one pixel whose crossings the border repeats."},
    CoverageGroup{
        "morphological/corner",
        "Pixels of runs with sharp corners, by axis and the nearer end; cut: the corners lie "
        "beyond the limit of the searches."},
    CoverageGroup{"morphological/diagonal", "Diagonals by direction and codes of their ends."},
    CoverageGroup{"morphological/diagonal-ends", "Ends of diagonals that are open."},
    CoverageGroup{"morphological/diagonal-length", "Diagonals by direction and pixels."},
    CoverageGroup{"morphological/diagonal-beyond",
                  "Diagonals that follow repeated edges beyond the border, by direction."},
    CoverageGroup{"morphological/threshold", "Edges by what decided their threshold."},
    CoverageGroup{"morphological/left", "Pixels that keep their colour by the rule of marks."},
    CoverageGroup{"morphological/leave-border",
                  "With leave = beside, pixels on the frame's border."},
    CoverageGroup{"morphological/half", "Weights that a mark halves."},
    CoverageGroup{"morphological/class",
                  "Lines with learned weights, by axis, end and class of what lies beside it."},
    CoverageGroup{
        "morphological/text",
        "With text_guard, pixels by what guards them or what alone is missing for it; "
        "just: by the number of strokes that decides; kept: guarded ones that had a "
        "weight. In tests alone: those that leave keeps, too, since what geometry marks has "
        "a colour of its own."},
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
  // Runs have bins called border, too.
  add(golden.bypass_coverage().bins(),
      [](const std::string& name) { return name.starts_with("border/") ? "leave-" + name : name; });
  add(golden.guard_coverage().bins(), same);
  add(golden.learned_coverage().bins(),
      [](const std::string& name) { return name.starts_with("class/") ? name : std::string(); });
  return coverage;
}

}  // namespace deburr::tb
