// SPDX-License-Identifier: MIT
#include "tb/results/result.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "spec/error.h"
#include "tb/base/file.h"

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

// JSON has no infinity: a PSNR of identical pictures is null, and a flag of its name says why.
Json to_json(const Quality& quality) {
  Json json = {{"reference", quality.reference}}, identical = Json::object();
  const std::pair<const char*, std::optional<double>> values[] = {
      {"psnr_db", quality.psnr_db},
      {"psnr_edge_db", quality.psnr_edge_db},
      {"psnr_silhouette_db", quality.psnr_silhouette_db},
      {"psnr_before_db", quality.psnr_before_db},
      {"psnr_edge_before_db", quality.psnr_edge_before_db},
      {"psnr_silhouette_before_db", quality.psnr_silhouette_before_db}};
  for (const auto& [name, value] : values) {
    json[name] = value && std::isfinite(*value) ? Json(*value) : Json();
    identical[name] = value && std::isinf(*value);
  }
  json["identical"] = identical;
  return json;
}

Json json_of(const WorkValue& value) {
  return std::visit(
      [](auto known) {
        if constexpr (std::is_same_v<decltype(known), std::monostate>)
          return Json();
        else
          return Json(known);
      },
      value);
}

// Collects the paths of all numbers and texts below a node: "units.address.busy".
void collect_meanings(const Json& node, const std::string& path, Json& meanings) {
  if (node.is_object()) {
    for (const auto& [key, value] : node.items())
      collect_meanings(value, path.empty() ? key : fmt::format("{}.{}", path, key), meanings);
    return;
  }
  if (const Statistic* s = find_statistic(path))
    meanings[path] = {{"unit", s->unit}, {"meaning", s->meaning}};
}

