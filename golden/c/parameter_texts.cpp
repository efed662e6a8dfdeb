// SPDX-License-Identifier: MIT
#include "golden/c/parameter_texts.h"

#include <algorithm>

namespace deburr::golden::c {
namespace {

template <class Names>
std::string joined(const Names& names) {
  std::string all;
  for (const auto& name : names) {
    if (!all.empty()) all += ", ";
    all += name;
  }
  return all;
}

}  // namespace

std::optional<std::int64_t> integer_of(std::string_view text) {
  int base = 10;
  if (text.starts_with("0x")) {
    text.remove_prefix(2);
    base = 16;
    if (text.starts_with('-')) return std::nullopt;
  }
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

void reject_value(std::string_view name, std::string_view text, std::string_view why) {
  throw ArgumentError("'" + std::string(name) + "' = '" + std::string(text) + "' " +
                      std::string(why));
}

void reject_name(std::string_view what, std::string_view name, std::span<const std::string> known) {
  throw ArgumentError("unknown " + std::string(what) + " '" + std::string(name) +
                      "'; known: " + joined(known));
}

std::int64_t number_in_range(std::string_view name, std::string_view text, std::int64_t min,
                             std::int64_t max) {
  const std::string range = std::to_string(min) + ".." + std::to_string(max);
  const std::optional<std::int64_t> value = integer_of(text);
  if (!value) reject_value(name, text, "must be an integer " + range);
  if (*value < min || *value > max) reject_value(name, text, "is outside " + range);
  return *value;
}

std::size_t code_of(std::string_view name, std::string_view text,
                    std::span<const std::string_view> names) {
  const auto found = std::find(names.begin(), names.end(), text);
  if (found == names.end()) reject_value(name, text, "must be one of " + joined(names));
  return static_cast<std::size_t>(found - names.begin());
}

bool switch_of(std::string_view name, std::string_view text) {
  const bool on = text == "true" || text == "on" || text == "yes",
             off = text == "false" || text == "off" || text == "no";
  if (!on && !off) reject_value(name, text, "must be true or false");
  return on;
}

}  // namespace deburr::golden::c
