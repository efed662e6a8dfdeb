// SPDX-License-Identifier: MIT
// Fetches the vertices of each edge that is to be kept, where the edge table has them in arrays of
// their own (records = split), and drops an edge whose vertices are out of range.
//
// Where: between EdgeClassifier and VertexFetch. It looks ahead as a cache does, with a place for a
// line of each array: boundaries, and other edges. Numbers of either only grow, so a line is read
// once. Stalls: `pairs` (the line has not come), `fills` (no place for one), `downstream`. A
// dropped edge leaves nothing. Source: docs/reference/geometric/memory.md.
#pragma once

#include <array>
#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/fifo.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/geometric/common/edge_latency.h"
#include "rtl_model/geometric/common/frame_configuration.h"
#include "rtl_model/geometric/common/line_cache.h"
#include "rtl_model/geometric/common/memory_arbiter.h"
#include "rtl_model/geometric/common/tokens.h"

namespace deburr::rtl::geometric {

class PairFetch final : public Unit {
 public:
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  WireIn<Phase> phase_in{"phase_in"};
  In<PairNumber> numbers_in{"numbers_in"};
  Out<KeptEdge> edges_out{"edges_out"};
  // A vertex is out of range.
  PulseOut invalid_pair_out{"invalid_pair_out"};
  MemoryClient memory;

  PairFetch(const sc_core::sc_module_name& name, ClockDomain& clock,
            const spec::geometric::Parameters& parameters, EdgeLatency& latency);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter lookups{"lookups", "edges", "edges whose pair was looked up"};
  Counter boundary_lookups{"boundary_lookups", "edges", "of these boundaries"};
  Counter lines_read{"lines_read", "lines", "lines of pairs read"};
  Counter boundary_lines{"boundary_lines", "lines", "of these of boundaries"};
  Counter invalid_edges{"invalid_edges", "edges", "edges with a vertex out of range"};
  Counter kept_edges{"kept_edges", "edges", "edges whose vertices are fetched"};

  static Datasheet datasheet();

 private:
  using PairLine = std::array<std::uint64_t, spec::geometric::kSplitInLine>;  // U48: v0, v1
  struct Lookup {
    std::uint8_t place;  // U4
    bool other;
    bool missed;
    bool crease;
    bool invalid;
    bool end;
    template <class Self, class Visit>
    static constexpr void fields(Self& self, Visit&& visit) {
      visit("place", self.place, 4, "U4");
      visit("other", self.other);
      visit("missed", self.missed);
      visit("crease", self.crease);
      visit("invalid", self.invalid);
      visit("end", self.end);
    }
  };

  Activity look_up(Cycle cycle);
  Activity deliver(Cycle cycle);

  EdgeLatency& latency_;       // an instrument
  LineCache<PairLine> cache_;  // a line of each array, boundaries first
  Fifo<Lookup> fifo_;

  // Stages 2 and 3.
  struct Work {
    KeptEdge edge;
    bool invalid;  // it has no pair
  };
  Pipe<Work, 2> pipe_;
};

}  // namespace deburr::rtl::geometric
