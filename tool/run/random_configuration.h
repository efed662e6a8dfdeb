// SPDX-License-Identifier: MIT
// Random settings of an engine's run, drawn from its own parameters: for soak tests, regressions
// and fuzzing.
//
// Frames are small with odd sizes, memories slow and irregular, links stall; each setting has an
// effect, and the engine accepts all of them. Parameters that need files, spend time on pictures or
// end a run by design keep their values: is_fixed().
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace deburr::tool {

class Engine;

// Names and values for ParameterSet::set(), to be set in this order after the settings in `given`,
// which are kept. Identical on every machine. ConfigError for an unknown engine, and if no
// configuration is valid with the given settings.
std::vector<std::pair<std::string, std::string>> random_configuration(
    const std::string& engine, std::uint64_t seed,
    const std::vector<std::pair<std::string, std::string>>& given = {});

// Whether this parameter of the engine never changes; a leading dot matches every memory.
bool is_fixed(const Engine& engine, std::string_view parameter);

}  // namespace deburr::tool
