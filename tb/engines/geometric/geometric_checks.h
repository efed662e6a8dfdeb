// SPDX-License-Identifier: MIT
// Compares the geometric engine with its golden model: lines, candidates and blocks as they appear,
// memory lines of each region in order, the pixels of a frame in memory, the registers.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "golden/geometric/geometric_golden.h"
#include "rtl_model/geometric/geometric_engine.h"
#include "rtl_model/platform/geometric_driver.h"
#include "rtl_model/platform/host.h"
#include "rtl_model/platform/memory_model.h"
#include "spec/geometric/packets.h"
#include "tb/engines/geometric/geometric_meter.h"
#include "tb/engines/geometric/geometric_setup.h"
#include "tb/engines/geometric/geometric_stimuli.h"
#include "tb/env/environment.h"
#include "tb/env/raster_scoreboard.h"

namespace deburr::tb {

class GeometricChecks {
 public:
  // `setup` and `regions` must outlive it. Without `golden` nothing is compared.
  GeometricChecks(const GeometricSetup& setup, const platform::GeometricRegions& regions,
                  bool golden);

  // Call after a reset of the engine's counters.
  void clear_counters();
  // Runs the golden model on a frame, which must outlive its checks.
  void begin(const geometric::Frame& frame);
  // Restarts the frame after a reset.
  void restart();

  void got(const spec::geometric::LineRecord& line, rtl::Cycle cycle);
  void got(const spec::geometric::Candidate& candidate, rtl::Cycle cycle);
  void got(const spec::geometric::BlockRecord& block, rtl::Cycle cycle);
  // Checks accesses that memory has recorded since the last call or the start of the frame.
  void check_traffic(const platform::MemoryModel& memory, rtl::Cycle cycle);
  // Ends a frame; `after` is the frame in memory.
  void end(const Image& after, rtl::Cycle cycle);
  // After all frames: sets the required number of comparisons and checks the registers and the
  // counters that have a second source.
  void finish(const rtl::geometric::GeometricEngine& engine, const platform::MemoryModel& memory,
              std::uint64_t pixels, platform::RegisterBus& registers);

  // The frame as the golden model finishes it.
  Image expected_frame() const;
  // Byte offset, from the base of a buffer, of the memory line that holds a pixel.
  std::uint32_t line_offset(int x, int y) const;
  const golden::geometric::GeometricGolden& golden_model() const { return golden_; }

  Scoreboard<spec::geometric::LineRecord> lines;
  Scoreboard<spec::geometric::Candidate> candidates;
  Scoreboard<spec::geometric::BlockRecord> blocks;
  RasterScoreboard<Rgba8> pixels;
  Scoreboard<spec::geometric::MemoryAccess> traffic;
  RegisterScoreboard registers;
  FigureScoreboard figures;

 private:
  golden::geometric::Bases bases() const;
  std::vector<std::pair<std::uint32_t, std::uint64_t>> expected_registers(
      const rtl::geometric::GeometricEngine& engine) const;
  void check_figures(const rtl::geometric::GeometricEngine& engine,
                     const platform::MemoryModel& memory);

  const GeometricSetup& setup_;
  const platform::GeometricRegions& regions_;
  bool used_;
  golden::geometric::GeometricGolden golden_;
  spec::geometric::Work work_;  // golden model's counts of all frames since the last reset
  LinesMoved moved_;
  std::uint64_t errors_ = 0;
  const geometric::Frame* frame_ = nullptr;
  golden::geometric::FrameLayout layout_;  // of the current frame
  Image expected_;
  std::size_t reads_checked_ = 0, writes_checked_ = 0;
};

}  // namespace deburr::tb
