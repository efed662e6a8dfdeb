// SPDX-License-Identifier: MIT
#include "tb/app/result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "spec/error.h"
#include "tb/app/file.h"

namespace deburr::tb {
namespace {

using Json = nlohmann::ordered_json;
using spec::FileError;

constexpr std::size_t kMaxResultBytes = 64u << 20;

std::string_view name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPass:
      return "pass";
    case Verdict::kFail:
      return "fail";
    case Verdict::kUnchecked:
      return "unchecked";
  }
  return "unchecked";
}

Json decibel(const std::optional<double>& value) {
  if (!value || std::isnan(*value)) return nullptr;
  if (std::isinf(*value)) return "inf";  // JSON has no infinity; equal pictures are not a number
  return *value;
}

// Collects the paths of all numbers and texts below a node: "units.address.busy".
void collect_meanings(const Json& node, const std::string& path, Json& meanings) {
  if (node.is_object()) {
    for (const auto& [key, value] : node.items())
      collect_meanings(value, path.empty() ? key : path + "." + key, meanings);
    return;
  }
  if (const Statistic* s = find_statistic(path))
    meanings[path] = {{"unit", s->unit}, {"meaning", s->meaning}};
}

}  // namespace

Json to_json(const Result& r) {
  Json json;
  json["schema"] = kResultSchema;
  json["unit"] = r.unit;
  json["verdict"] = name_of(r.verdict);
  if (!r.reason.empty()) json["reason"] = r.reason;
  if (r.interrupted) json["interrupted"] = true;
  json["checks"] = {{"comparisons", r.comparisons},
                    {"mismatches", r.mismatches},
                    {"traffic_comparisons", r.traffic_comparisons},
                    {"traffic_mismatches", r.traffic_mismatches}};
  json["cycles"] = r.cycles;
  json["clock_mhz"] = r.clock_mhz;
  json["throughput"] = {
      {"value", r.throughput}, {"unit", r.throughput_unit}, {"bound", r.throughput_bound}};
  Json histogram = Json::array();
  for (const LatencyBin& bin : r.latency.histogram)
    histogram.push_back({{"from", bin.from}, {"count", bin.count}});
  json["latency"] = {{"unit", "clk"},         {"min", r.latency.min}, {"p50", r.latency.p50},
                     {"p95", r.latency.p95},  {"p99", r.latency.p99}, {"max", r.latency.max},
                     {"histogram", histogram}};
  json["memory"] = {{"bytes_read", r.bytes_read},
                    {"bytes_written", r.bytes_written},
                    {"lines_filled", r.lines_filled}};
  json["units"] = Json::object();
  for (const UnitCycles& unit : r.units) {
    Json stalls = Json::object();
    for (const StallCycles& stall : unit.stalls) stalls[stall.cause] = stall.cycles;
    json["units"][unit.name] = {{"busy", unit.busy}, {"idle", unit.idle}, {"stalls", stalls}};
  }
  json["sram_bits"] = Json::object();
  for (const auto& [name, bits] : r.sram_bits) json["sram_bits"][name] = bits;
  json["work"] = Json::object();
  for (const WorkItem& item : r.work) json["work"][item.name] = item.value;
  if (r.quality)
    json["quality"] = {{"reference", r.quality->reference},
                       {"psnr_db", decibel(r.quality->psnr_db)},
                       {"psnr_edge_db", decibel(r.quality->psnr_edge_db)},
                       {"psnr_silhouette_db", decibel(r.quality->psnr_silhouette_db)}};
  json["host"] = {{"seconds", r.host_seconds},
                  {"mcycles_per_s", r.mcycles_per_s()},
                  {"cpu_seconds", r.host_cpu_seconds}};
  Json meanings = Json::object();
  collect_meanings(json, "", meanings);
  for (const auto& [name, bits] : r.sram_bits) {
    const Statistic* s = find_statistic("sram_bits.*");
    meanings["sram_bits." + name] = {{"unit", s->unit}, {"meaning", s->meaning}};
  }
  for (const UnitCycles& unit : r.units)
    for (const StallCycles& stall : unit.stalls)
      meanings[fmt::format("units.{}.stalls.{}", unit.name, stall.cause)] = {
          {"unit", "clk"}, {"meaning", stall.meaning}};
  for (const WorkItem& item : r.work)
    meanings["work." + item.name] = {{"unit", item.unit}, {"meaning", item.meaning}};
  json["meaning"] = meanings;
  return json;
}

Json read_result(const std::filesystem::path& path) {
  const std::filesystem::path file =
      std::filesystem::is_directory(path) ? path / "result.json" : path;
  const Json json = Json::parse(read_file(file, kMaxResultBytes), nullptr, false);
  if (json.is_discarded()) throw FileError(fmt::format("'{}' is not valid JSON", file.string()));
  if (!json.is_object() || json.value("schema", Json()) != kResultSchema)
    throw FileError(fmt::format("'{}' is not a result of schema {}", file.string(), kResultSchema));
  for (const char* key : {"unit", "verdict", "checks", "cycles", "throughput", "latency", "memory",
                          "units", "sram_bits", "work", "host"})
    if (!json.contains(key))
      throw FileError(fmt::format("'{}' is incomplete: '{}' is missing", file.string(), key));
  return json;
}

const Statistic* find_statistic(std::string_view key) {
  // The longest description wins: "units.*.busy" before "units.*".
  const auto matches = [](std::string_view pattern, std::string_view name) {
    while (!pattern.empty() && !name.empty()) {
      const std::string_view p = pattern.substr(0, pattern.find('.'));
      const std::string_view n = name.substr(0, name.find('.'));
      if (p != "*" && p != n) return false;
      pattern.remove_prefix(std::min(pattern.size(), p.size() + 1));
      name.remove_prefix(std::min(name.size(), n.size() + 1));
    }
    return pattern.empty() && name.empty();
  };
  const Statistic* best = nullptr;
  for (const Statistic& s : statistics())
    if (matches(s.name, key) && (!best || s.name.size() > best->name.size())) best = &s;
  return best;
}

}  // namespace deburr::tb
