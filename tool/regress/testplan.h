// SPDX-License-Identifier: MIT
// Reads the YAML file of a testplan (docs/reference/regression.md): features, the headings of pages
// that each of them tests, the runs for it, and what these runs must check and cover.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tool/sweep/definition.h"

namespace deburr::tool {

// Configurations of one engine, each with so many seeds; or so many random configurations.
struct Stimulus {
  std::string name;
  SweepDefinition configurations;
  std::uint64_t seeds = 1;
  bool random = false;
};

// What the runs of a feature must have compared together.
struct RequiredCheck {
  std::string scoreboard;
  std::uint64_t minimum = 0;
  std::string where;
};

struct RequiredBins {
  std::string glob, where;
  bool every = true;  // else one of them: which ones few seeds meet is chance
};

// Bins that no run of the plan meets, and why that is so.
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
  std::vector<std::filesystem::path> included;  // that add features and stimuli to it
  std::string name, title;
  std::uint64_t divisor = 1;  // of N seeds there are N / divisor
  std::vector<Feature> features;
  std::vector<RequiredBins> coverage;  // that all runs together must meet, but for these:
  std::vector<UnmetBins> unmet;
  std::vector<std::filesystem::path> pages;  // that were found
};

// With the files that it includes: `include: ["../engines/*/smoke.yaml"]` stands for one of each
// engine, in their order. Their features come before those of the file itself; one whose id there
// is already adds to it.
//
// ConfigError with file and line for everything that cannot be meant: unknown keys and parameters,
// features and stimuli of one name, headings that no page has, bins that no engine has. Pages are
// looked for in the folder of the testplan and in those around it. Every file may have `coverage`
// and `unmet` of the whole plan.
Testplan read_testplan(const std::filesystem::path& file);

// Of each configuration one of so many seeds, at least one, as much less of what must be compared
// (down to half of that of a feature with random configurations), and of each glob one bin: runs
// that the whole plan has too. Its name says so.
Testplan part_of(Testplan testplan, std::uint64_t divisor);

}  // namespace deburr::tool
