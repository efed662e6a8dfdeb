// SPDX-License-Identifier: MIT
// Messages of an engine about parameters without an effect.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "spec/error.h"
#include "tb/run/parameter_set.h"

namespace deburr::tool {

using Settings =
    std::vector<std::pair<std::string, std::string>>;  // names without the engine's prefix

// The reason in the first message about these settings, or an empty string. `reject` is called with
// the parameter set and the values of the engine's parameters.
template <class Parameters, class Reject>
std::string complaint(const std::string& engine, const Settings& settings, Reject&& reject) {
  static constexpr std::string_view kBefore = "has no effect: ";
  Parameters values;
  tb::ParameterSet set;
  set.add_engine(engine, values);
  for (const auto& [name, value] : settings) set.set(engine + "." + name, value, "--set");
  try {
    reject(set, values);
  } catch (const spec::ConfigError& error) {
    const std::string text = error.what();
    return text.substr(text.find(kBefore) + kBefore.size());
  }
  return "";
}

}  // namespace deburr::tool
