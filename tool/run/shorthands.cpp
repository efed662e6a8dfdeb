// SPDX-License-Identifier: MIT
#include "tool/run/shorthands.h"

#include <algorithm>

namespace deburr::tool {
namespace {

std::vector<Shorthand> common_shorthands() {
  return {
      {"--seed", "run.seed", "Seed of procedural textures"},
      {"--stall-seed", "run.stall_seed", "Seed of random stalls, latency and order"},
      {"--check", "run.check", "golden (default) or none"},
      {"--trace", "run.trace", "Write waves of these units and links (glob) to trace.vcd"},
      {"--trace-from", "run.trace_from", "First cycle traced"},
      {"--trace-to", "run.trace_to", "Cycle after the last one traced"},
      {"--windows", "run.interval_cycles", "Record the activity in intervals of N cycles"},
      {"--maps", "run.maps", "Write maps of the work per pixel"},
      {"--pixel", "run.pixel", "Record every step for this pixel"},
      {"--timeline", "run.timeline", "Write timeline.json for trace viewers such as Perfetto"},
      {"--timeline-from", "run.timeline_from", "First cycle of the timeline"},
      {"--timeline-to", "run.timeline_to", "Cycle after the last one of the timeline"},
      {"--line-trace", "run.line_trace", "Write every line requested from memory: text or binary"},
      {"--max-cycles", "run.max_cycles", "End with an error after N cycles"},
      {"--stalls", "run.stalls", "Random stalls: probability per cycle"},
      {"--shuffle", "run.shuffle", "Evaluate units in random order"},
      {"--truth", "run.reference", "Compare with the scene's supersampled reference"},
      {"--no-images", "run.images", "Write no pictures", "", "false"},
      {"--fault", "run.fault",
       "Inject a fault that the checks must catch (docs/reference/tests.md)"}};
}

}  // namespace

std::vector<Shorthand> shorthands_of(const Engine& engine) {
  const std::vector<Shorthand> own = engine.shorthands();
  std::vector<Shorthand> all = common_shorthands();
  std::erase_if(all, [&](const Shorthand& common) {
    return std::any_of(own.begin(), own.end(),
                       [&](const Shorthand& o) { return o.option == common.option; });
  });
  return joined(std::move(all), own);
}

std::vector<Shorthand> joined(std::vector<Shorthand> first, const std::vector<Shorthand>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

}  // namespace deburr::tool
