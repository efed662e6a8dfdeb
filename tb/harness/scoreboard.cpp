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
  for (const std::string& line : texts_) text += "\n  " + line;
  if (mismatches_ > texts_.size())
    text += fmt::format("\n  and {} more", mismatches_ - texts_.size());
  if (leftovers())
    text +=
        fmt::format("\n  {} expected but never came, the first: {}", leftovers(), first_leftover());
  if (comparisons_ < minimum_)
    text += fmt::format("\n  only {} comparisons, at least {} are needed for a verdict",
                        comparisons_, minimum_);
  throw Mismatch(text);
}

}  // namespace deburr::tb
