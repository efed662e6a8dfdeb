// SPDX-License-Identifier: MIT
// Output of a run: result.json, comparison, report, progress, files.
#include "tb/run/result.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "spec/error.h"
#include "tb/base/file.h"
#include "tb/base/headline.h"
#include "tb/run/amount.h"
#include "tb/run/progress.h"
#include "tb/scene/png.h"
#include "tool/pages/compare.h"
#include "tool/pages/report.h"
#include "tool/pages/run_context.h"

namespace deburr::tool::result_test {

using tb::find_statistic;
using tb::headline;
using tb::Image;
using tb::Progress;
using tb::read_file;
using tb::read_result;
using tb::Result;

namespace {

using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::ordered_json;

tb::MemoryFigures memory(const char* name, const char* kind, std::uint64_t logical,
                         std::uint64_t physical, std::uint64_t at_width) {
  tb::MemoryFigures m;
  m.name = name;
  m.content = "Lines of the cache.";
  m.kind = kind;
  m.words = logical / 64;
  m.word_bits = 64;
  m.ports = "2R1W";
  m.read_latency = 1;
  m.built_as = "2 copies of 1R1W";
  m.copies = physical / logical;
  m.logical_bits = logical;
  m.physical_bits = physical;
  m.logical_bits_at_frame_width = at_width;
  return m;
}

Result sample_result() {
  Result r;
  r.unit = "texture";
  r.verdict = tb::Verdict::kPass;
  r.comparisons = 1000;
  r.cycles = 54321;
  r.clock_mhz = 166.67;
  r.throughput = 0.98;
  r.throughput_bound = 1;
  r.throughput_unit = "bilinear/clk";
  r.latency = {17, 20, 90, 130, 180, {{16, 700}, {32, 200}, {64, 60}, {128, 40}}};
  r.bytes_read = 640000;
  r.lines_filled = 10000;
  r.units = {{"address", 40000, 13000, {{"downstream", "The next unit was not ready.", 1321}}},
             {"cache", 53000, 321, {{"downstream", "", 0}, {"wait_fill", "", 1000}}}};
  r.bottleneck = find_bottleneck(r.units, "cache");
  r.memories = {memory("cache_data", "sram", 131072, 262144, 131072),
                memory("cache_lines", "flops", 5120, 5120, 1280)};
  r.work = {{"fragments", 1000u, "fragment", "Colours </script><script>alert(1)</script>."}};
  r.figures = {{"Fragments", "work.fragments", "a remark"},
               {"Whole run", "cycles", "bound", "work.bound", true}};
  r.work.push_back({"bound", 50000u, "clk", "The least."});
  r.quality = tb::Quality{"supersampled-256",
                          41.25,
                          std::numeric_limits<double>::infinity(),
                          {},
                          35.5,
                          30.25,
                          {},
                          0.0125,
                          0.05,
                          0.9875,
                          0.95};
  r.change = tb::Change{12.5, 3.25, 1.5, 0.5, 38.25};
  r.host_seconds = 0.05;
  return r;
}

// With every optional part of a run.
Result full_result() {
  Result r = sample_result();
  r.verdict = tb::Verdict::kFail;
  r.reason = "3 mismatches";
  r.interrupted = true;
  r.mismatches = 3;
  r.traffic_comparisons = 20;
  r.traffic_mismatches = 1;
  r.scoreboards = {{"colours", 900, 2}, {"lines", 100, 1}};
  r.throughput_bound_meaning = "One a clock.";
  r.bytes_written = 64;
  r.memories[1].high_water = 7;
  r.memories[1].register_bits = 130;
  r.link_bits = {3, 700};
  r.memories[1].not_implementable = "nine ports";
  r.memories[0].reads = 900;
  r.memories[0].writes = 80;
  tb::Cost cost;
  cost.technology = "osu018";
  cost.gates = {900, 1000, 1100};
  cost.flip_flops = 64;
  cost.memory_bits = 4096;
  cost.ns = {4, 5, 6.25};
  cost.clock_mhz = {160, 200, 250};
  cost.frames_per_s = {40, 50, 62.5};
  cost.run_frames_per_s = 45;
  cost.yardstick_ratio = 1.25;
  cost.limited_by = "cache stage 2";
  cost.estimate = {1010, 5.5, 63};
  cost.sram = {{"cacti_45nm", 0.25}};
  cost.units = {
      {"cache", "estimate", {650, 1000, 1350}, 64, 4096, {4, 5, 6.25}, "2", {1000, 5, 64}}};
  r.cost = cost;
  r.links = {{"cache_in", "engine.cache.in", 30, {5, 10, 25}}, {"empty", "engine.empty", 0, {0}}};
  r.maps = {{"samples", "Samples", "sample", "Samples of each pixel.", 1, 16, 48, 12, "the walker"},
            {"nothing", "Nothing", "", "Of no pixel.", 0, 0, 0, 0, ""}};
  r.coverage = {{"footprint/rule/half", 3}, {"footprint/rule/max", 0}};
  r.work.push_back({"unknown", {}, "clk", "Not known of this run."});
  r.work.push_back({"exact", true, "", "A switch."});
  r.work.push_back({"share", 0.5, "line/texel", "A rate."});
  r.notes = {"16 bits made 8"};
  r.first_mismatches = {{"colours", "cycle 812", "pixel (3, 4)", "red", "17", "18"}};
  r.host_cpu_seconds = 0.04;
  return r;
}

// As read_result() returns it.
Json as_read(const Result& result) { return tb::with_infinity(to_json(result)); }

TEST(Headline, JoinsMessageWithoutDetails) {
  EXPECT_EQ(headline("one line"), "one line");
  EXPECT_EQ(headline("no such link; there are:\n  a\n  b\n"), "no such link; there are: a, b");
  EXPECT_EQ(headline("nothing moves\n\nlinks:\n  a 0 of 2\n"), "nothing moves");
  EXPECT_EQ(headline("first,\r\n\tsecond"), "first, second");
  EXPECT_EQ(headline(""), "");
  EXPECT_EQ(headline("\n\ndetails"), "");
}

class Directory : public testing::Test {
 protected:
  Directory() {
    path_ =
        std::filesystem::temp_directory_path() / ("deburr_results_" + std::to_string(::getpid()));
    std::filesystem::create_directories(path_);
  }
  ~Directory() override { std::filesystem::remove_all(path_); }
  std::filesystem::path path_;
};

TEST(ResultJson, KeysFollowSchemaOrder) {
  const Json json = to_json(sample_result());
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  EXPECT_THAT(keys, testing::ElementsAre("schema", "unit", "verdict", "checks", "scoreboards",
                                         "cycles", "clock_mhz", "throughput", "latency", "memory",
                                         "units", "bottleneck", "memories", "memory_bits", "work",
                                         "figures", "quality", "change", "host", "meaning"));
  EXPECT_EQ(json["schema"], 4);
  EXPECT_EQ(json["checks"]["comparisons"], 1000);
  EXPECT_EQ(json["units"]["address"]["stalls"]["downstream"], 1321);
  EXPECT_EQ(json["latency"]["histogram"][1]["count"], 200);
  EXPECT_TRUE(json["quality"]["psnr_silhouette_db"].is_null());
}

// Of a complete result, by hand.
constexpr const char* kFullResult = R"json({
  "schema": 4, "unit": "texture", "verdict": "fail", "reason": "3 mismatches",
  "interrupted": true,
  "checks": {
    "comparisons": 1000, "mismatches": 3, "traffic_comparisons": 20, "traffic_mismatches": 1
  },
  "scoreboards": {
    "colours": {"comparisons": 900, "mismatches": 2},
    "lines": {"comparisons": 100, "mismatches": 1}
  },
  "cycles": 54321, "clock_mhz": 166.67,
  "throughput": {
    "value": 0.98, "unit": "bilinear/clk", "bound": 1.0, "bound_meaning": "One a clock."
  },
  "latency": {
    "unit": "clk", "min": 17, "p50": 20, "p95": 90, "p99": 130, "max": 180,
    "histogram": [
      {"from": 16, "count": 700},
      {"from": 32, "count": 200},
      {"from": 64, "count": 60},
      {"from": 128, "count": 40}
    ]
  },
  "memory": {"bytes_read": 640000, "bytes_written": 64, "read_gb_per_s": 1.96367519007382,
             "written_gb_per_s": 0.00019636751900738202, "lines_filled": 10000},
  "units": {
    "address": {"busy": 40000, "idle": 13000, "stalls": {"downstream": 1321}},
    "cache": {"busy": 53000, "idle": 321, "stalls": {"downstream": 0, "wait_fill": 1000}}
  },
  "bottleneck": {"unit": "cache", "cause": "wait_fill", "cycles": 1000, "meaning": ""},
  "memories": {
    "cache_data": {
      "content": "Lines of the cache.", "kind": "sram", "words": 2048, "word_bits": 64,
      "ports": "2R1W", "read_latency": 1, "built_as": "2 copies of 1R1W", "copies": 2, "banks": 1,
      "logical_bits": 131072, "physical_bits": 262144, "logical_bits_at_frame_width": 131072,
      "reads": 900, "writes": 80
    },
    "cache_lines": {
      "content": "Lines of the cache.", "kind": "flops", "words": 80, "word_bits": 64,
      "ports": "2R1W", "read_latency": 1, "built_as": "2 copies of 1R1W", "copies": 1, "banks": 1,
      "logical_bits": 5120, "physical_bits": 5120, "logical_bits_at_frame_width": 1280,
      "register_bits": 130, "high_water": 7
    }
  },
  "memory_bits": {
    "flops": {"memories": 1, "logical": 5120, "physical": 5120, "logical_at_frame_width": 1280},
    "sram": {
      "memories": 1, "logical": 131072, "physical": 262144, "logical_at_frame_width": 131072
    },
    "total": {
      "memories": 2, "logical": 136192, "physical": 267264, "logical_at_frame_width": 132352
    },
    "registers": {"memories": 1, "logical": 130, "physical": 130, "logical_at_frame_width": 130},
    "links": {"memories": 3, "logical": 700, "physical": 700, "logical_at_frame_width": 700}
  },
  "cost": {
    "technology": "osu018", "gates": {"low": 900.0, "value": 1000.0, "high": 1100.0},
    "flip_flops": 64, "memory_bits": 4096, "ns": {"low": 4.0, "value": 5.0, "high": 6.25},
    "clock_mhz": {"low": 160.0, "value": 200.0, "high": 250.0},
    "frames_per_s": {"low": 40.0, "value": 50.0, "high": 62.5}, "run_frames_per_s": 45.0,
    "yardstick_ratio": 1.25, "limited_by": "cache stage 2",
    "estimate": {"gates": 1010.0, "flip_flops": 63, "ns": 5.5},
    "sram": {"cacti_45nm": {"mm2": 0.25}},
    "units": {
      "cache": {
        "basis": "estimate", "gates": {"low": 650.0, "value": 1000.0, "high": 1350.0},
        "flip_flops": 64, "memory_bits": 4096, "ns": {"low": 4.0, "value": 5.0, "high": 6.25},
        "stage": "2", "estimate": {"gates": 1000.0, "flip_flops": 64, "ns": 5.0}
      }
    }
  },
  "not_implementable": {"cache_lines": "nine ports"},
  "links": {
    "cache_in": {
      "link": "engine.cache.in", "depth": 2, "beats": 30, "occupancy": 60, "mean": 1.5, "most": 2,
      "full_percent": 62.5,
      "histogram": [5, 10, 25]
    },
    "empty": {
      "link": "engine.empty", "depth": 0, "beats": 0, "occupancy": 0, "mean": 0.0, "most": 0,
      "full_percent": 0.0,
      "histogram": [0]
    }
  },
  "maps": {
    "samples": {
      "title": "Samples", "meaning": "Samples of each pixel.", "unit": "sample",
      "picture": "map_samples.png", "values": "map_samples.pfm", "pixels": 12, "min": 1.0,
      "max": 16.0, "mean": 4.0, "sum": 48.0, "checked_against": "the walker"
    },
    "nothing": {
      "title": "Nothing", "meaning": "Of no pixel.", "unit": "", "picture": "map_nothing.png",
      "values": "map_nothing.pfm", "pixels": 0, "min": 0.0, "max": 0.0, "mean": 0.0, "sum": 0.0,
      "checked_against": ""
    }
  },
  "work": {"fragments": 1000, "bound": 50000, "unknown": null, "exact": true, "share": 0.5},
  "notes": ["16 bits made 8"],
  "first_mismatches": [
    {
      "check": "colours", "where": "cycle 812", "item": "pixel (3, 4)", "field": "red",
      "expected": "17", "got": "18"
    }
  ],
  "figures": [
    {"label": "Fragments", "key": "work.fragments", "against": {"label": "a remark"}},
    {
      "label": "Whole run", "key": "cycles",
      "against": {"label": "bound", "key": "work.bound"},
      "tile": true
    }
  ],
  "quality": {
    "reference": "supersampled-256", "psnr_db": 41.25, "psnr_edge_db": null,
    "psnr_silhouette_db": null, "psnr_before_db": 35.5, "psnr_edge_before_db": 30.25,
    "psnr_silhouette_before_db": null,
    "identical": {
      "psnr_db": false, "psnr_edge_db": true, "psnr_silhouette_db": false,
      "psnr_before_db": false, "psnr_edge_before_db": false, "psnr_silhouette_before_db": false
    },
    "flip": 0.0125, "flip_before": 0.05, "ssim": 0.9875, "ssim_before": 0.95
  },
  "change": {
    "over_2_percent": 12.5, "over_16_percent": 3.25,
    "right_over_2_percent": 1.5, "right_over_16_percent": 0.5,
    "psnr_db": 38.25, "identical": {"psnr_db": false}
  },
  "host": {"seconds": 0.05, "mcycles_per_s": 1.08642, "cpu_seconds": 0.04},
  "coverage": {"bins": {"footprint/rule/half": 3, "footprint/rule/max": 0}}
})json";