Json to_json(const LinkFigures& link) {
  std::uint64_t all = 0, occupancy = 0, most = 0;
  for (std::size_t beats = 0; beats < link.clocks.size(); ++beats) {
    all += link.clocks[beats];
    occupancy += beats * link.clocks[beats];
    if (link.clocks[beats] > 0) most = beats;
  }
  const auto mean = [&](std::uint64_t sum) {
    return all > 0 ? static_cast<double>(sum) / static_cast<double>(all) : 0.0;
  };
  return {{"link", link.full_name},
          {"depth", link.clocks.size() - 1},
          {"beats", link.beats},
          {"occupancy", occupancy},
          {"mean", mean(occupancy)},
          {"most", most},
          {"full_percent", 100 * mean(link.clocks.back())},
          {"histogram", link.clocks}};
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
  json["scoreboards"] = Json::object();
  for (const ScoreboardFigures& board : r.scoreboards)
    json["scoreboards"][board.name] = {{"comparisons", board.comparisons},
                                       {"mismatches", board.mismatches}};
  json["cycles"] = r.cycles;
  json["clock_mhz"] = r.clock_mhz;
  json["throughput"] = {{"value", r.throughput},
                        {"unit", r.throughput_unit},
                        {"bound", r.throughput_bound},
                        {"bound_meaning", r.throughput_bound_meaning}};
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
  if (r.bottleneck)
    json["bottleneck"] = {{"unit", r.bottleneck->unit},
                          {"cause", r.bottleneck->cause},
                          {"cycles", r.bottleneck->cycles},
                          {"meaning", r.bottleneck->meaning}};
  json["memories"] = Json::object();
  Json idealised = Json::object();
  for (const MemoryFigures& m : r.memories) {
    json["memories"][m.name] = {{"content", m.content},
                                {"kind", m.kind},
                                {"words", m.words},
                                {"word_bits", m.word_bits},
                                {"ports", m.ports},
                                {"read_latency", m.read_latency},
                                {"built_as", m.built_as},
                                {"copies", m.copies},
                                {"banks", m.banks},
                                {"logical_bits", m.logical_bits},
                                {"physical_bits", m.physical_bits},
                                {"logical_bits_at_frame_width", m.logical_bits_at_frame_width}};
    if (m.high_water) json["memories"][m.name]["high_water"] = *m.high_water;
    if (!m.idealised.empty()) idealised[m.name] = m.idealised;
  }
  json["memory_bits"] = Json::object();
  for (const MemoryBits& bits : memory_bits(r.memories))
    json["memory_bits"][std::string(bits.kind)] = {
        {"memories", bits.memories},
        {"logical", bits.logical},
        {"physical", bits.physical},
        {"logical_at_frame_width", bits.logical_at_frame_width}};
  if (!idealised.empty()) json["idealised"] = idealised;
  if (!r.links.empty()) json["links"] = Json::object();
  for (const LinkFigures& link : r.links) json["links"][link.name] = to_json(link);
  if (!r.maps.empty()) json["maps"] = Json::object();
  for (const MapFigures& m : r.maps)
    json["maps"][m.name] = {{"title", m.title},
                            {"meaning", m.meaning},
                            {"unit", m.unit},
                            {"picture", fmt::format("map_{}.png", m.name)},
                            {"values", fmt::format("map_{}.pfm", m.name)},
                            {"pixels", m.pixels},
                            {"min", m.min},
                            {"max", m.max},
                            {"mean", m.pixels > 0 ? m.sum / static_cast<double>(m.pixels) : 0.0},
                            {"sum", m.sum},
                            {"checked_against", m.account}};
  json["work"] = Json::object();
  for (const WorkItem& item : r.work) json["work"][item.name] = json_of(item.value);
  if (!r.notes.empty()) json["notes"] = r.notes;
  if (!r.first_mismatches.empty()) json["first_mismatches"] = Json::array();
  for (const MismatchLine& m : r.first_mismatches)
    json["first_mismatches"].push_back({{"check", m.check},
                                        {"where", m.where},
                                        {"item", m.item},
                                        {"field", m.field},
                                        {"expected", m.expected},
                                        {"got", m.got}});
  json["figures"] = Json::array();
  for (const Figure& figure : r.figures) {
    Json entry = {{"label", figure.label}, {"key", figure.key}};
    if (!figure.against_label.empty()) entry["against"] = {{"label", figure.against_label}};
    if (!figure.against.empty()) entry["against"]["key"] = figure.against;
    if (figure.tile) entry["tile"] = true;
    json["figures"].push_back(entry);
  }
  if (r.quality) json["quality"] = to_json(*r.quality);
  json["host"] = {{"seconds", r.host_seconds},
                  {"mcycles_per_s", r.mcycles_per_s()},
                  {"cpu_seconds", r.host_cpu_seconds}};
  Json meanings = Json::object();
  collect_meanings(json, "", meanings);
  for (const UnitCycles& unit : r.units)
    for (const StallCycles& stall : unit.stalls)
      meanings[fmt::format("units.{}.stalls.{}", unit.name, stall.cause)] = {
          {"unit", "clk"}, {"meaning", stall.meaning}};
  for (const WorkItem& item : r.work)
    meanings["work." + item.name] = {{"unit", item.unit}, {"meaning", item.meaning}};
  if (r.coverage) {
    json["coverage"] = {{"bins", *r.coverage}};
    const Statistic* s = find_statistic("coverage.bins");  // one for all bins, which are many
    meanings["coverage.bins"] = {{"unit", s->unit}, {"meaning", s->meaning}};
  }
  json["meaning"] = meanings;
  return json;
}

// ---- memories -----------------------------------------------------------------------------------

std::vector<MemoryBits> memory_bits(std::span<const MemoryFigures> memories) {
  std::vector<MemoryBits> all = {{"flops"}, {"sram"}, {"rom"}, {"total"}};
  for (const MemoryFigures& m : memories)
    for (MemoryBits& bits : all) {
      if (bits.kind != m.kind && bits.kind != "total") continue;
      ++bits.memories;
      bits.logical += m.logical_bits;
      bits.physical += m.physical_bits;
      bits.logical_at_frame_width += m.logical_bits_at_frame_width;
    }
  std::erase_if(all, [](const MemoryBits& b) { return b.kind != "total" && b.memories == 0; });
  return all;
}

std::vector<std::string> idealised_memories(const Json& result) {
  std::vector<std::string> all;
  const auto found = result.find("idealised");
  if (found == result.end() || !found->is_object()) return all;
  for (const auto& [name, why] : found->items())
    all.push_back(fmt::format("{} ({})", name, why.is_string() ? why.get<std::string>() : "?"));
  return all;
}

// ---- the bottleneck -----------------------------------------------------------------------------

