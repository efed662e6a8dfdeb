// SPDX-License-Identifier: MIT
// What every simulation of this repository has around its design: link checkers and a watchdog
// always; random stalls, injected faults, poison, shuffled evaluation and waves if asked for.
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
  std::uint32_t stall_permille = 0;      // on both sides of every link, cycles of 1000
  std::uint64_t seed = 1;                // of the stalls
  std::optional<std::uint64_t> shuffle;  // evaluate units in random order, by this seed
  rtl::Cycle patience = 100'000;         // cycles without a beat until the watchdog ends the run
  bool check_links = true;               // protocol checkers on every link
  bool check_widths = false;             // and every field fits its width, beat by beat
  bool poison = false;                   // fields that nobody wrote hold noise, by the seed
  bool fast_path = true;
  std::vector<std::string> faults;  // see Fault::parse
  std::optional<rtl::TraceOptions> trace;
  // How far the run came and what to raise, for the error when the limit of cycles is reached.
  std::function<std::string()> at_limit;
};

class Bench {
 public:
  // ConfigError for faults on links and scopes of waves that do not exist.
  Bench(rtl::ClockDomain& clock, const BenchOptions& options = {});

  // Until `done`, at most `limit` cycles; OutOfCycles if it is not done by then. Then the links
  // must be empty (unless `drained` is false), the accounts right, and every injected fault
  // reached. Returns the cycles it took.
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
