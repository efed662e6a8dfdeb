// SPDX-License-Identifier: MIT
#include "tb/env/simulation.h"

#include <cmath>
#include <utility>

namespace deburr::tb {

SimulationOptions simulation_options(const RunParameters& run, const RunContext& context) {
  SimulationOptions o;
  o.clock_mhz = run.clock_mhz;
  o.seed = static_cast<std::uint64_t>(run.seed);
  o.stall_permille = static_cast<std::uint32_t>(std::lround(run.stalls * 1000));
  o.golden = run.check == CheckMode::kGolden;
  o.shuffle = run.shuffle;
  o.fast_path = run.fast_path;
  o.check_links = run.check_links;
  o.max_cycles = static_cast<rtl::Cycle>(run.max_cycles);
  o.patience = static_cast<rtl::Cycle>(run.watchdog_cycles);
  if (!run.fault.empty()) o.faults = {run.fault};
  o.trace_scope = run.trace;
  o.trace_file = context.trace_file().string();
  o.trace_from = static_cast<rtl::Cycle>(run.trace_from);
  o.trace_to = static_cast<rtl::Cycle>(run.trace_to);
  return o;
}

BenchOptions bench_options(const SimulationOptions& options, std::vector<std::string> link_faults) {
  BenchOptions bench;
  bench.stall_permille = options.stall_permille;
  bench.seed = options.seed;
  if (options.shuffle) bench.shuffle = options.seed;
  bench.patience = options.patience;
  bench.check_links = options.check_links;
  bench.fast_path = options.fast_path;
  bench.faults = std::move(link_faults);
  if (!options.trace_scope.empty()) {
    rtl::TraceOptions trace;
    trace.file = options.trace_file;
    trace.scopes = {options.trace_scope};
    trace.from = options.trace_from;
    trace.to = options.trace_to;
    bench.trace = trace;
  }
  return bench;
}

sc_core::sc_time clock_period(double mhz) {
  return sc_core::sc_time(std::round(1e6 / mhz), sc_core::SC_PS);
}

}  // namespace deburr::tb