TEST(ResultJson, MatchesExpectedTextOfFullResult) {
  Json json = to_json(full_result());
  json.erase("meaning");
  EXPECT_EQ(json.dump(1), Json::parse(kFullResult).dump(1));
}

// The order of the file, followed by the values that an engine declares.
TEST(ResultJson, MeaningsFollowTheOrderOfTheFile) {
  const Json json = to_json(full_result());
  std::vector<std::string> paths, meanings, declared;
  const std::function<void(const Json&, const std::string&)> collect =
      [&](const Json& node, const std::string& path) {
        if (!node.is_object() || path == "coverage.bins") {
          (path.starts_with("work.") || path == "coverage.bins" ? declared : paths).push_back(path);
          return;
        }
        for (const auto& [key, value] : node.items())
          if (key != "meaning" || !path.empty())
            collect(value, path.empty() ? key : path + "." + key);
      };
  collect(json, "");
  paths.insert(paths.end(), declared.begin(), declared.end());
  for (const auto& [path, meaning] : json["meaning"].items()) meanings.push_back(path);
  EXPECT_EQ(meanings, paths);
  EXPECT_EQ(json["meaning"]["units.address.stalls.downstream"]["meaning"],
            "The next unit was not ready.");
  EXPECT_EQ(json["meaning"]["work.unknown"],
            (Json{{"unit", "clk"}, {"meaning", "Not known of this run."}}));
}

