// SPDX-License-Identifier: MIT
#include "tb/results/run_context.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

#include "spec/error.h"
#include "tb/results/build_info.h"
#include "tb/results/file.h"
#include "tb/results/interrupt.h"
#include "tb/results/report.h"
#include "tb/scene/image_io.h"
#include "tb/scene/truth.h"

namespace deburr::tb {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr const char* kManifest = "manifest.json";
constexpr const char* kTrace = "trace.vcd";
constexpr const char* kUnfinishedTrace = "trace.vcd.partial";

std::string now_utc() {
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(now)));
}

}  // namespace

RunContext::RunContext(fs::path directory, const ParameterSet& parameters, std::string command,
                       std::uint64_t seed)
    : directory_(std::move(directory)),
      parameters_(parameters),
      command_(std::move(command)),
      started_(now_utc()),
      seed_(seed) {}

fs::path RunContext::trace_file() const { return directory_ / kUnfinishedTrace; }

RunContext::~RunContext() {
  if (!claimed_) return;  // nothing here is this run's
  std::error_code ignored;
  fs::remove(trace_file(), ignored);
  if (finished_) return;
  for (const std::string& name : written_) fs::remove(directory_ / name, ignored);
}

// What an earlier run left, by its manifest; nothing without one.
std::vector<std::string> RunContext::old_results() const {
  constexpr std::size_t kMaxBytes = 64u << 20;
  std::error_code error;
  if (!fs::is_regular_file(directory_ / kManifest, error)) return {};
  const Json old = Json::parse(read_file(directory_ / kManifest, kMaxBytes), nullptr, false);
  if (!old.is_object() || !old.contains("schema") || !old.contains("configuration")) return {};
  std::vector<std::string> names = {"result.json", "report.html", kManifest};
  if (old["configuration"].is_object() && !old["configuration"].value("run.trace", "").empty())
    names.emplace_back(kTrace);
  if (old.contains("images") && old["images"].is_array())
    for (const Json& image : old["images"]) {
      const fs::path file = image.is_object() ? image.value("file", "") : "";
      // Only what an earlier run can have written: a picture in this directory.
      if (!file.has_parent_path() && file.extension() == ".png") names.push_back(file.string());
    }
  return names;
}

void RunContext::claim() {
  if (interrupted()) throw Interrupted();
  const std::vector<std::string> old = old_results();
  std::vector<std::string> concerned = old;
  for (const char* name : {"result.json", "report.html", kManifest}) concerned.emplace_back(name);
  const Parameter* trace = parameters_.find("run.trace");
  const bool traces = trace != nullptr && !trace->text().empty();
  if (traces) concerned.insert(concerned.end(), {kTrace, kUnfinishedTrace});
  for (const std::string_view name : kPictureNames)
    concerned.push_back(fmt::format("{}.png", name));
  std::error_code error;
  for (const std::string& name : concerned) {
    const fs::path file = directory_ / name;
    if (!fs::exists(file, error)) continue;
    for (const fs::path& input : protected_)
      if (fs::equivalent(file, input, error))
        throw spec::ConfigError(fmt::format(
            "the run reads '{}', and its results would replace it: choose another directory with "
            "--out",
            input.string()));
    if (std::find(old.begin(), old.end(), name) == old.end())
      throw spec::ConfigError(
          fmt::format("'{}' exists, and no manifest.json beside it names it as an earlier run's: "
                      "move it away, or choose another directory with --out",
                      file.string()));
  }
  prove_writable(directory_);
  claimed_ = true;
}

void RunContext::begin() {
  std::error_code ignored;
  for (const std::string& name : old_results()) fs::remove(directory_ / name, ignored);
  begun_ = true;
}

void RunContext::set_title(std::string title, std::string summary) {
  title_ = std::move(title);
  summary_ = std::move(summary);
}

