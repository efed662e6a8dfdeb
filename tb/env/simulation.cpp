// SPDX-License-Identifier: MIT
#include "tb/env/simulation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <utility>

#include "tb/env/environment.h"
#include "tb/run/progress.h"

namespace deburr::tb {
namespace {

constexpr rtl::Cycle kResetCycles = 4;
constexpr rtl::Cycle kReportPeriod = 4096;
constexpr std::size_t kLostInterval = 2;  // interval that the fault lose-window drops, from 0
constexpr rtl::Cycle kNoLimit = rtl::Cycle{1} << 50;

sc_core::sc_time clock_period(double mhz) {  // rounded to picoseconds
  return sc_core::sc_time(std::round(1e6 / mhz), sc_core::SC_PS);
}

BenchOptions bench_options(const SimulationOptions& options) {
  BenchOptions bench;
  bench.stall_permille = options.stall_permille;
  bench.seed = options.seed;
  if (options.shuffle) bench.shuffle = options.seed;
  bench.patience = options.patience;
  bench.check_links = options.check_links;
  bench.poison = bench.check_widths = options.poison;
  bench.fast_path = options.fast_path;
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

ScoreboardFigures& figures_named(const std::string& name, std::vector<ScoreboardFigures>& all) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& board) { return board.name == name; });
  return found != all.end() ? *found : all.emplace_back(ScoreboardFigures{name});
}

// Adds the host time between construction and destruction, also if an exception ends the scope.
class HostClock {
 public:
  HostClock(double& seconds, double& cpu_seconds) : seconds_(seconds), cpu_seconds_(cpu_seconds) {}
  ~HostClock() {
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    cpu_seconds_ += static_cast<double>(std::clock() - cpu_begin_) / CLOCKS_PER_SEC;
  }
  HostClock(const HostClock&) = delete;
  HostClock& operator=(const HostClock&) = delete;

 private:
  double &seconds_, &cpu_seconds_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::clock_t cpu_begin_ = std::clock();
};

}  // namespace

Simulation::Simulation(const SimulationOptions& options)
    : options_(options), clock_("clock", clock_period(options.clock_mhz)), faults_(options.faults) {
  faults_.know("", {{"lose-window", "Loses the counts of the third sampling interval.", "",
                     options.interval_cycles > 0 ? "" : "run.interval_cycles"}});
}

Simulation::~Simulation() = default;

void Simulation::elaborate(Environment& environment) {
  environment_ = &environment;
  BenchOptions bench = bench_options(options_);
  bench.faults = faults_.link_faults();
  bench.at_limit = [this] {
    const Amount amount = environment_->amount();
    return out_of_cycles(options_.max_cycles, amount.delivered, amount.total, amount.unit);
  };
  bench_ = std::make_unique<Bench>(clock_, bench);
  if (options_.interval_cycles > 0) {
    IntervalOptions intervals;
    intervals.cycles = options_.interval_cycles;
    if (faults_.injected("", "lose-window")) intervals.lose = kLostInterval;
    intervals_ = std::make_unique<IntervalRecorder>(clock_, intervals);
    environment.show_parts(*intervals_);
  }
  if (options_.timeline) {
    timeline_ = std::make_unique<Timeline>(clock_, *options_.timeline);
    environment.show_parts(*timeline_);
  }
}

void Simulation::reset() {
  clock_.set_reset_n(false);
  clock_.run(kResetCycles);
  clock_.set_reset_n(true);
  environment_->configure();
}

void Simulation::run(const GoOn& go_on) {
  try {
    run_pieces(go_on);
  } catch (...) {
    finish_records();
    throw;
  }
  finish_records();
}

void Simulation::finish_records() {
  if (intervals_) intervals_->finish();
  if (timeline_) timeline_->finish();
}

void Simulation::run_pieces(const GoOn& go_on) {
  reset();
  for (std::size_t piece = 0; environment_->begin(piece); ++piece)
    if (!run_piece(piece, go_on)) return;
  environment_->finish();
  complete_ = true;
  environment_->reject_memory_errors();
}

bool Simulation::asks_to_stop(const GoOn& go_on) {
  if (!go_on || clock_.cycle() < next_report_) return false;
  next_report_ = clock_.cycle() + kReportPeriod;
  const Amount amount = environment_->amount();
  return !go_on(amount.delivered, amount.taken);
}

bool Simulation::run_piece(std::size_t piece, const GoOn& go_on) {
  const rtl::Cycle before = cycles_;
  const rtl::Cycle limit = options_.max_cycles != 0 ? options_.max_cycles : kNoLimit;
  const rtl::Cycle reset_at = clock_.cycle() + options_.reset_after;
  bool reset_due = piece == 0 && options_.reset_after > 0;
  const auto done = [&] {
    environment_->watch();
    if (asks_to_stop(go_on)) return stopped_ = true;
    return (reset_due && clock_.cycle() >= reset_at) || environment_->done();
  };
  begun_ = clock_.cycle();
  running_ = true;
  try {
    const HostClock host_clock(host_seconds_, cpu_seconds_);
    bench_->run(done, std::max(limit, before) - before, false);
    if (!stopped_ && reset_due && clock_.cycle() >= reset_at) {
      reset_due = false;
      reset();
      environment_->restart();
      begun_ = clock_.cycle();
      bench_->run(done, limit, false);
    }
  } catch (...) {
    cycles_ = cycles();
    running_ = false;
    throw;
  }
  cycles_ = cycles();
  running_ = false;
  if (stopped_) return false;
  if (bench_->links()) bench_->links()->check_empty();
  environment_->end();
  return true;
}

rtl::Cycle Simulation::cycles() const {
  return running_ ? cycles_ + clock_.cycle() - begun_ : cycles_;
}

void Simulation::collect(Result& result) const {
  result.cycles = cycles();
  result.host_seconds = host_seconds_;
  result.host_cpu_seconds = cpu_seconds_;
  result.comparisons = result.mismatches = 0;
  result.first_mismatches.clear();
  result.scoreboards.clear();
  result.traffic_comparisons = result.traffic_mismatches = 0;
  const auto sum = [&](const Environment::Boards& boards, std::uint64_t& comparisons,
                       std::uint64_t& mismatches) {
    for (const ScoreboardBase* board : boards) {
      // In a complete run, items that never came count as mismatches.
      const std::uint64_t wrong = board->mismatches() + (complete_ ? board->leftovers() : 0);
      comparisons += board->comparisons();
      mismatches += wrong;
      ScoreboardFigures& figures = figures_named(board->name(), result.scoreboards);
      figures.comparisons += board->comparisons();
      figures.mismatches += wrong;
      for (const Difference& d : board->differences())
        result.first_mismatches.push_back({d.check, d.where, d.item, d.field, d.expected, d.got});
    }
  };
  sum(environment_->outputs(), result.comparisons, result.mismatches);
  sum(environment_->traffic(), result.traffic_comparisons, result.traffic_mismatches);
  sum(environment_->counters(), result.comparisons, result.mismatches);
  environment_->collect(result);
  if (intervals_)
    for (IntervalRecorder::Occupancy& link : intervals_->occupancy())
      result.links.push_back(
          {std::move(link.name), std::move(link.full_name), link.beats, std::move(link.cycles)});
  if (options_.pixel) result.pixel = environment_->pixel_history();
  if (options_.coverage) result.coverage = environment_->coverage().bins();
  environment_->collect_headline(result);
}

void describe(Simulation& simulation, Environment& environment, Result& result) {
  simulation.elaborate(environment);
  simulation.collect(result);
  result.faults = simulation.faults().known_names();
}

}  // namespace deburr::tb
