// SPDX-License-Identifier: MIT
// Windows that do not add up are noticed, whatever is wrong with them.
#include "tb/run/windows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "spec/error.h"

namespace deburr::tb::windows_test {
namespace {

using testing::HasSubstr;
using Json = nlohmann::ordered_json;

Json windows() {
  return Json::parse(R"({"cycles": [10, 10, 5], "series": {
    "units": {"filter": {"busy": [4, 3, 5], "idle": [6, 0, 0], "stalls": {"full": [0, 7, 0]}}},
    "work": {"misses": [1, 2, 3]},
    "links": {"texels": {"beats": [4, 4, 4], "occupancy": [5, 6, 7], "most": [1, 2, 2]}},
    "ports": {"port": {"outstanding": [1, 1, 1], "most": [1, 1, 1]}}}})");
}

Json result() {
  return Json::parse(R"({
    "units": {"filter": {"busy": 12, "idle": 6, "stalls": {"full": 7}}},
    "work": {"misses": 6}, "links": {"texels": {"beats": 12, "occupancy": 18, "most": 2}}})");
}

std::string complaint(const Json& of_windows, const Json& of_run) {
  try {
    check_windows(of_windows, of_run);
  } catch (const spec::CheckFailed& error) {
    return error.what();
  }
  return "";
}

TEST(Windows, ThatAddUpPass) { EXPECT_EQ(complaint(windows(), result()), ""); }

TEST(Windows, ALostCycleIsNoticed) {
  Json wrong = windows();
  wrong["series"]["units"]["filter"]["idle"][1] = 1;
  EXPECT_THAT(complaint(wrong, result()),
              HasSubstr("units.filter accounts for 11 of the 10 cycles of window 1"));
  Json last = windows();
  last["cycles"][2] = 6;
  EXPECT_THAT(complaint(last, result()),
              HasSubstr("units.filter accounts for 5 of the 6 cycles of window 2"));
}

TEST(Windows, ASumThatIsNotTheRunsIsNoticed) {
  for (const char* key : {"/series/work/misses/2", "/series/links/texels/beats/0",
                          "/series/links/texels/occupancy/1"}) {
    Json wrong = windows();
    wrong[Json::json_pointer(key)] = 100;
    EXPECT_THAT(complaint(wrong, result()), HasSubstr("over all windows, but the run counted"));
  }
  // From one cause to another: each window is still whole.
  Json wrong = windows();
  wrong["series"]["units"]["filter"]["busy"] = {4, 10, 5};
  wrong["series"]["units"]["filter"]["stalls"]["full"] = {0, 0, 0};
  EXPECT_THAT(complaint(wrong, result()), HasSubstr("units.filter.busy sums up to 19"));
}

// Whichever series, window and unit it is in: every value counts, but for those of windows alone.
TEST(Windows, EveryValueOfEverySeriesCounts) {
  Json two = windows(), run = result();
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
  // Totals count as well: of each kind one that is one off.
  for (const char* const key : {"/units/filter/idle", "/units/address/stalls/wait", "/work/fills",
                                "/links/texels/beats", "/links/texels/occupancy"}) {
    Json wrong = run;
    Json& total = wrong[Json::json_pointer(key)];
    total = total.get<int>() + 1;
    EXPECT_THAT(complaint(two, wrong), HasSubstr("over all windows, but the run counted")) << key;
  }
}

TEST(Windows, AMissingWindowIsNoticed) {
  Json wrong = windows();
  wrong["series"]["work"]["misses"] = {1, 5};
  EXPECT_THAT(complaint(wrong, result()), HasSubstr("work.misses has 2 of 3 windows"));
}

TEST(Windows, WhatTheResultDoesNotHaveIsNoticed) {
  Json without = result();
  without["work"].erase("misses");
  EXPECT_THAT(complaint(windows(), without), HasSubstr("result.json has no work.misses"));
}

}  // namespace
}  // namespace deburr::tb::windows_test
