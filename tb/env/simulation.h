// SPDX-License-Identifier: MIT
// What every bench of the command is told about its simulation, whatever engine it holds.
#pragma once

#include <cstdint>
#include <string>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "tb/app/engine.h"
#include "tb/harness/bench.h"
#include "tb/results/run_context.h"

namespace deburr::tb {

struct SimulationOptions {
  double clock_mhz = 166.67;
  std::uint64_t seed = 1;
  std::uint32_t stall_permille = 0;  // on both sides of every link
  bool golden = true;                // compare with the golden model
  bool shuffle = false;
  bool fast_path = true;
  bool check_links = true;
  rtl::Cycle max_cycles = 0;  // 0: no limit
  rtl::Cycle patience = 20000;
  // Names of the bench's own faults, or faults of the harness (fault_injector.h).
  std::vector<std::string> faults;
  std::string trace_file, trace_scope;  // empty: none
  rtl::Cycle trace_from = 0, trace_to = 2000;

  rtl::Cycle cycle_limit() const { return max_cycles != 0 ? max_cycles : rtl::Cycle{1} << 50; }
};

// As the parameters `run.*` say.
SimulationOptions simulation_options(const RunParameters& run, const RunContext& context);

// For the harness; `link_faults` are those of the options that it knows.
BenchOptions bench_options(const SimulationOptions& options, std::vector<std::string> link_faults);

sc_core::sc_time clock_period(double mhz);  // rounded to picoseconds

}  // namespace deburr::tb
