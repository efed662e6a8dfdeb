// SPDX-License-Identifier: MIT
// What a regression's runs show together: which features hold, which failures are the same one,
// what was covered. Written as JUnit XML, as JSON and as one self-contained page.
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
  Failure failure;     // of one that failed
  double seconds = 0;  // of the host
  std::uint64_t cycles = 0;
};

struct CheckResult {
  RequiredCheck required;
  std::uint64_t comparisons = 0;
  std::string unknown{};  // none of its runs has this scoreboard: where that is said, and what is
  bool met() const { return comparisons >= required.minimum; }
};

// A bin that a plan says is not met: why, and how often it was.
struct UnmetBin {
  std::string bin, reason;
  std::uint64_t hits = 0;
};

// The bins that a glob of a feature names, as its own runs met them; or one of the whole plan, as
// all runs did.
struct CoverageResult {
  RequiredBins required;
  std::uint64_t bins = 0;
  std::vector<std::string> holes;
  std::string unknown{};  // none of its runs has such a bin
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

// Failures of one engine with the same message, numbers aside.
struct FailureSignature {
  std::string engine, kind, message;
  std::vector<std::size_t> runs;    // indices; the first one is the example
  std::filesystem::path directory;  // of the example run again with waves; empty: there are none
};

struct RegressionResult {
  std::vector<RegressionRun> runs;
  std::vector<FeatureResult> features;
  std::vector<FailureSignature> signatures;
  std::map<std::string, Bins> coverage;  // by the engine that bins are of, whatever ran it
  std::vector<CoverageResult> merged;    // what the plan demands of all runs together
  std::vector<UnmetBin> unmet;           // what it excepts
  std::uint64_t passed = 0, failed = 0, missing = 0;
  // Every run passed, and every feature and all of them together were checked and covered as the
  // plan says.
  bool holds() const;
};

// Reads what is there. `testplan` must outlive the result.
RegressionResult collect_regression(const Testplan& testplan, const SweepPlace& place);

// The first run of each signature once more, with waves around the cycle in which it failed.
std::vector<PlannedPoint> runs_with_waves(const RegressionResult& result, const SweepPlace& place);
// Finds the waves that these runs have left.
void add_waves(RegressionResult& result, const std::vector<PlannedPoint>& runs,
               const SweepPlace& place);

// junit.xml, collected.json and index.html in the regression's directory, and the night in the
// trend of its testplan, unless runs are missing: all of them, or FileError and those of before.
// Says what is worse than the night before.
std::vector<std::string> write_regression(const Testplan& testplan, std::uint64_t base_seed,
                                          const Plan& plan, const SweepPlace& place,
                                          const RegressionResult& result);

// The base seed of the report of this testplan that was written last. FileError where none is.
std::uint64_t seed_of_last_report(const std::filesystem::path& out, const std::string& testplan);
// Names (PointOrigin::name) of the runs that the report there says have failed. FileError as above.
std::set<std::string> failed_in_report(const SweepPlace& place);

}  // namespace deburr::tool
