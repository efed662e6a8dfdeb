// SPDX-License-Identifier: MIT
// Function  Fetches the vertex indices of each edge to be kept where they are in separate arrays
//           (records = split), and drops edges whose vertices are out of range.
// Position  Between EdgeClassifier and VertexFetch.
// Stalls    `pairs` (the line has not arrived), `fills` (no fill entry is free), `downstream`. A
//           dropped edge produces no output.
// Source    docs/reference/geometric/memory.md.
//
// A lookahead cache with one line per array: boundaries, and other edges. The numbers in each array
// only increase, so a line is read once.
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
  // Raised when a vertex is out of range.
  PulseOut invalid_pair_out{"invalid_pair_out"};
  MemoryClient memory;

  PairFetch(const sc_core::sc_module_name& name, ClockDomain& clock,
            const spec::geometric::Parameters& parameters, EdgeLatency& latency);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter lookups{"lookups", "edges", "edges whose pair was looked up"};
  Counter boundary_lookups{"boundary_lookups", "edges", "boundary edges whose pair was looked up"};
  Counter lines_read{"lines_read", "lines", "lines of pairs read"};
  Counter boundary_lines{"boundary_lines", "lines", "lines of boundary pairs read"};
  Counter invalid_edges{"invalid_edges", "edges", "edges with a vertex out of range"};
  Counter kept_edges{"kept_edges", "edges", "edges whose vertices are fetched"};

  static Datasheet datasheet(const spec::geometric::Parameters& parameters = {});

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

  EdgeLatency& latency_;       // measuring instrument
  LineCache<PairLine> cache_;  // one line per array, boundaries first
  Fifo<Lookup> fifo_;

  // Stages 2 and 3.
  struct Work {
    KeptEdge edge;
    bool invalid;  // without a vertex pair
  };
  Pipe<Work, 2> pipe_;
};

}  // namespace deburr::rtl::geometric
