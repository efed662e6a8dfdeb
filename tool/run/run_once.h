// SPDX-License-Identifier: MIT
// One run of an engine: its parameters bound and checked, and the run from its claim on a directory
// to a verdict. `deburr run` does it once a process, a sweep's worker once a child.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "tb/run/parameter_set.h"
#include "tb/run/result.h"
#include "tool/pages/run_context.h"
#include "tool/run/engine.h"

namespace deburr::tool {

// An engine with all of its parameters, at their defaults until `set` is given others.
class BoundEngine {
 public:
  explicit BoundEngine(Engine& engine);
  BoundEngine(const BoundEngine&) = delete;
  BoundEngine& operator=(const BoundEngine&) = delete;

  // Once everything was set: what follows from it. ConfigError for what has no effect, and for
  // hardware that cannot be built.
  void resolve();

  Engine& engine;
  RunParameters run;
  tb::ParameterSet set;
};

struct RunEnd {
  int code = 0;
  std::string kind;   // of what failed: "mismatch"
  bool begun = true;  // false: interrupted before anything was simulated; there is no result
  tb::Result result{};
};

// Claims the context's directory, runs and checks; the caller finishes the context with the result.
// ConfigError and FileError where nothing could be run; every other failure is in the result, and
// on the error stream. `claimed` is called when the directory is this run's; false from it: there
// is nothing to do.
RunEnd run_once(BoundEngine& bound, RunContext& context, IfTaken if_taken,
                const std::function<bool()>& claimed = nullptr);

}  // namespace deburr::tool
