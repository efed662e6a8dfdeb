// SPDX-License-Identifier: MIT
// A directory of results. One run at a time owns it, writes to a draft, and replaces the existing
// results when the draft is complete.
//
//   DIR/                           the results of the last completed run
//   DIR/.deburr_run/               the draft of a run in progress
//   DIR/.deburr_run/claim.json     its locked owner; the kernel releases the lock of a dead one
//   DIR/.deburr_run/manifest.json  written last: it completes the draft
//
// If a run is killed before it writes manifest.json, the earlier results are unchanged, and the
// next run discards the draft. If it is killed later, the next run completes the move. During the
// move result.json is missing, so a mixture of old and new files is never taken for a result.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace deburr::tool {

// Behaviour if the directory is in use.
enum class IfTaken { kReject, kWait };

class RunDirectory {
 public:
  explicit RunDirectory(std::filesystem::path path) : path_(std::move(path)) {}
  // If publish() was not called, removes the draft and every folder created for it.
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  // Creates and locks the directory and checks that it is writable. `names` are the files that may
  // be written in addition to manifest.json; `command` is shown to other processes. FileError if
  // the directory is not writable, or if another run holds it (IfTaken::kReject). ConfigError if
  // one of the names is a file that no earlier run wrote. Interrupted after Ctrl-C while waiting.
  void claim(const std::string& command, std::vector<std::string> names, IfTaken if_taken);
  // ConfigError if the input `file` would be replaced or removed. Call after claim().
  void reject_to_replace(const std::filesystem::path& file) const;
  // Replaces the earlier results with everything in draft(), as listed by `manifest`. `head` is the
  // file that makes a directory a result. After a FileError the earlier results are intact.
  void publish(nlohmann::ordered_json manifest, std::string_view head);

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path draft() const;

 private:
  void lock(IfTaken if_taken);
  bool try_lock();
  void write_claim(const std::string& command) const;
  void move_in() const;
  void clear_draft() const;
  void release();
  std::set<std::string> earlier() const;

  std::filesystem::path path_;
  std::vector<std::filesystem::path> made_;  // created folders, deepest first
  std::vector<std::string> names_;
  int lock_ = -1;  // file descriptor of the claim
};

}  // namespace deburr::tool
