// SPDX-License-Identifier: MIT
// Packets inside the geometric engine in which golden model and RTL model are compared. Formats:
// docs/reference/geometric/algorithm.md.
#pragma once

#include <array>
#include <cstdint>
#include <iterator>

#include "spec/geometric/parameters.h"
#include "spec/geometric/records.h"
#include "spec/geometric/registers.h"

namespace deburr::spec::geometric {

using Rgba8 = std::array<std::uint8_t, 4>;    // R, G, B, A codes, U0.8 unorm
using Weights = std::array<std::uint8_t, 4>;  // U0.8, 0..128, by Direction

enum class Axis : std::uint8_t { kHorizontal, kVertical };  // major axis of a line

// A line for the walkers. Columns are along the major axis. `position` is the minor coordinate at
// the centre of column `first`, plus half a unit of 2^-16; `depth` is the depth there.
struct LineRecord {
  Axis axis = Axis::kHorizontal;
  bool tie_forward = false;     // a line through the centre of a pixel blends it down or right
  bool crease = false;          // its edge is of class crease
  std::uint16_t first = 0;      // column
  std::uint16_t count = 0;      // columns, 1..8192
  std::int64_t position = 0;    // S15.24 pixels
  std::int32_t slope = 0;       // S1.24 pixels per column
  std::int64_t depth = 0;       // S25.12
  std::int64_t depth_step = 0;  // S25.12 per column
  friend bool operator==(const LineRecord&, const LineRecord&) = default;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("axis", self.axis, 1, "0 horizontal, 1 vertical");
    visit("tie_forward", self.tie_forward);
    visit("crease", self.crease);
    visit("first", self.first, 13, "U13");
    visit("count", self.count, 14, "U14");
    visit("position", self.position, 40, "S15.24");
    visit("slope", self.slope, 26, "S1.24");
    visit("depth", self.depth, 38, "S25.12");
    visit("depth_step", self.depth_step, 38, "S25.12");
  }
};

// A pixel and the neighbour with which a line blends it. With coverage = area the second candidate
// of a column follows the first.
struct Candidate {
  std::uint16_t x = 0, y = 0;
  Direction direction = Direction::kUp;
  std::uint8_t coverage = 0;  // U0.8, 1..128
  std::uint32_t depth = 0;    // of the line, U24
  bool passed = false;        // passed the depth test
  friend bool operator==(const Candidate&, const Candidate&) = default;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("x", self.x, 13, "U13");
    visit("y", self.y, 13, "U13");
    visit("direction", self.direction, 2, "0 up, 1 down, 2 left, 3 right");
    visit("coverage", self.coverage, 8, "U0.8");
    visit("depth", self.depth, 24, "U24");
    visit("passed", self.passed);
  }
};

// A touched block of 4 x 4 pixels, as it is resolved. Pixels are in order of rows.
struct BlockRecord {
  std::uint16_t x = 0, y = 0;  // in blocks
  std::array<Weights, kBlockPixels> weights{};
  std::array<Rgba8, kBlockPixels> pixels{};  // zero for pixels without a bit in `blended`
  std::uint16_t blended = 0;                 // bit i: pixel i
  friend bool operator==(const BlockRecord&, const BlockRecord&) = default;
  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("x", self.x, 11, "U11");
    visit("y", self.y, 11, "U11");
    visit("weights", self.weights, 8, "U0.8", "udlr");
    visit("pixels", self.pixels, 8, "U0.8", "rgba");
    visit("blended", self.blended, 16, "bit i: pixel i of the block");
  }
};

// An access to a line of memory. Reads and writes of a region are compared separately, each in
// order.
struct MemoryAccess {
  std::uint32_t address = 0;  // bytes, multiple of kLineBytes
  bool write = false;
  friend bool operator==(const MemoryAccess&, const MemoryAccess&) = default;
};
enum class Region : std::uint8_t {
  kFaces,
  kEdges,
  kVertices,
  kDepth,
  kWeights,
  kColour,
  kCopy,
  kPairs,
  kCoarse
};
inline constexpr std::array<std::string_view, 9> kRegionNames = {
    "faces", "edges", "vertices", "depth", "weights", "colour", "copy", "pairs", "coarse"};

// Counts of the work of a frame; golden model and RTL model must agree.
struct Work {
  std::uint64_t edges = 0;
  std::uint64_t boundary_edges = 0;
  std::uint64_t silhouette_edges = 0;
  std::uint64_t back_edges = 0;
  std::uint64_t crease_edges = 0;
  std::uint64_t flat_edges = 0;
  std::uint64_t invalid_edges = 0;
  std::uint64_t kept_edges = 0;        // sum of the next four
  std::uint64_t outside_edges = 0;     // a vertex is not usable
  std::uint64_t degenerate_edges = 0;  // both ends at the same position
  std::uint64_t empty_edges = 0;       // no column in the frame
  std::uint64_t lines = 0;             // set up and walked
  std::uint64_t columns = 0;           // walked
  std::uint64_t groups = 0;            // cycles of the walkers; depends on their number
  std::uint64_t candidates = 0;        // pixels with a neighbour in the frame and coverage > 0
  std::uint64_t passed = 0;            // candidates that passed the depth test
  std::uint64_t blocks = 0;            // touched
  std::uint64_t blended_pixels = 0;
  friend bool operator==(const Work&, const Work&) = default;
};

// All counts of Work, and their registers.
struct WorkCount {
  std::uint64_t Work::*count;
  std::uint32_t offset;
};
inline constexpr WorkCount kWorkCounts[] = {{&Work::edges, reg::kEdges},
                                            {&Work::boundary_edges, reg::kBoundaryEdges},
                                            {&Work::silhouette_edges, reg::kSilhouetteEdges},
                                            {&Work::back_edges, reg::kBackEdges},
                                            {&Work::crease_edges, reg::kCreaseEdges},
                                            {&Work::flat_edges, reg::kFlatEdges},
                                            {&Work::invalid_edges, reg::kInvalidEdges},
                                            {&Work::kept_edges, reg::kKeptEdges},
                                            {&Work::outside_edges, reg::kOutsideEdges},
                                            {&Work::degenerate_edges, reg::kDegenerateEdges},
                                            {&Work::empty_edges, reg::kEmptyEdges},
                                            {&Work::lines, reg::kLines},
                                            {&Work::columns, reg::kColumns},
                                            {&Work::groups, reg::kGroups},
                                            {&Work::candidates, reg::kCandidates},
                                            {&Work::passed, reg::kPassed},
                                            {&Work::blocks, reg::kBlocks},
                                            {&Work::blended_pixels, reg::kBlendedPixels}};
static_assert(sizeof(Work) == std::size(kWorkCounts) * sizeof(std::uint64_t),
              "a count is not in the list");

}  // namespace deburr::spec::geometric
