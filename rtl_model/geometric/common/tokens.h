// SPDX-License-Identifier: MIT
// Tokens between the units of the geometric engine: one struct per link, with field widths, and the
// type of the phase wire. Unused lanes of a token hold old data. The last token of a frame is
// followed by one with only `end` set.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string>

#include "rtl_model/fabric/payload.h"
#include "spec/geometric/packets.h"
#include "spec/geometric/parameters.h"
#include "spec/geometric/records.h"

namespace deburr::rtl::geometric {

inline constexpr std::size_t kLanes = spec::geometric::kMaxLanes;
using Lanes8 = std::array<std::uint8_t, kLanes>;
using Lanes32 = std::array<std::uint32_t, kLanes>;

// FrameSequencer -> units: the phase of the current frame.
enum class Phase : std::uint8_t { kIdle, kBegin, kEdges, kResolve };
inline PayloadShape phase_shape() { return {.widths = {{"value", 2}}}; }

struct EdgeFields {
  std::uint32_t v0, v1, f0, f1;  // U24
  std::uint8_t flags;            // spec::geometric::flag
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("v0", self.v0, 24, "U24");
    visit("v1", self.v1, 24, "U24");
    visit("f0", self.f0, 24, "U24");
    visit("f1", self.f1, 24, "U24");
    visit("flags", self.flags, 4, "boundary, angle, split normals, seam");
  }
};

// EdgeReader -> EdgeClassifier. Without vertices if these are in separate arrays.
struct EdgeBeat {
  std::array<EdgeFields, kLanes> edge;
  std::uint8_t count;  // U3, 1..lanes
  bool end;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit.lanes("edge", self.edge);
    visit("count", self.count, 3, "U3");
    visit("end", self.end);
  }
};

// The part of an edge beat that is built.
inline PayloadShape edge_beat_shape(const spec::geometric::Parameters& p) {
  PayloadShape shape{.lanes = spec::geometric::kLaneCount[static_cast<std::size_t>(p.edge_lanes)]};
  if (p.records != spec::geometric::RecordsLayout::kSplit) return shape;
  for (std::uint32_t lane = 0; lane < shape.lanes; ++lane) {
    const std::string edge = "edge." + std::to_string(lane) + ".";
    for (const char* const vertex : {"v0", "v1"}) shape.widths.emplace_back(edge + vertex, 0);
    for (const char* const face : {"f0", "f1"})
      shape.widths.emplace_back(edge + face, spec::geometric::kSplitFaceBits);
  }
  return shape;
}

// EdgeClassifier -> PairFetch, with records = split: position of an edge's vertices.
struct PairNumber {
  std::uint32_t line;  // U21, memory line in its array
  std::uint8_t place;  // U4, 0..9, position in the line
  bool other;          // array of edges that are not boundaries
  bool crease;         // class of the edge
  bool invalid;        // has no vertex pair; PairFetch drops it
  bool end;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("line", self.line, 21, "U21");
    visit("place", self.place, 4, "U4");
    visit("other", self.other);
    visit("crease", self.crease);
    visit("invalid", self.invalid);
    visit("end", self.end);
  }
};

// EdgeClassifier or PairFetch -> VertexFetch.
struct KeptEdge {
  std::uint32_t v0, v1;  // U24
  bool crease;           // class of the edge
  bool end;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("v0", self.v0, 24, "U24");
    visit("v1", self.v1, 24, "U24");
    visit("crease", self.crease);
    visit("end", self.end);
  }
};

// A vertex in the engine. Unusable if outside the guard band.
struct VertexFields {
  std::int32_t x = 0, y = 0;  // S14.8
  std::uint32_t depth = 0;    // U24
  bool usable = false;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("x", self.x, 23, "S14.8");
    visit("y", self.y, 23, "S14.8");
    visit("depth", self.depth, 24, "U24");
    visit("usable", self.usable);
  }
};

// VertexFetch -> LineSetup.
struct EdgeEnds {
  std::array<VertexFields, 2> vertex;
  bool crease;  // class of the edge
  bool end;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("vertex", self.vertex);
    visit("crease", self.crease);
    visit("end", self.end);
  }
};

// LineSetup -> LineWalker.
struct LineToken {
  spec::geometric::LineRecord line;
  bool end;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("line", self.line);
    visit("end", self.end);
  }
};

// LineWalker -> CoverageUnit: columns of a line in one block.
struct GroupToken {
  bool vertical;
  bool tie_forward;
  bool crease;                                // class of the edge
  std::uint16_t column;                       // U13, of lane 0
  std::uint8_t count;                         // U3, 1..lanes
  std::array<std::int32_t, kLanes> position;  // S15.16: row and fraction
  std::int32_t slope;                         // S1.24
  std::int64_t depth;                         // S25.12, of lane 0
  std::int64_t step;                          // S25.12 per lane
  bool end;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("vertical", self.vertical);
    visit("tie_forward", self.tie_forward);
    visit("crease", self.crease);
    visit("column", self.column, 13, "U13");
    visit("count", self.count, 3, "U3");
    visit.lanes("position", self.position, 32, "S15.16");
    visit("slope", self.slope, 26, "S1.24");
    visit("depth", self.depth, 38, "S25.12");
    visit("step", self.step, 38, "S25.12");
    visit("end", self.end);
  }
};

