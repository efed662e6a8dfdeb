// SPDX-License-Identifier: MIT
// Function  Drops candidates behind a lower bound of the depths of their tile of 8 x 8 pixels,
//           before they look up the depth (coarse_lines). Every group is forwarded with a bit for
//           each dropped candidate, so the order is kept for DepthTest.
// Position  Between CoverageUnit and DepthTest, with a small lookahead cache of coarse lines.
// Stalls    `coarse` (the line has not arrived), `fills` (no fill entry is free), `downstream`.
// Source    docs/reference/geometric/memory.md.
//
// A group lies in one tile, and so do its neighbours.
#pragma once

#include <array>
#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/fifo.h"
#include "rtl_model/fabric/histogram.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/geometric/common/frame_configuration.h"
#include "rtl_model/geometric/common/line_cache.h"
#include "rtl_model/geometric/common/memory_arbiter.h"
#include "rtl_model/geometric/common/tokens.h"

namespace deburr::rtl::geometric {

class DepthScreen final : public Unit {
 public:
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  WireIn<Phase> phase_in{"phase_in"};
  In<CandidateToken> candidates_in{"candidates_in"};
  Out<CandidateToken> screened_out{"screened_out"};
  MemoryClient memory;

  DepthScreen(const sc_core::sc_module_name& name, ClockDomain& clock,
              const spec::geometric::Parameters& parameters);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter groups{"groups", "groups", "groups whose tiles were looked up"};
  Counter lookups{"lookups", "lines", "lines of coarse depth looked up"};
  Counter misses{"misses", "lines", "lookups that requested a line"};
  Counter both_missed{"both_missed", "groups", "groups with two lookups that requested a line"};
  Counter dropped{"dropped", "pixels", "candidates that were dropped"};
  Counter kept_at_bound{"kept_at_bound", "pixels",
                        "first candidates exactly at the bound, which are kept"};
  Histogram dropped_sides{"dropped_sides", "side",
                          "dropped first candidates by the side of their neighbour: up, "
                          "down, left, right"};
  Histogram lesser_tiles{"lesser_tiles", "tile",
                         "first candidates with a neighbour in another tile, by the smaller bound: "
                         "own tile, other tile, equal"};

  static Datasheet datasheet(const spec::geometric::Parameters& parameters = {});

 private:
  static constexpr std::size_t kInLine =
      std::size_t{spec::geometric::kCoarseAcross} * spec::geometric::kCoarseDown;
  using CoarseLine = std::array<std::uint16_t, kInLine>;
  struct Lookup {
    CandidateToken group;
    std::array<std::uint8_t, 2> index;  // U6: of the own line, of the neighbours' line
    std::array<std::uint8_t, 2> tile;   // U5, in the line
    std::uint8_t missed;                // bit k: lookup k
    bool looks;                         // false: no lookup
    bool two_lines;                     // the two lookups use different lines
    std::uint8_t crossing;              // bit k: the neighbour of lane k is in the other tile
    template <class Self, class Visit>
    static constexpr void fields(Self& self, Visit&& visit) {
      visit("group", self.group);
      visit("index", self.index, 6, "U6");
      visit("tile", self.tile, 5, "U5");
      visit("missed", self.missed, 2, "bit k: lookup k");
      visit("looks", self.looks);
      visit("two_lines", self.two_lines);
      visit.lane_bits("crossing", self.crossing, kLanes);
    }
  };
  // Coordinates of a memory line.
  struct Place {
    std::uint16_t u = 0, v = 0;  // U7, U8
    friend bool operator==(const Place&, const Place&) = default;
  };
  struct Work {
    Lookup lookup;
    std::array<std::uint16_t, 2> bound;  // entries of both tiles
    std::uint16_t lesser;                // the smaller bound
    std::uint8_t from_cache;             // bit k: the word of lookup k comes from the cache data
  };

  void find_tiles(Cycle cycle, const CandidateToken& group);
  Activity look_up(Cycle cycle);
  Activity deliver(Cycle cycle);
  void take(Work& work, std::size_t which, const CoarseLine& line) const;
  void screen(Cycle cycle, Work& work);

  LineCache<CoarseLine> cache_;  // lookups of the own line and of the neighbours' line
  const std::uint32_t index_bits_;
  Fifo<Lookup> fifo_;

  // Stage 2.
  Lookup lookup_{};
  std::array<Place, 2> line_{};
  bool looking_ = false;
  // Stages 3 to 5.
  Work work_{};
  bool working_ = false;
  Pipe<Work, 3> pipe_;
};

}  // namespace deburr::rtl::geometric
