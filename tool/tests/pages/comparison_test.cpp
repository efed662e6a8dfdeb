// SPDX-License-Identifier: MIT
// Several runs or sweeps compared: which entries are listed and matched, and how values are
// compared.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "spec/error.h"
#include "tb/run/result.h"
#include "tb/scene/image_io.h"
#include "tool/pages/compare.h"
#include "tool/pages/compare_runs.h"
#include "tool/pages/compare_sweeps.h"
#include "tool/pages/comparison_page.h"
#include "tool/tests/pages/page_words.h"

namespace deburr::tool::comparison_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Check, UsesDirectionAndToleranceOfTheValue) {
  const Tolerances t;
  const auto of = [&](const char* key, std::optional<double> a, std::optional<double> b,
                      std::optional<bool> maximise = std::nullopt) {
    return check(key, a, b, t, maximise);
  };
  EXPECT_EQ(of("cycles", 100, 102), Trend::kEqual) << "2 %";
  EXPECT_EQ(of("cycles", 100, 102.1), Trend::kWorse);
  EXPECT_EQ(of("cycles", 100, 98), Trend::kEqual);
  EXPECT_EQ(of("cycles", 100, 97.9), Trend::kBetter);
  EXPECT_EQ(of("throughput.value", 1, 0.9), Trend::kWorse);
  EXPECT_EQ(of("throughput.value", 1, 1.1), Trend::kBetter);
  EXPECT_EQ(of("quality.psnr_db", 40, 39.9), Trend::kWorse);
  EXPECT_EQ(of("quality.psnr_db", 40, 40.04), Trend::kEqual);
  EXPECT_EQ(of("quality.psnr_db", 40, kInfinity), Trend::kBetter);
  EXPECT_EQ(of("quality.psnr_db", kInfinity, kInfinity), Trend::kEqual);
  EXPECT_EQ(of("checks.mismatches", 0, 1), Trend::kWorse);
  EXPECT_EQ(of("checks.mismatches", 1, 1), Trend::kWorse) << "wrong on both sides";
  EXPECT_EQ(of("checks.mismatches", 1, 0), Trend::kBetter);
  EXPECT_EQ(of("checks.mismatches", 0, std::nullopt), Trend::kWorse) << "nobody looked";
  EXPECT_EQ(of("checks.mismatches", std::nullopt, 0), Trend::kEqual);
  EXPECT_EQ(of("memory_bits.total.physical", 100, 101), Trend::kWorse) << "no tolerance";
  EXPECT_EQ(of("memory_bits.rom.physical", std::nullopt, 8), Trend::kWorse);
  EXPECT_EQ(of("memory_bits.rom.physical", 8, std::nullopt), Trend::kBetter);
  EXPECT_EQ(of("memory_bits.total.memories", 1, 2), Trend::kNone);
  EXPECT_EQ(of("work.fragments", 1, 2), Trend::kNone);
  EXPECT_EQ(of("work.fragments", 1, 2, true), Trend::kBetter);
  EXPECT_EQ(of("work.fragments", 1, 2, false), Trend::kWorse);
  EXPECT_EQ(of("cycles", 100, 200, true), Trend::kWorse) << "the key decides";
  EXPECT_EQ(of("cycles", std::nullopt, 200), Trend::kNone);
  EXPECT_EQ(of("cycles", 100, std::nullopt), Trend::kWorse);
  EXPECT_FALSE(counts("memory_bits.total.physical", t));
  EXPECT_TRUE(counts("memory_bits.total.physical", {.memory_percent = 5}));
  EXPECT_TRUE(counts("cycles", t));
  EXPECT_EQ(change_of("cycles", 200, 150), "-25.00 %");
  EXPECT_EQ(change_of("quality.psnr_db", 30, 31.5), "+1.50 dB");
}

// Each key just inside and just outside its tolerance, in both directions.
TEST(Check, EachRuleHasItsDirectionAndTolerance) {
  Tolerances t;
  t.cycles_percent = 10;
  t.throughput_percent = 20;
  t.psnr_db = 0.5;
  t.flip = 0.25;
  t.ssim = 0.125;
  t.memory_percent = 30;
  struct Rule {
    const char* key;
    double fewer, more;  // from 1 up to 2, still equal
    bool less_is_better;
  };
  const Rule rules[] = {{"cycles", 0.9, 1.1, true},
                        {"latency.p50", 0.9, 1.1, true},
                        {"latency.p95", 0.9, 1.1, true},
                        {"latency.p99", 0.9, 1.1, true},
                        {"memory.bytes_read", 0.9, 1.1, true},
                        {"memory.bytes_written", 0.9, 1.1, true},
                        {"memory_bits.sram.logical", 0.7, 1.3, true},
                        {"memory_bits.links.physical", 0.7, 1.3, true},
                        {"throughput.value", 0.8, 1.2, false},
                        {"quality.psnr_db", 0.5, 1.5, false},
                        {"quality.psnr_edge_db", 0.5, 1.5, false},
                        {"quality.psnr_silhouette_db", 0.5, 1.5, false},
                        {"quality.flip", 0.75, 1.25, true},
                        {"quality.ssim", 0.875, 1.125, false}};
  for (const Rule& rule : rules) {
    const auto of = [&](double b) { return check(rule.key, 1, b, t); };
    EXPECT_EQ(of(rule.fewer + 1e-6), Trend::kEqual) << rule.key;
    EXPECT_EQ(of(rule.more - 1e-6), Trend::kEqual) << rule.key;
    EXPECT_EQ(of(rule.fewer - 1e-6), rule.less_is_better ? Trend::kBetter : Trend::kWorse)
        << rule.key;
    EXPECT_EQ(of(rule.more + 1e-6), rule.less_is_better ? Trend::kWorse : Trend::kBetter)
        << rule.key;
    EXPECT_EQ(
        check(rule.key, 1, std::nullopt, t),
        std::string_view(rule.key).starts_with("memory_bits") ? Trend::kBetter : Trend::kWorse)
        << rule.key;
    EXPECT_EQ(in_decibels(rule.key), std::string_view(rule.key).ends_with("_db")) << rule.key;
    EXPECT_TRUE(counts(rule.key, t)) << rule.key;
  }
  for (const char* const key : {"checks.mismatches", "checks.traffic_mismatches"}) {
    EXPECT_EQ(check(key, 0, 1, t), Trend::kWorse) << key;
    EXPECT_EQ(check(key, 2, 0, t), Trend::kBetter) << key;
    EXPECT_EQ(check(key, 3, 2, t), Trend::kWorse) << key;
  }
  for (const char* const key :
       {"checks.comparisons", "latency.min", "latency.max", "memory.lines_filled",
        "memory_bits.sram.memories", "quality.psnr_before_db", "throughput.bound", "clock_mhz"}) {
    EXPECT_EQ(check(key, 1, 2, t), Trend::kNone) << key;
    EXPECT_EQ(check(key, 1, std::nullopt, t), Trend::kNone) << key;
  }
}

