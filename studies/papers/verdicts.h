// SPDX-License-Identifier: MIT
// The verdicts of the reproduction report. Each is a word derived from figures, and is tested with
// figures that contradict the paper (studies/tests/papers/verdicts_test.cpp).
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

// "right" when `ours` rounds to the printed value at `decimals` digits, else `otherwise`.
std::string verdict(double paper, int decimals, double ours, const char* otherwise);

inline constexpr const char* kNotPrinted = "-";

// The same for a printed figure: "0.219" to its last digit, also "1 846 160.13"; "1/3" exactly.
// Returns "added" if nothing is printed, "not reproduced" if we have no value.
std::string verdict(std::string_view printed, std::optional<double> ours, const char* otherwise);

// item, paper, ours, verdict: the verdict is computed from the displayed figure.
std::vector<std::string> checked_row(std::string item, const std::string& printed, double ours,
                                     int decimals, const char* otherwise);

// ---- a claim ------------------------------------------------------------------------------------

// For a statement that must hold in every case: `against` counts the exceptions.
std::string claim(std::int64_t against, const char* holds = "right", const char* fails = "wrong");
// Strictly below, or at most.
std::string below(double ours, double bound, const char* yes = "right", const char* no = "wrong");
std::string at_most(double ours, double bound, const char* yes = "right", const char* no = "wrong");

// ---- methods against each other -----------------------------------------------------------------

// PSNR in dB; NaN for silhouettes if a picture lacks them.
struct Scores {
  double edges, silhouettes;
};
// Better on edges, and on silhouettes if there are any.
bool beats(const Scores& a, const Scores& b);
// "best" if it beats every other method, else "second" ... by the number of methods that it does
// not beat; "last" if it beats none.
std::string place(std::span<const Scores> methods, std::size_t which);

// The effect of one option on errors (less is better) and qualities (more is better), as displayed:
// "better", "worse", "mixed" or "same".
struct Figures {
  std::vector<double> errors, qualities;
};
std::string brings(const Figures& before, const Figures& after, int error_decimals,
                   int quality_decimals);

}  // namespace deburr::studies
