// SPDX-License-Identifier: MIT
// Figures of the geometric engine: units and counters, traffic by region, and a lower bound of the
// cycles for the frame's work (docs/reference/geometric/hardware.md, "Cycles").
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rtl_model/geometric/geometric_engine.h"
#include "tb/engines/geometric/geometric_setup.h"
#include "tb/engines/geometric/geometric_stimuli.h"
#include "tb/env/meter.h"

namespace deburr::tb {

// Memory lines by region, from the counters of the units that transfer them.
struct LinesMoved {
  std::array<std::uint64_t, spec::geometric::kRegionNames.size()> read{}, written{};
};
LinesMoved lines_moved(const rtl::geometric::GeometricEngine& engine, bool frame_copy);

class GeometricMeter : public Meter {
 public:
  // All arguments must outlive it.
  GeometricMeter(std::string name, const rtl::geometric::GeometricEngine& engine,
                 const platform::MemoryModel& memory, std::span<const geometric::Frame> frames,
                 const GeometricSetup& setup);

  // Start and end of frame number `frame`.
  void begin(std::size_t frame) { frame_ = frame; }
  void end();
  std::uint64_t edges_done() const { return edges_done_; }
  std::uint64_t frames_done() const { return frames_done_; }

  void collect(Result& result) const;
  void show_parts(Observer& observer) const;
  void collect_headline(Result& result, double clock_mhz) const;
  std::vector<Figure> work_figures() const;
  // Bound per frame, from the work of all frames so far.
  std::uint64_t frame_cycles_bound() const {
    return frames_done_ > 0 ? cycles_bound() / frames_done_ : 0;
  }

 private:
  std::uint64_t cycles_bound() const;
  void collect_traffic(Result& result) const;
  void collect_hits(Result& result) const;
  std::optional<Bottleneck> bottleneck(const Result& result) const;

  const rtl::geometric::GeometricEngine& engine_;
  const platform::MemoryModel& memory_;
  std::span<const geometric::Frame> frames_;
  const GeometricSetup& setup_;
  std::size_t frame_ = 0;
  std::uint64_t frames_done_ = 0, edges_done_ = 0, edge_cycles_ = 0, resolve_cycles_ = 0;
};

}  // namespace deburr::tb
