// SPDX-License-Identifier: MIT
#include "tb/regress/failure_message.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>

namespace deburr::tb {
namespace {

constexpr std::uint64_t kCyclesBefore = 400, kCyclesAfter = 100;

// The largest or smallest of all numbers in the groups of a pattern.
template <class Choose>
std::optional<std::uint64_t> chosen(const std::string& text, const std::regex& pattern,
                                    Choose choose) {
  std::optional<std::uint64_t> best;
  for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match)
    for (std::size_t group = 1; group < match->size(); ++group)
      if ((*match)[group].matched) {
        const std::uint64_t value = std::stoull((*match)[group]);
        best = best ? choose(*best, value) : value;
      }
  return best;
}

std::uint64_t smaller(std::uint64_t a, std::uint64_t b) { return std::min(a, b); }
std::uint64_t larger(std::uint64_t a, std::uint64_t b) { return std::max(a, b); }

}  // namespace

std::string without_particulars(const std::string& message) {
  // In quotes a path may be relative; elsewhere it would look like "expected/got".
  static const std::regex kQuotedPath(R"('[^'\s]*/[^']*')");
  static const std::regex kPath(R"((^|[\s"(=])\.{0,2}/[^\s'")]+)");
  static const std::regex kHexadecimal(R"(\b0x[0-9a-fA-F]+)");
  static const std::regex kHash(R"(\b(?=[a-f]*[0-9])[0-9a-f]{8,}\b)");
  static const std::regex kNumber(R"((^|[^\w.])-?[0-9]+([.,][0-9]+)*(?![0-9]))");
  std::string text = std::regex_replace(message, kQuotedPath, "'PATH'");
  text = std::regex_replace(text, kPath, "$1PATH");
  text = std::regex_replace(text, kHexadecimal, "N");
  text = std::regex_replace(text, kHash, "N");
  return std::regex_replace(text, kNumber, "$1N");
}

std::uint64_t failing_cycle(const nlohmann::json& result) {
  const std::string reason = result.value("reason", "");
  // The state of every link ends with "; cycle of its last push, of its last pop; from -> to".
  static const std::regex kLastMoves(R"(; (?:([0-9]+)|never), (?:([0-9]+)|never); [^;\n]* -> )");
  if (const auto cycle = chosen(reason, kLastMoves, larger)) return *cycle;
  static const std::regex kCycle(R"(\bcycle ([0-9]+))");
  std::string places;
  for (const auto& mismatch : result.value("first_mismatches", nlohmann::json::array()))
    places += mismatch.value("where", "") + "\n";
  if (const auto cycle = chosen(places, kCycle, smaller)) return *cycle;
  if (const auto cycle = chosen(reason, kCycle, smaller)) return *cycle;
  return result.value("cycles", std::uint64_t{0});
}

WaveWindow wave_window(std::uint64_t failing_cycle) {
  return {failing_cycle - std::min(failing_cycle, kCyclesBefore), failing_cycle + kCyclesAfter};
}

}  // namespace deburr::tb
