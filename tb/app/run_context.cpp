// SPDX-License-Identifier: MIT
#include "tb/app/run_context.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <utility>

#include "tb/app/build_info.h"
#include "tb/app/file.h"
#include "tb/app/report.h"
#include "tb/scene/image_io.h"

namespace deburr::tb {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

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
      seed_(seed) {
  prove_writable(directory_);
  remove_old_results();
}

void RunContext::remove_old_results() {
  std::error_code error;
  constexpr std::size_t kMaxBytes = 64u << 20;
  if (fs::is_regular_file(directory_ / "manifest.json", error)) {
    const Json old =
        Json::parse(read_file(directory_ / "manifest.json", kMaxBytes), nullptr, false);
    if (old.is_object() && old.contains("images") && old["images"].is_array())
      for (const Json& image : old["images"]) {
        const fs::path file = image.is_object() ? image.value("file", "") : "";
        // Only what an earlier run can have written: a picture in this directory.
        if (!file.has_parent_path() && file.extension() == ".png")
          fs::remove(directory_ / file, error);
      }
  }
  for (const char* name : {"result.json", "manifest.json", "report.html", "trace.vcd"})
    fs::remove(directory_ / name, error);
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
  inputs_.push_back(
      {{"file", file.string()}, {"bytes", fs::file_size(file)}, {"sha256", sha256_of_file(file)}});
}

void RunContext::add_image(const std::string& name, const Image& image, std::string title,
                           std::string caption) {
  write_image(directory_ / (name + ".png"), image);
  images_.push_back({{"file", name + ".png"},
                     {"role", name},
                     {"title", std::move(title)},
                     {"caption", std::move(caption)}});
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
  json["inputs"] = inputs_;
  json["host"] = {{"seconds", result.host_seconds}, {"mcycles_per_s", result.mcycles_per_s()}};
  json["bottleneck"] = bottleneck_;
  json["images"] = images_;
  json["parameters"] = Json::array();
  for (const Parameter& p : parameters_.all())
    json["parameters"].push_back({{"name", p.name},
                                  {"value", p.text()},
                                  {"default", p.default_value},
                                  {"range", p.range},
                                  {"unit", p.unit},
                                  {"meaning", p.meaning}});
  return json;
}

void RunContext::finish(const Result& result) {
  write_file_atomically(directory_ / "manifest.json", manifest(result).dump(2) + "\n");
  write_file_atomically(directory_ / "result.json", to_json(result).dump(2) + "\n");
  write_report(directory_);
}

}  // namespace deburr::tb
