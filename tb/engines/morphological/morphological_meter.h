// SPDX-License-Identifier: MIT
// Figures of the morphological engine: units and counters, and its cycles compared with the
// formulas of docs/reference/morphological/hardware.md.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "rtl_model/morphological/morphological_engine.h"
#include "tb/engines/morphological/frame_source.h"
#include "tb/engines/morphological/morphological_setup.h"
#include "tb/env/meter.h"

namespace deburr::tb {

// ---- cycles by formula (docs/reference/morphological/hardware.md) -------------------------------

// Cycles without stalls from the pop of a beat to its push.
std::uint64_t latency_by_formula(const spec::morphological::Parameters& parameters, int width);
// Cycles without stalls of a frame, from its first pop to its last push.
std::uint64_t frame_cycles_by_formula(const spec::morphological::Parameters& parameters, int width,
                                      int height);

// Progress of the environment.
struct MorphologicalProgress {
  int width = 0, height = 0;                      // of the current frame
  std::uint64_t delivered = 0;                    // pixels, total of all frames
  const FrameSource* source = nullptr;            // null in a composition
  const platform::MemoryModel* memory = nullptr;  // null with line buffers
  // Cycles of the last frame from first to last input beat.
  rtl::Cycle input_cycles() const { return source->last_cycle() - source->first_cycle() + 1; }
};

class MorphologicalMeter : public Meter {
 public:
  // All arguments must outlive it.
  MorphologicalMeter(std::string name, const rtl::morphological::MorphologicalEngine& engine,
                     const MorphologicalProgress& progress, const MorphologicalSetup& setup)
      : Meter(std::move(name)), engine_(engine), progress_(progress), setup_(setup) {}

  void collect(Result& result) const;
  void show_parts(Observer& observer, const rtl::LinkBase& in, const rtl::LinkBase& out) const;
  void collect_headline(Result& result, double clock_mhz) const;
  std::vector<Figure> work_figures() const;

 private:
  int lanes() const { return platform::lanes_of(setup_.morphological); }
  void collect_cycles(Result& result, double clock_mhz) const;
  std::vector<Figure> headline_figures() const;

  const rtl::morphological::MorphologicalEngine& engine_;
  const MorphologicalProgress& progress_;
  const MorphologicalSetup& setup_;
};

}  // namespace deburr::tb
