// SPDX-License-Identifier: MIT
// Analyses the message of a failed run: its failure signature, and the cycles to record.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace deburr::tool {

// The message without details that differ from run to run: numbers become N, paths PATH. Digits
// within a name ("predictor_h0") are kept.
std::string without_particulars(const std::string& message);

// The cycle in which a run failed, by its result.json: for a deadlock the last cycle with activity,
// else the first mismatch, else a cycle named in the reason. Without any (a counter checked at the
// end), the run's last cycle.
std::uint64_t failing_cycle(const nlohmann::json& result);

struct WaveWindow {
  std::uint64_t from = 0, to = 0;  // `to` is one past the last cycle
};
WaveWindow wave_window(std::uint64_t failing_cycle);

}  // namespace deburr::tool
