// SPDX-License-Identifier: MIT
// The verdicts of the reproduction report: each a word that follows from figures, and each tested
// with figures that speak against the paper (studies/tests/papers/verdicts_test.cpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace deburr::studies {

// ---- a figure that the paper prints -------------------------------------------------------------

// "right" when `ours` rounds to what the paper printed with so many decimals, else `otherwise`.
std::string verdict(double paper, int decimals, double ours, const char* otherwise);

inline constexpr const char* kNotPrinted = "-";

// The same of a figure as it is printed: "0.219" to its last digit, "1 846 160.13" too, "1/3"
// exactly. "added" where nothing is printed, "not reproduced" where we have none of our own.
std::string verdict(std::string_view printed, std::optional<double> ours, const char* otherwise);

// item, paper, ours, verdict: the figure shown is the one that is checked.
std::vector<std::string> checked_row(std::string item, const std::string& printed, double ours,
                                     int decimals, const char* otherwise);

// ---- a claim ------------------------------------------------------------------------------------

// Of something that is to hold in every case: `against` counts those in which it does not.
std::string claim(std::int64_t against, const char* holds = "right", const char* fails = "wrong");
// Strictly below, or at most.
std::string below(double ours, double bound, const char* yes = "right", const char* no = "wrong");
std::string at_most(double ours, double bound, const char* yes = "right", const char* no = "wrong");

// ---- methods against each other -----------------------------------------------------------------

// PSNR in dB; silhouettes are not a number where a picture has none.
struct Scores {
  double edges, silhouettes;
};
// Better on edges, and on silhouettes where there are any.
bool beats(const Scores& a, const Scores& b);
// "best" if it beats every other one, else "second" ... by the number of those that it does not
// beat, and "last" when it beats none.
std::string place(std::span<const Scores> methods, std::size_t which);

// What a rule brings, of errors (less is better) and qualities (more is better), as they are shown:
// "better", "worse", "mixed" or "same".
struct Figures {
  std::vector<double> errors, qualities;
};
std::string brings(const Figures& before, const Figures& after, int error_decimals,
                   int quality_decimals);

}  // namespace deburr::studies
