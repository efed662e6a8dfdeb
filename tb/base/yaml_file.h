// SPDX-License-Identifier: MIT
// A user's YAML file. An invalid entry is a ConfigError with file and line.
#pragma once

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace deburr::tb {

class YamlFile {
 public:
  static constexpr std::size_t kMaxBytes = 64u << 20;

  // Limit of nodes after alias expansion: a few lines of nested aliases can expand to an
  // unmanageable number.
  static constexpr std::uint64_t kMostAliasedNodes = 1'000'000;

  // Throws FileError for a file that cannot be read or exceeds `most` bytes; ConfigError for
  // invalid YAML, several documents or excessive alias expansion.
  explicit YamlFile(const std::filesystem::path& file, std::size_t most = kMaxBytes);
  // As above, for text already read.
  YamlFile(std::filesystem::path file, const std::string& text);

  const YAML::Node& root() const { return root_; }
  const std::filesystem::path& path() const { return path_; }

  // "sweep.yaml:12"
  std::string where(const YAML::Node& node) const;
  [[noreturn]] void fail(const YAML::Node& node, const std::string& what) const;
  // "a list", "an empty map"
  static const char* kind(const YAML::Node& node);

  // Requires each key of a map to be one of `known` and to occur once.
  void require_keys(const YAML::Node& map, const std::vector<std::string>& known) const;
  std::string scalar(const YAML::Node& node, std::string_view what) const;
  bool boolean(const YAML::Node& node, std::string_view what) const;
  // Addresses of 32 bits may be hexadecimal: 0x7fc0.
  template <class Number>
  Number number(const YAML::Node& node, std::string_view what) const {
    const std::string text = scalar(node, what);
    Number value{};
    const char* const last = text.data() + text.size();
    std::from_chars_result read{};
    if (std::uint32_t address = 0; text.starts_with("0x")) {
      read = std::from_chars(text.data() + 2, last, address, 16);
      value = static_cast<Number>(address);
    } else {
      read = std::from_chars(text.data(), last, value);
    }
    if (read.ec != std::errc() || read.ptr != last)
      fail(node, fmt::format("'{}' = '{}' must be a number", what, text));
    return value;
  }
  // Range 1..most.
  std::uint64_t count(const YAML::Node& node, std::string_view what, std::uint64_t most) const;

 private:
  std::filesystem::path path_;
  YAML::Node root_;
};

}  // namespace deburr::tb
