// SPDX-License-Identifier: MIT
#include "tb/harness/scoreboard.h"

namespace deburr::tb {

void ScoreboardBase::fail(const std::string& text) {
  ++mismatches_;
  if (texts_.size() < kKept) texts_.push_back(text);
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
  if (!texts_.empty()) text += '\n';
  for (const std::string& line : texts_) text += "\n  " + line;
  if (mismatches_ > texts_.size())
    text += fmt::format("\n  and {} more", mismatches_ - texts_.size());
  throw Mismatch(text);
}

}  // namespace deburr::tb
