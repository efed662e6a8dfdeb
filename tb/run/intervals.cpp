// SPDX-License-Identifier: MIT
#include "tb/run/intervals.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <vector>

#include "spec/error.h"

namespace deburr::tb {
namespace {

using Json = nlohmann::ordered_json;
using Series = std::map<std::string, std::vector<std::uint64_t>>;

// Collects all series under dotted keys.
void collect(const Json& node, const std::string& key, Series& all) {
  if (node.is_array()) {
    all[key] = node.get<std::vector<std::uint64_t>>();
    return;
  }
  for (const auto& [name, value] : node.items())
    collect(value, key.empty() ? name : fmt::format("{}.{}", key, name), all);
}

const Json* find(const Json& root, const std::string& key) {
  const Json* node = &root;
  for (std::size_t from = 0; from <= key.size();) {
    const std::size_t dot = std::min(key.find('.', from), key.size());
    const auto found = node->find(key.substr(from, dot - from));
    if (found == node->end()) return nullptr;
    node = &*found;
    from = dot + 1;
  }
  return node;
}

}  // namespace

void check_intervals(const Json& intervals, const Json& result) {
  Series all;
  collect(intervals.at("series"), "", all);
  const auto cycles = intervals.at("cycles").get<std::vector<std::uint64_t>>();
  std::map<std::string, std::vector<std::uint64_t>> of_unit;
  for (const auto& [key, values] : all) {
    DEBURR_CHECK(values.size() == cycles.size(),
                 fmt::format("intervals: {} has {} values for {} intervals", key, values.size(),
                             cycles.size()));
    if (!key.starts_with("units.")) continue;
    std::vector<std::uint64_t>& sums = of_unit[key.substr(0, key.find('.', 6))];
    sums.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) sums[i] += values[i];
  }
  for (const auto& [unit, sums] : of_unit)
    for (std::size_t i = 0; i < sums.size(); ++i)
      DEBURR_CHECK(sums[i] == cycles[i],
                   fmt::format("intervals: {} accounts for {} of the {} cycles of interval {}",
                               unit, sums[i], cycles[i], i));
  for (const auto& [key, values] : all) {
    if (key.starts_with("ports.") || key.ends_with(".most")) continue;  // per interval only
    const Json* total = find(result, key);
    DEBURR_CHECK(total != nullptr, fmt::format("intervals: {} is missing in result.json", key));
    const std::uint64_t sum = std::accumulate(values.begin(), values.end(), std::uint64_t{0});
    DEBURR_CHECK(
        *total == sum,
        fmt::format("intervals: {} adds up to {} over all intervals, but the run counted {}", key,
                    sum, total->dump()));
  }
}

std::span<const Statistic> interval_statistics() {
  static constexpr std::array kStatistics = {
      Statistic{"schema", "", "Version of this file's layout."},
      Statistic{"asked_cycles", "clk", "run.interval_cycles."},
      Statistic{"interval_cycles", "clk",
                "Sampling interval; the last one may be shorter. It is asked_cycles, doubled until "
                "at most 1023 intervals cover the run."},
      Statistic{"intervals", "", "Number of intervals: the length of every list below."},
      Statistic{"from", "clk",
                "First cycle of each interval, numbered as in waves and by --trace-from."},
      Statistic{"cycles", "clk", "Cycles of each interval."},
      Statistic{"throughput", "",
                "Throughputs: the series to divide by cycles, unit, and bound (0: none)."},
      Statistic{"series.units.*.busy", "clk", "As in result.json, per interval."},
      Statistic{"series.units.*.idle", "clk", "The same."},
      Statistic{"series.units.*.stalls.*", "clk", "The same, by cause."},
      Statistic{"series.work.*", "",
                "Every counter of result.json that is a sum; not maxima, nor counters that were "
                "cleared during the run."},
      Statistic{"series.links.*.beats", "beat", "Beats written."},
      Statistic{
          "series.links.*.occupancy", "beat x clk",
          "Sum of the number of beats at the end of each cycle; divide by cycles for the mean."},
      Statistic{"series.links.*.most", "beat", "Largest number of beats at the end of a cycle."},
      Statistic{"series.ports.*.outstanding", "transaction x clk",
                "Sum of the transactions in flight at a memory port at the end of each cycle; "
                "divide by cycles for the mean."},
      Statistic{"series.ports.*.most", "transaction",
                "Largest number in flight at the end of a cycle."},
      Statistic{"units", "", "Unit of each series, by key."},
  };
  return kStatistics;
}

}  // namespace deburr::tb
