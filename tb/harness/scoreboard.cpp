// SPDX-License-Identifier: MIT
#include "tb/harness/scoreboard.h"

namespace deburr::tb {

namespace {

// "cycle 812: item 100: expected A, got B (expected/got: ...)"
std::string line(const Difference& d) {
  std::string text;
  for (const std::string& place : {d.where, d.item})
    if (!place.empty()) text += place + ": ";
  text += fmt::format("expected {}, got {}", d.expected, d.got);
  return d.field.empty() || d.field == "order"
             ? text
             : fmt::format("{} (expected/got: {})", text, d.field);
}

}  // namespace

void ScoreboardBase::fail(Difference difference) {
  ++mismatches_;
  if (differences_.size() >= kKept) return;
  difference.check = name_;
  differences_.push_back(std::move(difference));
}

void ScoreboardBase::check() const {
  if (passed()) return;
  std::string text =
      fmt::format("{}: {} mismatches in {} comparisons", name_, mismatches_, comparisons_);
  if (comparisons_ < minimum_)
    text += fmt::format(", only {} comparisons, at least {} are needed for a verdict", comparisons_,
                        minimum_);
  if (leftovers())
    text +=
        fmt::format(", {} expected but never came, the first: {}", leftovers(), first_leftover());
  if (!differences_.empty()) text += '\n';
  for (const Difference& difference : differences_) text += "\n  " + line(difference);
  if (mismatches_ > differences_.size())
    text += fmt::format("\n  and {} more", mismatches_ - differences_.size());
  throw Mismatch(text);
}

}  // namespace deburr::tb
