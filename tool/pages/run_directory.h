// SPDX-License-Identifier: MIT
// The life of a directory of results: one run at a time owns it, writes beside the results that are
// there, and puts its own in their place when they are complete.
//
//   DIR/                        the results of the last run that came to its end
//   DIR/.deburr_run/            the draft: everything of a run that is not over
//   DIR/.deburr_run/claim.json  who is at it, locked; the kernel opens the lock of a dead process
//   DIR/.deburr_run/manifest.json  written last: with it the draft is complete and takes their
//   place
//
// Killed before that, the earlier results are as they were and the next run throws the draft away;
// killed after it, the next run finishes what was begun. In between, when files change places, the
// last of them (result.json) is missing, so that nobody takes a mixture for a result.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace deburr::tool {

// What a run does that finds its directory taken.
enum class IfTaken { kReject, kWait };

class RunDirectory {
 public:
  explicit RunDirectory(std::filesystem::path path) : path_(std::move(path)) {}
  // Without publish(): the draft goes, and every folder that was made for it.
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  // Makes the directory, takes it and proves it writable; `names` are the files that may be left
  // there besides manifest.json, `command` is what others are told. FileError when another run has
  // it (IfTaken::kReject) or nothing can be written; ConfigError where one of the names is a file
  // that no earlier run left; Interrupted by Ctrl-C while it waits.
  void claim(const std::string& command, std::vector<std::string> names, IfTaken if_taken);
  // ConfigError if `file`, which is read, would be replaced or removed. After claim().
  void reject_to_replace(const std::filesystem::path& file) const;
  // Everything in draft() takes the place of the earlier results; `manifest` lists it. `head` is
  // the file without which nothing is a result. FileError leaves the earlier results whole.
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
  std::vector<std::filesystem::path> made_;  // folders that were not there, the deepest first
  std::vector<std::string> names_;
  int lock_ = -1;  // descriptor of the claim
};

}  // namespace deburr::tool
