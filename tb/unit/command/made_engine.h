// SPDX-License-Identifier: MIT
// The engines of this program: nothing is simulated, a run leaves what the test says.
#pragma once

#include <functional>

#include "tb/app/engine.h"

namespace deburr::tb {

// What a run of either engine does; a test gives it.
using MadeRun = std::function<void(const RunParameters& run, RunContext& context, Result& result)>;
MadeRun& made_run();

}  // namespace deburr::tb
