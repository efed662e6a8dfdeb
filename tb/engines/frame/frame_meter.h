// SPDX-License-Identifier: MIT
// Figures of a whole frame: those of its engines, the frame buffer between them, and the clocks of
// each against what it needs at least.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tb/engines/frame/frame_buffer.h"
#include "tb/engines/geometric/geometric_environment.h"
#include "tb/engines/morphological/morphological_environment.h"
#include "tb/engines/texture/texture_environment.h"
#include "tb/env/meter.h"

namespace deburr::tb {

// In the order of the frame's way; the engines that do not smooth are null.
struct FrameParts {
  const TextureEnvironment& texture;
  const FrameBuffer& buffer;
  const GeometricEnvironment* geometric;
  const MorphologicalEnvironment* morphological;
};

// How far the composition is.
struct FrameProgress {
  rtl::Cycle begun = 0;              // when the run began
  std::uint64_t drawing_clocks = 0;  // of the geometric engine; 0 before it is done
  bool complete = false;             // the run
};

class FrameMeter : public Meter {
 public:
  explicit FrameMeter(const FrameParts& parts);

  void collect(Result& result) const;
  void show_parts(Observer& observer) const;
  void collect_headline(Result& result, const FrameProgress& progress) const;

 private:
  // Clocks of each engine at this frame, and what it needs at least.
  struct Clocks {
    std::uint64_t texturing = 0, drawing = 0, smoothing = 0;
    std::uint64_t texturing_bound = 0, drawing_bound = 0, smoothing_bound = 0;
    std::uint64_t together() const { return texturing + drawing + smoothing; }
  };
  Clocks clocks(const Result& result, const FrameProgress& progress) const;
  // Engines behind each other add up; the texture unit and the morphological engine overlap.
  std::uint64_t bound(const Clocks& clocks) const;
  std::string meaning_of_bound(const Clocks& clocks) const;
  void collect_clocks(Result& result, const Clocks& clocks) const;
  std::vector<Figure> headline_figures(bool complete) const;
  std::uint64_t pixels() const { return parts_.buffer.frame().pixels.size(); }

  FrameParts parts_;
};

}  // namespace deburr::tb
