// SPDX-License-Identifier: MIT
// What the run of every engine has in common: from an environment to a result, whatever ends it.
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

// As the parameters `run.*` say.
tb::SimulationOptions simulation_options(const RunParameters& run, const RunContext& context);

// Runs the environment between context.claim() and context.finish(). `add_pictures` is called with
// what has come until then, also when the run is broken off; Ctrl-C ends it at the next chance.
// Where the context only checks, it returns before the first clock.
void simulate(tb::Simulation& simulation, tb::Environment& environment, RunContext& context,
              tb::Result& result, const std::function<void()>& add_pictures);

// The text of a failed check, which names its file as the compiler saw it, with the file as users
// know it: from the root of the repository.
std::string from_repository(const std::string& text);

}  // namespace deburr::tool
