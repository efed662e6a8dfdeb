// SPDX-License-Identifier: MIT
#include "rtl_model/fabric/operators.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace deburr::rtl {
namespace {

struct Words {
  const char *key, *one, *many;
  const char* widths;  // of fmt, with a and b
};

constexpr auto kWords = std::to_array<Words>({
    {"add", "add", "adds", "{0}"},
    {"subtract", "subtract", "subtracts", "{0}"},
    {"compare", "comparator", "comparators", "{0}"},
    {"equal", "equality comparator", "equality comparators", "{0}"},
    {"magnitude", "magnitude", "magnitudes", "{0}"},
    {"maximum", "maximum", "maxima", "{0}"},
    {"mux", "mux", "muxes", "{1} : 1 x {0}"},
    {"multiply", "multiply", "multiplies", "{0} x {1}"},
    {"square", "square", "squares", "{0}"},
    {"multiply_constant", "constant multiply", "constant multiplies", "{0} with {1} adds"},
    {"shift", "shifter", "shifters", "{0} by {1}"},
    {"leading_one", "leading-one detector", "leading-one detectors", "{0}"},
    {"root_stage", "root stage", "root stages", "{0}"},
    {"count_ones", "count of ones", "counts of ones", "{0}"},
    {"priority", "priority", "priorities", "{0}"},
    {"rom_read", "ROM read", "ROM reads", "{1} x {0}"},
    {"logic", "logic", "logic", "{0} gates"},
});

const Words& words(OperatorKind kind) { return kWords.at(static_cast<std::size_t>(kind)); }

std::string widths(const Operator& one) {
  return fmt::format(fmt::runtime(words(one.kind).widths), one.a, one.b);
}

}  // namespace

const char* name_of(OperatorKind kind) { return words(kind).key; }

std::string text_of(const Operator& one) { return words(one.kind).one + (" " + widths(one)); }

std::string counted(const Operator& one) {
  if (one.count == 1) return text_of(one);
  return fmt::format("{} {} {}", one.count, words(one.kind).many, widths(one));
}

std::string by_kind(std::span<const Operator> operators) {
  std::vector<Operator> sums;
  for (Operator one : operators) {
    // Random logic has no width: its gates add up.
    if (one.kind == OperatorKind::kLogic) one = {one.kind, one.a * one.count};
    if (const auto same = std::find_if(sums.begin(), sums.end(),
                                       [&](const Operator& other) {
                                         return one.kind == OperatorKind::kLogic &&
                                                other.kind == one.kind;
                                       });
        same != sums.end())
      same->a += one.a;
    else
      sums.push_back(one);
  }
  sums = summed(sums);
  std::string text;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const OperatorKind kind = sums[i].kind;
    const auto is_kind = [&](const Operator& other) { return other.kind == kind; };
    if (std::any_of(sums.begin(), sums.begin() + static_cast<std::ptrdiff_t>(i), is_kind)) continue;
    text += fmt::format("{}{}", text.empty() ? "" : "; ", words(kind).one);
    const char* before = " ";
    for (const Operator& one : sums) {
      if (!is_kind(one)) continue;
      text += before + widths(one);
      if (one.count > 1) text += fmt::format(" ({})", one.count);
      before = ", ";
    }
  }
  return text;
}

std::vector<Operator> summed(std::span<const Operator> operators) {
  std::vector<Operator> sums;
  for (const Operator& one : operators) {
    if (one.count == 0) continue;
    const auto same = std::find_if(sums.begin(), sums.end(), [&](const Operator& other) {
      return other.kind == one.kind && other.a == one.a && other.b == one.b;
    });
    if (same == sums.end())
      sums.push_back(one);
    else
      same->count += one.count;
  }
  return sums;
}

}  // namespace deburr::rtl
