// SPDX-License-Identifier: MIT
// The files that a run depends on: what they hold, in a word that goes into keys, and how they are
// listed. Which they are an engine says (Engine::input_files), those too that files name, and those
// that are not there: a run is another one when they are.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tb/scene/mesh.h"

namespace deburr::tool {

inline constexpr std::string_view kMissingFile = "missing";        // there is no such file
inline constexpr std::string_view kUnreadableFile = "unreadable";  // a folder, a pipe, locked
// The SHA-256 of what the file holds, or one of these.
std::string content_of(const std::filesystem::path& file);

// An entry of the "inputs" of a manifest, or of what was collected. What only helped to say what is
// run, and is said by the parameters as well, has a role: "configuration", "definition".
nlohmann::ordered_json input_entry(const std::filesystem::path& file, std::string_view content,
                                   std::string_view role = "");
// What content_of() said of it.
std::string listed_content(const nlohmann::ordered_json& entry);

// What differs between two such lists, but for entries with a role: "A reads ..., B reads ..."; ""
// where nothing does. A file is known by its content: it may have been moved.
std::string different_inputs(const nlohmann::ordered_json& a, const nlohmann::ordered_json& b);

// What files hold, found out once, however many runs read them.
class InputFiles {
 public:
  const std::string& content(const std::filesystem::path& file);
  // Of several, for a key.
  std::vector<std::string> contents(const std::vector<std::filesystem::path>& files);
  // FileError if one of them, asked for before, is not as it was then.
  void reject_changed(const std::vector<std::filesystem::path>& files);
  // All that were asked for, and what they hold.
  std::map<std::string, std::string> all() const;
  tb::MeshFiles& meshes() { return meshes_; }

 private:
  // What no file keeps when it is written, or replaced.
  struct Stamp {
    std::uint64_t device = 0, number = 0, bytes = 0;
    std::int64_t written_s = 0, written_ns = 0, changed_s = 0, changed_ns = 0;
    friend bool operator==(const Stamp&, const Stamp&) = default;
  };
  struct Known {
    std::string content;
    Stamp stamp;
  };
  static Stamp stamp_of(const std::filesystem::path& file);

  std::map<std::filesystem::path, Known> known_;
  tb::MeshFiles meshes_;
};

}  // namespace deburr::tool
