// SPDX-License-Identifier: MIT
// Command line options shared by several engines.
#pragma once

#include <vector>

#include "tool/run/engine.h"

namespace deburr::tool {

// The options of every engine, and the engine's own options, which may redefine a common one.
std::vector<Shorthand> shorthands_of(const Engine& engine);

std::vector<Shorthand> joined(std::vector<Shorthand> first, const std::vector<Shorthand>& second);

}  // namespace deburr::tool
