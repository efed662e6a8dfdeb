// SPDX-License-Identifier: MIT
// Reads a testplan's YAML file (docs/reference/regression.md). It lists features, the headings of
// pages that each feature tests, the runs of each feature, and the checks and coverage that these
// runs must reach.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tool/sweep/definition.h"

namespace deburr::tool {

// Configurations of one engine with a number of seeds each, or a number of random configurations.
struct Stimulus {
  std::string name;
  SweepDefinition configurations;
  std::uint64_t seeds = 1;
  bool random = false;
};

// Comparisons required of all runs of a feature together.
struct RequiredCheck {
  std::string scoreboard;
  std::uint64_t minimum = 0;
  std::string where;
};

struct RequiredBins {
  std::string glob, where;
  bool every = true;  // false: at least one of them, since few seeds meet only some by chance
};

// Bins that no run of the plan meets, and the reason.
struct UnmetBins {
  std::string glob, reason, where;
};

struct Feature {
  std::string id, title;
  std::vector<std::string> traces;  // "docs/reference/texture/index.md#presets"
  std::vector<Stimulus> stimuli;
  std::vector<RequiredCheck> checks;
  std::vector<RequiredBins> coverage;
};

struct Testplan {
  std::filesystem::path file;
  std::vector<std::filesystem::path> included;  // files that add features and stimuli
  std::string name, title;
  std::uint64_t divisor = 1;  // N seeds become N / divisor
  std::vector<Feature> features;
  std::vector<RequiredBins> coverage;  // required of all runs together, except for:
  std::vector<UnmetBins> unmet;
  std::vector<std::filesystem::path> pages;  // the resolved pages
};

// Reads a testplan and the files that it includes: `include: ["../engines/*/smoke.yaml"]` expands
// to one file per engine, in order. Included features come first; features of the same id are
// merged.
//
// ConfigError with file and line for every invalid entry: unknown keys and parameters, duplicate
// features and stimuli, headings missing in their page, unknown bins. Pages are searched for in the
// testplan's folder and its parents; if none of these has a folder docs, 'traces' may be missing.
// Every file may have `coverage` and `unmet` of the whole plan.
Testplan read_testplan(const std::filesystem::path& file);

// A subset of the runs of the whole plan: for each configuration one seed in `divisor`, but at
// least one. Fewer comparisons are then required (for a feature with random configurations, down to
// half), and each glob needs only one bin. The name of the plan says that it is a part.
Testplan part_of(Testplan testplan, std::uint64_t divisor);

}  // namespace deburr::tool
