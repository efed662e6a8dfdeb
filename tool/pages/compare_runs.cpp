// SPDX-License-Identifier: MIT
#include "tool/pages/compare_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "spec/error.h"
#include "tb/base/file.h"
#include "tb/base/json_text.h"
#include "tb/run/result.h"

namespace deburr::tool {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxRunManifestBytes = 64u << 20;

struct Run {
  std::string letter;
  fs::path path, folder;
  Json result, manifest;  // manifest: null if missing
};

// Explains why the result is missing, as far as the contents of the directory show it.
[[noreturn]] void reject_unfinished(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder / ".deburr_run" / "claim.json", error))
    throw spec::FileError(
        fmt::format("'{}' has no result.json: its run is not finished or was killed: wait for it, "
                    "or run it again",
                    folder.string()));
  if (fs::exists(folder / "failure.json", error))
    throw spec::FileError(fmt::format(
        "'{}' has no result.json: it is a failed point of a sweep: see its failure.json",
        folder.string()));
  if (fs::exists(folder / "plan.json", error))
    throw spec::FileError(
        fmt::format("'{}' is a sweep that was not collected: run 'deburr sweep FILE collect' first",
                    folder.string()));
  throw spec::FileError(
      fmt::format("'{}' has no result.json: name the directory of a complete run or of a sweep",
                  folder.string()));
}

Run read_run(const fs::path& path, std::size_t index) {
  std::error_code error;
  if (!fs::exists(path, error))
    throw spec::FileError(fmt::format("'{}' does not exist", path.string()));
  const bool folder = fs::is_directory(path, error);
  if (folder && !fs::exists(path / "result.json", error)) reject_unfinished(path);
  Run run{letter(index), path, folder ? path : path.parent_path(), tb::read_result(path), nullptr};
  const fs::path manifest = run.folder / "manifest.json";
  if (!fs::is_regular_file(manifest, error)) return run;
  run.manifest = tb::try_parse_json(tb::read_file(manifest, kMaxRunManifestBytes));
  if (!run.manifest.is_object())
    throw spec::FileError(
        fmt::format("'{}' is damaged: run it again, or remove it", manifest.string()));
  return run;
}

void reject_different_engines(const std::vector<Run>& runs) {
  for (const Run& run : runs)
    if (run.result.at("unit") != runs[0].result.at("unit"))
      throw spec::ConfigError(fmt::format(
          "A is a run of '{}', {} of '{}': results of different engines cannot be compared",
          value_text(runs[0].result.at("unit")), run.letter, value_text(run.result.at("unit"))));
}

Json warnings_of(const std::vector<Run>& runs) {
  Json warnings = Json::array();
  for (const Run& run : runs) {
    for (const std::string& memory : tb::not_implementable_memories(run.result))
      warnings.push_back(fmt::format("{} is not implementable: memory {}", run.letter, memory));
    if (run.result.value("interrupted", false))
      warnings.push_back(
          fmt::format("{} was interrupted: its figures cover only the completed part", run.letter));
    if (other_technology(runs[0].result, run.result))
      warnings.push_back(
          fmt::format("the standard cells differ: A {}, {} {}: gates and ns are not compared",
                      value_text(value_at(runs[0].result, "cost.technology")), run.letter,
                      value_text(value_at(run.result, "cost.technology"))));
    if (&run == &runs[0] || !run.manifest.is_object() || !runs[0].manifest.is_object()) continue;
    for (std::string line : different_work(runs[0].manifest, run.manifest)) {
      // different_work() uses the letters A and B.
      if (runs.size() > 2) line = fmt::format("{} (B is {} here)", line, run.letter);
      warnings.push_back(line);
    }
  }
  return warnings;
}

Json described(const Run& run) {
  Json json = {{"name", run.letter},
               {"path", run.path.string()},
               {"verdict", run.result.at("verdict")},
               {"interrupted", run.result.value("interrupted", false)}};
  for (const char* key : {"title", "summary", "command", "commit", "images"})
    json[key] = run.manifest.is_object() && run.manifest.contains(key) ? run.manifest[key] : Json();
  json["folder"] = run.folder.string();
  return json;
}

// From every run that has a manifest.
Json parameters_of(const std::vector<Run>& runs) {
  std::vector<Json> all;  // entries of the manifests' lists, each name once
  const auto list = [](const Run& run) {
    return run.manifest.is_object() ? run.manifest.value("parameters", Json::array())
                                    : Json::array();
  };
  std::vector<std::map<std::string, std::string>> values(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i)
    for (const Json& entry : list(runs[i])) {
      const std::string name = entry.value("name", "");
      if (std::none_of(values.begin(), values.end(),
                       [&](const auto& known) { return known.contains(name); }))
        all.push_back(entry);
      values[i][name] = !entry.value("effect", true) ? "no effect"
                        : entry.contains("value")    ? value_text(entry["value"])
                                                     : "-";
    }
  Json differing = Json::array();
  for (const Json& entry : all) {
    const std::string name = entry.value("name", "");
    Json row = Json::array();
    bool differs = false;
    for (const auto& of_run : values) {
      if (of_run.empty()) {  // no manifest: nothing is known
        row.push_back("?");
        continue;
      }
      const auto found = of_run.find(name);
      row.push_back(found == of_run.end() ? "-" : found->second);
      differs = differs || row.back() != row.front();
    }
    if (differs)
      differing.push_back({{"name", name},
                           {"kind", entry.value("kind", "")},
                           {"unit", entry.value("unit", "")},
                           {"meaning", entry.value("meaning", "")},
                           {"values", row}});
  }
  return differing;
}

