// SPDX-License-Identifier: MIT
// The keys that results of an engine can have, known before any run, so that `plan` rejects an
// unknown metric.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tool/sweep/definition.h"

namespace deburr::tool {

// Keys of result.json, dotted; * stands for names that depend on the build or the run. Elaborates
// the model in a process of its own.
std::vector<std::string> result_keys(const std::string& engine);
bool is_key_of(std::string_view key, std::string_view pattern);

// ConfigError with file, line and near matches for a metric that no result of the engine can have.
void require_known_metrics(const SweepDefinition& sweep);

}  // namespace deburr::tool