// The table of keys has exactly the keys of a complete result.
TEST(Statistics, ListTheKeysOfAFullResult) {
  std::set<std::string_view> met;
  Result r = full_result();
  r.pixel = tb::PixelHistory{{3, 4}, "of one fragment", {}};
  r.pixel->compare({.part = "fragment 0",
                    .step = "level",
                    .item = "samples",
                    .golden = "4",
                    .hardware = "2",
                    .clock = 812});
  const Json json = to_json(r);
  for (const auto& [path, meaning] : json["meaning"].items()) {
    const tb::Statistic* s = find_statistic(path);
    if (path.starts_with("work.")) {
      EXPECT_EQ(s, nullptr) << path;
      continue;
    }
    ASSERT_NE(s, nullptr) << path;
    met.insert(s->name);
    EXPECT_EQ(meaning["unit"], s->unit) << path;
    if (path.find(".stalls.") == std::string::npos) {
      EXPECT_EQ(meaning["meaning"], s->meaning) << path;
    }
  }
  for (const tb::Statistic& s : tb::statistics()) EXPECT_TRUE(met.contains(s.name)) << s.name;
  EXPECT_EQ(met.size(), tb::statistics().size()) << "a key is in the table twice";
}

// A value that is not a finite number is null, never a string; a flag gives the reason.
TEST_F(Directory, PsnrOfIdenticalPicturesIsNullInFileAndInfiniteWhenRead) {
  std::ofstream(path_ / "result.json") << to_json(sample_result()).dump();
  const Json quality = Json::parse(read_file(path_ / "result.json", 1 << 20))["quality"];
  EXPECT_EQ(quality["psnr_db"], 41.25);
  EXPECT_TRUE(quality["psnr_edge_db"].is_null());
  EXPECT_EQ(quality["identical"], (Json{{"psnr_db", false},
                                        {"psnr_edge_db", true},
                                        {"psnr_silhouette_db", false},
                                        {"psnr_before_db", false},
                                        {"psnr_edge_before_db", false},
                                        {"psnr_silhouette_before_db", false}}));
  const Json read = read_result(path_);
  EXPECT_TRUE(tb::is_infinite(read["quality"]["psnr_edge_db"]));
  EXPECT_FALSE(tb::is_infinite(read["quality"]["psnr_db"]));
  EXPECT_TRUE(read["quality"]["psnr_silhouette_db"].is_null());
  EXPECT_EQ(read["change"]["psnr_db"], 38.25);
  Result unchanged = sample_result();
  unchanged.change->psnr_db = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(to_json(unchanged)["change"]["psnr_db"].is_null());
  EXPECT_TRUE(tb::is_infinite(as_read(unchanged)["change"]["psnr_db"]));
  EXPECT_EQ(tb::with_infinity(read), read);
  EXPECT_EQ(tb::with_infinity(Json{{"cycles", 1}}), (Json{{"cycles", 1}}));
  EXPECT_EQ(read.dump(), to_json(sample_result()).dump()) << "and null when it is written again";
}

TEST(Results, MemoriesAddUpByKind) {
  Result result = sample_result();
  result.memories[1].register_bits = 130;
  result.link_bits = {3, 700};
  const Json bits = to_json(result)["memory_bits"];
  EXPECT_EQ(bits["sram"]["logical"], 131072);
  EXPECT_EQ(bits["sram"]["physical"], 262144);
  EXPECT_EQ(bits["flops"]["memories"], 1);
  EXPECT_EQ(bits["total"]["memories"], 2);
  EXPECT_EQ(bits["total"]["physical"], 262144 + 5120);
  EXPECT_EQ(bits["total"]["logical_at_frame_width"], 131072 + 1280);
  EXPECT_FALSE(bits.contains("rom")) << "there is none";
  EXPECT_EQ(bits["registers"]["memories"], 1) << "those that have some";
  EXPECT_EQ(bits["registers"]["physical"], 130);
  EXPECT_EQ(bits["links"]["memories"], 3);
  EXPECT_EQ(bits["links"]["logical"], 700);
  EXPECT_FALSE(to_json(sample_result())["memory_bits"].contains("registers")) << "there are none";
}

TEST(Results, UnimplementableMemoryIsNamedEverywhere) {
  Result ideal = sample_result();
  EXPECT_THAT(tb::not_implementable_memories(to_json(ideal)), testing::IsEmpty());
  EXPECT_FALSE(to_json(ideal).contains("not_implementable"));
  ideal.memories[1].not_implementable = "nine ports";
  EXPECT_THAT(tb::not_implementable_memories(to_json(ideal)),
              testing::ElementsAre("cache_lines (nine ports)"));
  const Comparison worse = compare(to_json(sample_result()), to_json(ideal), {});
  EXPECT_TRUE(worse.worse) << "what B counts could not be built";
  EXPECT_FALSE(compare(to_json(ideal), to_json(sample_result()), {}).worse);
  EXPECT_FALSE(compare(to_json(ideal), to_json(ideal), {}).worse) << "it was before";
}

// Every number in the file has a unit and a meaning.
void expect_described(const Json& node, const std::string& path, const Json& meanings) {
  if (node.is_object()) {
    for (const auto& [key, value] : node.items())
      if (key != "meaning")
        expect_described(value, path.empty() ? key : path + "." + key, meanings);
    return;
  }
  EXPECT_TRUE(meanings.contains(path)) << path;
}

TEST(ResultJson, EveryKeyHasUnitAndMeaning) {
  const Json json = to_json(sample_result());
  expect_described(json, "", json["meaning"]);
}

