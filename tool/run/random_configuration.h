// SPDX-License-Identifier: MIT
// Random settings of an engine's run, drawn from its own parameters: for soak tests, regressions
// and fuzzing.
//
// Frames are small and have odd sizes, memories are slow and irregular, and links stall. Each
// setting has an effect, and the engine accepts all of them. Parameters that need files, spend time
// on pictures or end a run early keep their values; see is_fixed().
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace deburr::tool {

class Engine;

// Names and values for ParameterSet::set(), to be set in this order after the settings in `given`,
// which are kept. They are the same on every machine. ConfigError if the engine is unknown, or if
// no configuration is valid with the given settings.
std::vector<std::pair<std::string, std::string>> random_configuration(
    const std::string& engine, std::uint64_t seed,
    const std::vector<std::pair<std::string, std::string>>& given = {});

// Whether this parameter of the engine is never drawn; a leading dot matches every memory.
bool is_fixed(const Engine& engine, std::string_view parameter);

}  // namespace deburr::tool
