// SPDX-License-Identifier: MIT
// Steps along a line, a group of columns a clock: as many of the next ones, `walkers` at most, as
// have their pixels in one block of 4 x 4.
//
// Where: behind the line FIFO. Latency 1, a group a clock, over the ends of lines too. Stalls:
// `downstream`. Cost: 9 adds of 40 bits (position + k slope, the next position), 5 of 38 (the next
// depth), 3 compares of 14 bits, a 5 : 1 choice. Made for 250 MHz; longest path: 2 : 1 choice,
// 40-bit add + 13-bit compare + 5 : 1 choice.
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/histogram.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/geometric/edge_latency.h"
#include "rtl_model/geometric/tokens.h"

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
  Counter groups{"groups", "groups", "clocks in which the walkers stepped"};
  Histogram line_columns{"line_columns", "columns", "columns of a line"};

 private:
  EdgeLatency& latency_;  // an instrument
  const std::uint32_t walkers_;
  spec::geometric::LineRecord line_;  // the rest of it: its next column, position and depth
};

}  // namespace deburr::rtl::geometric
