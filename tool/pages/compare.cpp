// SPDX-License-Identifier: MIT
#include "tool/pages/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "spec/error.h"
#include "tb/base/json_text.h"
#include "tb/run/amount.h"
#include "tb/run/parameter_set.h"
#include "tb/run/result.h"
#include "tool/pages/input_files.h"

namespace deburr::tool {
namespace {

using Json = nlohmann::ordered_json;

enum class Better {
  kNone,
  kLessIsBetter,
  kMoreIsBetter,
  kDecibel,
  kFlip,
  kSsim,
  kMustBeZero,
  kBits
};

struct Rule {
  std::string_view key;
  Better better;
};
constexpr Rule kRules[] = {
    {"checks.mismatches", Better::kMustBeZero},
    {"checks.traffic_mismatches", Better::kMustBeZero},
    {"cycles", Better::kLessIsBetter},
    {"throughput.value", Better::kMoreIsBetter},
    {"latency.p50", Better::kLessIsBetter},
    {"latency.p95", Better::kLessIsBetter},
    {"latency.p99", Better::kLessIsBetter},
    {"memory.bytes_read", Better::kLessIsBetter},
    {"memory.bytes_written", Better::kLessIsBetter},
    {"quality.psnr_db", Better::kDecibel},
    {"quality.psnr_edge_db", Better::kDecibel},
    {"quality.psnr_silhouette_db", Better::kDecibel},
    {"quality.flip", Better::kFlip},
    {"quality.ssim", Better::kSsim},
};

Better better_of(const std::string& key) {
  for (const Rule& rule : kRules)
    if (rule.key == key) return rule.better;
  if (key.starts_with("memory_bits.") && (key.ends_with(".logical") || key.ends_with(".physical")))
    return Better::kBits;
  return Better::kNone;
}

using KeyValues = std::vector<std::pair<std::string, Json>>;

void flatten(const Json& node, const std::string& path, KeyValues& values) {
  // These are not compared: the host's speed, which is unrelated to the hardware; coverage bins,
  // which have no direction; the histogram, which its percentiles cover; and the flags for
  // identical pictures, whose values are infinite.
  if (path == "host" || path == "quality.identical" || path == "change.identical" ||
      path == "coverage" || path.ends_with("meaning") || path == "latency.histogram" ||
      path == "schema")
    return;
  // The ends of a range go with its value.
  if (path.starts_with("cost.") && (path.ends_with(".low") || path.ends_with(".high"))) return;
  if (node.is_object()) {
    for (const auto& [key, value] : node.items())
      flatten(value, path.empty() ? key : fmt::format("{}.{}", path, key), values);
  } else if (!node.is_array()) {
    values.emplace_back(path, node);
  }
}

const Json* find(const KeyValues& values, const std::string& key) {
  for (const auto& [name, value] : values)
    if (name == key) return &value;
  return nullptr;
}

std::optional<double> number_of(const Json* value) {
  return value ? as_number(*value) : std::nullopt;
}
std::string shown_or_dash(const Json* value) { return value ? value_text(*value) : "-"; }

// The parameters that either manifest marks as defining the work, each once.
std::vector<std::string> work_parameters(const Json& a, const Json& b, tb::GivenWork work) {
  std::vector<std::string> names;
  for (const Json* manifest : {&a, &b})
    for (const Json& entry : manifest->value("parameters", Json::array())) {
      if (entry.value("work", "") != name_of(work, tb::kGivenWorkNames)) continue;
      std::string name = entry.value("name", "");
      if (std::find(names.begin(), names.end(), name) == names.end())
        names.push_back(std::move(name));
    }
  return names;
}

// For values present in both.
Trend compare_numbers(Better better, double a, double b, const Tolerances& t) {
  const auto less = [&](double percent) {
    if (b > a * (1 + percent / 100)) return Trend::kWorse;
    return b < a * (1 - percent / 100) ? Trend::kBetter : Trend::kEqual;
  };
  const auto more = [&](double by) {
    if (b < a - by) return Trend::kWorse;
    return b > a + by ? Trend::kBetter : Trend::kEqual;
  };
  if (a == b) return Trend::kEqual;
  switch (better) {
    case Better::kLessIsBetter:
      return less(t.cycles_percent);
    case Better::kBits:
      return less(t.memory_percent.value_or(0));
    case Better::kMoreIsBetter:
      if (b < a * (1 - t.throughput_percent / 100)) return Trend::kWorse;
      return b > a * (1 + t.throughput_percent / 100) ? Trend::kBetter : Trend::kEqual;
    case Better::kDecibel:
      return more(t.psnr_db);
    case Better::kSsim:
      return more(t.ssim);
    case Better::kFlip:
      if (b > a + t.flip) return Trend::kWorse;
      return b < a - t.flip ? Trend::kBetter : Trend::kEqual;
    default:
      return Trend::kNone;
  }
}

// ---- cost ---------------------------------------------------------------------------------------

// A figure of cost with its range; without a range both ends are the value.
struct CostFigure {
  double low = 0, value = 0, high = 0;

