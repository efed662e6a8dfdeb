// SPDX-License-Identifier: MIT
// One simulation, whatever engine it is of: clock, reset, random stalls, injected faults, waves,
// progress, limits and time.
//
//   Simulation simulation(options);
//   SomeEnvironment environment(simulation, scene, setup);
//   simulation.elaborate(environment);    // after everything that it is made of
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
  std::uint32_t stall_permille = 0;  // on both sides of every link
  bool golden = true;                // compare with the golden model
  bool shuffle = false;
  bool fast_path = true;
  bool check_links = true;
  bool poison = false;  // fields that nobody wrote hold noise
  // Rules are written to registers after each reset, over others that the engine is built with;
  // else they are its reset values.
  bool program = true;
  rtl::Cycle max_cycles = 0;  // 0: no limit
  rtl::Cycle patience = 20000;
  // Names that an environment knows, or faults of the harness (fault_injector.h).
  std::vector<std::string> faults;
  rtl::Cycle reset_after = 0;  // resets once, so many cycles into the first piece; 0: never
  std::string trace_file, trace_scope;  // empty: none
  rtl::Cycle trace_from = 0, trace_to = 2000;
  rtl::Cycle interval_cycles = 0;  // 0: no windows
  bool maps = false;               // pixel by pixel, what was done
  bool coverage = false;           // bins of functional coverage, with their hits
  std::optional<TimelineOptions> timeline;
  std::optional<PixelAddress> pixel;  // whose history is kept
};

// One a process: SystemC elaborates once.
class Simulation {
 public:
  explicit Simulation(const SimulationOptions& options);
  ~Simulation();

  const SimulationOptions& options() const { return options_; }
  rtl::ClockDomain& clock() { return clock_; }
  FaultPlan& faults() { return faults_; }

  // The environment that the run is about, which must outlive the last call of anything here. The
  // design is complete. ConfigError for faults and waves of what does not exist.
  void elaborate(Environment& environment);

  // Called every few thousand cycles with what was delivered and taken (Environment::amount());
  // false ends the run early.
  using GoOn = std::function<bool(std::uint64_t delivered, std::uint64_t taken)>;
  // Resets, and runs every piece of work to its end. Does not throw on mismatches: that is
  // Environment::check(). SimulationError for memory errors and broken protocols, DeadlockError for
  // no progress, OutOfCycles for max_cycles.
  void run(const GoOn& go_on = {});

  bool complete() const { return complete_; }  // false when ended early
  // Cycles of all pieces so far; of one that a reset broke off, only those behind the reset.
  rtl::Cycle cycles() const;
  rtl::Cycle begun() const { return begun_; }  // the clock in which the last piece began
  std::uint64_t activations() const { return clock_.activations(); }
  // nullptr unless asked for. Complete once run() is over, however it ended.
  const IntervalRecorder* intervals() const { return intervals_.get(); }
  const Timeline* timeline() const { return timeline_.get(); }
  // Everything measured so far, also after an exception from run().
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

// For EngineTestbench::describe_statistics(): what an environment reports, and its faults, without
// a run.
void describe(Simulation& simulation, Environment& environment, Result& result);

}  // namespace deburr::tb