// CoverageUnit -> DepthScreen (if built) -> DepthTest: candidates in one block of 4 x 4 pixels, one
// column per lane. The second candidate of a column is the neighbour of the first and blends from
// it; it may be in the next block across the line.
struct CandidateToken {
  std::uint16_t block_x, block_y;  // U11
  bool vertical;                   // neighbours are left or right, else above or below
  bool crease;                     // class of the line's edge
  std::uint8_t candidates;         // bit k: lane k has a candidate
  std::uint8_t forward;            // bit k: its neighbour is below or right
  std::uint8_t seconds;            // bit k: lane k has a second candidate
  std::uint8_t dropped;            // bit k: DepthScreen found lane k hidden
  Lanes8 place;                    // U4, 4 y + x in the block
  Lanes8 coverage;                 // U0.8, 1..128
  Lanes8 second;                   // U0.8, 1..128, coverage of the second candidate
  Lanes32 depth;                   // U24, of the line
  bool end;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("block_x", self.block_x, 11, "U11");
    visit("block_y", self.block_y, 11, "U11");
    visit("vertical", self.vertical);
    visit("crease", self.crease);
    visit.lane_bits("candidates", self.candidates, kLanes);
    visit.lane_bits("forward", self.forward, kLanes);
    visit.lane_bits("seconds", self.seconds, kLanes);
    visit.lane_bits("dropped", self.dropped, kLanes);
    visit.lanes("place", self.place, 4, "U4");
    visit.lanes("coverage", self.coverage, 8, "U0.8");
    visit.lanes("second", self.second, 8, "U0.8");
    visit.lanes("depth", self.depth, 24, "U24");
    visit("end", self.end);
  }
};

// The part of a candidate token that is built, also for a token that contains candidates under the
// name `within`: `dropped` exists only after a DepthScreen.
inline PayloadShape candidates_shape(const spec::geometric::Parameters& p, bool screened,
                                     const std::string& within = "") {
  PayloadShape shape{.lanes = spec::geometric::kLaneCount[static_cast<std::size_t>(p.walkers)]};
  if (!screened) shape.widths.emplace_back(within + "dropped", 0);
  return shape;
}

// Number of candidates of a group, including second ones.
inline std::uint64_t count_of(std::uint8_t candidates, std::uint8_t seconds) {
  return static_cast<std::uint64_t>(std::popcount(std::uint32_t{seconds} << 8 | candidates));
}

struct WeightToken {
  std::uint16_t block_x, block_y;  // U11
  bool vertical;
  std::uint8_t candidates;  // that passed
  std::uint8_t forward;
  std::uint8_t seconds;  // of these
  std::uint8_t nearer;   // bit k: the pixel is nearer than its neighbour
  std::uint8_t farther;  // bit k: it is farther, so the second candidate is nearer
  Lanes8 place;          // U4
  Lanes8 coverage;       // U0.8
  Lanes8 second;         // U0.8
  bool end;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("block_x", self.block_x, 11, "U11");
    visit("block_y", self.block_y, 11, "U11");
    visit("vertical", self.vertical);
    visit.lane_bits("candidates", self.candidates, kLanes);
    visit.lane_bits("forward", self.forward, kLanes);
    visit.lane_bits("seconds", self.seconds, kLanes);
    visit.lane_bits("nearer", self.nearer, kLanes);
    visit.lane_bits("farther", self.farther, kLanes);
    visit.lanes("place", self.place, 4, "U4");
    visit.lanes("coverage", self.coverage, 8, "U0.8");
    visit.lanes("second", self.second, 8, "U0.8");
    visit("end", self.end);
  }
};

// BlockScanner -> BlockFetch.
struct TouchedBlock {
  std::uint16_t x, y;  // U11
  bool above;          // the block above is touched as well
  bool end;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("x", self.x, 11, "U11");
    visit("y", self.y, 11, "U11");
    visit("above", self.above);
    visit("end", self.end);
  }
};

using BlockWeights = std::array<spec::geometric::Weights, spec::geometric::kBlockPixels>;

// BlockFetch -> Resolver. `lines`: memory lines read for the block, bit 3 i + j. Tiled: block (x -
// 1 + j, y - 1 + i); raster: row 4 y - 1 + i, sixteen pixels at x / 4 - 1 + j.
struct BlockToken {
  std::uint16_t x, y;  // U11
  bool above;
  BlockWeights weights;
  std::uint16_t blended;     // bit i: pixel i
  std::uint16_t horizontal;  // bit i: pixel i blends from left and right
  std::uint32_t lines;       // U18
  bool end;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("x", self.x, 11, "U11");
    visit("y", self.y, 11, "U11");
    visit("above", self.above);
    visit("weights", self.weights, 8, "U0.8", "udlr");
    visit("blended", self.blended, 16, "bit i: pixel i");
    visit("horizontal", self.horizontal, 16, "bit i: pixel i");
    visit("lines", self.lines, 18, "bit 3 i + j");
    visit("end", self.end);
  }
};

// A six-byte record from a line that holds ten.
template <class Line>
std::uint64_t split_record_of(const Line& line, std::size_t place) {
  const std::size_t first = place * spec::geometric::kSplitBytes;
  std::uint64_t record = 0;
  for (std::size_t i = 0; i < spec::geometric::kSplitBytes; ++i)
    record |= std::uint64_t{line[first + i]} << 8 * i;
  return record;
}

// Little-endian word of a memory line.
template <class Line>
std::uint32_t word_of(const Line& line, std::size_t word) {
  return static_cast<std::uint32_t>(line[4 * word]) |
         static_cast<std::uint32_t>(line[4 * word + 1]) << 8 |
         static_cast<std::uint32_t>(line[4 * word + 2]) << 16 |
         static_cast<std::uint32_t>(line[4 * word + 3]) << 24;
}

}  // namespace deburr::rtl::geometric
