// SPDX-License-Identifier: MIT
// One simulation of any engine: clock, reset, random stalls, injected faults, waveforms, progress,
// limits and times.
//
//   Simulation simulation(options);
//   SomeEnvironment environment(simulation, scene, setup);
//   simulation.elaborate(environment);    // after all parts have been constructed
//   simulation.run();
//   environment.check();
//   simulation.collect(result);
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "tb/env/injected_faults.h"
#include "tb/harness/bench.h"
#include "tb/harness/interval_recorder.h"
#include "tb/harness/timeline.h"
#include "tb/run/result.h"

namespace deburr::tb {

class Environment;

struct SimulationOptions {
  double clock_mhz = 166.67;
  std::uint64_t seed = 1;
  std::uint32_t stall_permille = 0;  // at both ends of every link, per 1000 cycles
  bool golden = true;                // compare with the golden model
  bool shuffle = false;
  bool fast_path = true;
  bool check_links = true;
  bool poison = false;  // fill unwritten fields with noise
  // True: the engine is built with a different configuration, and the wanted one is written to
  // registers after each reset. False: the wanted configuration is the reset value.
  bool program = true;
  rtl::Cycle max_cycles = 0;  // 0: no limit
  rtl::Cycle patience = 20000;
  // Faults of an environment by name, or faults of the harness (fault_injector.h).
  std::vector<std::string> faults;
  rtl::Cycle reset_after = 0;  // cycle of the first piece in which one reset happens; 0: never
  std::string trace_file, trace_scope;  // empty: none
  rtl::Cycle trace_from = 0, trace_to = 2000;
  rtl::Cycle interval_cycles = 0;  // length of sampling intervals; 0: none
  bool maps = false;               // record per-pixel maps
  bool coverage = false;           // collect functional coverage
  std::optional<TimelineOptions> timeline;
  std::optional<PixelAddress> pixel;  // pixel whose history is recorded
};

// One per process, because SystemC elaborates once.
class Simulation {
 public:
  explicit Simulation(const SimulationOptions& options);
  ~Simulation();

  const SimulationOptions& options() const { return options_; }
  rtl::ClockDomain& clock() { return clock_; }
  FaultPlan& faults() { return faults_; }

  // Call after the design is complete. `environment` is the main one and must outlive the last call
  // of any function here. Throws ConfigError for faults and waveform scopes that do not exist.
  void elaborate(Environment& environment);

  // Called every few thousand cycles with the delivered and taken amounts (Environment::amount()).
  // If it returns false, the run ends early.
  using GoOn = std::function<bool(std::uint64_t delivered, std::uint64_t taken)>;
  // Resets the design and runs every piece of work to its end. Mismatches do not throw here; see
  // Environment::check(). Throws SimulationError for memory errors and protocol violations,
  // DeadlockError if there is no progress, and OutOfCycles after max_cycles.
  void run(const GoOn& go_on = {});

  bool complete() const { return complete_; }  // false if ended early
  // Total cycles of all pieces so far. If a reset restarted a piece, its cycles count from the
  // reset on.
  rtl::Cycle cycles() const;
  rtl::Cycle begun() const { return begun_; }  // start cycle of the last piece
  std::uint64_t activations() const { return clock_.activations(); }
  // nullptr unless enabled. Complete after run(), also after an exception.
  const IntervalRecorder* intervals() const { return intervals_.get(); }
  const Timeline* timeline() const { return timeline_.get(); }
  // Collects all measurements so far, also after an exception from run().
  void collect(Result& result) const;

 private:
  void reset();
  void run_pieces(const GoOn& go_on);
  void finish_records();
  bool run_piece(std::size_t piece, const GoOn& go_on);
  bool asks_to_stop(const GoOn& go_on);

  SimulationOptions options_;
  rtl::ClockDomain clock_;
  FaultPlan faults_;
  Environment* environment_ = nullptr;
  std::unique_ptr<Bench> bench_;
  std::unique_ptr<IntervalRecorder> intervals_;
  std::unique_ptr<Timeline> timeline_;
  rtl::Cycle cycles_ = 0, begun_ = 0, next_report_ = 0;
  double host_seconds_ = 0, cpu_seconds_ = 0;
  bool running_ = false, stopped_ = false, complete_ = false;
};

// For EngineTestbench::describe_statistics(): figures and faults of an environment, without a run.
void describe(Simulation& simulation, Environment& environment, Result& result);

}  // namespace deburr::tb
