// SPDX-License-Identifier: MIT
// Function  Fetches both vertices of each kept edge through a small lookahead cache. A missed
//           vertex is taken from the arriving line.
// Position  After the EdgeClassifier.
// Stalls    `vertices` (the line has not arrived), `fills` (no fill entry is free), `downstream`.
#pragma once

#include <array>
#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/fifo.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/geometric/common/frame_configuration.h"
#include "rtl_model/geometric/common/line_cache.h"
#include "rtl_model/geometric/common/memory_arbiter.h"
#include "rtl_model/geometric/common/tokens.h"

namespace deburr::rtl::geometric {

class VertexFetch final : public Unit {
 public:
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  WireIn<Phase> phase_in{"phase_in"};
  WireOut<bool> cleared_out{"cleared_out"};
  In<KeptEdge> edges_in{"edges_in"};
  Out<EdgeEnds> ends_out{"ends_out"};
  MemoryClient memory;

  VertexFetch(const sc_core::sc_module_name& name, ClockDomain& clock,
              const spec::geometric::Parameters& parameters);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter lookups{"lookups", "lines", "lines of vertices looked up"};
  Counter misses{"misses", "lines", "lookups that requested a line"};

  static Datasheet datasheet(const spec::geometric::Parameters& parameters = {});

 private:
  using VertexLine = std::array<VertexFields, spec::geometric::kVerticesInLine>;
  struct Lookup {
    std::array<std::uint16_t, 2> index;  // U10
    std::array<std::uint8_t, 2> place;   // U2, of the vertex in its line
    std::uint8_t missed;                 // bit k: lookup k
    bool one_line;                       // both lookups use the same line
    bool crease;                         // class of the edge
    bool end;
    template <class Self, class Visit>
    static constexpr void fields(Self& self, Visit&& visit) {
      visit("index", self.index, 10, "U10");
      visit("place", self.place, 2, "U2");
      visit("missed", self.missed, 2, "bit k: lookup k");
      visit("one_line", self.one_line);
      visit("crease", self.crease);
      visit("end", self.end);
    }
  };
  struct Work {
    Lookup lookup;
    EdgeEnds ends;
    std::uint8_t from_cache;  // bit k: the word of lookup k comes from the cache data
  };

  Activity look_up(Cycle cycle);
  Activity deliver(Cycle cycle);
  static void take(Work& work, std::size_t which, const VertexLine& line);

  LineCache<VertexLine> cache_;  // lookups of v0 and of v1
  Fifo<Lookup> fifo_;

  // Stage 2.
  std::array<std::uint32_t, 2> line_{};
  Lookup lookup_{};
  bool looking_ = false;
  // Stages 3 to 5.
  Work work_{};
  bool working_ = false;
  Pipe<Work, 3> pipe_;
};

}  // namespace deburr::rtl::geometric
