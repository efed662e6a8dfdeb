// SPDX-License-Identifier: MIT
#include "tb/harness/engine_kit.h"

#include <fmt/format.h>

#include <algorithm>

#include "tb/base/fnv.h"

namespace deburr::tb {
namespace {

std::string difference(const std::vector<NamedWords>& was, const std::vector<NamedWords>& is) {
  if (was.size() != is.size()) return "other lists";
  for (std::size_t i = 0; i < was.size(); ++i)
    if (std::string text = NamedWords::difference(was[i], is[i]); !text.empty()) return text;
  return "";
}

}  // namespace

std::string NamedWords::text() const {
  FnvHash hash;
  for (const std::uint64_t word : words_) hash.lowest_first(word, 8);
  return fmt::format("{}: {} words, hash {:#x}\n", name_, words_.size(), hash.value());
}

std::string NamedWords::difference(const NamedWords& was, const NamedWords& is) {
  if (was == is) return "";
  const std::size_t both = std::min(was.words_.size(), is.words_.size());
  const auto [a, b] =
      std::mismatch(was.words_.begin(), was.words_.begin() + static_cast<std::ptrdiff_t>(both),
                    is.words_.begin());
  const auto at = static_cast<std::size_t>(a - was.words_.begin());
  if (at == both)
    return fmt::format("{}: were {} words, are {}\n", was.name_, was.words_.size(),
                       is.words_.size());
  return fmt::format("{}: word {} was {:#x}, is {:#x}\n", was.name_, at, *a, *b);
}

std::string difference(const Outcome& was, const Outcome& is, Compared what) {
  std::string text = difference(was.data, is.data);
  if (what != Compared::kData) text += difference(was.counted, is.counted);
  if (what == Compared::kAll) text += difference(was.cycles, is.cycles);
  return text;
}

std::string text_of(const Outcome& outcome, Compared what) {
  std::string text;
  for (const NamedWords& words : outcome.data) text += words.text();
  if (what == Compared::kData) return text;
  for (const NamedWords& words : outcome.counted) text += words.text();
  if (what == Compared::kAll)
    for (const NamedWords& words : outcome.cycles) text += words.text();
  return text;
}

}  // namespace deburr::tb
