// SPDX-License-Identifier: MIT
// The bounds of a frame's cycles, as docs/reference/geometric/hardware.md has them.
#pragma once

#include <bit>
#include <map>
#include <utility>

#include "spec/geometric/tables.h"
#include "tb/unit/rtl/geometric/support.h"

namespace deburr::tb::geometric_rtl {

using spec::geometric::CacheLines;
using spec::geometric::Edge;
using spec::geometric::Lanes;
namespace flag = spec::geometric::flag;

// The bounds of the page, from what was drawn and what went over the port.
class Bounds {
 public:
  Bounds(const EngineBench& b, const Scene& scene) : b_(b), w_(b.engine.work()) {
    read_edges(scene);
    for (const spec::geometric::LineRecord& line : b.lines) walk(line);
  }
  std::uint64_t begin() const {
    const std::uint64_t words =
        static_cast<std::uint64_t>(((b_.width + 3) / 4 + 127) / 128 * ((b_.height + 3) / 4));
    const std::uint64_t tags =
        std::max({lines(b_.p.vertex_lines), lines(b_.p.depth_lines), lines(b_.p.weight_blocks)});
    const std::uint64_t faces = b_.reads(b_.bases.faces).size();
    return std::max({words, tags, faces ? faces + 20 : 0});
  }
  std::uint64_t edges() const {
    const std::uint64_t port =
        b_.reads(b_.bases.edges).size() + b_.reads(b_.bases.vertices).size() +
        b_.reads(b_.bases.depth).size() + b_.engine.weight_combiner.blocks_read.value() +
        b_.writes(b_.bases.weights).size() + 2 * b_.writes(b_.bases.copy).size();
    const std::uint64_t setup = b_.p.pipelined
                                    ? w_.lines
                                    : 13 * (w_.lines - b_.engine.line_setup.table_lines.value()) /
                                          static_cast<std::uint64_t>(b_.p.dividers);
    const std::uint64_t weights = b_.engine.weight_combiner.lookups.value();
    return std::max({beats_, vertices_, setup, w_.groups, weights, depth_, port});
  }
  std::uint64_t resolve() const {
    std::map<std::pair<int, int>, std::uint64_t> in_word;
    std::uint64_t blend = 0;
    const int lanes = count_of(b_.p.resolve_lanes);
    for (const spec::geometric::BlockRecord& block : b_.blocks) {
      ++in_word[{block.x / 128, block.y}];
      blend += static_cast<std::uint64_t>(
          std::max(1, (std::popcount(block.blended) + lanes - 1) / lanes));
    }
    std::uint64_t scan =
        static_cast<std::uint64_t>(((b_.width + 3) / 4 + 127) / 128 * ((b_.height + 3) / 4));
    for (const auto& word : in_word) scan += word.second - 1;
    const std::uint64_t port = b_.engine.block_fetch.weights_read.value() +
                               b_.engine.block_fetch.lines_read.value() +
                               b_.engine.resolver.lines_written.value();
    return std::max({scan, blend, port});
  }
  // What the page allows above a bound.
  static std::uint64_t most(std::uint64_t bound, int part = 20) {
    return bound + bound / static_cast<std::uint64_t>(part) + 8 * 20 + 150;
  }
  // Of the edges phase, where second pixels' look-ups wait for each other.
  std::uint64_t most_of_edges() const {
    return most(begin() + edges(), b_.p.coverage == spec::geometric::CoverageRule::kArea ? 12 : 20);
  }

