// SPDX-License-Identifier: MIT
#include "tool/regress/failure_message.h"

#include <regex.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>

#include "spec/error.h"

namespace deburr::tool {
namespace {

constexpr std::uint64_t kCyclesBefore = 400, kCyclesAfter = 100;

// An extended regular expression of the C library: std::regex takes seconds to compile.
class Pattern {
 public:
  // The match and its first groups; groups that did not participate are empty.
  using Match = std::array<std::string, 5>;

  explicit Pattern(const char* pattern) {
    DEBURR_CHECK(::regcomp(&compiled_, pattern, REG_EXTENDED) == 0, pattern);
  }
  ~Pattern() { ::regfree(&compiled_); }
  Pattern(const Pattern&) = delete;
  Pattern& operator=(const Pattern&) = delete;

  // Calls `visit` for every match; returns the text with each match replaced by its result.
  template <class Visit>
  std::string replaced(const std::string& text, Visit visit) const {
    std::string result;
    std::size_t end = 0;
    std::array<::regmatch_t, std::tuple_size_v<Match>> at{};
    const auto in_text = [&](const ::regmatch_t& part) {
      return part.rm_so < 0 ? std::string()
                            : text.substr(static_cast<std::size_t>(part.rm_so),
                                          static_cast<std::size_t>(part.rm_eo - part.rm_so));
    };
    for (;;) {
      at[0] = {static_cast<::regoff_t>(end), static_cast<::regoff_t>(text.size())};
      if (::regexec(&compiled_, text.c_str(), at.size(), at.data(), REG_STARTEND) != 0) break;
      Match match;
      std::transform(at.begin(), at.end(), match.begin(), in_text);
      result += text.substr(end, static_cast<std::size_t>(at[0].rm_so) - end) + visit(match);
      end = static_cast<std::size_t>(at[0].rm_eo);
    }
    return result + text.substr(end);
  }
  // Keeps the first group.
  std::string replaced(const std::string& text, const char* by) const {
    return replaced(text, [by](const Match& match) { return match[1] + by; });
  }

 private:
  ::regex_t compiled_;
};

// The largest or smallest of all numbers in the groups of a pattern.
template <class Choose>
std::optional<std::uint64_t> chosen(const std::string& text, const Pattern& pattern,
                                    Choose choose) {
  std::optional<std::uint64_t> best;
  pattern.replaced(text, [&](const Pattern::Match& match) {
    for (std::size_t group = 1; group < match.size(); ++group)
      if (match[group].find_first_of("0123456789") == 0) {
        const std::uint64_t value = std::stoull(match[group]);
        best = best ? choose(*best, value) : value;
      }
    return match[0];
  });
  return best;
}

std::uint64_t smaller(std::uint64_t a, std::uint64_t b) { return std::min(a, b); }
std::uint64_t larger(std::uint64_t a, std::uint64_t b) { return std::max(a, b); }

}  // namespace

std::string without_particulars(const std::string& message) {
  // Quoted paths may be relative; unquoted, "expected/got" would match as well.
  static const Pattern kQuotedPath("'[^'[:space:]]*/[^']*'");
  static const Pattern kPath(R"((^|[[:space:]"(=])\.{0,2}/[^[:space:]'")]+)");
  static const Pattern kHexadecimal(R"(\b0x[0-9a-fA-F]+)");
  static const Pattern kHash(R"(\b[0-9a-f]{8,}\b)");
  static const Pattern kNumber("(^|[^[:alnum:]_.])-?[0-9]+([.,][0-9]+)*");
  std::string text = kQuotedPath.replaced(message, "'PATH'");
  text = kPath.replaced(text, "PATH");
  text = kHexadecimal.replaced(text, "N");
  text = kHash.replaced(text, [](const Pattern::Match& match) {
    return match[0].find_first_of("0123456789") == std::string::npos ? match[0] : "N";
  });
  return kNumber.replaced(text, "N");
}

std::uint64_t failing_cycle(const nlohmann::json& result) {
  const std::string reason = result.value("reason", "");
  // The state of each link ends with "; cycle of its last push, of its last pop; from -> to".
  static const Pattern kLastMoves("; (([0-9]+)|never), (([0-9]+)|never); [^;\n]* -> ");
  if (const auto cycle = chosen(reason, kLastMoves, larger)) return *cycle;
  static const Pattern kCycle(R"(\bcycle ([0-9]+))");
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

}  // namespace deburr::tool
