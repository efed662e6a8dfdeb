// SPDX-License-Identifier: MIT
// The text of `deburr run ENGINE --help` for --preset: "mlaa, smaa or deburr (default)".
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

namespace deburr::tool {

// `names` are indexed by Preset; the default preset is given.
template <class Preset, std::size_t N>
std::string preset_help(const std::array<std::string_view, N>& names, Preset by_default) {
  std::string text;
  for (std::size_t i = 0; i < N; ++i) {
    if (i != 0) text += i + 1 == N ? " or " : ", ";
    text += names[i];
    if (i == static_cast<std::size_t>(by_default)) text += " (default)";
  }
  return text;
}

}  // namespace deburr::tool
