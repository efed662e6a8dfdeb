// SPDX-License-Identifier: MIT
// The files that a run depends on: hashes of their contents for keys, and their entries in
// manifests. The engine lists them (Engine::input_files). The list includes files that other files
// name, and files that do not exist, since creating one changes the run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tb/run/parameter_set.h"
#include "tb/scene/mesh.h"

namespace deburr::tool {

inline constexpr std::string_view kMissingFile = "missing";  // there is no such file
// a folder, a pipe, or no permission
inline constexpr std::string_view kUnreadableFile = "unreadable";
// The SHA-256 of the file's content, or one of the two names above.
std::string content_of(const std::filesystem::path& file);

// The files that parameters of the surroundings name (memory.latency_file), which no engine lists.
std::vector<std::filesystem::path> surroundings_files(const tb::ParameterSet& set);

// An entry of "inputs" in a manifest or a collection. A file that is not data of the engine has a
// role: "surroundings", or one that defines the run, whose parameters describe it too
// ("configuration", "definition").
nlohmann::ordered_json input_entry(const std::filesystem::path& file, std::string_view content,
                                   std::string_view role = "");
// The content_of() that the entry records.
std::string listed_content(const nlohmann::ordered_json& entry);

// Differences of two such lists, ignoring entries with a role: "A reads ..., B reads ..."; "" if
// there are none. Files are identified by content, since they may have been moved.
std::string different_inputs(const nlohmann::ordered_json& a, const nlohmann::ordered_json& b);

// Contents of files. Each file is hashed once, however many runs read it.
class InputFiles {
 public:
  const std::string& content(const std::filesystem::path& file);
  // The contents of several files, in their order.
  std::vector<std::string> contents(const std::vector<std::filesystem::path>& files);
  // FileError if one of the files has changed since its first use.
  void reject_changed(const std::vector<std::filesystem::path>& files);
  // All files used so far, and their contents.
  std::map<std::string, std::string> all() const;
  tb::MeshFiles& meshes() { return meshes_; }

 private:
  // Attributes that change when a file is written or replaced.
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
