// SPDX-License-Identifier: MIT
#include "tool/pages/run_directory.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>
#include <system_error>
#include <thread>
#include <utility>

#include "spec/error.h"
#include "tb/base/atomic_file.h"
#include "tb/base/file.h"
#include "tb/base/interrupt.h"
#include "tb/base/json_text.h"
#include "tb/scene/reference.h"

namespace deburr::tool {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr const char* kDraft = ".deburr_run";
constexpr const char* kClaim = "claim.json";
constexpr const char* kManifest = "manifest.json";
constexpr std::size_t kMaxJsonBytes = 64u << 20;

Json read_json(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return nullptr;
  return tb::try_parse_json(tb::read_file(file, kMaxJsonBytes));
}

// The files listed in a manifest, in order. Only names that a run can have written are returned,
// since a manifest of unknown origin must not cause other files to be deleted.
std::vector<std::string> files_of(const fs::path& manifest) {
  constexpr std::array<std::string_view, 7> kExtensions = {".png",  ".pfm", ".json", ".csv",
                                                           ".html", ".vcd", ".trace"};
  std::vector<std::string> names;
  const Json json = read_json(manifest);
  if (!json.is_object() || !json.contains("files") || !json["files"].is_array()) return names;
  for (const Json& entry : json["files"]) {
    const fs::path file = entry.is_string() ? entry.get<std::string>() : "";
    if (!file.has_parent_path() && std::find(kExtensions.begin(), kExtensions.end(),
                                             file.extension().string()) != kExtensions.end())
      names.push_back(file.string());
  }
  return names;
}

// "process 12 on host since TIME (deburr run ...)"; empty until it can be read.
std::string holder(const fs::path& claim) {
  try {
    const Json json = read_json(claim);
    if (!json.is_object()) return "";
    return fmt::format("process {} on {} since {} ({})", json.value("process", 0),
                       json.value("host", "?"), json.value("started", "?"),
                       json.value("command", "?"));
  } catch (const spec::FileError&) {  // removed meanwhile
    return "";
  } catch (const Json::exception&) {
    return "";
  }
}

[[noreturn]] void fail(std::string_view action, const fs::path& path, const std::string& reason) {
  throw spec::FileError(
      fmt::format("cannot {} '{}': {}; make room there, or choose another directory with --out",
                  action, path.string(), reason));
}

[[noreturn]] void reject_foreign(const fs::path& file) {
  throw spec::ConfigError(
      fmt::format("'{}' exists, but no manifest.json next to it lists it as a file of an earlier "
                  "run: move it away, or choose another directory with --out",
                  file.string()));
}

void put(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error)
    throw spec::FileError(
        fmt::format("cannot move '{}' to '{}': {}; the results are complete, and the next run into "
                    "this directory moves them first",
                    from.string(), to.string(), error.message()));
}

}  // namespace

fs::path RunDirectory::draft() const { return path_ / kDraft; }

RunDirectory::~RunDirectory() {
  try {
    // A complete draft is kept for the next run.
    std::error_code ignored;
    if (lock_ >= 0 && !fs::exists(draft() / kManifest, ignored)) clear_draft();
  } catch (const spec::FileError&) {  // the next run retries
  }
  release();
}

// ---- claiming -----------------------------------------------------------------------------------

void RunDirectory::claim(const std::string& command, std::vector<std::string> names,
                         IfTaken if_taken) {
  names_ = std::move(names);
  lock(if_taken);
  if (fs::exists(draft() / kManifest)) move_in();  // a run died while moving its results
  clear_draft();
  write_claim(command);
  const std::set<std::string> ours = earlier();
  names_.emplace_back(kManifest);
  for (const std::string& name : names_)
    if (fs::exists(fs::symlink_status(path_ / name)) && !ours.contains(name))
      reject_foreign(path_ / name);
}

void RunDirectory::lock(IfTaken if_taken) {
  using std::chrono::steady_clock;
  constexpr auto kPoll = std::chrono::milliseconds(20);
  // The longest time from when a run locks the file to when its entry is in the file.
  const auto patience = steady_clock::now() + std::chrono::seconds(2);
  bool told = false;
  while (!try_lock()) {
    const std::string other = holder(draft() / kClaim);
    if (if_taken == IfTaken::kReject && (!other.empty() || steady_clock::now() > patience))
      throw spec::FileError(
          fmt::format("'{}' is used by another run{}: wait for its end (--wait), or choose another "
                      "directory with --out",
                      path_.string(), other.empty() ? "" : ", " + other));
    if (if_taken == IfTaken::kWait && !told && !other.empty()) {
      fmt::print(stderr, "deburr: waiting for '{}', which is used by {}\n", path_.string(), other);
      told = true;
    }
    if (tb::interrupted()) throw tb::Interrupted();
    std::this_thread::sleep_for(kPoll);
  }
}

