// SPDX-License-Identifier: MIT
// Classifies parameters by whether they change the work that a run is given.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace deburr::tb {

// If two runs differ in such a parameter, they did different work, so a difference in their results
// says little about the hardware. A kSource may name a file; then the content of the file counts,
// not its name.
enum class GivenWork : std::uint8_t { kNone, kSource, kSetting };
inline constexpr std::array<std::string_view, 3> kGivenWorkNames = {"none", "source", "setting"};

}  // namespace deburr::tb
