// SPDX-License-Identifier: MIT
// What a design shows to whoever watches it run: its units, counters, links and memory ports, each
// under the name that results know it by. An environment lists them once
// (Environment::show_parts()), for all who watch.
#pragma once

#include <string>
#include <vector>

#include "rtl_model/fabric/counters.h"
#include "rtl_model/fabric/link.h"
#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/fabric/unit.h"

namespace deburr::tb {

// A rate that a reader looks at: what a counter counts, over cycles.
struct ThroughputSeries {
  std::string label, counter, unit;  // counter: its name; unit: of the rate
  double bound = 0;                  // a clock; 0: no such bound
};

class Observer {
 public:
  virtual ~Observer() = default;
  // `activities`: by activity code, what results count such a cycle as: "busy", "idle" or
  // "stalls.CAUSE".
  virtual void see(const std::string& /*name*/, const rtl::Unit&,
                   const std::vector<std::string>& /*activities*/) {}
  virtual void see(const std::string& /*name*/, const rtl::Counter&) {}
  virtual void see(const std::string& /*name*/, const rtl::LinkBase&) {}
  virtual void see(const std::string& /*name*/, const rtl::MemoryPort&) {}
  virtual void see(const ThroughputSeries&) {}

 protected:
  Observer() = default;
  Observer(const Observer&) = default;
  Observer& operator=(const Observer&) = default;
};

}  // namespace deburr::tb