void RunContext::add_note(const std::string& note) {
  fmt::print(stderr, "deburr: note: {}\n", note);
  summary_ += "; " + note;
}

void RunContext::add_input(const fs::path& file) {
  protect(file);
  inputs_.push_back(
      {{"file", file.string()}, {"bytes", fs::file_size(file)}, {"sha256", sha256_of_file(file)}});
}

void RunContext::add_image(const std::string& name, const Image& image, std::string title,
                           std::string caption) {
  DEBURR_CHECK(begun_, "a picture before begin()");
  DEBURR_CHECK(std::find(kPictureNames.begin(), kPictureNames.end(), name) != kPictureNames.end(),
               "kPictureNames lacks " + name);
  written_.push_back(name + ".png");
  write_image(directory_ / (name + ".png"), image);
  images_.push_back({{"file", name + ".png"},
                     {"role", name},
                     {"title", std::move(title)},
                     {"caption", std::move(caption)}});
}

// A hash of all that decides what the golden model computes: two runs with the same one have the
// same golden result. Files count by their content. A line that memory answers with an error reads
// as zero, and how long that is depends on what is built.
std::string RunContext::golden_key() const {
  Json key = {{"input", parameters_.resolved(ParameterKind::kInput)},
              {"rule", parameters_.resolved(ParameterKind::kRule)},
              {"seed", seed_}};
  for (const Parameter& p : parameters_.all())
    if (p.name.ends_with("error_address") && p.text() != p.default_value)
      key["build"] = parameters_.resolved(ParameterKind::kBuild);
  for (const Json& input : inputs_) key["files"].push_back(input["sha256"]);
  return sha256(key.dump());
}

Json RunContext::manifest(const Result& result) const {
  const BuildInfo& build = build_info();
  Json json;
  json["schema"] = kResultSchema;
  json["unit"] = result.unit;
  json["title"] = title_;
  json["summary"] = summary_;
  json["command"] = command_;
  json["seed"] = seed_;
  json["version"] = build.version;
  json["commit"] = build.commit;
  json["compiler"] = build.compiler;
  json["build"] = build.build;
  json["systemc"] = build.systemc;
  json["started"] = started_;
  json["configuration"] = parameters_.resolved();
  json["rules"] = parameters_.resolved(ParameterKind::kRule);
  json["build"] = parameters_.resolved(ParameterKind::kBuild);
  json["golden"] = golden_key();
  json["inputs"] = inputs_;
  json["host"] = {{"seconds", result.host_seconds}, {"mcycles_per_s", result.mcycles_per_s()}};
  json["images"] = images_;
  json["parameters"] = Json::array();
  for (const Parameter& p : parameters_.all())
    json["parameters"].push_back({{"name", p.name},
                                  {"kind", kind_name(p)},
                                  {"value", p.text()},
                                  {"default", p.default_value},
                                  {"range", p.range},
                                  {"unit", p.unit},
                                  {"meaning", p.meaning}});
  return json;
}

void RunContext::finish(const Result& result) {
  DEBURR_CHECK(begun_, "results before begin()");
  std::error_code none;
  if (fs::exists(trace_file(), none)) {
    written_.emplace_back(kTrace);
    std::error_code error;
    fs::rename(trace_file(), directory_ / kTrace, error);
    if (error)
      throw spec::FileError(fmt::format("'{}' cannot be renamed to {}: {}", trace_file().string(),
                                        kTrace, error.message()));
  }
  written_.emplace_back(kManifest);
  write_file_atomically(directory_ / kManifest, manifest(result).dump(2) + "\n");
  write_file_atomically(directory_ / "result.json", to_json(result).dump(2) + "\n");
  finished_ = true;
  try {
    write_report(directory_);
  } catch (const spec::FileError& error) {
    throw spec::FileError(fmt::format("{}; the results are there, and `deburr report {}` makes it",
                                      error.what(), directory_.string()));
  }
}

}  // namespace deburr::tb
