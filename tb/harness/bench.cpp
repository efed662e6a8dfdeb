// SPDX-License-Identifier: MIT
#include "tb/harness/bench.h"

#include <fmt/format.h>

#include "spec/error.h"

namespace deburr::tb {

Bench::Bench(rtl::ClockDomain& clock, const BenchOptions& options) : clock_(clock) {
  clock.set_fast_path(options.fast_path);
  if (options.shuffle) clock.shuffle(options.shuffle);
  if (options.stall_permille)
    stalls_ = std::make_unique<StallInjector>(
        clock,
        StallInjector::Options{options.stall_permille, options.stall_permille, options.seed, "*"});
  if (!options.faults.empty()) {
    std::vector<Fault> faults;
    for (const std::string& text : options.faults) faults.push_back(Fault::parse(text));
    faults_ = std::make_unique<FaultInjector>(clock, faults);
  }
  if (options.check_links) checker_ = std::make_unique<LinkChecker>(clock);
  watchdog_ = std::make_unique<Watchdog>(clock, options.patience);
  if (options.trace) trace_ = std::make_unique<rtl::Trace>(clock, *options.trace);
}

rtl::Cycle Bench::run(const std::function<bool()>& done, rtl::Cycle limit, bool drained) {
  const rtl::Cycle begin = clock_.cycle();
  if (!clock_.run_until(done, limit))
    throw spec::DeadlockError(
        fmt::format("{}: not done after {} cycles\n{}", clock_.name(), limit, dump_state(clock_)));
  if (faults_) faults_->check_fired();
  if (checker_ && drained) checker_->check_empty();
  clock_.check_accounting();
  return clock_.cycle() - begin;
}

}  // namespace deburr::tb
