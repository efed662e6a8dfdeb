// SPDX-License-Identifier: MIT
// Two results side by side: what changed, and whether it became worse by more than a tolerance.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace deburr::tb {

struct Tolerances {
  double cycles_percent = 2;      // cycles, latency and memory traffic may grow by this much
  double throughput_percent = 2;  // throughput may fall by this much
  double psnr_db = 0.05;          // quality may fall by this much
};

struct ComparedValue {
  std::string key;
  std::string a, b, change;  // change in percent or dB, "" where neither says something
  bool worse = false;
};

struct Comparison {
  std::vector<ComparedValue> values;  // every one that differs, or that is worse
  bool worse = false;
};

// `b` judged against `a`. A mismatch, a lost verdict, or a judged value that only `a` has is worse.
// ConfigError for results of different engines.
Comparison compare(const nlohmann::ordered_json& a, const nlohmann::ordered_json& b,
                   const Tolerances& tolerances);

// Two manifests: what makes their runs different work, so that a difference of the results says
// little about the hardware: inputs (by content), scene, size, clock. A line each.
std::vector<std::string> different_work(const nlohmann::ordered_json& a,
                                        const nlohmann::ordered_json& b);

}  // namespace deburr::tb