TEST(Comparing, FormatsChanges) {
  EXPECT_EQ(change_of("cycles", 100, 103.2), "+3.20 %");
  EXPECT_EQ(change_of("cycles", -4, -5), "-25.00 %") << "of its size";
  EXPECT_EQ(change_of("cycles", 4, 4), "");
  EXPECT_EQ(change_of("cycles", 0, 4), "");
  EXPECT_EQ(change_of("cycles", std::nullopt, 4), "");
  EXPECT_EQ(change_of("cycles", 4, std::nullopt), "");
  EXPECT_EQ(change_of("quality.psnr_edge_db", 0, -0.25), "-0.25 dB");
  EXPECT_EQ(change_of("quality.psnr_db", kInfinity, 30), "");
  EXPECT_EQ(change_of("quality.psnr_db", 30, kInfinity), "");
  EXPECT_EQ(value_text(Json(1234567)), "1234567");
  EXPECT_EQ(value_text(Json(0.1234567)), "0.123457");
  EXPECT_EQ(value_text(Json(kInfinity)), "identical");
  EXPECT_EQ(value_text(Json("text")), "text");
  EXPECT_EQ(value_text(Json()), "-");
  EXPECT_EQ(value_text(Json(true)), "true");
}

// Parts of a key may contain dots, and the first matching path may not lead to a value.
TEST(Comparing, FindsValueUnderDottedKey) {
  const Json result = {
      {"a", {{"b", 1}, {"c", nullptr}}}, {"a.b", {{"c", 2}}}, {"a.b.d", 3}, {"list", {1, 2}}};
  EXPECT_EQ(value_at(result, "a.b"), Json({{"c", 2}})) << "the whole name first";
  EXPECT_EQ(value_at(result, "a.b.c"), 2);
  EXPECT_EQ(value_at(result, "a.b.d"), 3);
  EXPECT_TRUE(value_at(result, "a.c").is_null());
  EXPECT_TRUE(value_at(result, "a.x").is_null());
  EXPECT_TRUE(value_at(result, "list.0").is_null());
}

class Directory : public testing::Test {
 protected:
  Directory()
      : path_(fs::temp_directory_path() / ("deburr_comparison_" + std::to_string(::getpid()))) {
    fs::create_directories(path_);
  }
  ~Directory() override { fs::remove_all(path_); }

  void put(const fs::path& file, const std::string& text) const {
    fs::create_directories((path_ / file).parent_path());
    std::ofstream(path_ / file) << text;
  }
  std::vector<fs::path> paths(std::initializer_list<const char*> names) const {
    std::vector<fs::path> all;
    for (const char* name : names) all.push_back(path_ / name);
    return all;
  }

  fs::path path_;
};

// ---- cost ---------------------------------------------------------------------------------------

// A result whose only unit has these gates, +-share, and takes as many ps.
Json with_cost(double gates, double share, const char* basis, double estimate) {
  tb::Result r;
  r.unit = "texture";
  r.cycles = 1000;
  tb::Cost cost;
  cost.technology = "osu018";
  cost.gates = {gates * (1 - share), gates, gates * (1 + share)};
  cost.ns = {gates * (1 - share) / 1000, gates / 1000, gates * (1 + share) / 1000};
  cost.clock_mhz = {1000 / cost.ns.high, 1000 / cost.ns.value, 1000 / cost.ns.low};
  cost.flip_flops = static_cast<std::uint64_t>(gates);
  cost.estimate = {estimate, estimate / 1000, static_cast<std::uint64_t>(estimate)};
  cost.units = {{"cache", basis, cost.gates, cost.flip_flops, 0, cost.ns, "to out", cost.estimate}};
  r.cost = cost;
  return to_json(r);
}

ComparedValue compared(const Json& a, const Json& b, const std::string& key) {
  const Comparison all = compare(a, b, {});
  EXPECT_FALSE(all.worse) << "cost is not a fault";
  for (const ComparedValue& value : all.values)
    if (value.key == key) return value;
  return {key, "", "", "not listed", Trend::kNone, false};
}

TEST(Comparing, CostIsJudgedWhereRangesAreApart) {
  const Json a = with_cost(1000, 0.04, "estimate", 1000);
  for (const char* owner : {"cost", "cost.units.cache"}) {
    const auto key = [&](const char* what) { return fmt::format("{}.{}", owner, what); };
    for (const auto& [gates, change, trend] : {std::tuple(1100.0, "+10.00 %", Trend::kWorse),
                                               {900.0, "-10.00 %", Trend::kBetter},
                                               {1080.0, "+8.00 %", Trend::kEqual},
                                               {930.0, "-7.00 %", Trend::kEqual}})
      for (const char* what : {"gates.value", "ns.value"}) {
        const ComparedValue value =
            compared(a, with_cost(gates, 0.04, "estimate", gates), key(what));
        EXPECT_EQ(value.change, change) << what;
        EXPECT_EQ(value.verdict, trend) << what << " " << change;
      }
  }
  const Json large = with_cost(1250, 0.04, "estimate", 1250);
  EXPECT_EQ(compared(a, large, "cost.clock_mhz.value").verdict, Trend::kWorse);
  EXPECT_EQ(compared(a, large, "cost.clock_mhz.value").change, "-20.00 %");
  EXPECT_EQ(compared(a, large, "cost.flip_flops").verdict, Trend::kWorse);
  EXPECT_EQ(compared(a, large, "cost.gates.low").change, "not listed");
}

