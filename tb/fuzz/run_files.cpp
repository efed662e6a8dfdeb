// SPDX-License-Identifier: MIT
#include "tb/fuzz/run_files.h"

#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "spec/error.h"
#include "tb/run/picture_map.h"
#include "tb/run/result.h"
#include "tool/pages/compare_runs.h"
#include "tool/pages/report.h"

namespace deburr::tb {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 4> kRunFiles = {"result.json", "manifest.json", "intervals.json",
                                                  "map_a.pfm"};
constexpr std::string_view kBetweenFiles = "\n---\n";

class RunFolder {
 public:
  RunFolder(std::string_view bytes, const char* name)
      : path_(fs::temp_directory_path() /
              ("deburr-fuzz-" + std::to_string(::getpid()) + "-" + name)) {
    fs::create_directories(path_);
    for (const char* const file : kRunFiles) {
      const std::size_t end = bytes.find(kBetweenFiles);
      std::ofstream(path_ / file, std::ios::binary) << bytes.substr(0, end);
      if (end == std::string_view::npos) break;
      bytes.remove_prefix(end + kBetweenFiles.size());
    }
  }
  ~RunFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// A wrong type is an error of the JSON library, which the command reports (exit code 5).
template <class Read>
void taken_or_damaged(Read&& read) {
  try {
    read();
  } catch (const spec::Error&) {
  } catch (const Json::exception&) {
  }
}

Result small_result() {
  Result r;
  r.unit = "engine";
  r.verdict = Verdict::kPass;
  r.notes = {"a note"};
  r.first_mismatches = {{"colours", "cycle 8", "pixel (3, 4)", "r", "1", "2"}};
  r.comparisons = 9;
  r.mismatches = 1;
  r.cycles = 100;
  r.clock_mhz = 500;
  r.throughput = 0.5;
  r.throughput_bound = 1;
  r.throughput_unit = "bilinear/clk";
  r.latency = {1, 2, 3, 4, 5, {{1, 7}, {2, 9}}};
  r.bytes_read = 640;
  r.units = {{"filter", 60, 30, {{"memory", "m", 10}}}};
  r.bottleneck = {"filter", "memory", "m", 10};
  MemoryFigures lines;
  lines.name = "lines";
  lines.kind = "sram";
  lines.logical_bits = lines.physical_bits = 64;
  r.memories = {lines};
  r.links = {{"quads", "engine.quads", 9, {50, 50}}};
  r.maps = {{"a", "A", "clk", "m", 0, 5, 9, 6, ""}};
  r.work = {{"samples", std::uint64_t{7}, "", "m"}};
  r.figures = {{"Samples", "work.samples", "cycles", "cycles", true}};
  r.quality = Quality{"reference", 30, 20, {}, 29, 19, {}, 0.1, 0.2, 0.9, 0.8};
  r.change = Change{1, 2, {}, {}, 40};
  return r;
}

}  // namespace

void run_files(std::string_view bytes) {
  static const RunFolder known(run_files_seeds().front(), "known");
  const RunFolder folder(bytes, "run");
  taken_or_damaged([&] { tool::build_report(folder.path()); });
  taken_or_damaged([&] { tool::compare_runs({known.path(), folder.path()}, {}); });
}

std::vector<std::string> run_files_seeds() {
  Json result = to_json(small_result());
  // libFuzzer's inputs have at most 4096 bytes.
  for (Json all = std::move(result["meaning"]); const char* key : {"cycles", "work.samples"})
    result["meaning"][key] = all[key];
  result["maps"]["a"]["picture"] = "map_a.png";
  result["maps"]["a"]["values"] = "map_a.pfm";
  const Json manifest = {
      {"title", "T"},
      {"summary", "S"},
      {"command", "deburr run engine --trace x --out out"},
      {"images", Json::array()},
      {"records", {{"intervals", "intervals.json"}}},
      {"parameters",
       {{{"name", "engine.axes"}, {"kind", "rule"}, {"value", "two"}, {"default", "two"}}}},
      {"inputs", {{{"role", "mesh"}, {"file", "a.obj"}, {"sha256", "0"}}}}};
  const Json windows = {
      {"interval_cycles", 50},
      {"asked_cycles", 50},
      {"from", {0, 50}},
      {"cycles", {50, 50}},
      {"throughput", {{{"key", "work.samples"}, {"label", "L"}, {"unit", "u"}}}},
      {"series",
       {{"work", {{"samples", {3, 4}}}}, {"ports", {{"memory", {{"outstanding", {1, 2}}}}}}}}};
  PictureMap map("a", "A", "clk", "m", 3, 2);
  for (int x = 0; x < 3; ++x) map.set(x, 0, x);
  const std::string between(kBetweenFiles), rest = between + windows.dump() + between + pfm_of(map);
  return {result.dump() + between + manifest.dump() + rest};
}

}  // namespace deburr::tb
