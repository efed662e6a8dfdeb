// SPDX-License-Identifier: MIT
#include "tb/run/amount.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace deburr::tb {

std::string grouped(std::uint64_t value) {
  const std::string digits = std::to_string(value);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

std::string amount(double value, int digits) {
  // A double holds every whole number up to here exactly.
  constexpr double kMost = 1e15;
  const double size = std::fabs(value);
  if (size < kMost && (value == std::round(value) || size >= std::pow(10.0, digits - 1)))
    return (value < 0 ? "-" : "") + grouped(static_cast<std::uint64_t>(std::llround(size)));
  const std::string text = fmt::format("{:.{}g}", size, digits);
  if (text.find_first_not_of("0123456789.") != std::string::npos)
    return fmt::format("{:.{}g}", value, digits);
  const std::size_t point = std::min(text.find('.'), text.size());
  return (value < 0 ? "-" : "") + grouped(std::stoull(text.substr(0, point))) + text.substr(point);
}

std::string rounded(double value) {
  constexpr int kDigits = 3;
  if (value <= 0) return "0";
  const double unit = std::pow(10.0, std::floor(std::log10(value)) + 1 - kDigits);
  return amount(unit > 1 ? std::round(value / unit) * unit : value, kDigits);
}

std::string with_range(double low, double value, double high) {
  if (value <= 0) return "-";
  if (low == high) return rounded(value);
  return fmt::format("{} ({} to {})", rounded(value), rounded(low), rounded(high));
}

}  // namespace deburr::tb
