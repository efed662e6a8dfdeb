// SPDX-License-Identifier: MIT
#include "tool/pages/run_context.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "spec/error.h"
#include "tb/base/atomic_file.h"
#include "tb/base/file.h"
#include "tb/base/interrupt.h"
#include "tb/base/json_text.h"
#include "tb/scene/image_io.h"
#include "tb/scene/png.h"
#include "tb/scene/reference.h"
#include "tool/pages/build_info.h"
#include "tool/pages/report.h"

namespace deburr::tool {

using tb::Parameter;
using tb::ParameterKind;

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr const char* kResult = "result.json";
constexpr const char* kReport = "report.html";

std::string now_utc() {
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(now)));
}

// An undeclared output could replace a user's file.
void check_declared(const std::string& name, const std::vector<std::string>& declared,
                    std::string_view what) {
  DEBURR_CHECK(std::find(declared.begin(), declared.end(), name) != declared.end(),
               fmt::format("the engine declares no {} '{}'", what, name));
}

}  // namespace

Json golden_dependencies(const tb::ParameterSet& parameters, std::uint64_t seed,
                         const std::vector<std::string_view>& built) {
  Json key = {{"seed", seed}};
  for (const Parameter& p : parameters.all())
    if (p.kind == ParameterKind::kInput || p.kind == ParameterKind::kRule ||
        std::find(built.begin(), built.end(), p.name) != built.end())
      key[p.name] = p.json();
  return key;
}

struct RunContext::Listed {
  Json inputs = Json::array(), images = Json::array(), records = Json::object();

  // The picture of the golden model comes after that of the hardware model and is usually
  // identical. Comparing both costs a hundredth of the time of encoding one.
  const std::string& png_of(const tb::Image& image) {
    DEBURR_CHECK(!image.pixels.empty(), "a picture without pixels");
    if (image.width != last_.width || image.pixels != last_.pixels) {
      last_ = image;
      png_ = encode_png(image);
    }
    return png_;
  }

 private:
  tb::Image last_;
  std::string png_;
};

RunContext::RunContext(fs::path directory, const tb::ParameterSet& parameters, std::string command,
                       std::uint64_t seed)
    : directory_(std::move(directory)),
      parameters_(parameters),
      command_(std::move(command)),
      started_(now_utc()),
      seed_(seed),
      listed_(std::make_unique<Listed>()) {}
RunContext::~RunContext() = default;

fs::path RunContext::draft_file(const char* name) const {
  return checking_only_ ? "/dev/null" : directory_.draft() / name;
}

void RunContext::claim(IfTaken if_taken) {
  std::vector<std::string> names = {kResult, kReport};
  // Parameters that request files: the name, the value that requests no file, and the file.
  constexpr std::array<std::array<std::string_view, 3>, 5> kAsked = {
      {{"run.trace", "", "trace.vcd"},
       {"run.line_trace", "none", "lines.trace"},
       {"run.fragment_trace", "none", "fragments.trace"},
       {"run.interval_cycles", "0", kIntervalsFile},
       {"run.timeline", "false", kTimelineFile}}};
  const auto is_set = [this](std::string_view parameter, std::string_view nothing) {
    const Parameter* found = parameters_.find(parameter);
    return found != nullptr && found->text() != nothing;
  };
  for (const auto& [parameter, nothing, file] : kAsked)
    if (is_set(parameter, nothing)) names.emplace_back(file);
  if (is_set("run.maps", "false"))
    for (const std::string& name : leaves_.maps)
      for (const char* kind : {"png", "pfm"}) names.push_back(fmt::format("map_{}.{}", name, kind));
  for (const std::string& name : leaves_.pictures) names.push_back(fmt::format("{}.png", name));
  directory_.claim(command_, std::move(names), if_taken);
}

void RunContext::set_title(std::string title, std::string summary) {
  title_ = std::move(title);
  summary_ = std::move(summary);
}

