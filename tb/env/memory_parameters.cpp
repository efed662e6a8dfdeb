// SPDX-License-Identifier: MIT
#include "tb/env/memory_parameters.h"

#include <fmt/format.h>

#include <charconv>
#include <cstddef>
#include <string>
#include <system_error>

#include "spec/error.h"
#include "tb/base/file.h"

namespace deburr::tb {

std::vector<std::uint32_t> read_latencies(const std::filesystem::path& file) {
  constexpr std::size_t kMostBytes = std::size_t{64} << 20;
  constexpr std::string_view kBlanks = " \t\r";
  const std::string text = read_file(file, kMostBytes);
  std::vector<std::uint32_t> latencies;
  std::size_t line = 0;
  for (std::string_view rest = text; !rest.empty();) {
    std::string_view row = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), row.size() + 1));
    ++line;
    if (row.starts_with('#')) continue;
    row.remove_prefix(std::min(row.size(), row.find_first_not_of(kBlanks)));
    row = row.substr(0, row.find_last_not_of(kBlanks) + 1);
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(row.data(), row.data() + row.size(), value);
    if (error != std::errc{} || end != row.data() + row.size() || value < 1 || value > kMostLatency)
      throw spec::FileError(fmt::format(
          "{}:{}: '{}' is not a latency: write a whole number of cycles, 1 to {}, in each line",
          file.string(), line, row.substr(0, 40), kMostLatency));
    latencies.push_back(value);
  }
  if (latencies.empty())
    throw spec::FileError(
        fmt::format("'{}' has no latency: write the cycles of one request in "
                    "each line (docs/reference/traces.md)",
                    file.string()));
  return latencies;
}

std::string latency_text(const MemoryTiming& p) {
  return p.latency_file.empty() ? fmt::format("{} clk", p.latency) : "of " + p.latency_file;
}

}  // namespace deburr::tb