TEST(Comparing, CostOfMappedAndEstimatedUnitIsComparedByEstimates) {
  const Json mapped = with_cost(1000, 0, "mapped", 1250),
             estimated = with_cost(1500, 0.3, "estimate", 1500);
  for (const char* key : {"cost.gates.value", "cost.ns.value", "cost.units.cache.gates.value"}) {
    const ComparedValue value = compared(mapped, estimated, key);
    EXPECT_EQ(value.change, "+20.00 % by estimates") << key;
    EXPECT_EQ(value.verdict, Trend::kEqual) << key << " ranges of 30 %";
  }
  EXPECT_EQ(compared(mapped, with_cost(2500, 0.3, "estimate", 2500), "cost.gates.value").verdict,
            Trend::kWorse);
  EXPECT_EQ(compared(mapped, estimated, "cost.clock_mhz.value").change, "");
}

TEST(Comparing, CostOfOtherStandardCellsIsNotCompared) {
  const Json a = with_cost(1000, 0, "estimate", 1000);
  Json b = with_cost(2000, 0, "estimate", 2000);
  EXPECT_FALSE(other_technology(a, b));
  b["cost"]["technology"] = "sky130";
  EXPECT_TRUE(other_technology(a, b));
  for (const char* key : {"cost.gates.value", "cost.ns.value", "cost.clock_mhz.value",
                          "cost.units.cache.ns.value", "cost.estimate.ns"}) {
    EXPECT_EQ(compared(a, b, key).change, "") << key;
    EXPECT_EQ(compared(a, b, key).verdict, Trend::kNone) << key;
  }
  EXPECT_EQ(compared(a, b, "cost.flip_flops").change, "+100.00 %") << "in every technology";
}

// ---- runs ---------------------------------------------------------------------------------------

class Runs : public Directory {
 protected:
  Json leave(const char* name, std::uint64_t cycles, const char* ways, std::uint64_t bits = 512) {
    tb::Result r;
    r.unit = "texture";
    r.verdict = tb::Verdict::kPass;
    r.cycles = cycles;
    r.throughput_unit = "bilinear/clk";
    r.throughput = 1;
    tb::MemoryFigures memory;
    memory.name = "cache";
    memory.kind = "sram";
    memory.logical_bits = memory.physical_bits = bits;
    r.memories = {memory};
    r.work = {{"hits", cycles / 2, "line", "Hits <b>."}};
    r.figures = {{"Hits", "work.hits"}};
    put(fs::path(name) / "result.json", to_json(r).dump());
    const auto parameter = [](const char* key, const char* value) {
      return Json{{"name", key},  {"kind", "build"}, {"value", value},    {"default", "2"},
                  {"range", "1"}, {"unit", "way"},   {"meaning", "Ways."}};
    };
    const Json manifest = {
        {"title", name},
        {"summary", "s"},
        {"command", "deburr run texture"},
        {"inputs", Json::array()},
        {"configuration", {{"scene.width", 8}}},
        {"images", Json::array({{{"file", "after.png"}, {"role", "after"}, {"title", "After"}}})},
        {"parameters",
         Json::array({parameter("texture.cache.ways", ways), parameter("scene.width", "8")})}};
    put(fs::path(name) / "manifest.json", manifest.dump());
    write_image(path_ / name / "after.png", tb::Image(4, 4));
    return manifest;
  }
};

TEST_F(Runs, ListDifferencesFromTheFirst) {
  leave("a", 1000, "2");
  leave("b", 900, "4", 1024);
  leave("c", 1100, "2");
  const Json all = compare_runs(paths({"a", "b/result.json", "c"}), {});
  EXPECT_TRUE(all["worse"]);
  EXPECT_TRUE(all["warnings"].empty());
  ASSERT_EQ(all["runs"].size(), 3u);
  EXPECT_EQ(all["runs"][2]["name"], "C");
  ASSERT_EQ(all["parameters"].size(), 1u);
  EXPECT_EQ(all["parameters"][0]["name"], "texture.cache.ways");
  EXPECT_EQ(all["parameters"][0]["values"], (Json{"2", "4", "2"}));
  const auto row = [&](const char* list, const std::string& key) -> Json {
    for (const Json& entry : all[list])
      if (entry["key"] == key) return entry;
    return nullptr;
  };
  const Json cycles = row("values", "cycles");
  EXPECT_EQ(cycles["unit"], "clk");
  EXPECT_EQ(cycles["cells"][1]["judgement"], "better");
  EXPECT_EQ(cycles["cells"][1]["change"], "-10.00 %");
  EXPECT_EQ(cycles["cells"][2]["judgement"], "worse");
  EXPECT_TRUE(cycles["cells"][2]["worse"]);
  const Json bits = row("figures", "memory_bits.total.physical");
  EXPECT_EQ(bits["cells"][1]["judgement"], "worse");
  EXPECT_FALSE(bits["cells"][1]["worse"]) << "its cost is not a fault";
  EXPECT_EQ(bits["cells"][2]["judgement"], "equal");
  EXPECT_EQ(row("figures", "throughput.value")["unit"], "bilinear/clk");
  EXPECT_EQ(row("figures", "work.hits")["cells"][1]["judgement"], "") << "no direction";
  EXPECT_TRUE(row("values", "throughput.value").is_null()) << "equal everywhere";
  EXPECT_FALSE(compare_runs(paths({"a", "b"}), {})["worse"]);
  EXPECT_TRUE(compare_runs(paths({"a", "b"}), {.memory_percent = 50})["worse"]);
  EXPECT_FALSE(compare_runs(paths({"a", "b"}), {.memory_percent = 100})["worse"]);
}

