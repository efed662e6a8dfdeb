// SPDX-License-Identifier: MIT
// Test harness around a design. Link checkers and a watchdog are always active; random stalls,
// injected faults, poison, shuffled evaluation order and waveform traces are optional.
//
//   MyDesign design("design"); Driver..., Sink..., bindings
//   Bench bench(clock, options);               // after the design
//   bench.run([&] { return sink.received() == n; }, limit);
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/trace.h"
#include "tb/harness/fault_injector.h"
#include "tb/harness/link_checker.h"
#include "tb/harness/poison.h"
#include "tb/harness/stall_injector.h"
#include "tb/harness/watchdog.h"

namespace deburr::tb {

struct BenchOptions {
  std::uint32_t stall_permille = 0;      // stalls at both ends of every link, in cycles per 1000
  std::uint64_t seed = 1;                // for the stalls
  std::optional<std::uint64_t> shuffle;  // seed of a random evaluation order
  rtl::Cycle patience = 100'000;         // cycles without any beat before the watchdog aborts
  bool check_links = true;               // protocol checker on every link
  bool check_widths = false;             // also check that every field fits its width
  bool poison = false;                   // fill unwritten fields with noise (uses `seed`)
  bool fast_path = true;
  std::vector<std::string> faults;  // see Fault::parse
  std::optional<rtl::TraceOptions> trace;
  // Added to the OutOfCycles error: progress so far and which limit to raise.
  std::function<std::string()> at_limit;
};

class Bench {
 public:
  // Throws ConfigError for a fault or a trace scope that matches no link or object.
  Bench(rtl::ClockDomain& clock, const BenchOptions& options = {});

  // Runs until `done` returns true; throws OutOfCycles after `limit` cycles. Afterwards checks that
  // links are empty (unless `drained` is false), that cycle accounts add up and that every injected
  // fault fired. Returns the number of cycles.
  rtl::Cycle run(const std::function<bool()>& done, rtl::Cycle limit, bool drained = true);

  const LinkChecker* links() const { return checker_.get(); }

 private:
  rtl::ClockDomain& clock_;
  std::function<std::string()> at_limit_;
  std::unique_ptr<Poison> poison_;
  std::unique_ptr<StallInjector> stalls_;
  std::unique_ptr<FaultInjector> faults_;
  std::unique_ptr<LinkChecker> checker_;
  std::unique_ptr<Watchdog> watchdog_;
  std::unique_ptr<rtl::Trace> trace_;
};

}  // namespace deburr::tb
