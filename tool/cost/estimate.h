// SPDX-License-Identifier: MIT
// The cost of the hardware of a run: gates, flip-flops, memory and longest path of each unit
// (docs/explanation/cost.md). A unit counts as mapped where docs/measurements/cost.json has the row
// of its very parameters; else it is an estimate, the sum of its operators.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "tb/run/result.h"
#include "tool/cost/primitives.h"

namespace deburr::tool {

// By the calibration on mapped units: an estimate is within these shares of the mapped figure.
inline constexpr double kUnitRange = 0.35;  // gates of a unit, four units of five
inline constexpr double kSumRange = 0.20;   // gates of an engine
// Share of its ns that an arithmetic operator adds behind another one (docs/explanation/cost.md).
inline constexpr double kOverlap = 0.6;
inline constexpr double kPathRange = 0.40;  // ns, four units of five

// The value of a parameter ("ENGINE.NAME"), null if there is none.
using ParameterValue = std::function<nlohmann::ordered_json(std::string_view)>;

// From the sheets, memories and links of the result.
tb::Cost estimate(const tb::Result& result, const ParameterValue& value,
                  const Primitives& primitives = Primitives::embedded());
// The same, with every unit an estimate.
tb::Cost estimate(const tb::Result& result, const Primitives& primitives = Primitives::embedded());

}  // namespace deburr::tool
