// SPDX-License-Identifier: MIT
// Functional coverage of the geometric engine: the situations that occurred in the frames so far.
//
// The golden model counts, since it knows every edge, line, candidate and block. Bins:
//   class/<select>/<crease>/<class>    edges
//   turned-away/<cull>/<class>         edges between two back faces
//   line/<octant>/<length>             shorter than 1 pixel, shorter than 4 (within the reciprocal
//                                      table), longer
//   fate/<fate>                        kept edges that give no line
//   columns/<cut>                      lines cut by the frame: at the start, the end, both, none
//   rows/<crossing>                    lines that enter or leave the rows of the frame
//   tie/<kind>                         lines exactly through the centre of a pixel
//   border/<border>                    candidates whose neighbour is outside the frame
//   depth/<farther>/<outcome>          depth tests against the farther pixel
//   crease/<direction>/<limit>         crease candidates that passed the depth test
//   second/<direction>/<block>         second candidates: in the block of the first, or another
//   weight/<direction>/<outcome>       updates of a weight
//   group/<end>                        what ended a group of columns
//   fetch/<cache>/<outcome>            lookups of every cache, of pairs and of the write buffer
//   coarse/...                         coarse depth tests: dropped, kept at equality, two tiles
//   resolve/<decision>, original/<where>
//   lines/<layout>/<n>                 colour lines per block
// Every bin is reachable (tb/unit/golden/geometric/coverage_test.cpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "golden/geometric/line.h"
#include "golden/geometric/resolve.h"
#include "spec/geometric/packets.h"
#include "spec/geometric/parameters.h"
#include "spec/geometric/records.h"

namespace deburr::golden::geometric {

struct CoverageBin {
  std::string name;
  std::uint64_t hits = 0;
};

enum class GroupEnd : std::uint8_t { kLength, kAcross, kAlong, kLine };
enum class Fetch : std::uint8_t { kHit, kMiss, kReplaced, kReadBack };
enum class CacheKind : std::uint8_t { kVertex, kDepth, kBlock, kColour };
enum class PairFetch : std::uint8_t {
  kBoundaryHit,
  kBoundaryMiss,
  kOtherHit,
  kOtherMiss,
  kInvalidNumber,
  kInvalidVertex
};
enum class Buffered : std::uint8_t { kHit, kEmptyPlace, kLeaves, kEndFull, kEndPart };
enum class TwoTiles : std::uint8_t { kOwnLess, kOtherLess };
enum class Original : std::uint8_t { kNone, kAbove, kLeft };

class EdgeCoverage {
 public:
  void count_class(const spec::geometric::Configuration& configuration,
                   spec::geometric::EdgeClass c) {
    ++classes_[index(configuration.select)][index(configuration.crease)][index(c)];
  }
  void count_turned_away(spec::geometric::Cull cull, spec::geometric::EdgeClass c);
  void count_fate(LineFate fate) { ++fates_[index(fate)]; }
  // Counts octant, length and the ends that the frame cuts off, of the edge from p to q.
  void count_line(const spec::geometric::Vertex& p, const spec::geometric::Vertex& q, int width,
                  int height);
  void count_tie(const spec::geometric::LineRecord& line);
  void count_outside(spec::geometric::Direction direction) { ++borders_[index(direction)]; }
  void count_depth(std::uint32_t own, std::uint32_t other, bool passed);
  void count_crease(spec::geometric::Direction direction, bool near) {
    ++creases_[index(direction)][near ? 0 : 1];
  }
  void count_second(spec::geometric::Direction direction, bool other_block) {
    ++seconds_[index(direction)][other_block ? 1 : 0];
  }
  void count_weight(spec::geometric::Combine rule, bool nearer,
                    const spec::geometric::Weights& before, spec::geometric::Direction direction,
                    int coverage);
  void count_group(GroupEnd end) { ++groups_[index(end)]; }
  void count_fetch(CacheKind cache, Fetch outcome) { ++fetches_[index(cache)][index(outcome)]; }
  void count_pair(PairFetch outcome) { ++pairs_[index(outcome)]; }
  void count_buffered(Buffered outcome) { ++buffered_[index(outcome)]; }
  void count_dropped(spec::geometric::Direction direction) { ++dropped_[index(direction)]; }
  void count_coarse_equal() { ++coarse_equal_; }
  void count_two_tiles(TwoTiles which) { ++two_tiles_[index(which)]; }
  void count_probe(const spec::geometric::Weights& weights);
  void count_original(Original where) { ++originals_[index(where)]; }
  void count_block_lines(spec::geometric::Layout layout, std::size_t lines) {
    ++block_lines_[index(layout)][lines];
  }

  // All reachable bins, hit or not, always in the same order.
  std::vector<CoverageBin> bins() const;
  void merge(const EdgeCoverage& other);

  // Raster: four rows of the block, four of one side neighbour, one row above, one below.
  static constexpr std::size_t kMaxBlockLines = 10;
  static constexpr std::size_t kMaxTiledLines = 5;  // the line of the block and its four neighbours

 private:
  template <class Enum>
  static constexpr std::size_t index(Enum value) {
    return static_cast<std::size_t>(value);
  }
  using BinSink = std::function<void(std::string name, std::uint64_t hits)>;
  void for_each_bin(const BinSink& sink) const;
  template <class Visit>
  static void for_each_table(EdgeCoverage& a, const EdgeCoverage& b, Visit&& visit);

  std::array<std::array<std::array<std::uint64_t, 7>, 3>, 3> classes_{};
  std::array<std::uint64_t, 3> turned_away_{};
  std::array<std::array<std::uint64_t, 3>, 8> lines_{};
  std::array<std::uint64_t, 6> fates_{};
  std::array<std::uint64_t, 4> columns_{};
  std::array<std::uint64_t, 5> rows_{};
  std::array<std::uint64_t, 4> ties_{};
  std::array<std::uint64_t, 4> borders_{};
  std::array<std::array<std::uint64_t, 2>, 4> depths_{};
  std::array<std::array<std::uint64_t, 2>, 4> creases_{}, seconds_{};
  std::array<std::array<std::uint64_t, 6>, 4> weights_{};
  std::array<std::uint64_t, 4> groups_{};
  std::array<std::array<std::uint64_t, 4>, 4> fetches_{};
  std::array<std::uint64_t, 6> pairs_{};
  std::array<std::uint64_t, 5> buffered_{};
  std::array<std::uint64_t, 4> dropped_{};
  std::uint64_t coarse_equal_ = 0;
  std::array<std::uint64_t, 2> two_tiles_{};
  std::array<std::uint64_t, 3> probes_{};
  std::array<std::uint64_t, 3> originals_{};
  std::array<std::array<std::uint64_t, kMaxBlockLines + 1>, 2> block_lines_{};
};

}  // namespace deburr::golden::geometric
