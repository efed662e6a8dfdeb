// SPDX-License-Identifier: MIT
// Files embedded into the program by the build (tool/pages/embed.cmake).
#pragma once

#include <string_view>

namespace deburr::tool::embedded {

std::string_view osu018_json();  // osu018.json
std::string_view sram_json();    // sram.json
std::string_view mapped_json();  // docs/measurements/cost.json

}  // namespace deburr::tool::embedded
