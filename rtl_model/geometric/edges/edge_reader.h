// SPDX-License-Identifier: MIT
// Function  Prefetches the edge table and forwards its records, edge_lanes per cycle. With records
//           = split the records hold faces and flags, ten per line, and a beat does not cross the
//           end of a line. The last record is followed by the end token.
// Position  Start of the pipeline. Requests begin with the frame, each with a reserved entry of
//           edge_buffer; edges leave after the begin phase.
// Stalls    `facing` (begin phase not finished), `edges` (the next line has not arrived),
//           `downstream`.
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

  static Datasheet datasheet(const spec::geometric::Parameters& parameters = {});

 private:
  bool ask(Cycle cycle);
  Activity hand_on(Cycle cycle);
  void decode(const Line& line, std::size_t place, EdgeFields& edge) const;
  void begin();

  EdgeLatency& latency_;  // measuring instrument
  const bool split_;
  const std::uint32_t in_line_, lanes_;  // most edges per line and per beat
  FillStore<Line> buffer_;
  Activity stalled_facing_, stalled_edges_;
  std::uint32_t asked_ = 0;        // U23, requested lines
  std::uint32_t asked_edges_ = 0;  // U25, edges in them
  std::uint32_t handed_ = 0;       // U25, forwarded edges
  std::uint32_t place_ = 0;        // U4, position of the next edge in its line
  bool ended_ = false;
};

}  // namespace deburr::rtl::geometric