// Notes for the reader, in addition to the figures.
TEST_F(Runs, DescribeRunsAndWarnings) {
  const auto changed = [&](const char* name, const std::function<void(Json&, Json&)>& change) {
    Json manifest = leave(name, 1000, "2");
    Json result = Json::parse(std::ifstream(path_ / name / "result.json"));
    change(result, manifest);
    put(fs::path(name) / "result.json", result.dump());
    put(fs::path(name) / "manifest.json", manifest.dump());
  };
  changed("a", [](Json&, Json& manifest) {
    manifest["parameters"].push_back({{"name", "only.a"}, {"value", "1"}});
  });
  changed("b", [](Json& result, Json& manifest) {
    result["interrupted"] = true;
    result["not_implementable"] = {{"cache", "nine ports"}};
    manifest["commit"] = "abc";
  });
  changed("c", [](Json&, Json& manifest) {
    for (Json& parameter : manifest["parameters"])
      if (parameter["name"] == "scene.width") parameter["work"] = "setting";
    manifest["configuration"]["scene.width"] = 9;
  });
  leave("d", 1000, "2");
  fs::remove(path_ / "d/manifest.json");
  const Json all = compare_runs(paths({"a", "b", "c", "d/result.json"}), {});
  EXPECT_EQ(all["warnings"], (Json{"B is not implementable: memory cache (nine ports)",
                                   "B was interrupted: its figures cover only the completed part",
                                   "scene.width differs: A 8, B 9 (B is C here)"}));
  EXPECT_EQ(all["runs"][1],
            (Json{{"name", "B"},
                  {"path", (path_ / "b").string()},
                  {"verdict", "pass"},
                  {"interrupted", true},
                  {"title", "b"},
                  {"summary", "s"},
                  {"command", "deburr run texture"},
                  {"commit", "abc"},
                  {"images",
                   Json::array({{{"file", "after.png"}, {"role", "after"}, {"title", "After"}}})},
                  {"folder", (path_ / "b").string()}}));
  EXPECT_EQ(all["runs"][3], (Json{{"name", "D"},
                                  {"path", (path_ / "d/result.json").string()},
                                  {"verdict", "pass"},
                                  {"interrupted", false},
                                  {"title", nullptr},
                                  {"summary", nullptr},
                                  {"command", nullptr},
                                  {"commit", nullptr},
                                  {"images", nullptr},
                                  {"folder", (path_ / "d").string()}}));
  ASSERT_EQ(all["parameters"].size(), 1u) << "nothing is known of D";
  EXPECT_EQ(all["parameters"][0], (Json{{"name", "only.a"},
                                        {"kind", ""},
                                        {"unit", ""},
                                        {"meaning", ""},
                                        {"values", {"1", "-", "-", "?"}}}));
  std::vector<std::string> figures;
  for (const Json& figure : all["figures"])
    figures.push_back(figure["label"].get<std::string>() + " " + figure["key"].get<std::string>());
  EXPECT_THAT(figures,
              ElementsAre("Verdict verdict", "Cycles cycles", "Throughput throughput.value",
                          "Latency p50 latency.p50", "Latency p99 latency.p99",
                          "Bytes read memory.bytes_read", "Bytes written memory.bytes_written",
                          "Memory, physical memory_bits.total.physical", "Hits work.hits"));
  EXPECT_EQ(all["kind"], "runs");
  EXPECT_EQ(all["engine"], "texture");
  try {
    changed("b", [](Json& result, Json&) { result["unit"] = "frame"; });
    compare_runs(paths({"a", "b"}), {});
    ADD_FAILURE();
  } catch (const spec::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("A is a run of 'texture', B of 'frame'"));
  }
}

TEST_F(Runs, CostHasItsRangeAndItsNote) {
  const auto put_cost = [&](const char* name, double gates, const char* technology) {
    leave(name, 1000, "2");
    Json result = tb::read_result(path_ / name);
    result["cost"] = with_cost(gates, 0.1, "estimate", gates)["cost"];
    result["cost"]["technology"] = technology;
    put(fs::path(name) / "result.json", result.dump());
  };
  put_cost("a", 1000, "osu018");
  put_cost("b", 1500, "osu018");
  put_cost("c", 1500, "sky130");
  const Json all = compare_runs(paths({"a", "b", "c"}), {});
  EXPECT_FALSE(all["worse"]);
  EXPECT_EQ(all["warnings"],
            Json{"the standard cells differ: A osu018, C sky130: gates and ns are not compared"});
  for (const Json& figure : all["figures"])
    if (figure["key"] == "cost.gates.value") {
      EXPECT_EQ(figure["label"], "Gates");
      EXPECT_EQ(figure["cells"][1]["range"], "1,350 to 1,650");
      EXPECT_EQ(figure["cells"][1]["judgement"], "worse");
      EXPECT_EQ(figure["cells"][2]["change"], "");
      EXPECT_EQ(figure["cells"][2]["judgement"], "");
    }
  const std::string page = comparison_page(all);
  EXPECT_THAT(page, HasSubstr("<small>1,350 to 1,650</small><small>+50.00 %</small>"));
  EXPECT_THAT(page, HasSubstr("the change is that of the estimates of both"));
}

TEST(Comparing, FailedRunIsWorseThanPassedRun) {
  tb::Result r;
  r.unit = "texture";
  r.verdict = tb::Verdict::kPass;
  const Json passed = to_json(r);
  r.verdict = tb::Verdict::kFail;
  const Json failed = to_json(r);
  EXPECT_FALSE(compare(passed, passed, {}).worse);
  EXPECT_FALSE(compare(failed, passed, {}).worse);
  EXPECT_TRUE(compare(passed, failed, {}).worse);
  EXPECT_TRUE(compare(failed, failed, {}).worse) << "wrong on both sides";
}

