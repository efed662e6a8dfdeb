// SPDX-License-Identifier: MIT
#include "tool/run/simulate.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "rtl_model/fabric/memory.h"
#include "spec/error.h"
#include "tb/base/interrupt.h"
#include "tb/base/json_text.h"
#include "tb/run/intervals.h"
#include "tb/run/progress.h"
#include "tb/traces/line_trace.h"

namespace deburr::tool {

tb::SimulationOptions simulation_options(const RunParameters& run, const RunContext& context) {
  tb::SimulationOptions o;
  o.clock_mhz = run.clock_mhz;
  o.seed = static_cast<std::uint64_t>(run.stall_seed);
  o.stall_permille = static_cast<std::uint32_t>(std::lround(run.stalls * 1000));
  o.golden = run.check == CheckMode::kGolden;
  o.reset_after = static_cast<rtl::Cycle>(run.reset_after);
  o.shuffle = run.shuffle;
  o.fast_path = run.fast_path;
  o.check_links = run.check_links;
  o.poison = run.poison;
  if (const tb::Parameter* const program = context.parameters().find("run.program"))
    o.program = program->text() != tb::kProgramNames[static_cast<std::size_t>(tb::Program::kReset)];
  o.max_cycles = static_cast<rtl::Cycle>(run.max_cycles);
  o.patience = static_cast<rtl::Cycle>(run.watchdog_cycles);
  if (!run.fault.empty()) o.faults = {run.fault};
  // Link checkers would be the first to detect an injected link fault. Unless the user asked for
  // link checks, they are disabled, so that the later checks show that they can fail too.
  if (!run.fault.empty() && !context.parameters().given("run.check_links")) o.check_links = false;
  o.trace_scope = run.trace;
  o.trace_file = context.trace_file().string();
  o.trace_from = static_cast<rtl::Cycle>(run.trace_from);
  o.trace_to = static_cast<rtl::Cycle>(run.trace_to);
  o.interval_cycles = static_cast<rtl::Cycle>(run.interval_cycles);
  o.maps = run.maps;
  if (run.coverage && !o.golden)
    throw spec::ConfigError("run.coverage needs the golden model: leave out run.check=none");
  o.coverage = run.coverage;
  if (!run.pixel.empty()) o.pixel = tb::pixel_of(run.pixel);
  if (run.timeline)
    o.timeline = {static_cast<rtl::Cycle>(run.timeline_from),
                  static_cast<rtl::Cycle>(run.timeline_to)};
  return o;
}

namespace {

void reject_empty_trace(tb::Simulation& simulation) {
  const tb::SimulationOptions& o = simulation.options();
  const rtl::Cycle end = simulation.clock().cycle();
  if (o.timeline && o.timeline->from >= end)
    throw spec::ConfigError(
        fmt::format("run.timeline_from = {}: the run ended after cycle {}, so the timeline is "
                    "empty: give a smaller --timeline-from",
                    o.timeline->from, end));
  if (!o.trace_scope.empty() && o.trace_from >= end)
    throw spec::ConfigError(
        fmt::format("run.trace_from = {}: the run ended after cycle {}, so nothing was traced: "
                    "give a smaller --trace-from",
                    o.trace_from, end));
}

// Adds the sampling intervals, however the run ended. Totals are checked only if every cycle was
// complete.
void leave_intervals(const tb::Simulation& simulation, RunContext& context,
                     const tb::Result& result, bool whole_cycles) {
  if (simulation.timeline())
    context.add_record("timeline", kTimelineFile, simulation.timeline()->json());
  if (!simulation.intervals()) return;
  const nlohmann::ordered_json intervals = simulation.intervals()->json();
  context.add_record("intervals", kIntervalsFile, tb::json_text(intervals) + "\n");
  if (whole_cycles) tb::check_intervals(intervals, to_json(result));
}

// With mismatches or missing output, counts differ too.
void leave_maps(const tb::Simulation& simulation, const tb::Environment& environment,
                RunContext& context, tb::Result& result) {
  const bool right =
      simulation.complete() && result.mismatches == 0 && result.traffic_mismatches == 0;
  for (const tb::PictureMap& map : environment.maps()) {
    context.add_map(map);
    result.maps.push_back(figures_of(map));
    if (right) check_map(map);
  }
}

// nullptr: not requested.
std::unique_ptr<tb::traces::LineTrace> line_trace(const tb::Simulation& simulation,
                                                  const RunContext& context,
                                                  const tb::Result& result) {
  const auto value = [&](const char* name) {
    const tb::Parameter* parameter = context.parameters().find(name);
    return parameter ? parameter->text() : std::string();
  };
  const std::string wanted = value("run.line_trace");
  if (wanted == "none") return nullptr;
  tb::traces::LineTraceOptions options;
  options.engine = result.unit;
  options.clock_mhz = simulation.options().clock_mhz;
  options.format =
      wanted == "binary" ? tb::traces::TraceFormat::kBinary : tb::traces::TraceFormat::kText;
  options.lookups = value("run.line_trace_lookups") == "true";
  return std::make_unique<tb::traces::LineTrace>(context.line_trace_file(), options);
}

// Bits of copies are counted like all bits. But so many copies of a large memory are rarely
// intended, so they are noted.
void note_copies(RunContext& context) {
  constexpr std::uint32_t kMany = 8;
  constexpr std::uint64_t kLarge = 1'000'000;
  rtl::for_each<rtl::MemoryBase>([&](const rtl::MemoryBase& memory) {
    if (memory.copies() > kMany && memory.physical_bits() > kLarge)
      context.add_note(fmt::format("{}: {} copies, one per read port, {} kbit for {} of content",
                                   memory.name(), memory.copies(), memory.physical_bits() / 1000,
                                   memory.logical_bits() / 1000));
  });
}

}  // namespace

void simulate(tb::Simulation& simulation, tb::Environment& environment, RunContext& context,
              tb::Result& result, const std::function<void()>& add_pictures) {
  simulation.elaborate(environment);
  const std::unique_ptr<tb::traces::LineTrace> lines = line_trace(simulation, context, result);
  if (context.checking_only()) return;
  if (tb::interrupted()) throw tb::Interrupted();  // while the input was prepared: nothing to keep
  note_copies(context);
  try {
    const tb::Amount amount = environment.amount();
    tb::Progress progress(result.unit, amount.total, amount.unit, context.quiet());
    simulation.run([&](std::uint64_t delivered, std::uint64_t taken) {
      progress.update(delivered, taken);
      return !tb::interrupted();
    });
  } catch (const spec::FileError&) {  // a waveform that could not be written: nothing is kept
    throw;
  } catch (...) {
    // If partial output cannot be written, this must not hide why the run failed.
    const auto leave = [&context](auto&& part) {
      try {
        part();
      } catch (const std::exception& error) {
        context.add_note(fmt::format("results of the failed run are missing: {}",
                                     from_repository(error.what())));
      }
    };
    leave([&] { simulation.collect(result); });
    if (lines) leave([&] { lines->finish(); });
    leave(add_pictures);
    leave([&] { leave_intervals(simulation, context, result, false); });
    leave([&] { leave_maps(simulation, environment, context, result); });
    throw;
  }
  simulation.collect(result);
  if (lines) lines->finish();
  result.interrupted = !simulation.complete();
  // while the golden model ran
  if (result.interrupted && result.cycles == 0) throw tb::Interrupted();
  add_pictures();
  leave_intervals(simulation, context, result, true);
  leave_maps(simulation, environment, context, result);
  if (!simulation.complete()) return;
  environment.check();
  environment.reject_unused_errors();
  reject_empty_trace(simulation);
}

std::string from_repository(const std::string& text) {
  for (const char* layer : {"/layers/spec/", "/layers/golden/", "/layers/rtl_model/", "/layers/tb/",
                            "/layers/tool/", "/layers/studies/"})
    if (const std::size_t at = text.find(layer); at != std::string::npos)
      return text.substr(at + std::string_view(layer).size());
  return text;
}

}  // namespace deburr::tool