 private:
  static std::uint64_t lines(CacheLines code) {
    return spec::geometric::kCacheLineCount[static_cast<std::size_t>(code)];
  }
  static int count_of(Lanes lanes) {
    return spec::geometric::kLaneCount[static_cast<std::size_t>(lanes)];
  }
  bool keeps(const Scene& scene, const Edge& e) const {
    const auto vertices = scene.vertices.size(), faces = scene.facing.size();
    const bool boundary = e.flags & flag::kBoundary,
               all = b_.p.select == spec::geometric::Select::kAll;
    if (e.v0 >= vertices || e.v1 >= vertices) return false;
    if (!all && (e.f0 >= faces || (!boundary && e.f1 >= faces))) return false;
    if (boundary || all) return true;
    if (scene.facing[e.f0] != scene.facing[e.f1]) return true;
    if (!scene.facing[e.f0] && b_.p.cull == spec::geometric::Cull::kBack) return false;
    const bool angle = e.flags & flag::kAngle, split = e.flags & flag::kSplitNormals,
               seam = e.flags & flag::kSeam;
    return b_.p.crease == spec::geometric::Crease::kPaper ? angle
           : b_.p.crease == spec::geometric::Crease::kOff ? false
                                                          : (angle && split) || seam;
  }
  // Beats of edges, and look-ups of vertices that both miss.
  void read_edges(const Scene& scene) {
    const std::size_t lanes = static_cast<std::size_t>(count_of(b_.p.edge_lanes));
    const std::uint64_t size = lines(b_.p.vertex_lines);
    std::map<std::uint64_t, std::uint32_t> cache;
    const auto misses = [&](std::uint32_t line) {
      const auto found = cache.find(line % size);
      if (found != cache.end() && found->second == line) return 0;
      cache[line % size] = line;
      return 1;
    };
    for (std::size_t from = 0; from < scene.edges.size(); from += lanes) {
      std::uint64_t kept = 0;
      for (std::size_t i = from; i < std::min(from + lanes, scene.edges.size()); ++i) {
        const Edge& e = scene.edges[i];
        if (!keeps(scene, e)) continue;
        ++kept;
        int missed = misses(e.v0 / 4);
        if (e.v1 / 4 != e.v0 / 4) missed += misses(e.v1 / 4);
        vertices_ += missed == 2 ? 2 : 1;
      }
      beats_ += std::max<std::uint64_t>(1, kept);
    }
  }
  // Groups, their lines of depth in pairs, and which of these miss.
  void walk(const spec::geometric::LineRecord& l) {
    const bool vertical = l.axis == spec::geometric::Axis::kVertical;
    const int walkers = count_of(b_.p.walkers);
    const int rows = vertical ? b_.width : b_.height;
    for (int i = 0; i < l.count;) {
      const auto at = [&](int k) { return (l.position + k * std::int64_t{l.slope}) >> 8; };
      const auto block = [&](int k) { return std::pair{(l.first + k) >> 2, at(k) >> 18}; };
      int n = 1;
      while (n < walkers && i + n < l.count && block(i + n) == block(i)) ++n;
      std::vector<std::pair<int, int>> wanted;
      for (int k = i; k < i + n; ++k) {
        const int row = static_cast<int>(at(k) >> 16),
                  distance = static_cast<int>(at(k) & 65535) - 32768;
        const int other = distance > 0 || (distance == 0 && l.tie_forward) ? row + 1 : row - 1;
        if (row < 0 || row >= rows || other < 0 || other >= rows || !covers(l, std::abs(distance)))
          continue;
        for (const int m : {row, other}) {
          const int x = vertical ? m : l.first + k, y = vertical ? l.first + k : m;
          const std::pair place = b_.tiled() ? std::pair{x / 4, y / 4} : std::pair{x / 16, y};
          if (std::find(wanted.begin(), wanted.end(), place) == wanted.end())
            wanted.push_back(place);
        }
      }
      for (std::size_t pair = 0; pair < wanted.size(); pair += 2) {
        std::uint64_t misses = 0;
        for (std::size_t k = pair; k < std::min(pair + 2, wanted.size()); ++k)
          misses += look_up(wanted[k]);
        depth_ += std::max<std::uint64_t>(1, misses);
      }
      i += n;
    }
  }
  bool covers(const spec::geometric::LineRecord& l, int away) const {
    const std::int32_t slope = std::abs(l.slope);
    if (b_.p.coverage == spec::geometric::CoverageRule::kDistance ||
        2 * away + (slope >> 8) <= 65536)
      return away <= 32640;
    const int k = std::max(1, (slope + (1 << 18)) >> 19);
    return spec::geometric::kCutArea[static_cast<std::size_t>(k - 1)]
                                    [static_cast<std::size_t>(away / 1024)] != 0;
  }
  std::uint64_t look_up(std::pair<int, int> place) {
    const int bits = spec::geometric::kCacheLineBits[static_cast<std::size_t>(b_.p.depth_lines)];
    const int low = b_.tiled() ? (bits + 1) / 2 : std::max(1, (bits + 1) / 2 - 2);
    const int index = place.first % (1 << low) + (place.second % (1 << (bits - low)) << low);
    const auto found = cache_.find(index);
    if (found != cache_.end() && found->second == place) return 0;
    cache_[index] = place;
    return 1;
  }

  const EngineBench& b_;
  const spec::geometric::Work w_;
  std::uint64_t beats_ = 0, vertices_ = 0, depth_ = 0;
  std::map<int, std::pair<int, int>> cache_;
};

inline void expect_bounds(const EngineBench& b, const Scene& scene, bool edges_too = true) {
  const Bounds bounds(b, scene);
  const std::uint64_t edge_cycles = b.engine.frame_sequencer.edge_cycles.value(),
                      resolve_cycles = b.engine.frame_sequencer.resolve_cycles.value();
  EXPECT_GE(edge_cycles, bounds.begin() + bounds.edges());
  if (edges_too) {
    EXPECT_LE(edge_cycles, bounds.most_of_edges());
  }
  EXPECT_GE(resolve_cycles, bounds.resolve());
  EXPECT_LE(resolve_cycles, Bounds::most(bounds.resolve()));
}

}  // namespace deburr::tb::geometric_rtl
