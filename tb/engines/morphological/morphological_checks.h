// SPDX-License-Identifier: MIT
// Compares the morphological engine with its golden model: pixels and probes as they appear,
// optionally runs and lines inside, memory lines, counters.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "golden/morphological/morphological_golden.h"
#include "rtl_model/morphological/morphological_engine.h"
#include "rtl_model/platform/host.h"
#include "rtl_model/platform/memory_model.h"
#include "spec/morphological/packets.h"
#include "tb/engines/morphological/morphological_input.h"
#include "tb/engines/morphological/morphological_setup.h"
#include "tb/env/environment.h"
#include "tb/env/raster_scoreboard.h"

namespace deburr::tb {

class MorphologicalChecks {
 public:
  // `setup` must outlive it. Without `golden` nothing is compared.
  MorphologicalChecks(const MorphologicalSetup& setup, bool golden);

  // Call after a reset of the engine's counters.
  void clear_counters();
  // Runs the golden model on a frame, which must outlive its checks.
  void begin(const MorphologicalInput& frame);
  // Restarts the frame after a reset.
  void restart();

  // Checks the framing signals of a beat that starts `left` pixels before the end of its row.
  void got_frame(rtl::Cycle cycle, std::size_t position, std::size_t left,
                 const spec::morphological::BlendedBeat& beat);
  void got(const spec::morphological::Rgba8& pixel, const spec::morphological::BlendProbe& probe,
           rtl::Cycle cycle) {
    if (!used_) return;
    pixels.got(pixel, cycle);
    probes.got(probe, cycle);
  }
  // Resynchronises at this pixel after a framing error.
  void resynchronise_at(std::size_t position);
  // Only with MorphologicalSetup::descriptors: collected here, compared at the end of the frame.
  void got(const spec::morphological::RunDescriptor& run) { runs_.push_back(run); }
  void got(const spec::morphological::LineDescriptor& line) { lines_.push_back(line); }
  // Checks and clears the accesses that memory has recorded.
  void check_traffic(platform::MemoryModel& memory, rtl::Cycle cycle);
  // Ends frame number `frame`.
  void end(rtl::Cycle cycle, std::size_t frame);
  // After all frames: sets the required number of comparisons and checks the counters.
  void finish(std::span<const MorphologicalInput> frames, const spec::morphological::Work& work,
              std::uint64_t frame_cycles, platform::RegisterBus& registers);
  // Checks counters that are not registers. `memory`: null with line buffers.
  void check_figures(std::span<const MorphologicalInput> frames,
                     const rtl::morphological::MorphologicalEngine& engine,
                     const platform::MemoryModel* memory);

  const golden::morphological::MorphologicalGolden& golden_model() const {
    return setup_.expectation ? *setup_.expectation : golden_;
  }

  RasterScoreboard<spec::morphological::Rgba8> pixels;
  RasterScoreboard<spec::morphological::BlendProbe> probes;
  Scoreboard<spec::morphological::RunDescriptor> runs;
  Scoreboard<spec::morphological::LineDescriptor> lines;
  Scoreboard<spec::morphological::FrameAccess> traffic;
  RegisterScoreboard registers;
  FigureScoreboard figures;

 private:
  bool in_memory() const {
    return setup_.morphological.storage == spec::morphological::Storage::kMemory;
  }
  void expect_traffic();
  void require(std::span<const MorphologicalInput> frames, const spec::morphological::Work& work);

  const MorphologicalSetup& setup_;
  bool used_;
  golden::morphological::MorphologicalGolden golden_;
  spec::morphological::Work work_;  // golden model's counts of all frames since the last reset
  std::array<std::uint64_t, 2> iterations_{};  // the same, per axis
  std::uint64_t unreadable_lines_ = 0;         // the same
  const MorphologicalInput* frame_ = nullptr;
  std::vector<spec::morphological::RunDescriptor> runs_;
  std::vector<spec::morphological::LineDescriptor> lines_;
};

}  // namespace deburr::tb
