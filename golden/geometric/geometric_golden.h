// SPDX-License-Identifier: MIT
// Bit-exact reference of the geometric engine. Inputs: edges, vertices, facing bits, depth and a
// frame. Outputs: the smoothed frame, every intermediate result and the memory traffic.
//
// No time, no SystemC, integers only (docs/reference/geometric/algorithm.md; paper 002). The steps
// are functions in classify.h, line.h and resolve.h; memory layout and cache contents are in
// traffic.h. GeometricGolden runs them over a frame. Run time depends on edges, columns of lines
// and touched blocks; other pixels are only copied.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "golden/geometric/classify.h"
#include "golden/geometric/coarse.h"
#include "golden/geometric/configuration.h"
#include "golden/geometric/edge_coverage.h"
#include "golden/geometric/pairs.h"
#include "golden/geometric/traffic.h"
#include "golden/morphological/planes.h"
#include "spec/geometric/packets.h"
#include "spec/geometric/parameters.h"
#include "spec/geometric/records.h"

namespace deburr::golden::geometric {

using ImageView = morphological::ViewOf<spec::geometric::Rgba8>;
using DepthView = morphological::ViewOf<std::uint32_t>;  // U24; bits 31..24 are ignored

// The contents of memory and their addresses. Views and spans are not owned.
struct FrameInput {
  ImageView image;  // defines the size of the frame
  DepthView depth;  // same size; may be empty with depth_test = off
  std::span<const spec::geometric::Edge> edges;
  std::span<const spec::geometric::Vertex> vertices;
  FacingBits facing;
  Bases bases = {};
  // BOUNDARY_COUNT, split records only. Without a value: counted from the flags of the edges.
  std::optional<std::uint32_t> boundary_count = {};
  // Coarse depth, indexed by CoarseLayout::index_of(). Empty: derived from the depths.
  std::span<const std::uint16_t> coarse = {};
};

class GeometricGolden {
 public:
  // kPixels: pixels, weights and work counters only; the fastest. kEverything: also classes, lines,
  // candidates, blocks, traffic and coverage.
  enum class Detail { kPixels, kEverything };

  // Throws ConfigError (spec/geometric/check_build.h).
  explicit GeometricGolden(const spec::geometric::Parameters& parameters,
                           Detail detail = Detail::kEverything);

  // Returns the output frame, row by row without padding; valid until the next call. Throws
  // ConfigError for a frame that the engine rejects at START, CheckFailed for views that are
  // smaller than their size.
  const std::vector<spec::geometric::Rgba8>& process(const FrameInput& input);

  // ---- Results of the last frame; index y * width + x ----------------------------------------
  int width() const { return width_; }
  int height() const { return height_; }
  const std::vector<spec::geometric::Rgba8>& pixels() const { return pixels_; }
  const std::vector<spec::geometric::Weights>& weights() const { return weights_; }
  // Counters of this frame only; the hardware accumulates them until its counters are cleared.
  const spec::geometric::Work& work() const { return work_; }
  // Empty without kEverything; each in order. Split records: an edge with an invalid vertex index
  // is listed as invalid here; its class counts it as well.
  const std::vector<spec::geometric::EdgeClass>& classes() const { return classes_; }
  const std::vector<spec::geometric::LineRecord>& lines() const { return lines_; }
  const std::vector<spec::geometric::Candidate>& candidates() const { return candidates_; }
  const std::vector<spec::geometric::BlockRecord>& blocks() const { return blocks_; }
  const Traffic& traffic() const { return traffic_; }

  // ---- Results of all frames -----------------------------------------------------------------
  const EdgeCoverage& coverage() const { return coverage_; }
  void clear_coverage() { coverage_ = {}; }

  // Line addresses whose accesses get an error response: reads return zeros, writes store nothing.
  using LinePredicate = std::function<bool(std::uint32_t address)>;
  void set_memory_errors(LinePredicate error) { error_ = std::move(error); }
  std::uint64_t memory_errors() const { return memory_errors_; }  // of the last frame

  const spec::geometric::Parameters& parameters() const { return parameters_; }

 private:
  void start(const FrameInput& input);
  void start_traffic();
  void check_bases() const;
  void read_with_errors();
  void draw_edge(const spec::geometric::Edge& edge);
  void count_class(const spec::geometric::Edge& edge, spec::geometric::EdgeClass c);
  bool fetch_pair(std::size_t array, std::uint32_t number, Pair& pair);
  void fetch_vertices(const Pair& pair);
  void count_fetch(CacheKind cache, Fetch outcome) {
    if (everything_) coverage_.count_fetch(cache, outcome);
  }
  template <bool kFollow>
  void walk(const spec::geometric::LineRecord& line);
  template <bool kFollow>
  void add_candidate(int x, int y, spec::geometric::Direction to, int share, std::uint32_t depth,
                     bool passed, bool nearer);
  template <bool kFollow>
  bool is_dropped_early(int x, int y, int nx, int ny, spec::geometric::Direction to,
                        std::uint32_t depth);
  void fetch_coarse(const LineOfPixels& line);
  void count_test(const spec::geometric::LineRecord& line, spec::geometric::Direction to,
                  std::uint32_t depth, std::uint32_t own, std::uint32_t other);
  void fetch_depth(int x, int y, int nx, int ny);
  void look_up_block(std::uint32_t bx, std::uint32_t by);
  void write_block(std::uint64_t tag);
  void empty_write_buffer();
  void read_colours(const LineOfPixels& line);
  void forget_block(int bx, int by);
  void resolve_block(int bx, int by);
  void finish_traffic();
  bool bad(std::uint32_t address) const { return error_ && error_(address); }
  const spec::geometric::Weights& weights_at(int x, int y) const {
    return weights_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                    static_cast<std::size_t>(x)];
  }
  std::uint32_t edges_in_line() const {
    return split_ ? spec::geometric::kSplitInLine : spec::geometric::kEdgesInLine;
  }
  std::uint32_t block_address(std::uint32_t bx, std::uint32_t by) const;

  spec::geometric::Parameters parameters_;
  bool everything_;
  bool follow_ = false;  // models the caches
  int lanes_ = 1;

  FrameInput input_;
  int width_ = 0, height_ = 0;
  FrameLayout layout_;
  std::vector<spec::geometric::Rgba8> pixels_;
  std::vector<spec::geometric::Weights> weights_;
  std::vector<std::uint8_t> touched_;  // one per block
  spec::geometric::Work work_;

  // Split records only.
  bool split_ = false;
  std::array<PairArray, 2> pairs_;
  // Coarse depth test only.
  bool screen_ = false;
  CoarseLayout coarse_layout_;
  std::vector<std::uint16_t> coarse_;

  DirectMapped vertex_cache_, depth_cache_, block_cache_, coarse_cache_;
  WriteBuffer write_buffer_;
  KeptLines kept_colours_;
  Traffic traffic_;
  std::vector<spec::geometric::EdgeClass> classes_;
  std::vector<spec::geometric::LineRecord> lines_;
  std::vector<spec::geometric::Candidate> candidates_;
  std::vector<spec::geometric::BlockRecord> blocks_;
  EdgeCoverage coverage_;

  LinePredicate error_;
  std::uint64_t memory_errors_ = 0;
  // Inputs as read from memory with errors.
  std::vector<spec::geometric::Edge> read_edges_;
  std::vector<spec::geometric::Vertex> read_vertices_;
  std::vector<std::uint8_t> read_facing_;
  std::vector<std::uint32_t> read_depth_;
  std::vector<spec::geometric::Rgba8> read_image_;
};

}  // namespace deburr::golden::geometric
