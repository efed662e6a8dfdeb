// SPDX-License-Identifier: MIT
// The files published by the authors of SMAA. They are not in this repository: folder `smaa` of the
// data folder (DEBURR_DATA) must hold SMAA.hlsl, AreaTex.h and SearchTex.h. Files with other
// contents throw FileError.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "spec/error.h"
#include "tb/harness/test_paths.h"

namespace deburr::tb {

inline constexpr int kSmaaAreaWidth = 160, kSmaaAreaHeight = 560;    // two bytes per texel
inline constexpr int kSmaaSearchWidth = 64, kSmaaSearchHeight = 16;  // one byte per texel
inline constexpr std::size_t kSmaaAreaBytes = std::size_t{2} * kSmaaAreaWidth * kSmaaAreaHeight;
inline constexpr std::size_t kSmaaSearchBytes = std::size_t{kSmaaSearchWidth} * kSmaaSearchHeight;

inline std::filesystem::path smaa_file(const char* name) { return data_folder() / "smaa" / name; }

// Skip message of a test that needs the file `name`.
inline std::string no_smaa_file(const char* name) {
  return "no " + smaa_file(name).string() + ": set DEBURR_DATA to the folder that holds smaa/";
}

[[noreturn]] inline void reject_smaa_file(const std::filesystem::path& path,
                                          const std::string& reason) {
  throw spec::FileError(
      fmt::format("'{}' {}: take the files of SMAA's repository", path.string(), reason));
}

// With line ends converted to LF.
inline std::string smaa_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) reject_smaa_file(path, "cannot be read");
  std::string text{std::istreambuf_iterator<char>(file), {}};
  std::erase(text, '\r');
  return text;
}

// Bytes of the array in a header; there must be `expected` of them.
inline std::vector<std::uint8_t> smaa_bytes(const std::filesystem::path& path,
                                            std::size_t expected) {
  const std::string text = smaa_text(path);
  std::vector<std::uint8_t> bytes;
  std::size_t at = text.find('{', text.find("[]"));
  while ((at = text.find("0x", at)) != std::string::npos) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(text.substr(at, 4), nullptr, 16)));
    at += 4;
  }
  if (bytes.size() != expected)
    reject_smaa_file(
        path, fmt::format("has {} bytes between its braces, expected {}", bytes.size(), expected));
  return bytes;
}

}  // namespace deburr::tb
