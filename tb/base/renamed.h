// SPDX-License-Identifier: MIT
// Names changed in version 0.4.0: parameters, keys of result.json, instances, registers and
// coverage bins.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace deburr::tb {

// `name` with each renamed word replaced, such as a glob of coverage bins.
std::string with_current_words(std::string name);

// The current name, among `known`, of what was called `name` before 0.4.0; empty if none.
std::optional<std::string> renamed(std::string_view name, const std::vector<std::string>& known);

}  // namespace deburr::tb
