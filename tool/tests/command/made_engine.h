// SPDX-License-Identifier: MIT
// The engines `made` and `other` simulate nothing; a test chooses their results.
#pragma once

#include <functional>

#include "tool/run/engine.h"

namespace deburr::tool {

// Replaces the run of both engines. Without it, as in the worker of a sweep, lanes and gain decide:
// 1200 / lanes cycles at a rate of `lanes`. With 3 lanes one of nine colours is wrong; a gain of 2
// deadlocks; a gain of 1.5 is rejected. The wave file holds the traced interval.
using MadeRun =
    std::function<void(const RunParameters& run, RunContext& context, tb::Result& result)>;
MadeRun& made_run();

}  // namespace deburr::tool
