// SPDX-License-Identifier: MIT
// The bounds on the cycles of a frame from docs/reference/geometric/hardware.md.
#pragma once

#include <bit>
#include <map>
#include <utility>

#include "golden/geometric/classify.h"
#include "golden/geometric/line.h"
#include "golden/geometric/traffic.h"
#include "tb/unit/rtl/geometric/support.h"

namespace deburr::tb::geometric_rtl {

using spec::geometric::CacheLines;
using spec::geometric::Edge;
using spec::geometric::Lanes;
namespace flag = spec::geometric::flag;

// The bounds of the page, computed from the drawn scene and the traffic at the memory port.
class Bounds {
 public:
  Bounds(const EngineBench& b, const Scene& scene) : b_(b), w_(b.engine.work()) {
    read_edges(scene);
    layout_ = {b.p.layout, b.width, b.height};
    const int bits = bits_of(b.p.depth_lines);
    cache_.reset(bits, golden::geometric::depth_column_bits(b.p.layout, bits));
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
  // The largest number of cycles that the page allows for a bound.
  static std::uint64_t most(std::uint64_t bound, int part = 20) {
    return bound + bound / static_cast<std::uint64_t>(part) + 8 * 20 + 150;
  }
  // The same for the edge phase, where the lookups of second pixels wait for each other.
  std::uint64_t most_of_edges() const {
    return most(begin() + edges(), b_.p.coverage == spec::geometric::CoverageRule::kArea ? 12 : 20);
  }

 private:
  static std::uint64_t lines(CacheLines code) {
    return spec::geometric::kCacheLineCount[static_cast<std::size_t>(code)];
  }
  static int bits_of(CacheLines code) {
    return spec::geometric::kCacheLineBits[static_cast<std::size_t>(code)];
  }
  static int count_of(Lanes lanes) {
    return spec::geometric::kLaneCount[static_cast<std::size_t>(lanes)];
  }
  // Counts beats of edges, and pairs of vertex lookups that both miss.
  void read_edges(const Scene& scene) {
    const std::size_t lanes = static_cast<std::size_t>(count_of(b_.p.edge_lanes));
    golden::geometric::DirectMapped cache;
    const int bits = bits_of(b_.p.vertex_lines);
    cache.reset(bits, bits);
    std::uint64_t replaced = 0;
    const auto misses = [&](std::uint32_t line) {
      return cache.look_up(line, 0, replaced) ? 0 : 1;
    };
    const auto count = static_cast<std::uint32_t>(scene.vertices.size());
    const std::vector<std::uint8_t> facing = platform::facing_bits(scene.facing);
    const golden::geometric::FacingBits faces = {facing,
                                                 static_cast<std::uint32_t>(scene.facing.size())};
    for (std::size_t from = 0; from < scene.edges.size(); from += lanes) {
      std::uint64_t kept = 0;
      for (std::size_t i = from; i < std::min(from + lanes, scene.edges.size()); ++i) {
        const Edge& e = scene.edges[i];
        if (!golden::geometric::is_kept(golden::geometric::classify(b_.p, e, count, faces)))
          continue;
        ++kept;
        int missed = misses(e.v0 / 4);
        if (e.v1 / 4 != e.v0 / 4) missed += misses(e.v1 / 4);
        vertices_ += missed == 2 ? 2 : 1;
      }
      beats_ += std::max<std::uint64_t>(1, kept);
    }
  }
  // Counts groups, their lines of depth in pairs, and the misses among them.
  void walk(const spec::geometric::LineRecord& l) {
    const bool vertical = l.axis == spec::geometric::Axis::kVertical;
    const int walkers = count_of(b_.p.walkers);
    const int rows = vertical ? b_.width : b_.height;
    for (int i = 0; i < l.count;) {
      const auto at = [&](int k) { return l.position + k * std::int64_t{l.slope}; };
      const auto block = [&](int k) { return std::pair{(l.first + k) >> 2, at(k) >> 26}; };
      int n = 1;
      while (n < walkers && i + n < l.count && block(i + n) == block(i)) ++n;
      std::vector<golden::geometric::LineOfPixels> wanted;
      for (int k = i; k < i + n; ++k) {
        const golden::geometric::ColumnPoint point = golden::geometric::point_at(at(k), 0);
        const int other =
            point.row + (golden::geometric::is_forward(point.distance, l.tie_forward) ? 1 : -1);
        if (std::min(point.row, other) < 0 || std::max(point.row, other) >= rows ||
            golden::geometric::shares(b_.p.coverage, point.distance, l.slope).first == 0)
          continue;
        for (const int m : {point.row, other}) {
          const auto line =
              vertical ? layout_.line_of(m, l.first + k) : layout_.line_of(l.first + k, m);
          if (std::find(wanted.begin(), wanted.end(), line) == wanted.end()) wanted.push_back(line);
        }
      }
      for (std::size_t pair = 0; pair < wanted.size(); pair += 2) {
        std::uint64_t misses = 0, replaced = 0;
        for (std::size_t k = pair; k < std::min(pair + 2, wanted.size()); ++k)
          misses += !cache_.look_up(wanted[k].u, wanted[k].v, replaced);
        depth_ += std::max<std::uint64_t>(1, misses);
      }
      i += n;
    }
  }

  const EngineBench& b_;
  const spec::geometric::Work w_;
  std::uint64_t beats_ = 0, vertices_ = 0, depth_ = 0;
  golden::geometric::FrameLayout layout_;
  golden::geometric::DirectMapped cache_;
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
