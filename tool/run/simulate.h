// SPDX-License-Identifier: MIT
// Shared by the runs of all engines: runs an environment and fills a result, however the run ends.
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

// Runs the environment; call it between context.claim() and context.finish(). `add_pictures` is
// called with the output so far, even if the run is aborted. Ctrl-C ends the run at the next poll.
// If the context only checks, simulate() returns before the first cycle.
void simulate(tb::Simulation& simulation, tb::Environment& environment, RunContext& context,
              tb::Result& result, const std::function<void()>& add_pictures);

// The text of a failed check contains the source path that the compiler was given. Makes this path
// relative to the repository.
std::string from_repository(const std::string& text);

}  // namespace deburr::tool
