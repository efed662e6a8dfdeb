// SPDX-License-Identifier: MIT
// Names that version 0.4.0 changed: parameters, keys of result.json, instances and registers.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace deburr::tb {

// The name among `known` that `name` had before 0.4.0, or nothing.
std::optional<std::string> renamed(std::string_view name, const std::vector<std::string>& known);

}  // namespace deburr::tb
