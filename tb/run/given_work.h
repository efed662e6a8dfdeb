// SPDX-License-Identifier: MIT
// What parameters say of the work that a run is given.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace deburr::tb {

// Whether runs that differ in a parameter were given different work, so that a difference of their
// results says little about the hardware. A source may be a file, whose content counts and not its
// name.
enum class GivenWork : std::uint8_t { kNone, kSource, kSetting };
inline constexpr std::array<std::string_view, 3> kGivenWorkNames = {"none", "source", "setting"};

}  // namespace deburr::tb
