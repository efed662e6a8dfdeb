// SPDX-License-Identifier: MIT
// Shared by the runs of all engines: from an environment to a result, however the run ends.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "tb/env/environment.h"
#include "tb/env/simulation.h"
#include "tb/run/result.h"
#include "tool/pages/run_context.h"
#include "tool/run/engine.h"

namespace deburr::tool {

// From the parameters `run.*`.
tb::SimulationOptions simulation_options(const RunParameters& run, const RunContext& context);

// Runs the environment between context.claim() and context.finish(). `add_pictures` is called with
// the output so far, also if the run is aborted; Ctrl-C ends it at the next poll. If the context
// only checks, it returns before the first cycle.
void simulate(tb::Simulation& simulation, tb::Environment& environment, RunContext& context,
              tb::Result& result, const std::function<void()>& add_pictures);

// Rewrites the source path in a failed check's text, which is the compiler's, relative to the
// repository.
std::string from_repository(const std::string& text);

}  // namespace deburr::tool
