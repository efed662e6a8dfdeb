// SPDX-License-Identifier: MIT
// Classifies parameters by whether they change the work that a run is given.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace deburr::tb {

// If runs differ in such a parameter they did different work, so a difference in their results says
// little about the hardware. kSource may name a file; then its content counts and not its name.
enum class GivenWork : std::uint8_t { kNone, kSource, kSetting };
inline constexpr std::array<std::string_view, 3> kGivenWorkNames = {"none", "source", "setting"};

}  // namespace deburr::tb
