// SPDX-License-Identifier: MIT
// The engines of this program: nothing is simulated, a run leaves what the test says.
#pragma once

#include <functional>

#include "tool/run/engine.h"

namespace deburr::tb {

// What a run of either engine does, where a test says so. Else, as in the worker of a sweep, it is
// given lanes and a gain: the cycles are 1200 / lanes and the rate is the lanes; of 3 lanes one of
// nine colours is wrong, a gain of 2 is a deadlock, and one of 1.5 is rejected. Waves say which
// clocks they are of.
using MadeRun = std::function<void(const RunParameters& run, RunContext& context, Result& result)>;
MadeRun& made_run();

}  // namespace deburr::tb
