// SPDX-License-Identifier: MIT
// Names changed in version 0.4.0: parameters, keys of result.json, instances and registers.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace deburr::tb {

// The current name, among `known`, of a parameter, key, instance or register called `name` before
// 0.4.0; empty if none.
std::optional<std::string> renamed(std::string_view name, const std::vector<std::string>& known);

}  // namespace deburr::tb
