// SPDX-License-Identifier: MIT
#include "tool/sweep/metric_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "spec/error.h"
#include "tb/base/forked.h"
#include "tb/base/near_matches.h"
#include "tb/run/result.h"
#include "tool/run/engine.h"

namespace deburr::tool {
namespace {

constexpr std::string_view kUnits = "units.*.", kStalls = "stalls.", kValue = ".value";

// One per line. Keys declared by the engine are listed by name.
std::string described_keys(const std::string& name) {
  tb::Result result;
  engine_named(name)->describe_statistics(result);
  std::set<std::string> keys;
  for (const tb::Statistic& statistic : tb::statistics()) {
    const std::string_view key = statistic.name;
    if (!key.starts_with(kUnits)) {
      keys.emplace(key);
      if (key.ends_with(kValue)) keys.emplace(key.substr(0, key.size() - kValue.size()));
      continue;
    }
    const std::string_view figure = key.substr(kUnits.size());
    for (const tb::UnitCycles& unit : result.units) {
      if (!figure.starts_with(kStalls)) {
        keys.insert(fmt::format("units.{}.{}", unit.name, figure));
        continue;
      }
      for (const tb::StallCycles& stall : unit.stalls)
        keys.insert(fmt::format("units.{}.stalls.{}", unit.name, stall.cause));
    }
  }
  for (const tb::WorkItem& item : result.work) keys.insert("work." + item.name);
  std::string lines;
  for (const std::string& key : keys) lines += key + "\n";
  return lines;
}

}  // namespace

std::vector<std::string> result_keys(const std::string& engine) {
  std::istringstream lines(tb::forked_text([&] { return described_keys(engine); }));
  std::vector<std::string> keys;
  for (std::string key; std::getline(lines, key);) keys.push_back(key);
  return keys;
}

bool is_key_of(std::string_view key, std::string_view pattern) {
  const std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return key == pattern;
  if (!key.starts_with(pattern.substr(0, star))) return false;
  const std::string_view rest = pattern.substr(star + 1);
  for (std::size_t end = star + 1; end <= key.size(); ++end)
    if (is_key_of(key.substr(end), rest)) return true;
  return false;
}

void require_known_metrics(const SweepDefinition& sweep) {
  const std::vector<std::string> known = result_keys(sweep.engine);
  for (const Metric& metric : sweep.metrics)
    for (std::string key : metric.keys()) {
      if (key.starts_with('/')) {  // a JSON pointer
        key.erase(0, 1);
        std::replace(key.begin(), key.end(), '/', '.');
      }
      if (std::none_of(known.begin(), known.end(),
                       [&](const std::string& pattern) { return is_key_of(key, pattern); }))
        throw spec::ConfigError(fmt::format("{}: metric '{}': no result of '{}' has the key '{}'{}",
                                            metric.where, metric.name, sweep.engine, key,
                                            tb::did_you_mean(tb::near_matches(key, known))));
    }
}

}  // namespace deburr::tool