TEST_F(Runs, IdenticalPictureIsLabelled) {
  for (const auto& [name, psnr] :
       {std::pair{"a", 40.0}, std::pair{"b", kInfinity}, std::pair{"c", kInfinity}}) {
    leave(name, 1000, "2");
    Json result = tb::read_result(path_ / name);
    result["quality"] = {{"psnr_db", psnr}, {"identical", {{"psnr_db", psnr > 100}}}};
    put(fs::path(name) / "result.json", result.dump());
  }
  const Json all = compare_runs(paths({"a", "b", "c"}), {});
  EXPECT_FALSE(all["worse"]);
  ASSERT_EQ(all["values"].size(), 1u);
  const Json cells = all["values"][0]["cells"];
  EXPECT_EQ(all["values"][0]["key"], "quality.psnr_db");
  EXPECT_EQ(cells[0]["value"], 40.0);
  EXPECT_FALSE(cells[0].contains("identical"));
  for (const int better : {1, 2}) {
    EXPECT_EQ(cells[better], (Json{{"value", nullptr},
                                   {"text", "identical"},
                                   {"identical", true},
                                   {"change", ""},
                                   {"judgement", "better"},
                                   {"worse", false}}));
  }
  EXPECT_THAT(comparison_page(all), HasSubstr("identical"));
  EXPECT_THAT(all.dump(), Not(HasSubstr("inf\"")));
  EXPECT_TRUE(compare_runs(paths({"b", "a"}), {})["worse"]);
  EXPECT_TRUE(compare_runs(paths({"b", "c"}), {})["values"].empty());
}

TEST_F(Runs, ParametersWithoutEffectAreNotListed) {
  const auto values = [&](bool in_a, bool in_b) {
    for (const auto& [name, ways, effect] :
         {std::tuple("a", "2", in_a), std::tuple("b", "4", in_b)}) {
      Json manifest = leave(name, 1000, ways);
      if (!effect) manifest["parameters"][0]["effect"] = false;
      put(fs::path(name) / "manifest.json", manifest.dump());
    }
    const Json all = compare_runs(paths({"a", "b"}), {})["parameters"];
    return all.empty() ? Json() : all[0]["values"];
  };
  EXPECT_EQ(values(true, true), (Json{"2", "4"}));
  EXPECT_EQ(values(true, false), (Json{"2", "no effect"}));
  EXPECT_EQ(values(false, false), Json());
}

TEST_F(Runs, PageIsSelfContainedAndEscapes) {
  leave("a", 1000, "2");
  leave("b", 900, "<4>", 1024);
  const std::string page = comparison_page(compare_runs(paths({"a", "b"}), {}));
  EXPECT_THAT(page, HasSubstr("&lt;4&gt;"));
  EXPECT_THAT(page, HasSubstr("Hits &lt;b&gt;."));
  EXPECT_THAT(page, HasSubstr("<b>Better:</b> Cycles -10.00 %"));
  EXPECT_THAT(page, HasSubstr("<b>Worse:</b> nothing</p><p><b>Higher cost, not judged:</b> Memory, "
                              "physical +"));
  EXPECT_THAT(page, HasSubstr("data:image/png;base64,"));
  EXPECT_THAT(page, HasSubstr("nothing is worse"));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  EXPECT_THAT(page, Not(HasSubstr("{{")));
  for (const char* reference : {"src=\"http", "href=\"http", "@import", "<link"})
    EXPECT_THAT(page, Not(HasSubstr(reference)));
}

// Three runs whose rows have one cell of each kind, compared with the exact text.
TEST_F(Runs, PageShowsEveryKindOfCell) {
  const auto cell = [](const Json& value, const char* change, const char* judgement,
                       bool worse = false) {
    return Json{{"value", value},
                {"text", value_text(value)},
                {"change", change},
                {"judgement", judgement},
                {"worse", worse}};
  };
  const auto run = [&](const char* name, const Json& images) {
    return Json{{"name", name},
                {"path", std::string("out/") + name + "run"},
                {"verdict", "pass"},
                {"title", std::string("Title ") + name},
                {"summary", "of it"},
                {"command", std::string("deburr run ") + name},
                {"folder", path_.string()},
                {"images", images}};
  };
  const auto image = [](const char* role, const char* title) {
    return Json{
        {"file", std::string(role) + ".png"}, {"role", role}, {"title", title}, {"caption", "c"}};
  };
  for (const char* name : {"before.png", "after.png"}) write_image(path_ / name, tb::Image(2, 2));
  Json same = cell(nullptr, "", "better");
  same["identical"] = true;
  same["text"] = "identical";
  const Json all = {
      {"kind", "runs"},
      {"engine", "texture"},
      {"worse", true},
      {"warnings", {"Look."}},
      {"runs",
       {run("A", Json::array({image("before", "Before"), image("after", "After")})),
        run("B", Json::array({image("after", "Later")})), run("C", nullptr)}},
      {"parameters",
       {{{"name", "ways"}, {"unit", "way"}, {"meaning", "Ways."}, {"values", {"2", "4", "2"}}}}},
      {"figures",
       {{{"key", "cycles"},
         {"label", "Cycles"},
         {"unit", "clk"},
         {"meaning", "All."},
         {"cells",
          {cell(1000, "", ""), cell(800, "-20.00 %", "better"),
           cell(1250, "+25.00 %", "worse", true)}}},
        {{"key", "quality.psnr_db"},
         {"label", "PSNR"},
         {"unit", "dB"},
         {"meaning", "Peak."},
         {"cells", {cell(30.5, "", ""), same, cell(20.25, "-10.25 dB", "worse", true)}}},
        {{"key", "work.rate"},
         {"label", "Rate"},
         {"unit", ""},
         {"meaning", "R."},
         {"cells", {cell(-2.5, "", ""), cell(nullptr, "", ""), cell(1234.567, "", "equal")}}}}},
      {"values",
       {{{"key", "work.rate"},
         {"unit", "u"},
         {"meaning", "R."},
         {"cells", {cell("a", "", ""), cell(true, "", ""), cell(12345, "x", "")}}}}}};
  EXPECT_EQ(words(comparison_page(all)), R"page(
Deburr &middot;
comparison of runs · texture
Arun, Brun, Crun|badge fail|worse
Look.
Parameters|Figures|Pictures|Values|Commands
Directory|Title
A|out/Arun|baseline|Title A|of it
B|out/Brun|Title B|of it
C|out/Crun|Title C|of it
--columns: 2
B against A
better|Better:|Cycles -20.00 %, PSNR
worse|Worse:|nothing
C against A
better|Better:|nothing
worse|Worse:|Cycles +25.00 %, PSNR -10.25 dB
Different parameters
Parameter|A|B|C|Unit|Meaning
ways|2|other|4|2|way|Ways.
Figures
Figure|A|B|C|Unit|Meaning
Cycles|1,000|width: 80.0%|better|800|-20.00 %|width: 64.0%|worse fails|1,250|+25.00 %|width: 100.0%|clk|All.
PSNR|30.5|better|identical|worse fails|20.25|-10.25 dB|dB|Peak.
Rate|-2.5|width: 0.2%|-|equal|1,234.6|width: 100.0%|R.
Green is better and red is worse than A by more than the tolerance, bold where it fails the comparison;
bars are relative to the row's largest value.
Pictures
Show|Later|Before
difference from A, 8 times
Wheel:
zoom all pictures together.
Double click:
whole picture.
Later
A|c
B|c
C|has no such picture.
Before
A|c
B|has no such picture.
C|has no such picture.
All different values
1 values
Value|A|B|C|Unit|Meaning
work.rate|a|true|12,345|x|u|R.
Commands
A
deburr run A
B
deburr run B
C
deburr run C
)page");
}

