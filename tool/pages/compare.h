// SPDX-License-Identifier: MIT
// Two results side by side: what changed, and whether it became worse by more than a tolerance.
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
  // Bits of memory may grow by this much; without it they are checked, but fail nothing: what a
  // choice costs is not a fault of it.
  std::optional<double> memory_percent{};
};

// By the value's own direction: fewer cycles, more decibels. kEqual within the tolerance too,
// kNone: nobody can say.
enum class Trend : std::uint8_t { kNone, kEqual, kBetter, kWorse };
inline constexpr std::array<std::string_view, 4> kTrendNames = {"", "equal", "better", "worse"};

struct ComparedValue {
  std::string key;
  std::string a, b, change;  // change in percent or dB, "" where neither says something
  Trend verdict = Trend::kNone;
  bool worse = false;  // and it counts
};

struct Comparison {
  std::vector<ComparedValue> values;  // every one that differs, or that is worse
  bool worse = false;
};

// `b` compared with `a`, both as read_result() gives them. A mismatch, a lost verdict, or a value
// with a better side that only `a` has is worse. ConfigError for results of different engines.
Comparison compare(const nlohmann::ordered_json& a, const nlohmann::ordered_json& b,
                   const Tolerances& tolerances);

// One number against another, by the key of a result; nothing: it has no direction, unless
// `maximise` says one. Empty optionals: there is no value.
Trend check(const std::string& key, std::optional<double> a, std::optional<double> b,
            const Tolerances& tolerances, std::optional<bool> maximise = std::nullopt);
// Whether a worse value of this key fails a comparison.
bool counts(const std::string& key, const Tolerances& tolerances);
// Changes of it are differences, not percents.
bool in_decibels(const std::string& key);
// "+3.20 %", "-0.31 dB", or "".
std::string change_of(const std::string& key, std::optional<double> a, std::optional<double> b);
// The value of a result under a dotted key, as a reader wants it; "-" for none.
std::string value_text(const nlohmann::ordered_json& value);
std::optional<double> as_number(const nlohmann::ordered_json& value);
// null where there is none.
nlohmann::ordered_json value_at(const nlohmann::ordered_json& result, const std::string& key);

// Two manifests: what makes their runs different work, so that a difference of the results says
// little about the hardware: inputs (by content), and what parameters say to be work (scene, size,
// clock). A line each.
std::vector<std::string> different_work(const nlohmann::ordered_json& a,
                                        const nlohmann::ordered_json& b);

}  // namespace deburr::tool
