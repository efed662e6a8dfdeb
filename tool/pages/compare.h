// SPDX-License-Identifier: MIT
// Compares two results: the changes, and whether a value became worse by more than its tolerance.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace deburr::tool {

struct Tolerances {
  double cycles_percent = 2;      // cycles, latency and memory traffic may grow by this much
  double throughput_percent = 2;  // throughput may fall by this much
  double psnr_db = 0.05;          // quality may fall by this much
  double flip = 0.0005;           // FLIP may grow by this much
  double ssim = 0.0005;           // SSIM may fall by this much
  // Allowed growth of memory bits. If it is not set, memory bits are compared but never fail, since
  // the cost of a choice is not a fault.
  std::optional<double> memory_percent{};
};

// Judged by the direction of the value: fewer cycles or more decibels are better. kEqual: within
// the tolerance; kNone: the value has no direction.
enum class Trend : std::uint8_t { kNone, kEqual, kBetter, kWorse };
inline constexpr std::array<std::string_view, 4> kTrendNames = {"", "equal", "better", "worse"};

struct ComparedValue {
  std::string key;
  std::string a, b, change;  // change in percent or dB; "" if neither applies
  Trend verdict = Trend::kNone;
  bool worse = false;  // worse, and it fails the comparison
};

struct Comparison {
  std::vector<ComparedValue> values;  // all values that differ or are worse
  bool worse = false;
};

// Compares `b` with `a`, both from read_result(). Worse are a mismatch, a lost verdict, or a value
// with a direction that only `a` has. A figure of cost never fails the comparison, and is kEqual
// where the ranges overlap. ConfigError for results of different engines.
Comparison compare(const nlohmann::ordered_json& a, const nlohmann::ordered_json& b,
                   const Tolerances& tolerances);

// Compares two numbers by their result key. kNone: the key has no direction and `maximise` gives
// none. An empty optional means that there is no value.
Trend check(const std::string& key, std::optional<double> a, std::optional<double> b,
            const Tolerances& tolerances, std::optional<bool> maximise = std::nullopt);
// Whether a worse value of this key fails a comparison.
bool counts(const std::string& key, const Tolerances& tolerances);
// Whether changes of this key are given as differences instead of percentages.
bool in_decibels(const std::string& key);
// "+3.20 %", "-0.31 dB", or "".
std::string change_of(const std::string& key, std::optional<double> a, std::optional<double> b);
// Formats the value of a result under a dotted key; "-" for none.
std::string value_text(const nlohmann::ordered_json& value);
std::optional<double> as_number(const nlohmann::ordered_json& value);
// null if absent.
nlohmann::ordered_json value_at(const nlohmann::ordered_json& result, const std::string& key);

// Whether gates and nanoseconds of the two results are of different standard cells: then they are
// not compared.
bool other_technology(const nlohmann::ordered_json& a, const nlohmann::ordered_json& b);
// "394,000 to 411,000", of a figure of cost; "" without a range.
std::string range_text(const nlohmann::ordered_json& result, const std::string& key);

// Compares the work of two manifests: inputs (by content) and parameters marked as work (scene,
// size, clock). Returns a line for each difference; differences make results hard to compare.
std::vector<std::string> different_work(const nlohmann::ordered_json& a,
                                        const nlohmann::ordered_json& b);

}  // namespace deburr::tool
