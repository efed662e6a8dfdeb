// SPDX-License-Identifier: MIT
// Options of the command line that several engines have.
#pragma once

#include <vector>

#include "tool/run/engine.h"

namespace deburr::tool {

// Those of every engine, and this one's own, which may give one of them another meaning.
std::vector<Shorthand> shorthands_of(const Engine& engine);

std::vector<Shorthand> joined(std::vector<Shorthand> first, const std::vector<Shorthand>& second);

}  // namespace deburr::tool