TEST_F(Directory, RejectsIncompleteOrForeignResult) {
  EXPECT_THROW(read_result(path_), spec::FileError);
  const auto reject = [&](const std::string& text) {
    std::ofstream(path_ / "result.json") << text;
    EXPECT_THROW(read_result(path_), spec::FileError) << text;
  };
  reject("");
  reject("{");
  reject("[1]");
  reject(R"({"schema": 4})");
  reject(R"({"schema": 1, "unit": "texture"})");
  Json old = to_json(sample_result());
  old["schema"] = 3;
  reject(old.dump());
  std::ofstream(path_ / "result.json") << to_json(sample_result()).dump();
  EXPECT_EQ(read_result(path_)["cycles"], 54321);
  EXPECT_EQ(read_result(path_ / "result.json")["cycles"], 54321);
}

TEST(Compare, EqualResultsAreNotWorse) {
  const Json a = as_read(sample_result());
  EXPECT_FALSE(compare(a, a, {}).worse);
}

TEST(Compare, EachValueIsComparedInItsDirection) {
  const Json a = as_read(sample_result());
  const auto worse = [&](auto change) {
    Result r = sample_result();
    change(r);
    return compare(a, as_read(r), {}).worse;
  };
  EXPECT_FALSE(worse([](Result& r) { r.cycles = 55000; })) << "within 2 %";
  EXPECT_TRUE(worse([](Result& r) { r.cycles = 56000; }));
  EXPECT_FALSE(worse([](Result& r) { r.cycles = 100; })) << "better";
  EXPECT_TRUE(worse([](Result& r) { r.throughput = 0.9; }));
  EXPECT_TRUE(worse([](Result& r) { r.latency.p99 = 200; }));
  EXPECT_TRUE(worse([](Result& r) { r.bytes_read = 700000; }));
  EXPECT_TRUE(worse([](Result& r) { r.mismatches = 1; }));
  EXPECT_TRUE(worse([](Result& r) { r.traffic_mismatches = 1; }));
  EXPECT_TRUE(worse([](Result& r) { r.verdict = tb::Verdict::kFail; }));
  EXPECT_TRUE(worse([](Result& r) { r.verdict = tb::Verdict::kUnchecked; }));
  EXPECT_TRUE(worse([](Result& r) { r.quality->psnr_db = 41.1; }));
  EXPECT_FALSE(worse([](Result& r) { r.quality->psnr_db = 41.22; }));
  EXPECT_TRUE(worse([](Result& r) { r.quality->psnr_edge_db = 60.0; })) << "identical before";
  EXPECT_FALSE(worse([](Result& r) { r.quality->psnr_db = INFINITY; })) << "identical now";
  EXPECT_TRUE(worse([](Result& r) { r.quality->psnr_edge_db.reset(); })) << "gone";
  EXPECT_TRUE(worse([](Result& r) { r.quality.reset(); })) << "a quality that is gone";
  EXPECT_TRUE(worse([](Result& r) { r.quality->flip = 0.0131; }));
  EXPECT_FALSE(worse([](Result& r) { r.quality->flip = 0.0129; })) << "within 0.0005";
  EXPECT_FALSE(worse([](Result& r) { r.quality->flip = 0.001; })) << "less is better";
  EXPECT_TRUE(worse([](Result& r) { r.quality->ssim = 0.9869; }));
  EXPECT_FALSE(worse([](Result& r) { r.quality->ssim = 0.9871; })) << "within 0.0005";
  EXPECT_FALSE(worse([](Result& r) { r.quality->ssim = 1; }));
  EXPECT_FALSE(worse([](Result& r) { r.change->small_percent = 50; })) << "it may be meant";
  EXPECT_FALSE(worse([](Result& r) { r.host_seconds = 100; })) << "the host is not compared";
}

TEST(Compare, MissingMismatchCountIsWorse) {
  const Json a = as_read(sample_result());
  for (const char* key : {"mismatches", "traffic_mismatches"}) {
    Json b = a;
    b["checks"].erase(key);
    EXPECT_TRUE(compare(a, b, {}).worse) << key;
    EXPECT_FALSE(compare(b, a, {}).worse) << key;
  }
}

TEST(Compare, ListsOnlyDifferentOrWorseValues) {
  const Json a = to_json(sample_result());
  EXPECT_TRUE(compare(a, a, {}).values.empty());
  Result r = sample_result();
  r.cycles += 1;
  std::vector<std::string> keys;
  for (const auto& value : compare(a, to_json(r), {}).values) keys.push_back(value.key);
  EXPECT_THAT(keys, ::testing::ElementsAre("cycles", "memory.read_gb_per_s"));
  r.cycles -= 1;
  r.mismatches = 3;
  const Comparison same = compare(to_json(r), to_json(r), {});
  ASSERT_EQ(same.values.size(), 1u) << "equal, and wrong on both sides";
  EXPECT_TRUE(same.values[0].worse);
  r.unit = "frame";
  EXPECT_THROW(compare(a, to_json(r), {}), spec::ConfigError);
}

TEST(Compare, DifferentWorkIsNamed) {
  const auto manifest = [](const char* hash, int width, double clock, const char* source) {
    return Json{
        {"inputs", *hash ? Json::array({{{"file", "x.png"}, {"sha256", hash}}}) : Json::array()},
        {"parameters",
         {{{"name", "picture.width"}, {"work", "setting"}},
          {{"name", "run.clock_mhz"}, {"work", "setting"}},
          {{"name", "picture.source"}, {"work", "source"}},
          {{"name", "picture.notes"}}}},
        {"configuration",
         {{"picture.width", width},
          {"run.clock_mhz", clock},
          {"picture.source", source},
          {"picture.notes", clock}}}};
  };
  const Json a = manifest("11", 640, 148.5, "x.png"), scene = manifest("", 640, 148.5, "road");
  EXPECT_TRUE(different_work(a, a).empty());
  EXPECT_TRUE(different_work(a, manifest("11", 640, 148.5, "moved/x.png")).empty());
  EXPECT_EQ(different_work(a, manifest("22", 640, 148.5, "x.png")).size(), 1u);
  EXPECT_EQ(different_work(a, manifest("11", 641, 148.5, "x.png")).size(), 1u);
  EXPECT_EQ(different_work(a, manifest("11", 640, 166.67, "x.png")).size(), 1u);
  EXPECT_EQ(different_work(a, scene).size(), 1u);
  EXPECT_EQ(different_work(scene, manifest("", 640, 148.5, "object")).size(), 1u);
  // A parameter that only one of them has.
  Json other = a;
  other["parameters"].push_back({{"name", "picture.count"}, {"work", "setting"}});
  other["configuration"]["picture.count"] = 2;
  for (const auto& lines : {different_work(a, other), different_work(other, a)})
    EXPECT_THAT(lines, ::testing::ElementsAre(::testing::StartsWith("picture.count differs")));
}