TEST_F(Runs, RejectsIncompleteRuns) {
  Json manifest = leave("a", 1000, "2");
  const auto rejected = [&](const char* name, const char* says) {
    try {
      compare_runs(paths({"a", name}), {});
      ADD_FAILURE() << name;
    } catch (const spec::FileError& error) {
      EXPECT_THAT(error.what(), HasSubstr(says));
      EXPECT_THAT(error.what(), HasSubstr(name));
    }
  };
  rejected("none", "does not exist");
  put("empty/x", "");
  rejected("empty", "name the directory of a complete run");
  put("running/.deburr_run/claim.json", "{}");
  rejected("running", "is not finished or was killed");
  put("point/failure.json", "{}");
  rejected("point", "failed point of a sweep");
  put("planned/plan.json", "{}");
  rejected("planned", "collect");
  put("torn/result.json", "{");
  rejected("torn", "not valid JSON");
  leave("b", 1000, "2");
  put("b/manifest.json", "[");
  rejected("b", "damaged");
  manifest["images"][0]["file"] = "../a/after.png";
  put("a/manifest.json", manifest.dump());
  leave("b", 1000, "2");
  EXPECT_THROW(comparison_page(compare_runs(paths({"a", "b"}), {})), spec::FileError)
      << "a picture from elsewhere";
}

// ---- sweeps -------------------------------------------------------------------------------------

class Sweeps : public Directory {
 protected:
  static Json axis(const char* name) {
    return {{"name", name},
            {"parameters", {name}},
            {"labels", Json::array()},
            {"choices", Json::object()}};
  }
  static Json metric(const char* name, const char* key, const char* unit) {
    return {{"name", name}, {"key", key}, {"unit", unit}, {"meaning", "m"}};
  }
  static Json point(std::vector<std::string> at, Json values, bool front = false) {
    Json p = {{"name", "p"}, {"state", "done"}, {"at", at}, {"values", std::move(values)}};
    if (front) p["front"] = true;
    return p;
  }
  static Json identical(Json point) {
    point["identical"] = {"psnr"};
    return point;
  }
  static Json sweep(Json base, Json axes, Json points) {
    return {{"schema", kCollectionSchema},
            {"sweep", "cache"},
            {"title", "Cache"},
            {"engine", "texture"},
            {"commit", "abc"},
            {"counts", {{"points", points.size()}, {"done", points.size()}, {"front", 1}}},
            {"base", std::move(base)},
            {"axes", std::move(axes)},
            {"metrics", Json::array({metric("cycles", "cycles", "clk"),
                                     metric("psnr", "quality.psnr_db", "dB"),
                                     metric("lines", "/work/lines", "line")})},
            {"objectives", Json::array({{{"metric", "cycles"}, {"maximise", false}},
                                        {{"metric", "lines"}, {"maximise", false}}})},
            {"points", std::move(points)}};
  }
  void leave(const char* name, const Json& json) const {
    put(fs::path(name) / "collected.json", json.dump());
  }
  Json compared(std::initializer_list<const char*> names) const {
    const auto unsaid = [](const std::string&, const auto&, const std::string& parameter) {
      return parameter == "ways" ? std::string("2") : std::string("?");
    };
    return compare_sweeps(paths(names), {}, unsaid);
  }
};

