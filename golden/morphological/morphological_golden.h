// SPDX-License-Identifier: MIT
// Bit-exact reference of the morphological engine. Input: a frame. Outputs: the smoothed frame,
// every intermediate result and the predicted memory traffic.
//
// No time, no SystemC, integers only (docs/reference/morphological/algorithm.md,
// docs/reference/morphological/smaa.md; papers 000, 001 and 003). The blocks are pure functions:
// luma.h or colour.h, edges.h, runs.h, predictor.h, line.h, area.h or area_table.h or
// learned_weights.h, corners.h, diagonals.h, blend.h, bypass.h, text_guard.h, traffic.h; conversion
// of images to codes: convert.h. MorphologicalGolden runs them over a frame. Edges are detected for
// all pixels; later blocks only visit edges and the pixels next to them.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "golden/morphological/area.h"
#include "golden/morphological/blend.h"
#include "golden/morphological/bypass.h"
#include "golden/morphological/configuration.h"
#include "golden/morphological/learned_weights.h"
#include "golden/morphological/planes.h"
#include "golden/morphological/predictor.h"
#include "golden/morphological/run_coverage.h"
#include "golden/morphological/smaa_coverage.h"
#include "golden/morphological/text_guard.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"

namespace deburr::golden::morphological {

// A descriptor and its prediction. Positions count from line.run.start; the outermost corners are
// at far_left <= 0 and far_right >= 1.
struct PredictedRun {
  spec::morphological::LineDescriptor line;
  std::int16_t far_left = 0, far_right = 0;
  std::uint16_t probes = 0;
  std::uint8_t iterations = 0;
  Outcome left = Outcome::kUntried, right = Outcome::kUntried;
  SideEnd left_end = SideEnd::kUntried, right_end = SideEnd::kUntried;
};

class MorphologicalGolden {
 public:
  // kPixels: pixels, edges and work counters only; the fastest. kEverything: also probes,
  // decisions, runs and coverage.
  enum class Detail { kPixels, kEverything };

  // Throws ConfigError (spec/morphological/check_build.h).
  explicit MorphologicalGolden(const spec::morphological::Parameters& parameters,
                               Detail detail = Detail::kEverything);

  // Returns the output frame, row by row without padding; valid until the next call. Depth has the
  // size of the image; without depth every depth is 0. Throws ConfigError for a frame that the
  // engine rejects.
  const std::vector<spec::morphological::Rgba8>& process(const ImageView& image,
                                                         const DepthView& depth = {});
  // Uses the given edges instead of edge detection. They have the size of the image; column 0
  // (left) and row 0 (top) must be 0.
  const std::vector<spec::morphological::Rgba8>& process(const ImageView& image,
                                                         const EdgePlanes& edges);

  // ---- Results of the last frame; index y * width + x ----------------------------------------
  int width() const { return edges_.left.width(); }
  int height() const { return edges_.left.height(); }
  const std::vector<spec::morphological::Rgba8>& pixels() const { return pixels_; }
  const EdgePlanes& edges() const { return edges_; }
  // Weights of the top and of the left edge of a pixel, as read by the blender.
  EdgeWeights top_weights(int x, int y) const { return horizontal_.at(x, y).of_edge(); }
  EdgeWeights left_weights(int x, int y) const { return vertical_.at(y, x).of_edge(); }
  // Counters of this frame only; the hardware accumulates them until its counters are cleared.
  const spec::morphological::Work& work() const { return work_; }
  // Empty without kEverything. Probes are those of the engine, including edge bits.
  const std::vector<spec::morphological::BlendProbe>& probes() const { return probes_; }
  const std::vector<Decision>& decisions() const { return decisions_; }
  // Every descriptor in canonical order: horizontal by (row, start), then vertical by (start row,
  // column).
  const std::vector<PredictedRun>& runs() const { return runs_; }
  // Line accesses with storage = memory: all writes, then all reads. Empty with line buffers.
  std::vector<spec::morphological::FrameAccess> traffic(std::uint32_t pixel_base = 0) const;