TEST_F(Directory, ReportIsSelfContainedAndEscapes) {
  tb::ParameterSet parameters;
  RunContext context(path_, parameters, "deburr run texture --set a='<b>'", 7);
  context.set_title("A <title> & more", "summary");
  context.set_leaves({{"before", "after"}, {}});
  context.claim();
  context.add_image("before", Image(4, 3, {10, 20, 30, 255}), "Before", "");
  context.add_image("after", Image(4, 3, {11, 20, 30, 255}), "After", "");
  context.finish(sample_result());
  const std::string page = read_file(path_ / "report.html", 1 << 24);
  EXPECT_THAT(page, HasSubstr("data:image/png;base64,"));
  EXPECT_THAT(page, HasSubstr("A &lt;title&gt; &amp; more"));
  EXPECT_THAT(page, Not(HasSubstr("</script><script>alert(1)")));
  EXPECT_THAT(page, HasSubstr("\\u003c/script>"));
  EXPECT_THAT(page, HasSubstr("<noscript>"));
  EXPECT_THAT(page, HasSubstr("deburr run texture --set a=&apos;&lt;b&gt;&apos;"));
  EXPECT_THAT(page, HasSubstr("Chart.js v3"));
  // No external resource is loaded: the content policy forbids it, and the page has no external
  // reference.
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  for (const char* reference : {"src=\"http", "href=\"http", "@import", "<link"})
    EXPECT_THAT(page, Not(HasSubstr(reference)));
  // Each chart has a text description, and links in the contents have targets.
  EXPECT_THAT(page, Not(testing::ContainsRegex("<canvas id=\"[a-z-]*\">")));
  // No table is wider than a phone: each is in its own scrolling box.
  const auto count = [&](std::string_view text) {
    std::size_t found = 0;
    for (std::size_t at = page.find(text); at != std::string::npos; at = page.find(text, at + 1))
      ++found;
    return found;
  };
  EXPECT_GT(count("<table"), 5u);
  EXPECT_EQ(count("<table"), count("class=\"scroll\"><table"));
  const std::regex link("href=\"#([a-z-]+)\"");
  std::size_t links = 0;
  for (std::sregex_iterator i(page.begin(), page.end(), link), end; i != end; ++i, ++links)
    EXPECT_THAT(page, HasSubstr("id=\"" + (*i)[1].str() + "\""));
  EXPECT_GE(links, 9u);
  const Json manifest = Json::parse(read_file(path_ / "manifest.json", 1 << 20));
  for (const char* key :
       {"commit", "compiler", "systemc", "command", "seed", "configuration", "inputs", "host"})
    EXPECT_TRUE(manifest.contains(key)) << key;
  // Build type and build options.
  EXPECT_TRUE(manifest["build_type"].is_string());
  EXPECT_TRUE(manifest["build"].is_object());
  for (const auto& entry : std::filesystem::directory_iterator(path_))
    EXPECT_THAT(entry.path().extension().string(), testing::AnyOf(".json", ".html", ".png"));
}

// The page of a result.
class Page : public Directory {
 protected:
  std::string page_of(const Result& result) {
    tb::ParameterSet parameters;
    RunContext context(path_, parameters, "x", 0);
    context.claim();
    context.finish(result);
    return read_file(path_ / "report.html", 1 << 24);
  }
};

TEST_F(Page, ShowsMainFiguresFirst) {
  const std::string page = page_of(sample_result());
  EXPECT_THAT(page, HasSubstr("bound 50,000, +8.6\u00a0%")) << "the tile, against its formula";
  EXPECT_THAT(page, HasSubstr("<td>PSNR, whole frame</td><td class=\"n\">35.50</td>"
                              "<td class=\"n\">41.25</td><td class=\"n\">+5.75</td><td>dB</td>"));
  EXPECT_THAT(page, HasSubstr("<td>FLIP, less is better</td><td class=\"n\">0.0500</td>"
                              "<td class=\"n\">0.0125</td><td class=\"n\">-0.0375</td>"));
  EXPECT_THAT(page, HasSubstr("<td>SSIM</td><td class=\"n\">0.9500</td>"
                              "<td class=\"n\">0.9875</td><td class=\"n\">+0.0375</td>"));
  EXPECT_THAT(page, HasSubstr("<td>Changed by more than 2 codes</td><td class=\"n\">12.50</td>"
                              "<td class=\"n\">1.50</td><td>%</td>"));
  EXPECT_THAT(page, HasSubstr("<td>PSNR to the input</td><td class=\"n\">38.25</td>"));
  EXPECT_THAT(page, HasSubstr("<td class=\"n\">identical</td>"));
  EXPECT_THAT(page, HasSubstr("PSNR, edge pixels</")) << "and not the frame's for want of a number";
  EXPECT_THAT(page, Not(HasSubstr("silhouette pixels"))) << "there was no depth";
  EXPECT_THAT(
      page,
      HasSubstr("<td class=\"name\">cache_<wbr>lines</td><td>flops</td><td class=\"n\">80 x 64</td>"
                "<td>2R1W</td><td class=\"n\">1</td><td>2 copies of 1R1W</td>"
                "<td class=\"n\">1,280</td><td class=\"n\">5,120</td>"));
  EXPECT_THAT(page, HasSubstr("<td>total</td><td class=\"n\">2</td><td class=\"n\">132,352</td>"
                              "<td class=\"n\">136,192</td><td class=\"n\">267,264"));
  EXPECT_THAT(page, HasSubstr("Limited by cache: stalled, wait fill"));
  EXPECT_THAT(page, HasSubstr("<td>a remark</td>"));
  EXPECT_THAT(page, HasSubstr("id=\"latency\""));
}

TEST_F(Page, SaysEqualOnlyForEqualValues) {
  Result r = sample_result();
  r.cycles = 50000;
  EXPECT_THAT(page_of(r), HasSubstr("= bound"));
  ++r.cycles;
  EXPECT_THAT(page_of(r), Not(HasSubstr("= bound")));
}

TEST_F(Page, OmitsHistogramOfOneValue) {
  Result r = sample_result();
  r.latency = {47366, 47366, 47366, 47366, 47366, {{47366, 1000}}};
  const std::string page = page_of(r);
  EXPECT_THAT(page, Not(HasSubstr("id=\"latency\"")));
  EXPECT_THAT(page, HasSubstr("47,366 clk for every transaction"));
}

TEST_F(Page, InterruptedRunShowsComparedPart) {
  Result r = sample_result();
  r.verdict = tb::Verdict::kUnchecked;
  r.interrupted = true;
  const std::string page = page_of(r);
  EXPECT_THAT(page, HasSubstr("of 1,000 comparisons, incomplete"));
  EXPECT_THAT(page, HasSubstr("Incomplete: the run was interrupted"));
  r.comparisons = 0;
  EXPECT_THAT(page_of(r), HasSubstr("not checked against the golden model"));
}

TEST_F(Page, ShowsUnimplementableMemory) {
  EXPECT_THAT(page_of(sample_result()), Not(HasSubstr("cannot be built")));
  Result ideal = sample_result();
  ideal.memories[1].not_implementable = "nine ports";
  const std::string page = page_of(ideal);
  EXPECT_THAT(page, HasSubstr("cannot be built as it is"));
  EXPECT_THAT(page, HasSubstr("cache_lines (nine ports)"));
}

// It is made from the written values, not from the values read back; readers get other types, and
// null.
TEST_F(Page, ReportOfResultEqualsReportOfItsFile) {
  Result result = full_result();
  result.work.push_back({"unbounded", std::numeric_limits<double>::infinity(), "", "No end."});
  result.work.push_back({"undefined", std::numeric_limits<double>::quiet_NaN(), "", "0 / 0."});
  result.work.push_back({"whole", 7.0, "", "Without a fraction."});
  result.throughput = std::numeric_limits<double>::quiet_NaN();
  const std::string page = page_of(result);
  EXPECT_EQ(page, build_report(path_));
}

