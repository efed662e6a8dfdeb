// SPDX-License-Identifier: MIT
// Figures of a run by their keys in result.json ("/work/edge_cycles"), and how a run of several
// frames must combine the figures of its frames.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tb/base/forked.h"
#include "tb/env/environment.h"
#include "tb/run/picture_map.h"
#include "tb/run/result.h"

namespace deburr::tb {

using Json = nlohmann::ordered_json;

// The result without the parts that depend on the host.
inline Json json_of(const Simulation& simulation) {
  Result result;
  simulation.collect(result);
  Json json = to_json(result);
  json.erase("host");
  json.erase("meaning");
  return json;
}

// Maps of the run: their values, and whether their sums agree with the counters.
inline Json json_of(const std::vector<PictureMap>& maps) {
  Json all = Json::object();
  for (const PictureMap& map : maps) {
    const bool agrees = !map.account || std::abs(map.account->counted - map.account->mapped) <=
                                            1e-4 * map.account->counted;
    Json& one = all[map.name] = {{"width", map.width},
                                 {"height", map.height},
                                 {"values", Json::array()},
                                 {"account", map.account.has_value()},
                                 {"agrees", agrees}};
    for (const float value : map.values)
      one["values"].push_back(std::isnan(value) ? Json() : Json(value));
  }
  return all;
}

inline double number_at(const Json& run, const std::string& key) {
  const Json::json_pointer at(key);
  EXPECT_TRUE(run.contains(at) && run[at].is_number()) << key;
  return run.contains(at) && run[at].is_number() ? run[at].get<double>() : 0;
}
inline double work(const Json& run, const std::string& name) {
  return number_at(run, "/work/" + name);
}
// Hits of a coverage bin, or of all bins of a group whose name ends in '/'.
inline double hits(const Json& run, const std::string& name) {
  double all = 0;
  bool any = false;
  for (const auto& [bin, count] : run["coverage"]["bins"].items())
    if (name.ends_with('/') ? bin.starts_with(name) : bin == name) {
      all += count.get<double>();
      any = true;
    }
  EXPECT_TRUE(any) << name;
  return all;
}
inline double sum_of(const std::vector<Json>& runs, const std::string& key) {
  double sum = 0;
  for (const Json& run : runs) sum += number_at(run, key);
  return sum;
}

// Compares a run of several frames with runs of each frame on its own, in order. Cycles of a frame
// may differ by `cycles`.
struct SeveralFrames {
  std::set<std::string> from_last{}, largest{};  // figures of `work`; all other counts are sums
  std::set<std::string> by_formula{};            // ratios, which the test computes itself
};
inline void expect_sums(const Json& run, const std::vector<Json>& alone,
                        const SeveralFrames& figures, double cycles = 0) {
  const double in_all = cycles * static_cast<double>(alone.size());
  EXPECT_NEAR(number_at(run, "/cycles"), sum_of(alone, "/cycles"), in_all);
  for (const char* const key : {"/memory/bytes_read", "/memory/bytes_written",
                                "/memory/lines_filled", "/checks/traffic_comparisons"})
    EXPECT_EQ(number_at(run, key), sum_of(alone, key)) << key;
  EXPECT_EQ(number_at(run, "/checks/mismatches"), 0);
  for (const auto& [name, board] : run["scoreboards"].items()) {
    if (name == "status registers" || name == "figures") continue;  // only at the end
    EXPECT_EQ(board["comparisons"], sum_of(alone, "/scoreboards/" + name + "/comparisons")) << name;
  }
  for (const auto& [name, value] : run["work"].items()) {
    const std::string key = "/work/" + name;
    if (figures.from_last.contains(name)) {
      EXPECT_NEAR(value.get<double>(), number_at(alone.back(), key), cycles) << name;
    } else if (figures.largest.contains(name)) {
      double most = 0;
      for (const Json& one : alone) most = std::max(most, number_at(one, key));
      EXPECT_EQ(value, most) << name;
    } else if (!figures.by_formula.contains(name)) {
      EXPECT_TRUE(value.is_number_unsigned()) << name << " is no count";
      EXPECT_EQ(value, sum_of(alone, key)) << name;
    }
  }
  for (const auto& [name, unit] : run["units"].items()) {
    EXPECT_NEAR(unit["busy"].get<double>(), sum_of(alone, "/units/" + name + "/busy"), 2 * in_all)
        << name;
    for (const auto& [cause, stalled] : unit["stalls"].items())
      EXPECT_NEAR(stalled.get<double>(), sum_of(alone, "/units/" + name + "/stalls/" + cause),
                  2 * in_all)
          << name << cause;
  }
  // Hits of merged runs add up; stall bins count cycles. A run lists only the test bins that it
  // hit.
  std::set<std::string> bins;
  for (const Json& one : alone)
    for (const auto& [bin, hits] : one["coverage"]["bins"].items()) bins.insert(bin);
  EXPECT_EQ(run["coverage"]["bins"].size(), bins.size());
  for (const std::string& bin : bins) {
    double hits = 0;
    for (const Json& one : alone) hits += one["coverage"]["bins"].value(bin, 0.0);
    const bool in_cycles = bin.find("/stall/") != std::string::npos || bin.ends_with("/waited-for");
    EXPECT_NEAR(run["coverage"]["bins"].value(bin, 0.0), hits, in_cycles ? 2 * in_all : 0) << bin;
  }
  double count = 0;
  for (const Json& bin : run["latency"]["histogram"]) count += bin["count"].get<double>();
  for (const Json& one : alone)
    for (const Json& bin : one["latency"]["histogram"]) count -= bin["count"].get<double>();
  EXPECT_EQ(count, 0) << "latencies";
}

// The history of a pixel, independent of earlier frames.
inline Json without_cycles(Json pixel) {
  for (Json& step : pixel["steps"]) step.erase("clock");
  return pixel;
}

// Maps of a run of several frames show the last frame; those of one frame must add up to its
// counters.
inline void expect_maps_of_the_last(const Json& run, const Json& alone, int width, int height) {
  for (const auto& [name, map] : alone["maps"].items()) {
    const Json& same = run["maps"][name];
    EXPECT_EQ(same["width"], width) << name;
    EXPECT_EQ(same["height"], height) << name;
    EXPECT_EQ(same["values"], map["values"]) << name;
    EXPECT_EQ(map["account"], true) << name;
    EXPECT_EQ(map["agrees"], true) << name;
    EXPECT_EQ(same["account"], false) << name;
  }
}

}  // namespace deburr::tb