  // ---- Results of all frames -----------------------------------------------------------------
  const RunCoverage& coverage() const { return coverage_; }
  const SmaaCoverage& smaa_coverage() const { return smaa_coverage_; }
  const BypassCoverage& bypass_coverage() const { return bypass_coverage_; }
  const LearnedCoverage& learned_coverage() const { return learned_coverage_; }
  const GuardCoverage& guard_coverage() const { return guard_coverage_; }
  void clear_coverage() {
    coverage_ = {};
    bypass_coverage_ = {};
    smaa_coverage_ = {};
    learned_coverage_ = {};
    guard_coverage_ = {};
  }

  // storage = memory: line addresses whose reads get an error response; their pixels read as zero
  // in the blender. Edges come from the stream and are not affected.
  using LinePredicate = std::function<bool(std::uint32_t address)>;
  void set_read_errors(LinePredicate error, std::uint32_t pixel_base = 0);
  std::uint64_t memory_errors() const { return memory_errors_; }  // of the last frame

  // Takes effect with the next frame, like a register write.
  void set_weight_tables(const WeightTables& tables) { tables_ = tables; }

  const spec::morphological::Parameters& parameters() const { return parameters_; }

 private:
  struct Weight {  // of an edge
    std::uint8_t first = 0, second = 0;
    std::uint16_t span = 0;
    EdgeWeights of_edge() const { return {first, second}; }
  };
  // Weights of all edges of an axis, in the order of the bits of `edges.along`; pixels without an
  // edge have no entry.
  struct AxisWeights {
    AxisEdges edges;
    std::vector<Weight> weights;
    std::vector<std::uint32_t> edges_before;  // for each word of edges.along
    void count_edges();
    std::size_t index(int position, int line) const;  // of the weight of an edge
    Weight at(int position, int line) const;          // zero without an edge
  };
  void smooth(const ImageView& image);
  void process_axis(AxisWeights& axis);
  void process_descriptor(AxisWeights& axis, const spec::morphological::RunDescriptor& run);
  void weight(AxisWeights& axis, const spec::morphological::LineDescriptor& line) const;
  void weight_learned(AxisWeights& axis, const spec::morphological::LineDescriptor& line);
  void weight_gap(AxisWeights& axis, int edges);
  bool is_learned(const spec::morphological::RunDescriptor& run,
                  const Prediction& prediction) const;
  void count_searches(const spec::morphological::LineDescriptor& line, int extent);
  void count_thresholds(const ImageView& image);
  void process_diagonals();
  void put_runs_in_order(std::size_t first_vertical);
  PixelWeights gather(int x, int y) const;
  spec::morphological::BlendProbe remaining_probe(const ImageView& image, int x, int y,
                                                  const spec::morphological::BlendProbe& probe);
  void blend_row(const ImageView& image, int y);
  void blend_pixel(const ImageView& image, int x, int y);
  ImageView as_read_back(const ImageView& image);

  spec::morphological::Parameters parameters_;
  bool everything_;
  EdgePlanes edges_;
  TextGuard guard_;  // with text_guard only
  AxisWeights horizontal_, vertical_;
  std::vector<spec::morphological::Rgba8> pixels_, read_back_;
  std::vector<spec::morphological::BlendProbe> probes_;
  std::vector<Decision> decisions_;
  std::vector<PredictedRun> runs_;
  spec::morphological::Work work_;
  RunCoverage coverage_;
  SmaaCoverage smaa_coverage_;
  BypassCoverage bypass_coverage_;
  LearnedCoverage learned_coverage_;
  GuardCoverage guard_coverage_;
  WeightTables tables_;
  LinePredicate error_;
  std::uint32_t pixel_base_ = 0;
  std::uint64_t memory_errors_ = 0;
};

}  // namespace deburr::golden::morphological
