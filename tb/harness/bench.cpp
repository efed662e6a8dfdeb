// SPDX-License-Identifier: MIT
#include "tb/harness/bench.h"

#include <fmt/format.h>

#include <algorithm>

#include "rtl_model/fabric/glob.h"
#include "rtl_model/fabric/link.h"
#include "rtl_model/fabric/ownership.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "spec/error.h"
#include "tb/harness/verdict.h"

namespace deburr::tb {
namespace {

// A scope that matches nothing is probably misspelt: reject it instead of writing an empty trace.
void check_scopes(const rtl::ClockDomain& clock, const rtl::TraceOptions& trace) {
  const std::vector<std::string> names = rtl::Trace::names(clock);
  for (const std::string& scope : trace.scopes) {
    if (std::any_of(names.begin(), names.end(),
                    [&](const std::string& name) { return rtl::glob_match(scope, name); }))
      continue;
    std::string known;
    const auto add = [&](const sc_core::sc_object& object) {
      known += std::string("\n  ") + object.name();
    };
    rtl::for_each_of<rtl::LinkBase>(clock, add);
    rtl::for_each_of<rtl::WireBase>(clock, add);
    rtl::for_each_of<rtl::Unit>(clock, add);
    throw spec::ConfigError(
        fmt::format("trace: no link, wire, unit, counter or register matches {} (* matches any "
                    "text, ? any character); known links, wires and units:{}",
                    scope, known));
  }
}

}  // namespace

Bench::Bench(rtl::ClockDomain& clock, const BenchOptions& options)
    : clock_(clock), at_limit_(options.at_limit) {
  if (options.trace) check_scopes(clock, *options.trace);
  clock.set_fast_path(options.fast_path);
  if (options.shuffle) clock.shuffle(options.shuffle);
  if (options.poison) poison_ = std::make_unique<Poison>(clock, options.seed);
  if (options.stall_permille)
    stalls_ = std::make_unique<StallInjector>(
        clock,
        StallInjector::Options{options.stall_permille, options.stall_permille, options.seed, "*"});
  if (!options.faults.empty()) {
    std::vector<Fault> faults;
    for (const std::string& text : options.faults) faults.push_back(Fault::parse(text));
    faults_ = std::make_unique<FaultInjector>(clock, faults);
  }
  if (options.check_links)
    checker_ = std::make_unique<LinkChecker>(clock, "*", options.check_widths);
  watchdog_ = std::make_unique<Watchdog>(clock, options.patience);
  if (options.trace) trace_ = std::make_unique<rtl::Trace>(clock, *options.trace);
}

rtl::Cycle Bench::run(const std::function<bool()>& done, rtl::Cycle limit, bool drained) {
  const rtl::Cycle begin = clock_.cycle();
  if (!clock_.run_until(done, limit))
    throw OutOfCycles(
        fmt::format("{}: {}\n\n{}", clock_.name(),
                    at_limit_ ? at_limit_() : fmt::format("not done after {} cycles", limit),
                    dump_state(clock_)));
  if (trace_) trace_->flush();
  if (faults_) faults_->check_fired();
  if (checker_ && drained) checker_->check_empty();
  clock_.check_accounting();
  return clock_.cycle() - begin;
}

}  // namespace deburr::tb