void RunContext::add_note(const std::string& note) {
  if (!quiet_) fmt::print(stderr, "deburr: note: {}\n", note);
  notes_.push_back(note);
}

void RunContext::share(std::shared_ptr<SharedInputs> shared, std::vector<fs::path> files) {
  shared_ = std::move(shared);
  shared_files_ = std::move(files);
  for (fs::path& file : surroundings_files(parameters_)) shared_files_.push_back(std::move(file));
}

std::string RunContext::shared_bytes(std::string_view what,
                                     std::initializer_list<std::string_view> prefixes,
                                     const std::function<std::string()>& make) const {
  if (!shared_) return make();
  return shared_->bytes(key_of(what, prefixes), [&] {
    std::string made = make();
    shared_->files().reject_changed(shared_files_);
    return made;
  });
}

void RunContext::add_inputs(const std::vector<fs::path>& files) {
  const auto add = [this](const std::vector<fs::path>& some, std::string_view role) {
    for (const fs::path& file : some) {
      DEBURR_CHECK(!shared_ || std::find(shared_files_.begin(), shared_files_.end(), file) !=
                                   shared_files_.end(),
                   fmt::format("'{}' was read but is in no key", file.string()));
      list(file, shared_ ? shared_->files().content(file) : content_of(file), role);
    }
    if (shared_) shared_->files().reject_changed(some);
  };
  add(files, "");
  add(surroundings_files(parameters_), "surroundings");
}

// Records the text that was read: a pipe can be read only once.
void RunContext::add_configuration(const fs::path& file, const std::string& text) {
  list(file, tb::sha256(text), "configuration")["bytes"] = text.size();
}

Json& RunContext::list(const fs::path& file, std::string_view content, std::string_view role) {
  directory_.reject_to_replace(file);
  Json entry = input_entry(file, content, role);
  std::error_code error;
  if (entry.contains("sha256")) entry["bytes"] = fs::file_size(file, error);
  return listed_->inputs.emplace_back(std::move(entry));
}

bool RunContext::writes_images() const {
  const Parameter* wanted = parameters_.find("run.images");
  return wanted == nullptr || wanted->text() != "false";
}

std::string RunContext::add_frame(int number, const tb::Image& image) {
  if (!writes_images()) return "";
  std::string file = fmt::format("frame_{:04}.png", number);
  tb::write_file_atomically(directory_.draft() / file, listed_->png_of(image));
  return file;
}

void RunContext::add_image(const std::string& name, const tb::Image& image, std::string title,
                           std::string caption) {
  check_declared(name, leaves_.pictures, "picture");
  if (!writes_images()) return;
  tb::write_file_atomically(directory_.draft() / (name + ".png"), listed_->png_of(image));
  listed_->images.push_back({{"file", name + ".png"},
                             {"role", name},
                             {"title", std::move(title)},
                             {"caption", std::move(caption)}});
}

void RunContext::add_map(const tb::PictureMap& map) {
  check_declared(map.name, leaves_.maps, "map");
  const std::string file = fmt::format("map_{}", map.name);
  write_image(directory_.draft() / (file + ".png"), picture_of(map));
  tb::write_file_atomically(directory_.draft() / (file + ".pfm"), pfm_of(map));
  listed_->images.push_back({{"file", file + ".png"},
                             {"role", file},
                             {"title", "Map: " + map.title},
                             {"caption", fmt::format("{} Values in {}.pfm.", map.meaning, file)}});
}

void RunContext::add_record(const std::string& kind, std::string_view file,
                            std::string_view content) {
  tb::write_file_atomically(directory_.draft() / file, content);
  listed_->records[kind] = file;
}

