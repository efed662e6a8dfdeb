// SPDX-License-Identifier: MIT
// One simulation of the morphological engine on one or several frames: clock, engine, memory,
// source, sink, golden model and scoreboards. `deburr run morphological` and the tests in tb/system
// use the same bench.
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
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <systemc>
#include <vector>

#include "golden/morphological/morphological_golden.h"
#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/morphological/morphological_engine.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"
#include "tb/env/frame_source.h"
#include "tb/env/memory_parameters.h"
#include "tb/env/raster_scoreboard.h"
#include "tb/env/simulation.h"
#include "tb/harness/bench.h"
#include "tb/harness/driver.h"
#include "tb/harness/memory_model.h"
#include "tb/harness/register_host.h"
#include "tb/harness/scoreboard.h"
#include "tb/results/result.h"

namespace deburr::tb {

struct MorphologicalBenchOptions : SimulationOptions {
  MorphologicalBenchOptions() { clock_mhz = 148.5; }
  spec::morphological::Parameters morphological;
  MemoryParameters memory;  // storage = memory only
  bool records = false;     // runs and lines inside the engine are compared too
  std::uint32_t pixel_base = 0;
  rtl::Cycle reset_after = 0;  // resets once, so many cycles into the first frame; 0: never
};

// A fault by name, for `--fault`; docs/verification.md says what must catch it.
struct MorphologicalFault {
  std::string_view name, meaning;
};
std::span<const MorphologicalFault> morphological_faults();

// ---- figures of the engine by formula (docs/morphological_hardware.md) --------------------------

// Unstalled clocks from a beat being popped to the same beat being pushed.
std::uint64_t latency_by_formula(const spec::morphological::Parameters& parameters, int width);
// Unstalled clocks of a frame, from its first pop to its last push.
std::uint64_t frame_clocks_by_formula(const spec::morphological::Parameters& parameters, int width,
                                      int height);

// Units, memories and counters of an engine, for any bench that has one; names get the prefix.
void collect_morphological(rtl::morphological::MorphologicalEngine& engine, int width,
                           const std::string& prefix, Result& result);

class MorphologicalBench {
 public:
  // Called every few thousand cycles with the numbers of pixels delivered and taken; false ends the
  // run early.
  using Progress = std::function<bool(std::uint64_t pixels, std::uint64_t taken)>;

  // Elaborates; one a process. The frames must outlive the bench. ConfigError for wrong parameters
  // or a frame that the engine does not take.
  MorphologicalBench(std::span<const MorphologicalInput> frames,
                     const MorphologicalBenchOptions& options);
  ~MorphologicalBench();

  // Does not throw on mismatches: see check(). SimulationError for memory errors and broken
  // protocols, DeadlockError for no progress, OutOfCycles for max_cycles.
  void run(const Progress& progress = {});
  // Throws Mismatch when a pixel, a tap, a record, a memory access or a counter differs.
  void check() const;
  // Everything measured so far, also after an exception from run().
  void collect(Result& result) const;

  bool complete() const { return complete_; }  // false when ended early
  rtl::Cycle cycles() const { return cycles_; }
  std::uint64_t pixels() const { return pixels_; }
  std::uint64_t activations() const { return clock_.activations(); }
  // Of the last frame: what the engine delivered, and clocks from its first to its last input beat.
  const Image& frame() const { return frame_; }
  std::size_t delivered() const { return position_; }
  const std::vector<spec::morphological::BlendTap>& taps() const { return taps_; }
  rtl::Cycle input_clocks() const { return source_.last_cycle() - source_.first_cycle() + 1; }
  // The golden model, which has seen every frame (none without golden).
  const golden::morphological::MorphologicalGolden& golden() const { return golden_; }
  // FNV-1a over all pixels and taps in order, to compare runs that must not differ.
  std::uint64_t pixel_hash() const { return hash_; }

  rtl::ClockDomain& clock() { return clock_; }
  rtl::morphological::MorphologicalEngine& engine() { return engine_; }

  RegisterHost& host() { return host_; }

 private:
  struct Status {
    std::uint32_t offset, value;
    friend bool operator==(const Status&, const Status&) = default;
  };

  int lanes() const;
  bool in_memory() const { return memory_ != nullptr; }
  void plant_memory_faults();
  void reset();
  void run_frame(const MorphologicalInput& frame, bool reset_within, const Progress& progress);
  void expect(const MorphologicalInput& frame);
  void judge(rtl::Cycle cycle, const spec::morphological::BlendedBeat& beat);
  void judge_records();
  void judge_traffic();
  void judge_registers();

  std::span<const MorphologicalInput> frames_;
  MorphologicalBenchOptions options_;
  rtl::ClockDomain clock_;
  rtl::Link<spec::morphological::PixelBeat> pixels_link_{"pixels"};
  rtl::Link<spec::morphological::BlendedBeat> blended_{"blended"};
  FrameSource source_;
  rtl::morphological::MorphologicalEngine engine_;
  Sink<spec::morphological::BlendedBeat> sink_;
  std::unique_ptr<MemoryModel> memory_;
  RegisterHost host_;
  std::unique_ptr<Bench> bench_;

  golden::morphological::MorphologicalGolden golden_;
  spec::morphological::Work golden_work_;  // of all frames since the last reset
  RasterScoreboard<spec::morphological::Rgba8> pixel_board_;
  RasterScoreboard<spec::morphological::BlendTap> tap_board_;
  Scoreboard<spec::morphological::RunRecord> run_board_;
  Scoreboard<spec::morphological::LineRecord> line_board_;
  Scoreboard<spec::morphological::FrameAccess> traffic_board_;
  Scoreboard<Status> register_board_;
  std::vector<spec::morphological::RunRecord> runs_;
  std::vector<spec::morphological::LineRecord> lines_;

  Image frame_;
  std::vector<spec::morphological::BlendTap> taps_;
  std::size_t position_ = 0;  // of the next pixel in the frame
  std::uint64_t pixels_ = 0, hash_ = 0xCBF29CE484222325ULL;
  rtl::Cycle cycles_ = 0, started_ = 0, next_progress_ = 0;
  double host_seconds_ = 0, cpu_seconds_ = 0;
  std::uint64_t frames_done_ = 0;
  std::size_t writes_judged_ = 0, reads_judged_ = 0;
  bool running_ = false, stopped_ = false, complete_ = false;
};

}  // namespace deburr::tb
