// SPDX-License-Identifier: MIT
// Function  Steps along a line, one group of columns per cycle: the next columns, at most
//           `walkers`, whose pixels are in the same block of 4 x 4.
// Position  After the line FIFO.
// Stalls    `downstream`.
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/histogram.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/geometric/common/edge_latency.h"
#include "rtl_model/geometric/common/tokens.h"

namespace deburr::rtl::geometric {

class LineWalker final : public Unit {
 public:
  In<LineToken> lines_in{"lines_in"};
  Out<GroupToken> groups_out{"groups_out"};

  LineWalker(const sc_core::sc_module_name& name, ClockDomain& clock,
             const spec::geometric::Parameters& parameters, EdgeLatency& latency)
      : Unit(name, clock),
        latency_(latency),
        walkers_(spec::geometric::kLaneCount[static_cast<std::size_t>(parameters.walkers)]) {}
  Activity tick(Cycle cycle) override;
  void reset() override { line_.count = 0; }

  Counter columns{"columns", "columns", "columns walked"};
  Counter groups{"groups", "groups", "cycles in which the walkers stepped"};
  Histogram line_columns{"line_columns", "columns", "columns per line"};

  static Datasheet datasheet(const spec::geometric::Parameters& parameters = {});

 private:
  EdgeLatency& latency_;  // measuring instrument
  const std::uint32_t walkers_;
  spec::geometric::LineRecord line_;  // the remainder of the line: next column, position and depth
};

}  // namespace deburr::rtl::geometric
