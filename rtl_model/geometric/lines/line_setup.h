// SPDX-License-Identifier: MIT
// Function  Computes a line from a kept edge: axis, columns, slope, and position and depth at the
//           first column. Error bounds: docs/reference/geometric/algorithm.md.
// Position  After VertexFetch.
// Stalls    `divider` (no divider is free), `downstream`. All stages advance together; a line waits
//           for a divider before the quotient.
// Source    Paper 002, eqs (5), (6).
//
// Lines leave in order, since every line takes the same time from the divider on, including those
// that use the table.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/geometric/common/edge_latency.h"
#include "rtl_model/geometric/common/frame_configuration.h"
#include "rtl_model/geometric/common/tokens.h"

namespace deburr::rtl::geometric {

class LineSetup final : public Unit {
 public:
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  In<EdgeEnds> ends_in{"ends_in"};
  Out<LineToken> lines_out{"lines_out"};

  LineSetup(const sc_core::sc_module_name& name, ClockDomain& clock,
            const spec::geometric::Parameters& parameters, EdgeLatency& latency);
  Activity tick(Cycle cycle) override;
  void reset() override;

  std::function<void(const spec::geometric::LineRecord&)> observer;

  Counter outside_edges{"outside_edges", "edges", "kept edges with a vertex that is not usable"};
  Counter degenerate_edges{"degenerate_edges", "edges",
                           "kept edges with both ends at the same position"};
  Counter empty_edges{"empty_edges", "edges", "kept edges that cover no column of the frame"};
  Counter lines{"lines", "lines", "lines set up"};
  Counter table_lines{"table_lines", "lines", "lines whose reciprocal came from the table"};
  Counter divider_cycles{"divider_cycles", "clk", "busy cycles of all dividers"};

  static Datasheet datasheet(const spec::geometric::Parameters& parameters);

 private:
  static constexpr std::size_t kFront = 4, kBack = 18;  // stages before the quotient and from it on
  static constexpr std::uint64_t kDivideCycles = 13;

  struct Beat {
    EdgeEnds ends;
    bool dropped;
    bool in_table;
    bool minor_falls, depth_falls;
    std::uint8_t exponent;       // U5, floor(lb L)
    std::int32_t major0;         // S14.8
    std::int32_t minor0;         // S14.8
    std::uint32_t depth0;        // U24
    std::uint32_t length;        // U15.8, L
    std::uint32_t minor_extent;  // U15.8, |dm|
    std::uint32_t depth_extent;  // U24, D
    std::uint32_t normalised;    // U23, l
    std::uint32_t reciprocal;    // U1.26
    std::uint32_t slope;         // U1.24
    std::uint32_t offset;        // U15.8
    std::uint32_t share;         // U0.24, t
    spec::geometric::LineRecord line;
  };
  void find_axis(Cycle cycle, Beat& beat);
  void normalise(Cycle cycle, Beat& beat);
  void divide(Cycle cycle, Beat& beat) const;
  static void scale(Beat& beat);
  static void sum(Beat& beat);
  std::uint64_t* free_divider();
  void deliver(Cycle cycle, const Beat& beat);
  bool advance_front(Cycle cycle);

  EdgeLatency& latency_;  // measuring instrument
  const bool pipelined_;
  const std::uint32_t table_bits_;
  std::unique_ptr<Memory<std::uint32_t>> table_;  // nullptr: not built
  std::unique_ptr<ReadPort<std::uint32_t>> table_port_;
  Activity stalled_divider_;
  Pipe<Beat, kFront + 1> front_;  // its last stage is the first one of the quotient
  Pipe<Beat, kBack> back_;
  std::uint64_t moves_ = 0;                   // cycles in which the stages moved
  std::array<std::uint64_t, 8> free_from_{};  // of each divider, in moves
  const std::size_t dividers_;
};

}  // namespace deburr::rtl::geometric