// Returns false if another run holds the lock, or has just released it and removed the folder.
bool RunDirectory::try_lock() {
  std::error_code error;
  for (fs::path p = fs::absolute(draft()).lexically_normal(); !fs::exists(p, error) && !error;
       p = p.parent_path())
    if (std::find(made_.begin(), made_.end(), p) == made_.end()) made_.push_back(p);
  std::sort(made_.begin(), made_.end(), std::greater<>());
  if (!fs::exists(fs::symlink_status(draft(), error))) fs::create_directories(draft(), error);
  if (error) fail("make the folder", path_, error.message());
  if (!fs::is_directory(fs::symlink_status(draft())))
    fail("make the folder", draft(), "something that is not a folder has its name");
  const fs::path file = draft() / kClaim;
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (descriptor < 0 && errno == ENOENT) return false;
  if (descriptor < 0) fail("create a file in", path_, std::strerror(errno));
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    const int reason = errno;
    ::close(descriptor);
    if (reason == EWOULDBLOCK || reason == EINTR) return false;
    fail("lock a file in", path_, std::strerror(reason));
  }
  struct stat locked {
  }, named{};
  if (::fstat(descriptor, &locked) != 0 || ::stat(file.c_str(), &named) != 0 ||
      locked.st_ino != named.st_ino || locked.st_dev != named.st_dev) {
    ::close(descriptor);
    return false;
  }
  // Discards the entry of a dead run.
  if (::ftruncate(descriptor, 0) != 0) fail("write in", path_, std::strerror(errno));
  lock_ = descriptor;
  return true;
}

void RunDirectory::write_claim(const std::string& command) const {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  const Json json = {{"state", "running"},
                     {"process", ::getpid()},
                     {"host", host.data()},
                     {"started", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now))},
                     {"command", command}};
  const std::string text = tb::json_text(json, 2) + "\n";
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t written = ::write(lock_, text.data() + done, text.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("write in", path_, std::strerror(errno));
    done += static_cast<std::size_t>(written);
  }
  if (::fsync(lock_) != 0) fail("write in", path_, std::strerror(errno));
}

std::set<std::string> RunDirectory::earlier() const {
  const std::vector<std::string> files = files_of(path_ / kManifest);
  std::set<std::string> names(files.begin(), files.end());
  if (!names.empty()) names.insert(kManifest);
  return names;
}

void RunDirectory::reject_to_replace(const fs::path& file) const {
  // Files of an earlier run are removed too, unless this run replaces them.
  std::set<std::string> going = earlier();
  going.insert(names_.begin(), names_.end());
  std::error_code error;
  for (const std::string& name : going)
    if (fs::exists(path_ / name, error) && fs::equivalent(path_ / name, file, error))
      throw spec::ConfigError(fmt::format(
          "the results would overwrite the input '{}': choose another directory with --out",
          file.string()));
}

// ---- releasing ----------------------------------------------------------------------------------

void RunDirectory::publish(Json manifest, std::string_view head) {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(draft()))
    if (const std::string name = entry.path().filename().string(); name != kClaim)
      files.push_back(name);
  std::sort(files.begin(), files.end(), [&](const std::string& a, const std::string& b) {
    return std::pair(a == head, a) < std::pair(b == head, b);
  });
  // A user may have added a file meanwhile.
  const std::set<std::string> ours = earlier();
  for (const std::string& name : files)
    if (fs::exists(fs::symlink_status(path_ / name)) && !ours.contains(name))
      reject_foreign(path_ / name);
  manifest["files"] = files;
  tb::write_file_atomically(draft() / kManifest, tb::json_text(manifest, 2) + "\n");
  move_in();
  made_.clear();
  release();
}

// Moves a complete draft into place, or resumes an interrupted move. Moved files are no longer in
// the draft.
void RunDirectory::move_in() const {
  const std::vector<std::string> mine = files_of(draft() / kManifest);
  const auto waits = [&](const std::string& name) { return fs::exists(draft() / name); };
  std::vector<std::string> old = files_of(path_ / kManifest);
  if (!mine.empty() && !waits(mine.back())) old.clear();  // all but the manifest has moved
  std::error_code error;
  for (auto name = old.rbegin(); name != old.rend(); ++name)
    if (std::find(mine.begin(), mine.end(), *name) == mine.end() ||
        (waits(*name) && *name == mine.back()))
      if (fs::remove(path_ / *name, error); error)
        fail("remove an earlier run's", path_ / *name, error.message());
  for (const std::string& name : mine)
    if (waits(name)) put(draft() / name, path_ / name);
  put(draft() / kManifest, path_ / kManifest);
}

void RunDirectory::clear_draft() const {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(draft(), error))
    if (entry.path().filename() != kClaim && (fs::remove_all(entry.path(), error), error))
      fail("remove a file of a killed run,", entry.path(), error.message());
}

// Deletes the claim while it is locked, so that a process waiting for the lock notices that the
// file is gone.
void RunDirectory::release() {
  std::error_code ignored;
  if (lock_ >= 0) {
    ::unlink((draft() / kClaim).c_str());
    ::rmdir(draft().c_str());
    ::close(lock_);
    lock_ = -1;
  }
  for (const fs::path& folder : made_) ::rmdir(folder.c_str());  // only empty ones
  made_.clear();
}

}  // namespace deburr::tool