// The golden model's picture is copied from the hardware model's if they are equal.
TEST_F(Directory, KeepsPicturesApart) {
  tb::ParameterSet parameters;
  RunContext context(path_, parameters, "x", 0);
  context.set_leaves({{"a", "b", "c", "d"}, {}});
  context.claim();
  const Image first(4, 2, {1, 2, 3, 255}), taller(2, 4, {1, 2, 3, 255});
  Image other = first;
  other.pixels[7][1] = 9;
  const std::vector<std::pair<std::string, Image>> all = {
      {"a", first}, {"b", first}, {"c", other}, {"d", taller}};
  for (const auto& [name, image] : all) context.add_image(name, image, "", "");
  context.finish(sample_result());
  for (const auto& [name, image] : all)
    EXPECT_EQ(read_file(path_ / (name + ".png"), 1 << 20), encode_png(image)) << name;
}

// A result.json of an earlier version lacks the newer keys.
TEST_F(Page, AcceptsOlderResult) {
  page_of(sample_result());
  Json json = Json::parse(read_file(path_ / "result.json", 1 << 20));
  for (const char* key : {"bottleneck", "figures"}) json.erase(key);
  json["throughput"].erase("bound_meaning");
  for (const char* key :
       {"psnr_before_db", "psnr_edge_before_db", "flip", "flip_before", "ssim", "ssim_before"})
    json["quality"].erase(key);
  json.erase("change");
  std::ofstream(path_ / "result.json") << json.dump();
  const std::string page = build_report(path_);
  EXPECT_THAT(page, HasSubstr("<td class=\"name\">cache_<wbr>lines</td><td>flops</td>"));
  EXPECT_THAT(page, Not(HasSubstr("Key figures")));
  EXPECT_THAT(page, Not(HasSubstr("FLIP, less is better")));
  EXPECT_THAT(page, Not(HasSubstr("id=\"change\"")));
}

TEST_F(Directory, ManifestCannotIncludeFilesFromElsewhere) {
  tb::ParameterSet parameters;
  RunContext context(path_, parameters, "x", 0);
  context.claim();
  context.finish(sample_result());
  std::ofstream(path_ / "manifest.json") << R"({"images": [{"file": "../../etc/passwd"}]})";
  EXPECT_THROW(build_report(path_), spec::FileError);
  std::ofstream(path_ / "manifest.json") << "[]";
  EXPECT_THROW(build_report(path_), spec::FileError);
}

struct Inputs {
  std::int32_t width = 8;
  std::int64_t error_address = -1;
};
template <class Visitor>
void describe(Inputs& p, Visitor& v) {
  v.integer("width", p.width, 1, 99, "pixel", "Columns.");
  v.is_work("width", tb::GivenWork::kSetting);
  v.integer("error_address", p.error_address, -1, 99, "byte", "Fails.");
}
struct One {
  std::int32_t value = 1;
};
template <class Visitor>
void describe(One& p, Visitor& v) {
  v.integer("value", p.value, 0, 99, "", "One.");
}
struct OfRun {
  bool images = true, maps = false;
  std::int64_t interval_cycles = 0;
};
template <class Visitor>
void describe(OfRun& p, Visitor& v) {
  v.boolean("images", p.images, "Pictures.");
  v.boolean("maps", p.maps, "Maps.");
  v.integer("interval_cycles", p.interval_cycles, 0, 99, "clk", "Windows.");
}

// A run with a parameter of each kind.
class Manifests : public Directory {
 protected:
  Manifests() {
    set_.add("scene", tb::ParameterKind::kInput, inputs_);
    set_.add("rule", tb::ParameterKind::kRule, rule_);
    set_.add("build", tb::ParameterKind::kBuild, build_);
    set_.add("run", tb::ParameterKind::kRun, run_);
  }
  Json manifest(std::uint64_t seed = 5, const std::function<void(RunContext&)>& more = {}) {
    RunContext context(path_ / "out", set_, "deburr run x", seed);
    context.set_quiet(true);
    context.set_title("Title", "Summary");
    context.set_leaves({{"after"}, {"level"}, true});
    context.claim();
    if (more) more(context);
    Result result;
    result.unit = "x";
    result.host_seconds = 2;
    result.cycles = 3'000'000;
    context.finish(result);
    return Json::parse(read_file(path_ / "out/manifest.json", 1 << 20));
  }
  Inputs inputs_;
  One rule_, build_;
  OfRun run_;
  tb::ParameterSet set_;
};

TEST_F(Manifests, DescribeTheRun) {
  set_.set("scene.width", "9", "--set");
  Json json = manifest(5, [](RunContext& context) {
    context.add_note("of the test");
    context.add_image("after", Image(2, 1), "After", "Came out.");
    context.add_map(tb::PictureMap("level", "Level", "level", "Levels.", 2, 2));
    context.add_record("timeline", kTimelineFile, "{}");
  });
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  EXPECT_THAT(keys,
              testing::ElementsAre("schema", "state", "unit", "title", "summary", "command",
                                   "working_directory", "seed", "version", "commit", "model",
                                   "compiler", "build_type", "systemc", "started", "configuration",
                                   "rules", "build", "golden", "inputs", "host", "images",
                                   "pixel_history", "records", "parameters", "files"));
  const auto entry = [](const char* name, const char* kind, const char* value, const char* from,
                        const char* usual, const char* range, const char* unit,
                        const char* meaning) {
    return Json{{"name", name},     {"kind", kind},   {"value", value}, {"from", from},
                {"default", usual}, {"range", range}, {"unit", unit},   {"meaning", meaning}};
  };
  Json width = entry("scene.width", "input", "9", "given", "8", "1..99", "pixel", "Columns.");
  width["work"] = "setting";
  EXPECT_EQ(
      json["parameters"],
      (Json{
          width,
          entry("scene.error_address", "input", "-1", "default", "-1", "-1..99", "byte", "Fails."),
          entry("rule.value", "rule", "1", "default", "1", "0..99", "", "One."),
          entry("build.value", "build", "1", "default", "1", "0..99", "", "One."),
          entry("run.images", "run", "true", "default", "true", "true | false", "", "Pictures."),
          entry("run.maps", "run", "false", "default", "false", "true | false", "", "Maps."),
          entry("run.interval_cycles", "run", "0", "default", "0", "0..99", "clk", "Windows.")}));
  EXPECT_EQ(json["configuration"], set_.resolved());
  EXPECT_EQ(json["rules"], (Json{{"rule.value", 1}}));
  EXPECT_EQ(json["build"], (Json{{"build.value", 1}}));
  EXPECT_EQ(json["host"], (Json{{"seconds", 2.0}, {"mcycles_per_s", 1.5}}));
  EXPECT_EQ(json["records"], (Json{{"timeline", "timeline.json"}}));
  EXPECT_EQ(
      json["images"],
      (Json{
          {{"file", "after.png"}, {"role", "after"}, {"title", "After"}, {"caption", "Came out."}},
          {{"file", "map_level.png"},
           {"role", "map_level"},
           {"title", "Map: Level"},
           {"caption", "Levels. Values in map_level.pfm."}}}));
  EXPECT_EQ(json["files"], (Json{"after.png", "map_level.pfm", "map_level.png", "report.html",
                                 "timeline.json", "result.json"}));
  EXPECT_EQ(json["title"], "Title");
  EXPECT_EQ(json["summary"], "Summary");
  EXPECT_EQ(json["command"], "deburr run x");
  EXPECT_EQ(json["seed"], 5);
  EXPECT_EQ(json["state"], "complete");
  EXPECT_EQ(json["unit"], "x");
  EXPECT_EQ(json["working_directory"], std::filesystem::current_path().string());
  EXPECT_EQ(read_result(path_ / "out")["notes"], Json{"of the test"});
}