class Rows {
 public:
  Rows(const std::vector<Run>& runs, const Tolerances& tolerances) {
    for (std::size_t i = 1; i < runs.size(); ++i)
      comparisons_.push_back(compare(runs[0].result, runs[i].result, tolerances));
    for (const Run& run : runs) results_.push_back(&run.result);
  }

  bool worse() const {
    return std::any_of(comparisons_.begin(), comparisons_.end(),
                       [](const Comparison& c) { return c.worse; });
  }

  // Every key that differs in any run, in the order of the results.
  std::vector<std::string> keys() const {
    std::vector<std::string> keys;
    for (const Comparison& comparison : comparisons_)
      for (const ComparedValue& value : comparison.values)
        if (std::find(keys.begin(), keys.end(), value.key) == keys.end()) keys.push_back(value.key);
    return keys;
  }

  Json row(const std::string& key, const Tolerances& tolerances) const {
    Json json = {{"key", key}};
    json["unit"] = described(key, "unit");
    json["meaning"] = described(key, "meaning");
    json["cells"] = Json::array();
    const Json base = value_at(*results_[0], key);
    for (std::size_t i = 0; i < results_.size(); ++i) {
      const Json value = value_at(*results_[i], key);
      Json cell = {{"value", tb::is_infinite(value) ? Json() : value}, {"text", value_text(value)}};
      if (tb::is_infinite(value)) cell["identical"] = true;
      if (const std::string range = range_text(*results_[i], key); !range.empty())
        cell["range"] = range;
      if (i > 0) {
        const ComparedValue* found = find(comparisons_[i - 1], key);
        const Trend equal = check(key, as_number(base), as_number(value), tolerances);
        cell["change"] = found ? found->change : "";
        cell["judgement"] = kTrendNames[static_cast<std::size_t>(found ? found->verdict : equal)];
        cell["worse"] = found && found->worse;
      }
      json["cells"].push_back(cell);
    }
    return json;
  }

 private:
  static const ComparedValue* find(const Comparison& comparison, const std::string& key) {
    for (const ComparedValue& value : comparison.values)
      if (value.key == key) return &value;
    return nullptr;
  }

  std::string described(const std::string& key, const char* what) const {
    for (const Json* result : results_) {
      const auto meanings = result->find("meaning");
      if (meanings == result->end() || !meanings->contains(key)) continue;
      std::string text = (*meanings)[key].value(what, "");
      if (key == "throughput.value" && std::string_view(what) == "unit")
        return result->at("throughput").value("unit", text);
      return text;
    }
    return "";
  }

  std::vector<Comparison> comparisons_;
  std::vector<const Json*> results_;
};

// The headline figures present in at least one result: label and key.
using Headlines = std::vector<std::pair<std::string, std::string>>;
Headlines headlines(const std::vector<Run>& runs) {
  Headlines all = {{"Verdict", "verdict"},
                   {"Cycles", "cycles"},
                   {"Throughput", "throughput.value"},
                   {"Latency p50", "latency.p50"},
                   {"Latency p99", "latency.p99"},
                   {"Bytes read", "memory.bytes_read"},
                   {"Bytes written", "memory.bytes_written"},
                   {"Memory, physical", "memory_bits.total.physical"},
                   {"Gates", "cost.gates.value"},
                   {"Flip-flops", "cost.flip_flops"},
                   {"SRAM and ROM", "cost.memory_bits"},
                   {"Longest path", "cost.ns.value"},
                   {"Clock limit", "cost.clock_mhz.value"},
                   {"Frames per second at the clock limit", "cost.frames_per_s.value"},
                   {"PSNR", "quality.psnr_db"},
                   {"PSNR, edge pixels", "quality.psnr_edge_db"},
                   {"PSNR, silhouettes", "quality.psnr_silhouette_db"},
                   {"FLIP", "quality.flip"},
                   {"SSIM", "quality.ssim"},
                   {"Pixels changed by more than 2 codes", "change.over_2_percent"},
                   {"Correct pixels changed by more than 2 codes", "change.right_over_2_percent"}};
  for (const Run& run : runs)
    for (const Json& figure : run.result.value("figures", Json::array()))
      if (const std::string key = figure.value("key", "");
          std::none_of(all.begin(), all.end(), [&](const auto& h) { return h.second == key; }))
        all.emplace_back(figure.value("label", key), key);
  std::erase_if(all, [&](const auto& headline) {
    return std::all_of(runs.begin(), runs.end(), [&](const Run& run) {
      return value_at(run.result, headline.second).is_null();
    });
  });
  return all;
}

}  // namespace

std::string letter(std::size_t index) {
  return std::string(1, static_cast<char>('A' + static_cast<int>(index)));
}

Json compare_runs(const std::vector<fs::path>& paths, const Tolerances& tolerances) {
  std::vector<Run> runs;
  runs.reserve(paths.size());
  for (const fs::path& path : paths) runs.push_back(read_run(path, runs.size()));
  reject_different_engines(runs);
  const Rows rows(runs, tolerances);
  Json json = {{"kind", "runs"}, {"engine", runs[0].result.at("unit")}};
  json["worse"] = rows.worse();
  json["warnings"] = warnings_of(runs);
  json["runs"] = Json::array();
  for (const Run& run : runs) json["runs"].push_back(described(run));
  json["parameters"] = parameters_of(runs);
  json["figures"] = Json::array();
  json["values"] = Json::array();
  for (const auto& [label, key] : headlines(runs)) {
    json["figures"].push_back(rows.row(key, tolerances));
    json["figures"].back()["label"] = label;
  }
  for (const std::string& key : rows.keys()) json["values"].push_back(rows.row(key, tolerances));
  return json;
}

}  // namespace deburr::tool
