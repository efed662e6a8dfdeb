// SPDX-License-Identifier: MIT
#include "studies/papers/verdicts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "spec/error.h"

namespace deburr::studies {
namespace {

struct Printed {
  double value;
  std::optional<int> decimals;  // none: a fraction, which is exact
};

Printed read_printed(std::string_view printed) {
  std::string digits;
  std::copy_if(printed.begin(), printed.end(), std::back_inserter(digits),
               [](char c) { return c != ' '; });
  DEBURR_CHECK(!digits.empty() && digits.find_first_not_of("0123456789./") == std::string::npos,
               "no figure: " + std::string(printed));
  if (const std::size_t bar = digits.find('/'); bar != std::string::npos)
    return {std::stod(digits.substr(0, bar)) / std::stod(digits.substr(bar + 1)), {}};
  const std::size_t point = digits.find('.');
  return {std::stod(digits),
          point == std::string::npos ? 0 : static_cast<int>(digits.size() - point - 1)};
}

double rounded(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return std::round(value * scale) / scale;
}

}  // namespace

std::string verdict(double paper, int decimals, double ours, const char* otherwise) {
  const double half_a_digit = 0.5 * std::pow(10.0, -decimals);
  return std::fabs(ours - paper) <= half_a_digit * 1.0001 ? "right" : otherwise;
}

std::string verdict(std::string_view printed, std::optional<double> ours, const char* otherwise) {
  if (printed == kNotPrinted) return "added";
  if (!ours) return "not reproduced";
  constexpr double kExact = 1e-9;
  const Printed paper = read_printed(printed);
  if (paper.decimals) return verdict(paper.value, *paper.decimals, *ours, otherwise);
  return std::fabs(*ours - paper.value) < kExact ? "right" : otherwise;
}

std::vector<std::string> checked_row(std::string item, const std::string& printed, double ours,
                                     int decimals, const char* otherwise) {
  return {std::move(item), printed, fmt::format("{:.{}f}", ours, decimals),
          verdict(printed, ours, otherwise)};
}

std::string claim(std::int64_t against, const char* holds, const char* fails) {
  return against == 0 ? holds : fails;
}

std::string below(double ours, double bound, const char* yes, const char* no) {
  return ours < bound ? yes : no;
}

std::string at_most(double ours, double bound, const char* yes, const char* no) {
  return ours <= bound ? yes : no;
}

bool beats(const Scores& a, const Scores& b) {
  return a.edges > b.edges && !(a.silhouettes <= b.silhouettes);
}

std::string place(std::span<const Scores> methods, std::size_t which) {
  constexpr std::array kPlaces = {"best", "second", "third", "fourth", "fifth", "sixth"};
  std::size_t not_beaten = 0;
  for (std::size_t i = 0; i < methods.size(); ++i)
    not_beaten += i != which && !beats(methods[which], methods[i]);
  if (not_beaten > 0 && not_beaten + 1 == methods.size()) return "last";
  return kPlaces.at(not_beaten);
}

std::string brings(const Figures& before, const Figures& after, int error_decimals,
                   int quality_decimals) {
  bool better = false, worse = false;
  const auto look = [&](const std::vector<double>& less, const std::vector<double>& more,
                        int decimals) {
    DEBURR_CHECK(less.size() == more.size(), "figures of different rows");
    for (std::size_t i = 0; i < less.size(); ++i) {
      const double a = rounded(less[i], decimals), b = rounded(more[i], decimals);
      better = better || a < b;
      worse = worse || a > b;
    }
  };
  look(after.errors, before.errors, error_decimals);
  look(before.qualities, after.qualities, quality_decimals);
  return better && worse ? "mixed" : better ? "better" : worse ? "worse" : "same";
}

}  // namespace deburr::studies
