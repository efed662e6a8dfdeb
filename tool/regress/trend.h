// SPDX-License-Identifier: MIT
// The trend of a testplan over nights: one line per night in a file next to its reports.
//
//   OUT/regressions/NAME.jsonl   one line per base seed and commit, the latest one last
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tool/regress/regression_result.h"

namespace deburr::tool {

// A regression with no missing runs.
struct Night {
  std::string date, commit;  // "2026-11-23", the day in UTC
  std::uint64_t seed = 0;
  bool holds = false;
  std::uint64_t runs = 0, passed = 0;
  std::uint64_t bins = 0, met = 0;  // over all engines and all runs together
  std::uint64_t cycles = 0;         // simulated
  double seconds = 0;               // of simulation

  double cycles_a_second() const;
};

Night night_of(const RegressionResult& result, std::uint64_t base_seed);
nlohmann::ordered_json to_json(const Night& night);

// Describes what is worse than the night before: "pass rate from 100.0 % to 91.7 %". A loss of
// speed counts from 20 %, and only between nights of at least a minute: shorter ones measure the
// machine.
std::vector<std::string> falls_between(const Night& before, const Night& after);

std::filesystem::path trend_file(const std::filesystem::path& out, const std::string& testplan);
// Empty if the file does not exist. FileError for an invalid line.
std::vector<Night> read_trend(const std::filesystem::path& file);
// Appends this night, replacing an earlier one with its seed and commit.
std::vector<Night> with_night(std::vector<Night> nights, const Night& night);
std::string trend_text(const std::vector<Night>& nights);

// Held while the file is read and written, so that concurrent regressions lose no night.
class TrendLock {
 public:
  explicit TrendLock(const std::filesystem::path& folder);
  ~TrendLock();
  TrendLock(const TrendLock&) = delete;
  TrendLock& operator=(const TrendLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace deburr::tool