  double share() const { return value > 0 ? std::max(high - value, value - low) / value : 0; }
};

std::optional<CostFigure> cost_figure(const Json& result, const std::string& key) {
  const std::optional<double> value = as_number(value_at(result, key));
  if (!value) return std::nullopt;
  CostFigure figure{*value, *value, *value};
  if (!key.ends_with(".value")) return figure;
  const std::string stem = key.substr(0, key.size() - std::string_view("value").size());
  figure.low = as_number(value_at(result, stem + "low")).value_or(*value);
  figure.high = as_number(value_at(result, stem + "high")).value_or(*value);
  return figure;
}

// "cost.units.NAME" or "cost", of which the key is a figure.
std::string owner_of_cost(const std::string& key) {
  constexpr std::string_view kUnits = "cost.units.";
  return key.starts_with(kUnits) ? key.substr(0, key.find('.', kUnits.size())) : "cost";
}

// Whether a unit is mapped in one result and an estimate in the other.
bool other_basis(const Json& a, const Json& b, const std::string& owner) {
  if (owner != "cost") return value_at(a, owner + ".basis") != value_at(b, owner + ".basis");
  const Json units = value_at(a, "cost.units");
  if (!units.is_object()) return false;
  for (const auto& [name, unit] : units.items()) {
    const Json other = value_at(b, "cost.units." + name + ".basis");
    if (!other.is_null() && unit.value("basis", Json()) != other) return true;
  }
  return false;
}

struct CostChange {
  std::string change;
  Trend trend = Trend::kNone;
};

CostChange compare_cost(const std::string& key, const Json& a, const Json& b) {
  const std::string owner = owner_of_cost(key);
  const std::string what =
      key.substr(owner.size() + 1, key.find('.', owner.size() + 1) - owner.size() - 1);
  const bool of_cells = what != "flip_flops" && what != "memory_bits" && what != "sram";
  std::optional<CostFigure> x = cost_figure(a, key), y = cost_figure(b, key);
  if (!x || !y || (of_cells && other_technology(a, b))) return {};
  std::string by;
  // One path is the longest: it is mapped, and has no range, or it is not.
  const bool of_path = what == "ns" || what == "clock_mhz" || what == "frames_per_s";
  const bool other = of_path
                         ? (x->share() > 0) != (y->share() > 0)
                         : (what == "gates" || what == "flip_flops") && other_basis(a, b, owner);
  if (other) {
    // The errors of two estimates of a unit are much the same, those of an estimate and RTL not.
    const double share = std::max(x->share(), y->share());
    const std::string estimate = owner + ".estimate." + what;
    x = cost_figure(a, estimate);
    y = cost_figure(b, estimate);
    if (!x || !y) return {};
    for (CostFigure* one : {&*x, &*y}) {
      one->low = one->value * (1 - share);
      one->high = one->value * (1 + share);
    }
    by = " by estimates";
  }
  CostChange result;
  if (x->value > 0 && y->value > 0 && x->value != y->value)
    result.change = fmt::format("{:+.2f} %{}", 100 * (y->value / x->value - 1), by);
  const bool more_is_better = what == "clock_mhz" || what == "frames_per_s";
  if (x->low <= y->high && y->low <= x->high)
    result.trend = Trend::kEqual;
  else if (what != "estimate" && what != "yardstick_ratio" && what != "run_frames_per_s")
    result.trend = (y->value > x->value) == more_is_better ? Trend::kBetter : Trend::kWorse;
  return result;
}

}  // namespace

bool other_technology(const Json& a, const Json& b) {
  const Json x = value_at(a, "cost.technology"), y = value_at(b, "cost.technology");
  return !x.is_null() && !y.is_null() && x != y;
}

std::string range_text(const Json& result, const std::string& key) {
  const std::optional<CostFigure> figure =
      key.starts_with("cost.") ? cost_figure(result, key) : std::nullopt;
  if (!figure || figure->low == figure->high) return "";
  return fmt::format("{} to {}", tb::rounded(figure->low), tb::rounded(figure->high));
}

std::optional<double> as_number(const Json& value) {
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

std::string value_text(const Json& value) {
  if (value.is_null()) return "-";
  if (value.is_string()) return value.get<std::string>();
  if (tb::is_infinite(value)) return "identical";
  if (value.is_number_float()) {
    const auto number = value.get<double>();
    return std::abs(number) < 1e6 ? fmt::format("{:.6g}", number) : fmt::format("{:.0f}", number);
  }
  return tb::json_text(value);
}

// Parts of a key may contain dots.
Json value_at(const Json& result, const std::string& key) {
  if (!result.is_object()) return nullptr;
  if (const auto whole = result.find(key); whole != result.end()) return *whole;
  for (std::size_t dot = key.find('.'); dot != std::string::npos; dot = key.find('.', dot + 1))
    if (const auto part = result.find(key.substr(0, dot)); part != result.end())
      if (Json found = value_at(*part, key.substr(dot + 1)); !found.is_null()) return found;
  return nullptr;
}

Trend check(const std::string& key, std::optional<double> a, std::optional<double> b,
            const Tolerances& tolerances, std::optional<bool> maximise) {
  Better rule = better_of(key);
  if (rule == Better::kMustBeZero) {
    if (b.value_or(1) != 0) return Trend::kWorse;
    return a.value_or(0) != 0 ? Trend::kBetter : Trend::kEqual;
  }
  if (rule == Better::kBits) a = a.value_or(0), b = b.value_or(0);  // no memory of this kind
  if (rule == Better::kNone && maximise)
    rule = *maximise ? Better::kMoreIsBetter : Better::kLessIsBetter;
  if (rule == Better::kNone || !a) return Trend::kNone;  // nothing to compare with
  return b ? compare_numbers(rule, *a, *b, tolerances) : Trend::kWorse;
}

bool counts(const std::string& key, const Tolerances& tolerances) {
  if (key.starts_with("cost.")) return false;
  return better_of(key) != Better::kBits || tolerances.memory_percent;
}

bool in_decibels(const std::string& key) { return better_of(key) == Better::kDecibel; }

std::string change_of(const std::string& key, std::optional<double> a, std::optional<double> b) {
  if (!a || !b || *a == *b || std::isinf(*a) || std::isinf(*b)) return "";
  if (in_decibels(key)) return fmt::format("{:+.2f} dB", *b - *a);
  return *a == 0 ? "" : fmt::format("{:+.2f} %", 100 * (*b - *a) / std::fabs(*a));
}

Comparison compare(const Json& a, const Json& b, const Tolerances& tolerances) {
  if (a.at("unit") != b.at("unit"))
    throw spec::ConfigError(fmt::format(
        "A is a run of '{}', B of '{}': results of different engines cannot be compared",
        shown_or_dash(&a.at("unit")), shown_or_dash(&b.at("unit"))));
  KeyValues values_a, values_b;
  flatten(a, "", values_a);
  flatten(b, "", values_b);
  KeyValues keys = values_a;
  for (const auto& entry : values_b)
    if (!find(values_a, entry.first)) keys.push_back(entry);

  Comparison comparison;
  for (const auto& [key, unused] : keys) {
    const Json* left = find(values_a, key);
    const Json* right = find(values_b, key);
    const auto x = number_of(left), y = number_of(right);
    ComparedValue value{key,
                        shown_or_dash(left),
                        shown_or_dash(right),
                        change_of(key, x, y),
                        check(key, x, y, tolerances),
                        false};
    if (key.starts_with("cost.")) {
      const CostChange cost = compare_cost(key, a, b);
      value.change = cost.change;
      value.verdict = cost.trend;
    }
    value.worse = value.verdict == Trend::kWorse && counts(key, tolerances);
    if (key == "verdict") value.worse = left && *left == "pass" && (!right || *right != "pass");
    if (key == "verdict" && right && *right == "fail") value.worse = true;
    // A result with a memory that is not implementable is worse than one without.
    if (key.starts_with("not_implementable.")) value.worse = right != nullptr && left == nullptr;
    if (value.worse) value.verdict = Trend::kWorse;
    if (left && right && *left == *right && !value.worse) continue;
    comparison.worse = comparison.worse || value.worse;
    comparison.values.push_back(std::move(value));
  }
  return comparison;
}

std::vector<std::string> different_work(const Json& a, const Json& b) {
  std::vector<std::string> lines;
  const auto inputs = [](const Json& manifest) { return manifest.value("inputs", Json::array()); };
  const std::string different = different_inputs(inputs(a), inputs(b));
  if (!different.empty()) lines.push_back("the inputs differ: " + different);
  const auto look = [&](const std::string& key) {
    const auto value = [&](const Json& manifest) {
      const auto found = manifest.find("configuration");
      return found != manifest.end() && found->is_object() && found->contains(key)
                 ? shown_or_dash(&found->at(key))
                 : std::string("-");
    };
    if (value(a) != value(b))
      lines.push_back(fmt::format("{} differs: A {}, B {}", key, value(a), value(b)));
  };
  const auto reads = [&](const Json& manifest) {
    const Json all = inputs(manifest);
    return std::any_of(all.begin(), all.end(),
                       [](const Json& input) { return !input.contains("role"); });
  };
  // A file may have been moved.
  if (!reads(a) && !reads(b))
    for (const std::string& name : work_parameters(a, b, tb::GivenWork::kSource)) look(name);
  for (const std::string& name : work_parameters(a, b, tb::GivenWork::kSetting)) look(name);
  return lines;
}

}  // namespace deburr::tool
