// SPDX-License-Identifier: MIT
#include "tool/run/run_once.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "spec/error.h"
#include "tb/base/interrupt.h"
#include "tb/scene/reference.h"
#include "tool/cost/estimate.h"
#include "tool/run/simulate.h"

namespace deburr::tool {
namespace {

using spec::ConfigError;
using spec::ExitCode;

constexpr std::int64_t kMostTimelineCycles = 100'000;

void reject_no_history(const Engine& engine) {
  if (keeps_pixel_history(engine)) return;
  std::vector<std::string> known;
  for (const std::unique_ptr<Engine>& other : engines())
    if (keeps_pixel_history(*other)) known.emplace_back(other->name());
  throw ConfigError(fmt::format(
      "run.pixel: the engine {} does not record the history of a pixel: leave out --pixel; engines "
      "that do: {}",
      engine.name(), known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", "))));
}

}  // namespace

tb::Cost cost_of(const tb::Result& result, const tb::ParameterSet& set) {
  return estimate(result, [&set](std::string_view name) {
    const tb::Parameter* const parameter = set.find(name);
    return parameter ? parameter->json() : nlohmann::ordered_json();
  });
}

BoundEngine::BoundEngine(Engine& bound) : engine(bound), run(bound.run_parameters()) {
  set.add("run", tb::ParameterKind::kRun, run);
  engine.add_parameters(set);
}

void BoundEngine::resolve() {
  engine.resolve(set);
  set.check_build();
  if (!run.pixel.empty()) {
    reject_no_history(engine);
    tb::pixel_of(run.pixel);
  }
  if (!run.trace.empty() && run.trace_from >= run.trace_to)
    throw ConfigError(fmt::format(
        "run.trace_from = {} and run.trace_to = {} leave no cycle to trace: --trace-to is the "
        "cycle after the last one, give one above {}",
        run.trace_from, run.trace_to, run.trace_from));
  if (run.timeline && run.timeline_from >= run.timeline_to)
    throw ConfigError(fmt::format(
        "run.timeline_from = {} and run.timeline_to = {} leave no cycle: --timeline-to is the "
        "cycle after the last one, give one above {}",
        run.timeline_from, run.timeline_to, run.timeline_from));
  if (run.timeline && run.timeline_to - run.timeline_from > kMostTimelineCycles)
    throw ConfigError(
        fmt::format("run.timeline_from = {} and run.timeline_to = {}: {} cycles are more than "
                    "trace viewers open, at most {}: choose a shorter range",
                    run.timeline_from, run.timeline_to, run.timeline_to - run.timeline_from,
                    kMostTimelineCycles));
  if (!run.timeline)
    for (const char* name : {"run.timeline_from", "run.timeline_to"})
      set.reject(name, "it needs run.timeline (--timeline)");
  if (run.trace.empty())
    for (const char* name : {"run.trace_from", "run.trace_to"})
      set.reject(name, "it needs run.trace (--trace)");
}

RunEnd run_once(BoundEngine& bound, RunContext& context, IfTaken if_taken,
                const std::function<bool()>& claimed) {
  RunEnd end;
  tb::Result& result = end.result;
  result.unit = bound.engine.name();
  result.clock_mhz = bound.run.clock_mhz;
  try {
    const std::vector<std::string_view> pictures = bound.engine.pictures();
    context.set_leaves({{pictures.begin(), pictures.end()},
                        maps_of(bound.engine),
                        keeps_pixel_history(bound.engine)});
    context.claim(if_taken);
    if (claimed && !claimed()) {
      end.begun = false;
      return end;
    }
    bound.engine.run(bound.run, context, result);
    if (!result.sheets.empty()) result.cost = cost_of(result, bound.set);
    if (result.mismatches + result.traffic_mismatches > 0) {
      end.code = static_cast<int>(ExitCode::kMismatch);
      end.kind = "mismatch";
      result.reason =
          fmt::format("{} of {} outputs and {} of {} memory accesses differ from the golden model",
                      result.mismatches, result.comparisons, result.traffic_mismatches,
                      result.traffic_comparisons);
    }
  } catch (const tb::Interrupted&) {
    result.interrupted = true;
    end.begun = false;
    return end;
  } catch (const spec::Error& error) {
    // Errors before simulation give no result; errors during it give a partial one.
    end.code = static_cast<int>(error.code());
    if (error.code() == ExitCode::kUsage || error.code() == ExitCode::kFile) throw;
    end.kind = error.code() == ExitCode::kDeadlock   ? "deadlock"
               : error.code() == ExitCode::kMismatch ? "mismatch"
                                                     : "simulation";
    result.reason = error.what();
    fmt::print(stderr, "deburr: {}\n", error.what());
  } catch (const spec::CheckFailed& error) {
    end.code = static_cast<int>(ExitCode::kSimulation);
    end.kind = "simulation";
    result.reason = from_repository(error.what());
    fmt::print(stderr, "deburr: {}\n", result.reason);
  }
  if (end.code != 0)
    result.verdict = tb::Verdict::kFail;
  else
    result.verdict =
        bound.run.check == CheckMode::kGolden ? tb::Verdict::kPass : tb::Verdict::kUnchecked;
  if (result.interrupted && end.code == 0) {
    result.verdict = tb::Verdict::kUnchecked;
    result.reason = "interrupted: the results cover only the completed part";
  }
  return end;
}

}  // namespace deburr::tool
