// SPDX-License-Identifier: MIT
// Settings of an engine's run, drawn from its own parameters: for soaks, regressions and fuzzing.
//
// Frames are small and odd, memories slow and uneven, links stall; each setting has an effect, and
// the engine takes all of them. What asks for files, spends time on pictures or ends a run by
// design stays as it is: is_fixed().
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace deburr::tool {

class Engine;

// Names and values for ParameterSet::set(), in an order in which it takes them behind those that
// are `given`, which stay as they are. The same on every machine. ConfigError for an unknown
// engine, and where nothing goes with what is given.
std::vector<std::pair<std::string, std::string>> random_configuration(
    const std::string& engine, std::uint64_t seed,
    const std::vector<std::pair<std::string, std::string>>& given = {});

// Whether it never changes this parameter of the engine; in front of a dot, of every memory.
bool is_fixed(const Engine& engine, std::string_view parameter);

}  // namespace deburr::tool
