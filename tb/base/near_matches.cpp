// SPDX-License-Identifier: MIT
#include "tb/base/near_matches.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <optional>
#include <utility>

#include "tb/base/renamed.h"

namespace deburr::tb {
namespace {

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<int>> d(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = static_cast<int>(i);
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int substitution = d[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, substitution});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

std::vector<std::string> near_matches(std::string_view name,
                                      const std::vector<std::string>& candidates) {
  constexpr std::size_t kMaxName =
      100;  // longer texts are not typing errors, and the search is quadratic
  std::vector<std::pair<int, std::string>> ranked;
  if (name.empty() || name.size() > kMaxName) return {};
  if (const std::optional<std::string> now = renamed(name, candidates)) return {*now};
  const auto last_part = [](std::string_view text) { return text.substr(text.rfind('.') + 1); };
  for (const std::string& candidate : candidates) {
    int distance = edit_distance(name, candidate);
    // Differences in case are ignored.
    distance =
        std::min(distance, std::max(1, edit_distance(lower_case(name), lower_case(candidate))));
    // The right last part after a wrong or missing prefix is also a likely meaning.
    if (last_part(candidate) == last_part(name)) distance = std::min(distance, 2);
    if (candidate.ends_with("." + std::string(name))) distance = 1;
    // So is an incomplete name.
    if (candidate.starts_with(name)) distance = std::min(distance, 2);
    if (distance <= std::max<int>(1, static_cast<int>(name.size()) / 3))
      ranked.emplace_back(distance, candidate);
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, ranked.size()); ++i)
    names.push_back(ranked[i].second);
  return names;
}

std::string did_you_mean(const std::vector<std::string>& candidates) {
  if (candidates.empty()) return "";
  std::string text = ": did you mean ";
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (i > 0) text += i + 1 == candidates.size() ? " or " : ", ";
    text += "'" + candidates[i] + "'";
  }
  return text + "?";
}

}  // namespace deburr::tb
