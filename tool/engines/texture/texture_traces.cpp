// SPDX-License-Identifier: MIT
#include "tool/engines/texture/texture_traces.h"

#include "spec/error.h"

namespace deburr::tb {

void reject_unused_look_ups(const ParameterSet& set) {
  if (set.find("run.line_trace")->text() == "none")
    set.reject("run.line_trace_look_ups",
               "there is no trace without run.line_trace (--line-trace text)");
}

void reject_unused_scene(const ParameterSet& set) {
  for (const char* name :
       {"scene.width", "scene.height", "scene.traversal", "scene.visibility", "scene.eye",
        "scene.target", "scene.fov", "scene.roll", "sequence.frames", "sequence.motion"})
    set.reject(name, "the fragments come from the file scene.fragments (--fragments)");
  if (set.find("run.truth")->text() == "true")
    throw spec::ConfigError("run.truth: the scene of a file's fragments is unknown: leave it out");
}

}  // namespace deburr::tb