namespace {

constexpr std::string_view kDownstream = "downstream";
// A unit that waits for records waits for one of those that finish them.
constexpr std::string_view kRecords = "records";
constexpr std::array<std::string_view, 5> kFinishRecords = {"predictor_h", "predictor_v",
                                                            "divider_h", "divider_v", "area"};
// Shares of a unit's cycles: below the first, a stall is no bottleneck; within the second, two
// units are equally busy.
constexpr double kNegligible = 0.01, kTie = 0.001;

double cycles_of(const UnitCycles& unit) {
  std::uint64_t cycles = unit.busy + unit.idle;
  for (const StallCycles& stall : unit.stalls) cycles += stall.cycles;
  return static_cast<double>(cycles);
}
double share(std::uint64_t cycles, const UnitCycles& unit) {
  const double all = cycles_of(unit);
  return all > 0 ? static_cast<double>(cycles) / all : 0.0;
}

// The first of the busiest units.
template <class Wanted>
const UnitCycles* busiest(std::span<const UnitCycles> units, Wanted wanted) {
  const UnitCycles* found = nullptr;
  for (const UnitCycles& unit : units)
    if (wanted(unit) && (!found || share(unit.busy, unit) > share(found->busy, *found) + kTie))
      found = &unit;
  return found;
}

Bottleneck busy(const UnitCycles& unit) {
  return {unit.name, "busy", std::string(find_statistic("units.*.busy")->meaning), unit.busy};
}

}  // namespace

std::optional<Bottleneck> find_bottleneck(std::span<const UnitCycles> units,
                                          std::string_view output) {
  struct Loss {
    const UnitCycles* unit;
    const StallCycles* stall;
    double share;
  };
  std::vector<Loss> losses;
  double largest = 0;
  for (const UnitCycles& unit : units)
    for (const StallCycles& stall : unit.stalls) {
      if (stall.cause == kDownstream && unit.name != output) continue;
      losses.push_back({&unit, &stall, share(stall.cycles, unit)});
      largest = std::max(largest, losses.back().share);
    }
  // A stall that the head of the pipe never feels costs nothing: a FIFO hides it.
  const auto head = std::find_if(units.begin(), units.end(),
                                 [](const UnitCycles& unit) { return unit.busy > 0; });
  const bool felt =
      head != units.end() && 1 - share(head->busy, *head) - share(head->idle, *head) >= kNegligible;
  if (!felt || largest < kNegligible) {
    const UnitCycles* unit = busiest(units, [](const UnitCycles&) { return true; });
    if (!unit || unit->busy == 0) return std::nullopt;
    return busy(*unit);
  }
  const Loss* deepest = nullptr;
  for (const Loss& loss : losses) {
    if (loss.share < largest / 2) continue;
    // The two axes lie side by side, not one behind the other.
    const bool beside = deepest && deepest->stall->cause == loss.stall->cause &&
                        deepest->unit->name.ends_with("_h") && loss.unit->name.ends_with("_v");
    if (!beside || loss.share > deepest->share) deepest = &loss;
  }
  if (deepest->stall->cause == kRecords) {
    const UnitCycles* unit = busiest(units, [](const UnitCycles& u) {
      return std::any_of(kFinishRecords.begin(), kFinishRecords.end(),
                         [&](std::string_view name) { return u.name.ends_with(name); });
    });
    if (unit) return busy(*unit);
  }
  return Bottleneck{deepest->unit->name, deepest->stall->cause, deepest->stall->meaning,
                    deepest->stall->cycles};
}

Json read_result(const std::filesystem::path& path) {
  const std::filesystem::path file =
      std::filesystem::is_directory(path) ? path / "result.json" : path;
  Json json = Json::parse(read_file(file, kMaxResultBytes), nullptr, false);
  if (json.is_discarded()) throw FileError(fmt::format("'{}' is not valid JSON", file.string()));
  if (!json.is_object() || json.value("schema", Json()) != kResultSchema)
    throw FileError(fmt::format("'{}' is not a result of schema {}", file.string(), kResultSchema));
  for (const char* key : {"unit", "verdict", "checks", "cycles", "throughput", "latency", "memory",
                          "units", "memories", "memory_bits", "work", "host"})
    if (!json.contains(key))
      throw FileError(fmt::format("'{}' is incomplete: '{}' is missing", file.string(), key));
  return with_infinity(std::move(json));
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
