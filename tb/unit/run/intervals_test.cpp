// SPDX-License-Identifier: MIT
// Sampling intervals whose sums are wrong are detected, for every kind of error.
#include "tb/run/intervals.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "spec/error.h"

namespace deburr::tb::intervals_test {
namespace {

using testing::HasSubstr;
using Json = nlohmann::ordered_json;

Json intervals() {
  return Json::parse(R"({"cycles": [10, 10, 5], "series": {
    "units": {"filter_pipeline": {"busy": [4, 3, 5], "idle": [6, 0, 0], "stalls": {"full": [0, 7, 0]}}},
    "work": {"misses": [1, 2, 3]},
    "links": {"texels": {"beats": [4, 4, 4], "occupancy": [5, 6, 7], "most": [1, 2, 2]}},
    "ports": {"port": {"outstanding": [1, 1, 1], "most": [1, 1, 1]}}}})");
}

Json result() {
  return Json::parse(R"({
    "units": {"filter_pipeline": {"busy": 12, "idle": 6, "stalls": {"full": 7}}},
    "work": {"misses": 6}, "links": {"texels": {"beats": 12, "occupancy": 18, "most": 2}}})");
}

std::string complaint(const Json& of_intervals, const Json& of_run) {
  try {
    check_intervals(of_intervals, of_run);
  } catch (const spec::CheckFailed& error) {
    return error.what();
  }
  return "";
}

TEST(Intervals, CorrectSumsPass) { EXPECT_EQ(complaint(intervals(), result()), ""); }

TEST(Intervals, DetectsLostCycle) {
  Json wrong = intervals();
  wrong["series"]["units"]["filter_pipeline"]["idle"][1] = 1;
  EXPECT_THAT(complaint(wrong, result()),
              HasSubstr("units.filter_pipeline accounts for 11 of the 10 cycles of interval 1"));
  Json last = intervals();
  last["cycles"][2] = 6;
  EXPECT_THAT(complaint(last, result()),
              HasSubstr("units.filter_pipeline accounts for 5 of the 6 cycles of interval 2"));
}

TEST(Intervals, DetectsSumThatDiffersFromRun) {
  for (const char* key : {"/series/work/misses/2", "/series/links/texels/beats/0",
                          "/series/links/texels/occupancy/1"}) {
    Json wrong = intervals();
    wrong[Json::json_pointer(key)] = 100;
    EXPECT_THAT(complaint(wrong, result()), HasSubstr("over all intervals, but the run counted"));
  }
  // Moved from one cause to another: each interval still adds up.
  Json wrong = intervals();
  wrong["series"]["units"]["filter_pipeline"]["busy"] = {4, 10, 5};
  wrong["series"]["units"]["filter_pipeline"]["stalls"]["full"] = {0, 0, 0};
  EXPECT_THAT(complaint(wrong, result()), HasSubstr("units.filter_pipeline.busy adds up to 19"));
}

// In whichever series, interval and unit: every value counts, except values that only intervals
// have.
TEST(Intervals, EveryValueOfEverySeriesCounts) {
  Json two = intervals(), run = result();
  two["series"]["units"]["address"] = {
      {"busy", {10, 0, 5}}, {"idle", {0, 9, 0}}, {"stalls", {{"wait", {0, 1, 0}}}}};
  run["units"]["address"] = {{"busy", 15}, {"idle", 9}, {"stalls", {{"wait", 1}}}};
  two["series"]["work"]["fills"] = {0, 0, 2};
  run["work"]["fills"] = 2;
  ASSERT_EQ(complaint(two, run), "");
  const Json flat = two["series"].flatten();
  int alone = 0;
  for (const auto& [key, value] : flat.items()) {
    Json wrong = two;
    Json& changed = wrong["series"][Json::json_pointer(key)];
    changed = value.get<int>() + 1;
    if (key.starts_with("/ports/") || key.find("/most/") != std::string::npos) {
      EXPECT_EQ(complaint(wrong, run), "") << key;
      ++alone;
    } else {
      EXPECT_NE(complaint(wrong, run), "") << key;
    }
  }
  EXPECT_EQ(alone, 3 + 6);
  // Totals count as well: one value of each kind is off by one.
  for (const char* const key : {"/units/filter_pipeline/idle", "/units/address/stalls/wait",
                                "/work/fills", "/links/texels/beats", "/links/texels/occupancy"}) {
    Json wrong = run;
    Json& total = wrong[Json::json_pointer(key)];
    total = total.get<int>() + 1;
    EXPECT_THAT(complaint(two, wrong), HasSubstr("over all intervals, but the run counted")) << key;
  }
}

TEST(Intervals, DetectsMissingInterval) {
  Json wrong = intervals();
  wrong["series"]["work"]["misses"] = {1, 5};
  EXPECT_THAT(complaint(wrong, result()), HasSubstr("work.misses has 2 values for 3 intervals"));
}

TEST(Intervals, DetectsEntriesMissingInResult) {
  Json without = result();
  without["work"].erase("misses");
  EXPECT_THAT(complaint(intervals(), without), HasSubstr("work.misses is missing in result.json"));
}

}  // namespace
}  // namespace deburr::tb::intervals_test
