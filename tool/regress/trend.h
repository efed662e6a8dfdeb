// SPDX-License-Identifier: MIT
// What becomes of a testplan over nights: a line each in a file beside its reports.
//
//   OUT/regressions/NAME.jsonl   one of each base seed and commit, the last one at the end
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tool/regress/regression_result.h"

namespace deburr::tool {

// A regression of which no run is missing.
struct Night {
  std::string date, commit;  // "2026-11-23", the day in UTC
  std::uint64_t seed = 0;
  bool holds = false;
  std::uint64_t runs = 0, passed = 0;
  std::uint64_t bins = 0, met = 0;  // of all engines, as all runs together met them
  std::uint64_t cycles = 0;         // that were simulated
  double seconds = 0;               // of simulation

  double cycles_a_second() const;
};

Night night_of(const RegressionResult& result, std::uint64_t base_seed);
nlohmann::ordered_json to_json(const Night& night);

// What is worse than the night before, in words: "pass rate from 100.0 % to 91.7 %". Speed counts
// from a fifth on, of two nights that each took a minute: shorter ones tell of the machine.
std::vector<std::string> falls_between(const Night& before, const Night& after);

std::filesystem::path trend_file(const std::filesystem::path& out, const std::string& testplan);
// None where there is no file. FileError for a line that is no night.
std::vector<Night> read_trend(const std::filesystem::path& file);
// With this night at the end, in the place of an earlier one of its seed and commit.
std::vector<Night> with_night(std::vector<Night> nights, const Night& night);
std::string trend_text(const std::vector<Night>& nights);

// Held while the file is read and written, so that two regressions at once lose no night.
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