// Two runs with the same key have the same golden result.
TEST_F(Manifests, HoldKeyOfGoldenResult) {
  std::set<std::string> keys;
  const auto golden = [&](std::uint64_t seed = 5, const char* text = nullptr) {
    return manifest(seed,
                    [&](RunContext& context) {
                      if (!text) return;
                      std::ofstream(path_ / "in.png") << text;
                      context.add_inputs({path_ / "in.png"});
                      context.add_configuration(path_ / "c.yaml", text);
                    })["golden"]
        .get<std::string>();
  };
  const std::string first = golden();
  keys.insert(first);
  const auto is_new = [&](const std::string& key) { return keys.insert(key).second; };
  build_.value = 2;
  run_.maps = true;
  EXPECT_EQ(golden(), first) << "what changes no pixel";
  build_.value = 1;
  EXPECT_TRUE(is_new(golden(6)));
  EXPECT_TRUE(is_new(golden(5, "one")));
  EXPECT_TRUE(is_new(golden(5, "two")));
  inputs_.width = 7;
  EXPECT_TRUE(is_new(golden()));
  rule_.value = 3;
  EXPECT_TRUE(is_new(golden()));
  inputs_.error_address = 64;  // the failing input depends on build parameters
  EXPECT_TRUE(is_new(golden()));
  build_.value = 2;
  EXPECT_TRUE(is_new(golden()));
  const Json key = golden_dependencies(set_, 9, {"build.value"});
  EXPECT_EQ(key, (Json{{"seed", 9},
                       {"scene.width", 7},
                       {"scene.error_address", 64},
                       {"rule.value", 3},
                       {"build.value", 2}}));
}

// A file of another user is never replaced, whatever parameter requests a file of that name.
TEST_F(Manifests, RunReplacesNoForeignFiles) {
  run_.interval_cycles = 10;
  run_.maps = true;
  for (const char* name : {"result.json", "report.html", "manifest.json", "intervals.json",
                           "map_level.png", "map_level.pfm", "after.png"}) {
    std::filesystem::create_directories(path_ / "out");
    std::ofstream(path_ / "out" / name) << "mine";
    EXPECT_THROW(manifest(), spec::ConfigError) << name;
    std::filesystem::remove_all(path_ / "out");
  }
  run_.images = false;
  const Json json =
      manifest(5, [](RunContext& context) { context.add_image("after", Image(1, 1), "", ""); });
  EXPECT_TRUE(json["images"].empty());
  EXPECT_FALSE(json.contains("records"));
}

