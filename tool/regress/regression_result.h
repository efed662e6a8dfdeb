// SPDX-License-Identifier: MIT
// Combined results of a regression's runs: which features pass, failure signatures, coverage.
// Writes JUnit XML, JSON and one self-contained page.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tool/regress/regression_plan.h"
#include "tool/regress/testplan.h"
#include "tool/sweep/plan.h"
#include "tool/sweep/point.h"

namespace deburr::tool {

// Hits by bin.
using Bins = std::map<std::string, std::uint64_t>;

struct RegressionRun {
  PlannedPoint point;
  PointState state = PointState::kMissing;
  Failure failure;     // if it failed
  double seconds = 0;  // wall-clock
  std::uint64_t cycles = 0;
};

struct CheckResult {
  RequiredCheck required;
  std::uint64_t comparisons = 0;
  // set if no run has this scoreboard: where the plan names it, and the known names
  std::string unknown{};
  bool met() const { return comparisons >= required.minimum; }
};

// A bin that the plan declares unreachable: the reason, and its hits.
struct UnmetBin {
  std::string bin, reason;
  std::uint64_t hits = 0;
};

// The bins that a glob matches. Their hits are those of the feature's runs or, for a glob of the
// whole plan, of all runs.
struct CoverageResult {
  RequiredBins required;
  std::uint64_t bins = 0;
  std::vector<std::string> holes;
  std::string unknown{};  // no run has such a bin
  bool met() const { return required.every ? bins > 0 && holes.empty() : holes.size() < bins; }
};

struct FeatureResult {
  const Feature* feature = nullptr;
  std::uint64_t passed = 0, failed = 0, missing = 0;
  std::vector<CheckResult> checks;
  std::vector<CoverageResult> coverage;
  std::uint64_t runs() const { return passed + failed + missing; }
  bool holds() const;
};

// Failures of one engine with the same message, ignoring numbers.
struct FailureSignature {
  std::string engine, kind, message;
  std::vector<std::size_t> runs;    // indices; the first is the example
  std::filesystem::path directory;  // of the example repeated with waveforms; empty: none
};

struct RegressionResult {
  std::vector<RegressionRun> runs;
  std::vector<FeatureResult> features;
  std::vector<FailureSignature> signatures;
  // by the engine that owns the bins, whatever composition ran it
  std::map<std::string, Bins> coverage;
  std::vector<CoverageResult> merged;  // requirements on all runs together
  std::vector<UnmetBin> unmet;         // exempted bins
  std::uint64_t passed = 0, failed = 0, missing = 0;
  // Whether every run passed, and the checks and coverage of every feature and of the whole plan
  // are met.
  bool holds() const;
};

// Reads the existing results. `testplan` must outlive the return value.
RegressionResult collect_regression(const Testplan& testplan, const SweepPlace& place);

// The first run of each signature again, with waveforms around the failing cycle.
std::vector<PlannedPoint> runs_with_waves(const RegressionResult& result, const SweepPlace& place);
// Locates the waveforms that these runs wrote.
void add_waves(RegressionResult& result, const std::vector<PlannedPoint>& runs,
               const SweepPlace& place);

// Writes junit.xml, collected.json and index.html to the regression's directory and, if no runs are
// missing, adds the night to its testplan's trend. Either all files are written, or FileError is
// thrown and the old files remain. Returns what is worse than in the night before.
std::vector<std::string> write_regression(const Testplan& testplan, std::uint64_t base_seed,
                                          const Plan& plan, const SweepPlace& place,
                                          const RegressionResult& result);

// The base seed of this testplan's latest report. FileError if it does not exist.
std::uint64_t seed_of_last_report(const std::filesystem::path& out, const std::string& testplan);
// Names (PointOrigin::name) of the failed runs in the report. FileError as above.
std::set<std::string> failed_in_report(const SweepPlace& place);

}  // namespace deburr::tool
