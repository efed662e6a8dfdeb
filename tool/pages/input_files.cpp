// SPDX-License-Identifier: MIT
#include "tool/pages/input_files.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "spec/error.h"
#include "tb/base/file.h"

namespace deburr::tool {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Content and name of each file, by content.
std::vector<std::pair<std::string, std::string>> contents_of(const Json& inputs) {
  std::vector<std::pair<std::string, std::string>> contents;
  if (!inputs.is_array()) return contents;
  for (const Json& input : inputs) {
    if (!input.is_object() || input.contains("role")) continue;
    contents.emplace_back(listed_content(input), input.value("file", ""));
  }
  std::sort(contents.begin(), contents.end());
  return contents;
}

// Entries of `some` that `others` lack.
std::string only_in(const std::vector<std::pair<std::string, std::string>>& some,
                    std::vector<std::pair<std::string, std::string>> others) {
  constexpr std::size_t kDigits = 8;
  std::string text;
  for (const auto& [content, name] : some) {
    const auto same =
        std::find_if(others.begin(), others.end(),
                     [&content = content](const auto& other) { return other.first == content; });
    if (same != others.end()) {
      others.erase(same);
      continue;
    }
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", name, content.substr(0, kDigits));
  }
  return text.empty() ? "no other file" : text;
}

}  // namespace

std::vector<fs::path> surroundings_files(const tb::ParameterSet& set) {
  std::vector<fs::path> files;
  for (const tb::Parameter& p : set.all())
    if (p.kind == tb::ParameterKind::kSurroundings && p.range == "file" && !p.text().empty())
      files.emplace_back(p.text());
  return files;
}

std::string content_of(const fs::path& file) {
  std::error_code error;
  if (fs::status(file, error).type() == fs::file_type::not_found) return std::string(kMissingFile);
  try {
    return tb::sha256_of_file(file);
  } catch (const spec::FileError&) {  // its reader reports the reason
    return std::string(kUnreadableFile);
  }
}

Json input_entry(const fs::path& file, std::string_view content, std::string_view role) {
  Json entry = {{"file", file.string()}};
  if (content == kMissingFile || content == kUnreadableFile)
    entry[std::string(content)] = true;
  else
    entry["sha256"] = content;
  if (!role.empty()) entry["role"] = role;
  return entry;
}

std::string listed_content(const Json& entry) {
  return entry.value("sha256",
                     std::string(entry.contains(kMissingFile) ? kMissingFile : kUnreadableFile));
}

std::string different_inputs(const Json& a, const Json& b) {
  const auto in_a = contents_of(a), in_b = contents_of(b);
  if (std::equal(in_a.begin(), in_a.end(), in_b.begin(), in_b.end(),
                 [](const auto& x, const auto& y) { return x.first == y.first; }))
    return "";
  return fmt::format("A reads {}, B reads {}", only_in(in_a, in_b), only_in(in_b, in_a));
}

InputFiles::Stamp InputFiles::stamp_of(const fs::path& file) {
  struct stat info {};
  if (::stat(file.c_str(), &info) != 0) return {};
  return {info.st_dev,         info.st_ino,          static_cast<std::uint64_t>(info.st_size),
          info.st_mtim.tv_sec, info.st_mtim.tv_nsec, info.st_ctim.tv_sec,
          info.st_ctim.tv_nsec};
}

const std::string& InputFiles::content(const fs::path& file) {
  const auto [known, is_new] = known_.try_emplace(file);
  // The stamp is taken first: a later write changes it.
  if (is_new) {
    known->second.stamp = stamp_of(file);
    known->second.content = content_of(file);
  }
  return known->second.content;
}

std::vector<std::string> InputFiles::contents(const std::vector<fs::path>& files) {
  std::vector<std::string> contents;
  contents.reserve(files.size());
  for (const fs::path& file : files) contents.push_back(content(file));
  return contents;
}

void InputFiles::reject_changed(const std::vector<fs::path>& files) {
  for (const fs::path& file : files) {
    const auto known = known_.find(file);
    if (known == known_.end()) continue;
    const Stamp stamp = stamp_of(file);
    if (stamp == known->second.stamp) continue;
    if (content_of(file) != known->second.content)
      throw spec::FileError(fmt::format(
          "'{}' has changed since the run was planned: run the same command again", file.string()));
    known->second.stamp = stamp;  // only touched
  }
}

std::map<std::string, std::string> InputFiles::all() const {
  std::map<std::string, std::string> all;
  for (const auto& [file, known] : known_) all[file.string()] = known.content;
  return all;
}

}  // namespace deburr::tool
