// SPDX-License-Identifier: MIT
// The morphological engine on one or several frames.
//
//   frames ─► FrameSource ─► MorphologicalEngine ─► Sink ─► pixels, taps: against the golden frame
//                                │       └ registers ◄─ RegisterHost: SIZE, and the counters at the
//                                end
//                            MemoryModel (storage = memory) ─► lines written, lines read
//
// The golden model works on a frame before it is sent. Every pixel that leaves the engine is judged
// as it comes, with its tap (axis, shares, edge bits); runs and lines inside too, if asked for.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <systemc>
#include <vector>

#include "golden/morphological/morphological_golden.h"
#include "rtl_model/morphological/morphological_engine.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"
#include "tb/env/environment.h"
#include "tb/env/frame_source.h"
#include "tb/env/memory_parameters.h"
#include "tb/env/morphological_coverage.h"
#include "tb/env/morphological_maps.h"
#include "tb/env/raster_scoreboard.h"
#include "tb/harness/driver.h"

namespace deburr::tb {

struct MorphologicalSetup {
  spec::morphological::Parameters morphological;
  MemoryParameters memory;  // storage = memory only
  bool records = false;     // runs and lines inside the engine are compared too
  std::uint32_t pixel_base = 0;
  // A golden model that has worked on the frames, which are all the same, already; null: it works
  // here. Its parameters may differ in what is built. Never with errors of memory.
  std::shared_ptr<const golden::morphological::MorphologicalGolden> expectation = nullptr;
};

// ---- figures of the engine by formula (docs/morphological_hardware.md) --------------------------

// Unstalled clocks from a beat being popped to the same beat being pushed.
std::uint64_t latency_by_formula(const spec::morphological::Parameters& parameters, int width);
// Unstalled clocks of a frame, from its first pop to its last push.
std::uint64_t frame_clocks_by_formula(const spec::morphological::Parameters& parameters, int width,
                                      int height);
int lanes_of(const spec::morphological::Parameters& parameters);

class MorphologicalEnvironment final : public Environment {
 public:
  // The frames, which must outlive it, are what the golden model smooths. With a name it is part of
  // a composition, which puts the frames into `pixels`. ConfigError for wrong parameters or a frame
  // that the engine does not take.
  MorphologicalEnvironment(Simulation& simulation, std::span<const MorphologicalInput> frames,
                           const MorphologicalSetup& setup, std::string name = {});

  void configure() override;
  bool begin(std::size_t piece) override;
  void watch() override;
  bool done() const override;
  void end() override;
  void restart() override;
  void finish() override;
  void refuse_memory_errors() override;
  void refuse_unused_errors() const override;
  Amount amount() const override;
  bool memory_at_rest() const override { return !memory_ || memory_->at_rest(); }
  Boards outputs() const override;
  Boards traffic() const override;
  Boards counters() const override { return {&register_board_.board()}; }
  void collect(Result& result) const override;
  void show_parts(Observer& observer) const override;
  std::vector<PictureMap> maps() const override;
  Coverage coverage() const override { return morphological_coverage(golden_model()); }
  void collect_headline(Result& result) const override;

  rtl::Link<spec::morphological::PixelBeat> pixels;

  // Of its work, for the report of a composition too.
  std::vector<Figure> work_figures() const;
  std::uint64_t delivered_in_all() const { return all_delivered_; }
  // Of the last frame: what the engine delivered, and clocks from its first to its last input beat.
  const Image& frame() const { return frame_; }
  std::size_t delivered() const { return position_; }
  const std::vector<spec::morphological::BlendTap>& taps() const { return taps_; }
  rtl::Cycle input_clocks() const { return source_->last_cycle() - source_->first_cycle() + 1; }
  // The golden model, which has seen every frame (none without golden).
  const golden::morphological::MorphologicalGolden& golden_model() const {
    return setup_.expectation ? *setup_.expectation : golden_;
  }
  // Over all pixels and taps in order.
  std::uint64_t pixel_hash() const { return hash_.value(); }

  rtl::morphological::MorphologicalEngine& engine() { return engine_; }
  const rtl::morphological::MorphologicalEngine& engine() const { return engine_; }
  RegisterHost& host() { return host_; }

 private:
  std::vector<PlantedFault> faults() const;
  std::vector<PlantedFault> smaa_faults() const;
  std::vector<PlantedFault> shares_faults() const;
  spec::morphological::Parameters as_built() const;
  void plant_in_roms();
  int lanes() const { return lanes_of(setup_.morphological); }
  int width() const { return frame_.width; }
  bool in_memory() const {
    return setup_.morphological.storage == spec::morphological::Storage::kMemory;
  }
  // Of the model and of its parameters; memory alone is called that.
  std::string memory_name() const { return name().empty() ? "memory" : "frame_memory"; }
  void start();
  void expect();
  void expect_traffic();
  void judge(rtl::Cycle cycle, const spec::morphological::BlendedBeat& beat);
  void go_on_at_row(std::size_t row);
  void judge_records();
  void judge_traffic();
  void require_comparisons();

  std::span<const MorphologicalInput> frames_;
  MorphologicalSetup setup_;
  rtl::Link<spec::morphological::BlendedBeat> blended_;
  std::unique_ptr<FrameSource> source_;  // alone
  rtl::morphological::MorphologicalEngine engine_;
  Sink<spec::morphological::BlendedBeat> sink_;
  std::unique_ptr<MemoryModel> memory_;
  RegisterHost host_;

  golden::morphological::MorphologicalGolden golden_;
  spec::morphological::Work golden_work_;  // of all frames since the last reset
  std::uint64_t unreadable_lines_ = 0;     // of these frames, by the golden model
  RasterScoreboard<spec::morphological::Rgba8> pixel_board_;
  RasterScoreboard<spec::morphological::BlendTap> tap_board_;
  Scoreboard<spec::morphological::RunRecord> run_board_;
  Scoreboard<spec::morphological::LineRecord> line_board_;
  Scoreboard<spec::morphological::FrameAccess> traffic_board_;
  RegisterScoreboard register_board_;
  std::vector<spec::morphological::RunRecord> runs_;
  std::vector<spec::morphological::LineRecord> lines_;

  std::size_t current_ = 0;  // of frames_
  Image frame_;
  std::vector<spec::morphological::BlendTap> taps_;
  std::size_t position_ = 0;  // of the next pixel in the frame
  std::uint64_t all_delivered_ = 0;
  std::uint64_t taken_before_ = 0;  // beats that were taken before this frame's
  rtl::Cycle first_taken_ = 0;      // when the engine took the first of this frame
  OutputHash hash_;
  std::optional<MorphologicalMaps> maps_;
};

}  // namespace deburr::tb
