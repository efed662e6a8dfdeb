// SPDX-License-Identifier: MIT
// The files that the authors of SMAA publish. They are not here: a folder `smaa` of the data folder
// (DEBURR_DATA) holds SMAA.hlsl, AreaTex.h and SearchTex.h.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tb/harness/test_paths.h"

namespace deburr::tb {

inline constexpr int kSmaaAreaWidth = 160, kSmaaAreaHeight = 560;    // two bytes a texel
inline constexpr int kSmaaSearchWidth = 64, kSmaaSearchHeight = 16;  // one

inline std::filesystem::path smaa_file(const char* name) { return data_folder() / "smaa" / name; }

// A test that needs `name` says this where it is absent.
inline std::string no_smaa_file(const char* name) {
  return "no " + smaa_file(name).string() + ": set DEBURR_DATA to the folder that holds smaa/";
}

// With line ends of one byte.
inline std::string smaa_text(const char* name) {
  std::ifstream file(smaa_file(name), std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  std::erase(text, '\r');
  return text;
}

// The bytes between the braces of a header.
inline std::vector<std::uint8_t> smaa_bytes(const char* name) {
  const std::string text = smaa_text(name);
  std::vector<std::uint8_t> bytes;
  std::size_t at = text.find('{', text.find("[]"));
  while ((at = text.find("0x", at)) != std::string::npos) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(text.substr(at, 4), nullptr, 16)));
    at += 4;
  }
  return bytes;
}

}  // namespace deburr::tb
