// SPDX-License-Identifier: MIT
#include "tool/sweep/point.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>

#include "spec/error.h"
#include "tb/base/atomic_file.h"
#include "tb/base/file.h"
#include "tb/base/json_text.h"
#include "tb/base/shell.h"
#include "tool/pages/build_info.h"

namespace deburr::tool {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kFailure = "failure.json";
constexpr std::size_t kMaxFailureBytes = 1 << 20;
constexpr std::size_t kDigits = 24;

// Whether a running process holds the directory.
bool is_taken(const fs::path& directory) {
  const fs::path claim = directory / ".deburr_run" / "claim.json";
  const int descriptor = ::open(claim.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool taken = ::flock(descriptor, LOCK_EX | LOCK_NB) != 0;
  ::close(descriptor);
  return taken;
}

// The verdict comes before all lists, so that the whole result need not be read.
bool says_fail(const fs::path& result) {
  std::array<char, 256> head{};
  std::ifstream file(result);
  file.read(head.data(), head.size());
  const std::string_view text(head.data(), static_cast<std::size_t>(file.gcount()));
  return text.find("\"verdict\": \"fail\"") != std::string_view::npos;
}

}  // namespace

PointEngine::PointEngine(const std::string& name, const std::vector<Setting>& settings)
    : engine(engine_named(name)), bound(*engine) {
  for (const Setting& setting : settings) bound.set.set(setting.name, setting.value, setting.where);
}

std::string point_name(const BoundEngine& bound, InputFiles& files) {
  std::string key = fmt::format("{}\n{}\n", bound.engine.name(), build_info().model);
  for (const tb::Parameter& p : bound.set.all()) key += fmt::format("{}={}\n", p.name, p.text());
  std::vector<fs::path> inputs = bound.engine.input_files(files.meshes());
  for (fs::path& file : surroundings_files(bound.set)) inputs.push_back(std::move(file));
  for (const std::string& content : files.contents(inputs)) key += fmt::format("  {}\n", content);
  return tb::sha256(key).substr(0, kDigits);
}

std::string input_name(const BoundEngine& bound) {
  std::string key;
  for (const tb::Parameter& p : bound.set.all())
    if (p.kind == tb::ParameterKind::kInput || p.name == "run.seed")
      key += fmt::format("{}={}\n", p.name, p.text());
  return key;
}

std::string golden_name(const BoundEngine& bound) {
  return tb::json_text(golden_dependencies(bound.set, static_cast<std::uint64_t>(bound.run.seed),
                                           bound.engine.built_for_golden()));
}

fs::path point_directory(const fs::path& points, std::string_view name) {
  return points / name.substr(0, 2) / name;
}

PointState state_of(const fs::path& directory) {
  std::error_code error;
  if (!fs::is_directory(directory, error)) return PointState::kMissing;
  if (fs::exists(directory / kFailure, error)) return PointState::kFailed;
  if (has_result(directory)) return PointState::kDone;
  return is_taken(directory) ? PointState::kRunning : PointState::kMissing;
}

bool has_result(const fs::path& directory) {
  std::error_code error;
  return fs::exists(directory / "result.json", error) &&
         fs::exists(directory / "manifest.json", error) && !says_fail(directory / "result.json");
}

bool has_failed_result(const fs::path& directory) {
  std::error_code error;
  return fs::exists(directory / kFailure, error) && says_fail(directory / "result.json");
}

Failure read_failure(const fs::path& directory) {
  const Json json = tb::try_parse_json(tb::read_file(directory / kFailure, kMaxFailureBytes));
  if (!json.is_object()) return {"unknown", "failure.json cannot be read", true};
  return {json.value("kind", "unknown"), json.value("reason", ""), json.value("again", true)};
}

void write_failure(const fs::path& directory, const Failure& failure) {
  std::error_code error;
  fs::create_directories(directory, error);
  const Json json = {{"kind", failure.kind}, {"reason", failure.reason}, {"again", failure.again}};
  // A reason may contain bytes of an invalid file.
  tb::write_file_atomically(directory / kFailure,
                            tb::json_text(json, 2, tb::NotUtf8::kReplace) + "\n");
}

void remove_failure(const fs::path& directory) {
  std::error_code ignored;
  fs::remove(directory / kFailure, ignored);
}

std::string arguments_of(const std::string& engine, const std::vector<Setting>& settings) {
  std::string arguments = "run " + engine;
  for (const Setting& setting : settings)
    arguments += " --set " + tb::shell_quoted(fmt::format("{}={}", setting.name, setting.value));
  return arguments;
}

std::string command_of(const std::string& engine, const std::vector<Setting>& settings) {
  return "deburr " + arguments_of(engine, settings);
}

}  // namespace deburr::tool
