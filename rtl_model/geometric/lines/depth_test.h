// SPDX-License-Identifier: MIT
// Function  Drops candidates that are hidden: behind the farther depth of their own pixel and of
//           the neighbour from which they would blend. Drops candidates of a crease if that farther
//           depth is far behind it. A group without passing candidates produces no output.
// Position  After the CoverageUnit or DepthScreen, with a small lookahead cache of depth lines.
// Stalls    `depth` (the line has not arrived), `fills` (no fill entry is free), `downstream`.
//
// Candidates dropped by the DepthScreen make no lookup and do not pass. A second candidate passes
// with the first of its column, since it uses the same depths. The lines of a group have different
// indices, so none replaces another.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/fifo.h"
#include "rtl_model/fabric/histogram.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/geometric/common/edge_latency.h"
#include "rtl_model/geometric/common/frame_configuration.h"
#include "rtl_model/geometric/common/line_cache.h"
#include "rtl_model/geometric/common/memory_arbiter.h"
#include "rtl_model/geometric/common/tokens.h"

namespace deburr::rtl::geometric {

class DepthTest final : public Unit {
 public:
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  WireIn<Phase> phase_in{"phase_in"};
  WireOut<bool> cleared_out{"cleared_out"};
  In<CandidateToken> candidates_in{"candidates_in"};
  Out<WeightToken> weights_out{"weights_out"};
  MemoryClient memory;

  DepthTest(const sc_core::sc_module_name& name, ClockDomain& clock,
            const spec::geometric::Parameters& parameters, EdgeLatency& latency);
  Activity tick(Cycle cycle) override;
  void reset() override;

  std::function<void(const spec::geometric::Candidate&)> observer;

  Counter passed{"passed", "pixels", "candidates that passed the depth test"};
  Counter lookups{"lookups", "lines", "lines of depth looked up"};
  Counter misses{"misses", "lines", "lookups that requested a line"};
  Histogram group_lines{"group_lines", "lines", "lines of depth per group"};

  static Datasheet datasheet(const spec::geometric::Parameters& parameters = {});

 private:
  // Per group: raster, vertical, four own lines and four of neighbours beyond a multiple of 16.
  static constexpr std::size_t kMostLines = 8;
  using DepthLine = std::array<std::uint32_t, spec::geometric::kPixelsInLine>;
  struct Lookup {
    CandidateToken group;
    std::uint8_t count;                           // U4, lines
    std::uint8_t missed;                          // bit i: line i
    std::array<std::uint16_t, kMostLines> index;  // U10
    Lanes8 own_line, own_word;                    // U3, U4: position of a lane's depths
    Lanes8 other_line, other_word;
    template <class Self, class Visit>
    static constexpr void fields(Self& self, Visit&& visit) {
      visit("group", self.group);
      visit("count", self.count, 4, "U4");
      visit("missed", self.missed, kMostLines, "bit i: line i");
      visit("index", self.index, 10, "U10");
      visit.lanes("own_line", self.own_line, 3, "U3");
      visit.lanes("own_word", self.own_word, 4, "U4");
      visit.lanes("other_line", self.other_line, 3, "U3");
      visit.lanes("other_word", self.other_word, 4, "U4");
    }
  };
  // Coordinates of a memory line.
  struct Place {
    std::uint16_t u, v;  // U11, U13
    friend bool operator==(const Place&, const Place&) = default;
  };
  struct Wanted {
    Lookup lookup;
    std::array<Place, kMostLines> line;
  };
  struct Work {
    Lookup lookup;
    Lanes32 own, other;            // U24
    Lanes32 far;                   // U24, farther depth; the line must not be behind it
    std::uint8_t nearer, farther;  // bit k: the pixel compared with its neighbour
  };

  void find_lines(Cycle cycle, const CandidateToken& group, Wanted& out) const;
  std::uint8_t add_line(Wanted& wanted, Place line, bool tiled) const;
  void read_tags(Cycle cycle);
  Activity look_up(Cycle cycle);
  Activity look_up_pair(Cycle cycle);
  void capture(Cycle cycle, Work& work, std::size_t which, const DepthLine& line) const;
  void capture_words(Cycle cycle);
  Activity deliver(Cycle cycle);
  void compare(Cycle cycle, Work& work) const;
  void test(Cycle cycle, const Work& work);
  void show(const CandidateToken& group, std::size_t lane, bool passes) const;

  EdgeLatency& latency_;  // measuring instrument
  const std::uint32_t index_bits_;
  LineCache<DepthLine> cache_;  // lookups of even and of odd lines of a group
  Fifo<Lookup> fifo_;

  // Stages 2 and 3.
  Wanted addressed_{}, looking_{};
  bool has_addressed_ = false, is_looking_ = false;
  std::size_t pair_ = 0;  // U3, first line of the pair being looked up
  // Stages 4 to 7.
  Work work_{};
  bool working_ = false;
  std::size_t step_ = 0;          // U4, first line of the pair being installed and read
  std::uint8_t reading_ = 0;      // bit k: port k has a word
  std::size_t reading_step_ = 0;  // the pair of these words
  bool reading_last_ = false;     // of the group in stage 5, otherwise in stage 4
  Pipe<Work, 4> pipe_;
};

}  // namespace deburr::rtl::geometric
