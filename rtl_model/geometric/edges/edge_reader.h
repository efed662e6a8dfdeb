// SPDX-License-Identifier: MIT
// Reads the edge table ahead and hands its records on, edge_lanes a clock. With records = split
// these are faces and flags, ten a line, and no beat goes beyond a line's end.
//
// Where: head of the pipe. Lines are asked for as soon as a frame begins, and each has its place in
// edge_buffer before; edges go out once the begin is over. Stalls: `facing` (the begin is not
// over), `edges` (the next line has not come), `downstream`. After the last record comes the
// frame's end.
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/geometric/common/edge_latency.h"
#include "rtl_model/geometric/common/fill_store.h"
#include "rtl_model/geometric/common/frame_configuration.h"
#include "rtl_model/geometric/common/memory_arbiter.h"
#include "rtl_model/geometric/common/tokens.h"

namespace deburr::rtl::geometric {

class EdgeReader final : public Unit {
 public:
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  WireIn<Phase> phase_in{"phase_in"};
  MemoryClient memory;
  Out<EdgeBeat> edges_out{"edges_out"};

  EdgeReader(const sc_core::sc_module_name& name, ClockDomain& clock,
             const spec::geometric::Parameters& parameters, EdgeLatency& latency);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter lines_read{"lines_read", "lines", "lines of the edge table read"};

  static Datasheet datasheet();

 private:
  bool ask(Cycle cycle);
  Activity hand_on(Cycle cycle);
  void decode(const Line& line, std::size_t place, EdgeFields& edge) const;
  void begin();

  EdgeLatency& latency_;  // an instrument
  const bool split_;
  const std::uint32_t in_line_, lanes_;  // edges of a line and of a beat, at most
  FillStore<Line> buffer_;
  Activity stalled_facing_, stalled_edges_;
  std::uint32_t asked_ = 0;        // U23, lines
  std::uint32_t asked_edges_ = 0;  // U25, of these
  std::uint32_t handed_ = 0;       // U25, edges
  std::uint32_t place_ = 0;        // U4, of the next one in its line
  bool ended_ = false;
};

}  // namespace deburr::rtl::geometric
