// SPDX-License-Identifier: MIT
// The interface through which a design presents its observable parts: units, counters, links and
// memory ports. Each has the name that it has in the results. Environment::show_parts() lists the
// parts, once for all observers.
#pragma once

#include <string>
#include <vector>

#include "rtl_model/fabric/counters.h"
#include "rtl_model/fabric/link.h"
#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/fabric/unit.h"

namespace deburr::tb {

// A rate to plot: increments of a counter per cycle.
struct ThroughputSeries {
  std::string label, counter, unit;  // counter: its name; unit: of the rate
  double bound = 0;                  // upper bound per cycle; 0: none
};

class Observer {
 public:
  virtual ~Observer() = default;
  // `activities`: result key for each activity code: "busy", "idle" or "stalls.CAUSE".
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
