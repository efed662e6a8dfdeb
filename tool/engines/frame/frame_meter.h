// SPDX-License-Identifier: MIT
// Figures of a whole frame: those of its engines and of the frame buffer, and the cycles of each
// engine compared with their lower bound.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tb/env/meter.h"
#include "tool/engines/frame/frame_buffer.h"
#include "tool/run/composition.h"

namespace deburr::tool {

// The parts of a composition in processing order. `mesh` and `rows` are null if there is no such
// stage.
struct FrameParts {
  const PictureDrawer& drawer;
  const DrawingStage& drawing;
  const FrameBuffer& buffer;
  std::vector<const tb::Environment*> environments;
  const MeshStage* mesh;
  const RowStage* rows;
  std::string_view mesh_title, rows_title;
  // `mesh` and `rows`; in a composition that is only described, every smoothing engine.
  std::vector<const SmoothingStage*> smoothing;
};

// Progress of the composition.
struct FrameProgress {
  rtl::Cycle begun = 0;              // first cycle of the run
  std::uint64_t drawing_cycles = 0;  // along mesh edges; 0 until done
  bool complete = false;             // the run is complete
};

class FrameMeter : public tb::Meter {
 public:
  explicit FrameMeter(const FrameParts& parts);

  void collect(tb::Result& result) const;
  void show_parts(tb::Observer& observer) const;
  void collect_headline(tb::Result& result, const FrameProgress& progress) const;

 private:
  // Cycles of each engine for this frame, and their lower bounds.
  struct Cycles {
    std::uint64_t colours = 0, drawing = 0, smoothing = 0;
    std::uint64_t colours_bound = 0, drawing_bound = 0, smoothing_bound = 0;
    std::uint64_t together() const { return colours + drawing + smoothing; }
  };
  Cycles cycles(const tb::Result& result, const FrameProgress& progress) const;
  // Engines in series add up; the drawing engine and row-based smoothing overlap.
  std::uint64_t bound(const Cycles& cycles) const;
  std::string meaning_of_bound(const Cycles& cycles) const;
  void collect_cycles(tb::Result& result, const Cycles& cycles) const;
  std::vector<tb::Figure> headline_figures(bool complete) const;
  std::uint64_t pixels() const { return parts_.buffer.frame().pixels.size(); }
  std::string colours_key() const;

  FrameParts parts_;
  DrawingWords words_;
};

}  // namespace deburr::tool
