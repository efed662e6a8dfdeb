// SPDX-License-Identifier: MIT
// One run of an engine: binds and checks its parameters, and runs it, from claiming a directory to
// the verdict. `deburr run` does this once per process, a sweep's worker once per child.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "tb/run/parameter_set.h"
#include "tb/run/result.h"
#include "tool/pages/run_context.h"
#include "tool/run/engine.h"

namespace deburr::tool {

// An engine with all of its parameters, at their defaults until `set` changes them.
class BoundEngine {
 public:
  explicit BoundEngine(Engine& engine);
  BoundEngine(const BoundEngine&) = delete;
  BoundEngine& operator=(const BoundEngine&) = delete;

  // Call after all settings: derives dependent values. ConfigError for settings without effect and
  // for hardware that cannot be built.
  void resolve();

  Engine& engine;
  RunParameters run;
  tb::ParameterSet set;
};

// Of the hardware in the result (tool/cost/estimate.h).
tb::Cost cost_of(const tb::Result& result, const tb::ParameterSet& set);

struct RunEnd {
  int code = 0;
  std::string kind;   // of the failure: "mismatch"
  bool begun = true;  // false: interrupted before simulation; there is no result
  tb::Result result{};
};

// Claims the context's directory, runs and checks; the caller finishes the context with the result.
// Throws ConfigError or FileError if the run could not start. Every other failure is in the result
// and on the error stream. `claimed` is called when the directory has been claimed; if it returns
// false, the run is skipped.
RunEnd run_once(BoundEngine& bound, RunContext& context, IfTaken if_taken,
                const std::function<bool()>& claimed = nullptr);

}  // namespace deburr::tool
