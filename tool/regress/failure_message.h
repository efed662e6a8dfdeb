// SPDX-License-Identifier: MIT
// Analyses the message of a failed run: its failure signature, and the cycles to record.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace deburr::tool {

// The message without details that differ from run to run: numbers become N, paths become PATH.
// Digits within a name ("predictor_h0") are kept.
std::string without_particulars(const std::string& message);

// The cycle in which a run failed, taken from its result.json: for a deadlock the last cycle with
// activity; otherwise the cycle of the first mismatch; otherwise a cycle named in the reason. If
// there is none (a counter checked at the end), the last cycle of the run.
std::uint64_t failing_cycle(const nlohmann::json& result);

struct WaveWindow {
  std::uint64_t from = 0, to = 0;  // `to` is one past the last cycle
};
WaveWindow wave_window(std::uint64_t failing_cycle);

}  // namespace deburr::tool