TEST_F(Sweeps, MatchPointsByConfiguration) {
  leave("a",
        sweep(Json::array({Json{"latency", "100"}}), Json::array({axis("bytes")}),
              Json::array({point({"1024"}, {100, 30.0, 5}, true), point({"2048"}, {90, 31.0, 4}),
                           identical(point({"4096"}, {80, nullptr, 3}))})));
  // Another axis, whose default is the value of the first sweep; another base.
  leave("b",
        sweep(Json::array({Json{"latency", "200"}}), Json::array({axis("ways"), axis("bytes")}),
              Json::array({point({"2", "2048"}, {99, 31.02, 4}),
                           point({"2", "1024"}, {50, 30.0, 6}, true),
                           point({"4", "1024"}, {40, 30.0, 5}),
                           identical(point({"2", "4096"}, {80, nullptr, nullptr}))})));
  const Json all = compared({"a", "b"});
  EXPECT_EQ(all["axes"], (Json{"bytes", "ways"}));
  ASSERT_EQ(all["parameters"].size(), 1u);
  EXPECT_EQ(all["parameters"][0]["values"], (Json{"100", "200"}));
  ASSERT_EQ(all["points"].size(), 3u);
  EXPECT_EQ(all["points"][0]["at"], (Json{"1024", "2"}));
  EXPECT_EQ(all["points"][0]["values"], (Json{{100, 30, 5}, {50, 30, 6}}));
  EXPECT_EQ(all["points"][0]["judgements"][0], (Json{"better", "equal", "worse"}));
  EXPECT_EQ(all["points"][0]["front"], (Json{true, true}));
  EXPECT_EQ(all["points"][1]["front"], (Json{false, false}));
  EXPECT_EQ(all["points"][1]["judgements"][0], (Json{"worse", "equal", "equal"}));
  EXPECT_EQ(all["points"][2]["judgements"][0], (Json{"equal", "equal", "worse"})) << "lost";
  EXPECT_TRUE(all["points"][2]["values"][0][1].is_null());
  EXPECT_EQ(all["points"][2]["identical"], (Json{{"psnr"}, {"psnr"}}));
  EXPECT_EQ(all["points"][0]["identical"], (Json{Json::array(), Json::array()}));
  ASSERT_EQ(all["only"].size(), 1u);
  EXPECT_EQ(all["only"][0]["at"], (Json{"1024", "4"}));
  EXPECT_EQ(all["only"][0]["states"], (Json{"none", "done"}));
  EXPECT_FALSE(all["only"][0]["worse"]);
  EXPECT_TRUE(all["worse"]);
  EXPECT_EQ(all["summary"][0][0]["better"], 1);
  EXPECT_EQ(all["summary"][0][0]["worse"], 1);
  EXPECT_NEAR(all["summary"][0][0]["mean"].get<double>(), (-50 + 10 + 0) / 3.0, 1e-9);
  EXPECT_EQ(all["summary"][0][1]["unit"], "dB");
  EXPECT_NEAR(all["summary"][0][1]["most"].get<double>(), 0.02, 1e-9);
  // (80, 3) of A and (40, 5) of B: neither sweep is better in both objectives.
  EXPECT_EQ(all["sweeps"][0]["joint_front"], 1);
  EXPECT_EQ(all["sweeps"][1]["joint_front"], 1);
  EXPECT_EQ(all["metrics"][0]["maximise"], false);
  EXPECT_EQ(all["metrics"][1]["maximise"], true);
  EXPECT_FALSE(compared({"a", "a"})["worse"]);
  EXPECT_THAT(comparison_page(all), HasSubstr("1 on the joint front"));
}

TEST_F(Sweeps, PageShowsEveryKindOfCell) {
  leave("a",
        sweep(Json::array({Json{"latency", "100"}}), Json::array({axis("bytes"), axis("ways")}),
              Json::array({point({"1024", "1"}, {1000, 30.0, 50}, true),
                           point({"2048", "1"}, {900, 31.0, 40}),
                           point({"4096", "1"}, {800, 31.0, 0})})));
  leave("b",
        sweep(Json::array({Json{"latency", "200"}}), Json::array({axis("bytes"), axis("ways")}),
              Json::array({point({"1024", "1"}, {1100, 30.0, 60}, true),
                           point({"2048", "1"}, {450, 31.5, 40}),
                           point({"4096", "1"}, {808, 30.25, 7}),
                           point({"8192", "1"}, {1, 1.0, 1})})));
  Json all = compared({"a", "b"});
  for (Json& each : all["sweeps"]) each["path"] = "out/" + each["name"].get<std::string>();
  EXPECT_EQ(words(comparison_page(all)), R"page(
Deburr &middot;
comparison of sweeps · texture
A, B|badge fail|worse
Parameters|Common points|Fronts|Matched points|Other points
Directory|Title
A|out/A|baseline|Cache|3 points, 3 done, 1 on its front, 1 on the joint front
B|out/B|Cache|4 points, 4 done, 1 on its front, 1 on the joint front
Different parameters, except the axes
Parameter|A|B
latency|100|other|200
Points in all sweeps: 3
Matched by bytes, ways.
1 points are not finished in every sweep.
Metric|Better|Equal|Worse|Mean change|Smallest|Largest|Unit|Meaning
B|cycles|1|1|worse|1|-13.00 %|-50.00 %|+10.00 %|clk|m
B|psnr|1|1|worse|1|-0.08 dB|-0.75 dB|+0.50 dB|dB|m
B|lines|0|1|worse|2|+10.00 %|+0.00 %|+20.00 %|line|m
Fronts
Across
Up
fronts only
Large points are on their sweep's Pareto front;
lines connect the points that are Pareto-optimal in these two metrics within their sweep.
Matched points
Show|all|worse points|different points|points on a front
Points that are not finished in every sweep: 1
The points and the chart of the fronts need JavaScript;
deburr compare --json prints all points.
)page");
}

// No picture is better than an identical one, and losing identity is worse.
TEST_F(Sweeps, IdenticalPictureIsBest) {
  const auto with = [](Json first, Json second) {
    Json all = sweep(Json::array(), Json::array({axis("bytes")}),
                     Json::array({std::move(first), std::move(second)}));
    all["objectives"] = Json::array(
        {{{"metric", "cycles"}, {"maximise", false}}, {{"metric", "psnr"}, {"maximise", true}}});
    return all;
  };
  leave("a", with(point({"1"}, {100, 30.0, 1}), identical(point({"2"}, {200, nullptr, 1}))));
  leave("b", with(point({"1"}, {100, 99.0, 1}), point({"2"}, {150, 98.0, 1})));
  leave("c", with(point({"1"}, {100, 99.0, 1}), point({"2"}, {200, nullptr, 1})));
  const Json lost = compared({"a", "b"});
  EXPECT_EQ(lost["points"][1]["judgements"][0], (Json{"better", "worse", ""}));
  EXPECT_EQ(lost["sweeps"][0]["joint_front"], 1) << "the identical one, whatever its cycles";
  EXPECT_EQ(lost["sweeps"][1]["joint_front"], 1);
  EXPECT_EQ(compared({"b", "a"})["points"][1]["judgements"][0], (Json{"worse", "better", ""}));
  const Json missing = compared({"a", "c"});
  EXPECT_EQ(missing["points"][1]["judgements"][0][1], "worse")
      << "null without flag is not a value";
  EXPECT_EQ(missing["points"][1]["identical"], (Json{{"psnr"}, Json::array()}));
}