// A hash of everything that affects the golden model: runs with the same hash have the same golden
// result. Files are hashed by content. A memory line with an error reads as zero, and its size is a
// build parameter.
std::string RunContext::golden_key() const {
  Json key = {{"input", parameters_.resolved(ParameterKind::kInput)},
              {"rule", parameters_.resolved(ParameterKind::kRule)},
              {"seed", seed_}};
  for (const Parameter& p : parameters_.all())
    if (p.name.ends_with("error_address") && p.text() != p.default_value)
      key["build"] = parameters_.resolved(ParameterKind::kBuild);
  for (const Json& input : listed_->inputs)
    if (!input.contains("role")) key["files"].push_back(listed_content(input));
  return tb::sha256(tb::json_text(key));
}

bool RunContext::may_share_golden() const {
  const Parameter* check = parameters_.find("run.check");
  return check != nullptr && check->text() == "golden" &&
         std::none_of(parameters_.all().begin(), parameters_.all().end(), [](const Parameter& p) {
           return p.name.ends_with("error_address") && p.text() != p.default_value;
         });
}

std::string RunContext::key_of_golden(const std::vector<std::string_view>& built) const {
  Json key = golden_dependencies(parameters_, seed_, built);
  key["files"] = shared_->files().contents(shared_files_);
  return tb::json_text(key);
}

std::string RunContext::key_of(std::string_view what,
                               std::initializer_list<std::string_view> prefixes) const {
  Json key = {{"what", what}, {"seed", seed_}, {"files", shared_->files().contents(shared_files_)}};
  for (const Parameter& p : parameters_.all()) {
    if (std::none_of(prefixes.begin(), prefixes.end(),
                     [&](std::string_view prefix) { return p.name.starts_with(prefix); }))
      continue;
    key[p.name] = p.json();
  }
  return tb::json_text(key);
}

Json RunContext::manifest(const tb::Result& result) const {
  const BuildInfo& build = build_info();
  Json json;
  json["schema"] = tb::kResultSchema;
  json["state"] = "complete";
  json["unit"] = result.unit;
  json["title"] = title_;
  json["summary"] = summary_;
  json["command"] = command_;
  // Base of relative file names.
  std::error_code error;
  json["working_directory"] = fs::current_path(error).string();
  json["seed"] = seed_;
  json["version"] = build.version;
  json["commit"] = build.commit;
  json["model"] = build.model;
  json["compiler"] = build.compiler;
  json["build_type"] = build.build;
  json["systemc"] = build.systemc;
  json["started"] = started_;
  json["configuration"] = parameters_.resolved();
  json["rules"] = parameters_.resolved(ParameterKind::kRule);
  json["build"] = parameters_.resolved(ParameterKind::kBuild);
  json["golden"] = golden_key();
  json["inputs"] = listed_->inputs;
  json["host"] = {{"seconds", result.host_seconds}, {"mcycles_per_s", result.mcycles_per_s()}};
  json["images"] = listed_->images;
  if (leaves_.pixel_history) json["pixel_history"] = true;
  if (!listed_->records.empty()) json["records"] = listed_->records;
  json["parameters"] = Json::array();
  for (const Parameter& p : parameters_.all()) {
    json["parameters"].push_back({{"name", p.name},
                                  {"kind", kind_name(p)},
                                  {"value", p.text()},
                                  {"from", parameters_.origin(p)},
                                  {"default", p.default_value},
                                  {"range", p.range},
                                  {"unit", p.unit},
                                  {"meaning", p.meaning}});
    if (!parameters_.has_effect(p.name)) json["parameters"].back()["effect"] = false;
    if (p.work != tb::GivenWork::kNone)
      json["parameters"].back()["work"] = std::string(name_of(p.work, tb::kGivenWorkNames));
  }
  return json;
}

void RunContext::finish(const tb::Result& result) {
  tb::Result noted = result;
  noted.notes = notes_;
  Json json = to_json(noted);
  const Json origin = manifest(result);
  const fs::path draft = directory_.draft();
  tb::write_file_atomically(draft / kResult, tb::json_text(json, 2) + "\n");
  if (report_)
    tb::write_file_atomically(draft / kReport, build_report(draft, std::move(json), origin));
  directory_.publish(origin, kResult);
}

}  // namespace deburr::tool