TEST_F(Directory, Sha256MatchesContent) {
  EXPECT_EQ(tb::sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  std::ofstream(path_ / "x") << "abc";
  EXPECT_EQ(tb::sha256_of_file(path_ / "x"), tb::sha256("abc"));
  EXPECT_THROW(tb::sha256_of_file(path_ / "missing"), spec::FileError);
  EXPECT_THROW(read_file(path_ / "x", 2), spec::FileError);
  EXPECT_THROW(read_file(path_, 100), spec::FileError);
}

TEST(Progress, ShowsRateAndTimeLeft) {
  EXPECT_EQ(Progress::line("texture", "fragment", 500000, 1000000, 0.25),
            "texture   50 %  2.00 Mfragment/s  0 s left");
  EXPECT_EQ(Progress::line("x", "y", 100, 4000, 10), "x    2 %  10 y/s  6 min 30 s left");
  EXPECT_EQ(Progress::line("x", "y", 10, 10, 1), "x  100 %  10 y/s");
  EXPECT_EQ(Progress::line("x", "y", 0, 10, 0), "x    0 %");
}

TEST(Progress, SlowItemsHaveSecondsPerItemAndFallingEstimate) {
  EXPECT_EQ(Progress::line("x", "y", 2, 6, 15), "x   33 %  7.5 s/y  30 s left");
  EXPECT_EQ(Progress::line("x", "y", 2, 6, 25, 10), "x   33 %  7.5 s/y  20 s left");
  EXPECT_EQ(Progress::line("x", "y", 2, 6, 50, 35), "x   33 %  7.5 s/y") << "overdue";
  EXPECT_EQ(Progress::line("x", "y", 1, 2, 90), "x   50 %  90 s/y  1 min 30 s left");
}

TEST(Progress, ShowsTimesInTwoUnits) {
  const auto left = [](double seconds) {  // of a second hundredth
    return Progress::line("x", "y", 1, 101, seconds / 100);
  };
  EXPECT_EQ(left(59.4), "x    0 %  2 y/s  59 s left");
  EXPECT_EQ(left(59.6), "x    0 %  2 y/s  1 min 00 s left");
  EXPECT_EQ(left(3599.4), "x    0 %  36 s/y  59 min 59 s left");
  EXPECT_EQ(left(3600), "x    0 %  36 s/y  1 h 00 min left");
  EXPECT_EQ(left(7 * 3600 + 5 * 60 + 59), "x    0 %  256 s/y  7 h 05 min left");
  EXPECT_EQ(Progress::line("x", "y", 999, 1000, 1), "x   99 %  999 y/s  0 s left")
      << "not before all are done";
  EXPECT_EQ(Progress::line("x", "y", 1000, 1000, 1), "x  100 %  1.0 ky/s");
  EXPECT_EQ(Progress::line("x", "y", 2345678, 0, 2), "x  100 %  1.17 My/s");
  EXPECT_EQ(Progress::fitted(60, "x", "y", 3, 4, 1, ""),
            "[##################......] x   75 %  3 y/s  0 s left");
  EXPECT_EQ(tb::out_of_cycles(12345, 678, 9000, "pixel"),
            "not done after 12,345 cycles, the limit of --max-cycles (run.max_cycles): 678 of "
            "9,000 pixels are done; raise the limit, or set it to 0 for none");
}

TEST(Progress, FitsEveryTerminal) {
  const auto fitted = [](std::size_t columns) {
    return Progress::fitted(columns, "sweep", "point", 100, 4000, 10,
                            "3 899 queued, 1 running, 99 passed, 1 failed");
  };
  EXPECT_EQ(fitted(119),
            "[........................] sweep    2 %  10 point/s  6 min 30 s left  3 899 queued, 1 "
            "running, 99 passed, 1 failed");
  EXPECT_EQ(fitted(98),
            "[........] sweep    2 %  10 point/s  6 min 30 s left  3 899 queued, 1 running, 99 "
            "passed, 1 failed");
  EXPECT_EQ(fitted(97),
            "sweep    2 %  10 point/s  6 min 30 s left  3 899 queued, 1 running, 99 passed, 1 "
            "failed");
  EXPECT_EQ(fitted(79),
            "sweep    2 %  6 min 30 s left  3 899 queued, 1 running, 99 passed, 1 failed");
  EXPECT_EQ(fitted(60), "sweep    2 %  3 899 queued, 1 running, 99 passed, 1 failed");
  EXPECT_EQ(fitted(50), "sweep    2 %  10 point/s  6 min 30 s left");
  EXPECT_EQ(fitted(39), "sweep    2 %  6 min 30 s left");
  EXPECT_EQ(fitted(20), "sweep    2 %");
  EXPECT_EQ(fitted(3), "swe");
  // A character takes one column whatever its number of bytes, and is never split.
  EXPECT_EQ(Progress::fitted(2, "bürste", "point", 1, 2, 1, ""), "bü");
  EXPECT_EQ(Progress::fitted(10, "bürste", "p", 1, 2, 0, ""), "bürste   5");
}

// A morphological engine takes 37 rows before it delivers a pixel.
TEST(Progress, CountsPixelsTaken) {
  EXPECT_EQ(Progress::done(0, 0), 0u);
  EXPECT_EQ(Progress::done(0, 47360), 23680u);
  EXPECT_EQ(Progress::done(900, 1000), 950u);
  EXPECT_EQ(Progress::done(1000, 1000), 1000u);
  EXPECT_EQ(Progress::done(1000, 0), 1000u);
}

// ---- the bottleneck -----------------------------------------------------------------------------

tb::UnitCycles unit(const std::string& name, std::uint64_t busy,
                    std::vector<std::pair<std::string, std::uint64_t>> stalls = {}) {
  tb::UnitCycles cycles{name, busy, 1000 - busy, {}};
  for (auto& [cause, count] : stalls) {
    cycles.stalls.push_back({cause, "", count});
    cycles.idle -= count;
  }
  return cycles;
}

struct Limited {
  const char* name;
  std::vector<tb::UnitCycles> units;
  std::string unit, cause;
};

TEST(Bottleneck, NamesTheDeepestCauseOfTheLoss) {
  const Limited rows[] = {
      {"nothing stalls: the first of the busiest",
       {unit("slot_sequencer", 999), unit("luma_unit", 1000), unit("blender", 950)},
       "slot_sequencer",
       "busy"},
      {"the divider starts too seldom",
       {unit("slot_sequencer", 460, {{"downstream", 540}}),
        unit("run_extractor", 460, {{"descriptors", 540}}),
        unit("line_unit_h", 276, {{"interval", 385}}),
        unit("line_unit_v", 200, {{"interval", 300}}), unit("blender", 460)},
       "line_unit_h",
       "interval"},
      {"the same, the other axis",
       {unit("run_extractor", 460, {{"descriptors", 540}}),
        unit("line_unit_h", 276, {{"interval", 305}}),
        unit("line_unit_v", 200, {{"interval", 390}}), unit("blender", 460)},
       "line_unit_v",
       "interval"},
      {"a divider that makes descriptors wait, but no slot",
       {unit("slot_sequencer", 999), unit("line_unit_h", 57, {{"interval", 33}}),
        unit("blender", 950)},
       "slot_sequencer",
       "busy"},
      {"descriptors that predictors finish too late",
       {unit("slot_sequencer", 600, {{"downstream", 400}}),
        unit("run_extractor", 600, {{"descriptors", 400}}), unit("endpoint_predictor_h", 700),
        unit("endpoint_predictor_v", 990), unit("line_unit_h", 300)},
       "endpoint_predictor_v",
       "busy"},
      {"memory",
       {unit("luma_unit", 600, {{"downstream", 390}}), unit("pixel_store", 610, {{"memory", 390}})},
       "pixel_store",
       "memory"},
      {"a stall of less than half further down the pipe does not count",
       {unit("luma_unit", 600, {{"downstream", 390}}), unit("pixel_store", 610, {{"memory", 390}}),
        unit("line_unit_h", 700, {{"interval", 194}})},
       "pixel_store",
       "memory"},
      {"a stall of half counts",
       {unit("luma_unit", 600, {{"downstream", 390}}), unit("pixel_store", 610, {{"memory", 390}}),
        unit("line_unit_h", 700, {{"interval", 195}})},
       "line_unit_h",
       "interval"},
      {"only the two axes lie side by side: past one of them",
       {unit("store_h", 610, {{"memory", 390}}), unit("area_unit", 700, {{"memory", 300}})},
       "area_unit",
       "memory"},
      {"and one of them past it",
       {unit("luma_unit", 610, {{"memory", 390}}), unit("store_v", 700, {{"memory", 300}})},
       "store_v",
       "memory"},
      {"one further down that waits for the next is held up by another",
       {unit("luma_unit", 600, {{"downstream", 390}}), unit("pixel_store", 610, {{"memory", 390}}),
        unit("area_unit", 600, {{"downstream", 400}}), unit("blender", 600)},
       "pixel_store",
       "memory"},
      {"no input",
       {unit("slot_sequencer", 610, {{"upstream", 390}}), unit("blender", 610)},
       "slot_sequencer",
       "upstream"},
      {"nobody takes the output",
       {unit("slot_sequencer", 610, {{"downstream", 390}}),
        unit("blender", 610, {{"downstream", 390}})},
       "blender",
       "downstream"}};
  for (Limited row : rows) {
    if (row.units.back().name != "blender") row.units.push_back(unit("blender", 0));
    const auto found = find_bottleneck(row.units, "blender");
    ASSERT_TRUE(found) << row.name;
    EXPECT_EQ(found->unit, row.unit) << row.name;
    EXPECT_EQ(found->cause, row.cause) << row.name;
  }
  EXPECT_FALSE(tb::find_bottleneck({}, "blender"));
  const std::vector<tb::UnitCycles> still = {unit("blender", 0)};
  EXPECT_FALSE(find_bottleneck(still, "blender"));
  EXPECT_THROW(find_bottleneck(still, "luma"), spec::CheckFailed);
}

TEST(Numbers, UseThousandsSeparators) {
  EXPECT_EQ(tb::grouped(0), "0");
  EXPECT_EQ(tb::grouped(999), "999");
  EXPECT_EQ(tb::grouped(1000), "1,000");
  EXPECT_EQ(tb::grouped(1234567), "1,234,567");
}

TEST(Statistics, MostSpecificDescriptionWins) {
  ASSERT_NE(find_statistic("units.address.busy"), nullptr);
  EXPECT_EQ(find_statistic("units.address.busy")->name, "units.*.busy");
  EXPECT_EQ(find_statistic("units.address.stalls.downstream")->name, "units.*.stalls.*");
  EXPECT_EQ(find_statistic("units.address"), nullptr);
  EXPECT_EQ(find_statistic("nothing"), nullptr);
}

}  // namespace
}  // namespace deburr::tool::result_test
