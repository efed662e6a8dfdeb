// SPDX-License-Identifier: MIT
// What a failed run says of itself: which failures are the same one, and around which cycles to
// look.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace deburr::tool {

// The message without what differs from run to run: numbers become N, paths PATH. Digits within a
// name ("predictor_h0") stay.
std::string without_particulars(const std::string& message);

// In which cycle a failed run went wrong, as far as its result.json tells: of a deadlock the last
// one in which anything moved, else that of the first mismatch, else one that the reason names;
// where none is told, as of a counter that is checked at the end, the last cycle of the run.
std::uint64_t failing_cycle(const nlohmann::json& result);

struct WaveWindow {
  std::uint64_t from = 0, to = 0;  // `to` is the cycle behind the last
};
WaveWindow wave_window(std::uint64_t failing_cycle);

}  // namespace deburr::tool
