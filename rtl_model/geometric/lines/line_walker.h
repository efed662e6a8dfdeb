// SPDX-License-Identifier: MIT
// Steps along a line, a group of columns a clock: as many of the next ones, `walkers` at most, as
// have their pixels in one block of 4 x 4.
//
// Where: after the line FIFO. Stalls: `downstream`.
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
  Counter groups{"groups", "groups", "cycles in which the walkers step"};
  Histogram line_columns{"line_columns", "columns", "columns of a line"};

  static Datasheet datasheet();

 private:
  EdgeLatency& latency_;  // an instrument
  const std::uint32_t walkers_;
  spec::geometric::LineRecord line_;  // the rest of it: its next column, position and depth
};

}  // namespace deburr::rtl::geometric