// The message about the third sweep uses the name B and explains which sweep that is.
TEST_F(Sweeps, WarnOfDifferentInputFiles) {
  const auto with = [&](const char* name, const char* hash) {
    Json one = sweep(Json::array(), Json::array({axis("bytes")}),
                     Json::array({point({"1"}, {1, 1.0, 1})}));
    one["inputs"] = Json::array({{{"file", "x.png"}, {"sha256", hash}}});
    leave(name, one);
  };
  with("a", "1111111111");
  with("b", "2222222222");
  with("c", "3333333333");
  const Json all = compared({"a", "b", "c"});
  EXPECT_EQ(
      all["warnings"],
      (Json{
          "the inputs differ: A reads x.png (11111111), B reads x.png (22222222)",
          "the inputs differ: A reads x.png (11111111), B reads x.png (33333333) (B is C here)"}));
  EXPECT_EQ(all["objectives"], (Json{"cycles", "lines"}));
  EXPECT_EQ(all["metrics"][2], (Json{{"name", "lines"},
                                     {"key", "/work/lines"},
                                     {"unit", "line"},
                                     {"meaning", "m"},
                                     {"maximise", false},
                                     {"counts", true}}));
  EXPECT_EQ(all["sweeps"][2]["name"], "C");
  EXPECT_EQ(all["sweeps"][2]["path"], (path_ / "c").string());
  EXPECT_EQ(all["sweeps"][2]["title"], "Cache");
  EXPECT_EQ(all["sweeps"][2]["commit"], "abc");
  EXPECT_EQ(all["summary"].size(), 2u);
  EXPECT_EQ(all["points"][0]["judgements"].size(), 2u);
}

TEST_F(Sweeps, NamedChoicesMatchTheirValues) {
  const auto points = [](const char* label) { return Json::array({point({label}, {1, 30.0, 1})}); };
  Json named = axis("shape");
  named["parameters"] = {"bytes", "ways"};
  named["choices"] = {{"small", {"1024", "2"}}};
  leave("a", sweep(Json::array(), Json::array({named}), points("small")));
  leave("b", sweep(Json::array(), Json::array({axis("bytes")}), points("1024")));
  EXPECT_EQ(compared({"a", "b"})["points"].size(), 1u);
}

TEST_F(Sweeps, FailedPointIsWorse) {
  leave("a", sweep(Json::array(), Json::array({axis("bytes")}),
                   Json::array({point({"1"}, {1, 1.0, 1}), point({"2"}, {1, 1.0, 1})})));
  Json failed = point({"1"}, {nullptr, nullptr, nullptr});
  failed["state"] = "failed";
  failed["failure"] = "deadlock: nothing moves";
  Json missing = point({"2"}, {nullptr, nullptr, nullptr});
  missing["state"] = "missing";
  Json b = sweep(Json::array(), Json::array({axis("bytes")}), Json::array({failed, missing}));
  b["counts"]["failed"] = b["counts"]["missing"] = 1;
  leave("b", b);
  const Json all = compared({"a", "b"});
  EXPECT_TRUE(all["worse"]);
  EXPECT_THAT(all["warnings"][0].get<std::string>(), HasSubstr("1 points failed, 1 are missing"));
  EXPECT_EQ(all["only"][0]["states"], (Json{"done", "failed: deadlock: nothing moves"}));
  EXPECT_TRUE(all["only"][0]["worse"]);
  EXPECT_FALSE(all["only"][1]["worse"]) << "it may still come";
  EXPECT_FALSE(compared({"b", "a"})["worse"]);
}

TEST_F(Sweeps, RejectsIncompleteOrDifferentSweeps) {
  const Json good =
      sweep(Json::array(), Json::array({axis("bytes")}), Json::array({point({"1"}, {1, 1.0, 1})}));
  leave("a", good);
  EXPECT_TRUE(is_sweep(path_ / "a"));
  EXPECT_TRUE(is_sweep(path_ / "a/collected.json"));
  put("planned/plan.json", "{}");
  EXPECT_TRUE(is_sweep(path_ / "planned"));
  put("run/result.json", "{}");
  EXPECT_FALSE(is_sweep(path_ / "run"));
  EXPECT_THROW(compared({"a", "planned"}), spec::FileError);
  const auto spoiled = [&](auto spoil) {
    Json bad = good;
    spoil(bad);
    leave("b", bad);
    return compared({"a", "b"});
  };
  EXPECT_THROW(spoiled([](Json& j) { j = "x"; }), spec::FileError);
  EXPECT_THROW(spoiled([](Json& j) { j["schema"] = 1; }), spec::FileError);
  EXPECT_THROW(spoiled([](Json& j) { j.erase("points"); }), spec::FileError);
  EXPECT_THROW(spoiled([](Json& j) { j["points"][0]["values"].push_back(1); }), spec::FileError);
  EXPECT_THROW(spoiled([](Json& j) { j["axes"][0]["parameters"] = Json::array(); }),
               spec::FileError);
  EXPECT_THROW(spoiled([](Json& j) { j["base"].push_back("x"); }), spec::FileError);
  EXPECT_THROW(spoiled([](Json& j) { j["engine"] = "frame"; }), spec::ConfigError);
  EXPECT_THROW(spoiled([](Json& j) {
                 for (Json& m : j["metrics"]) m["key"] = "other";
               }),
               spec::ConfigError);
}

}  // namespace
}  // namespace deburr::tool::comparison_test
