// SPDX-License-Identifier: MIT
// History of one pixel in the morphological engine: edges, runs and lines of its four sides,
// weights, blend, with golden model and hardware side by side (docs/reference/run.md, "One pixel").
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "golden/morphological/morphological_golden.h"
#include "rtl_model/fabric/clocked.h"
#include "spec/morphological/packets.h"
#include "tb/engines/morphological/morphological_input.h"
#include "tb/run/pixel_history.h"

namespace deburr::tb {

class MorphologicalHistory {
 public:
  explicit MorphologicalHistory(const PixelAddress& pixel) : pixel_(pixel) {}

  // Starts the next frame, of this width, and discards observations of the previous one.
  void begin(int width);
  void see(const spec::morphological::RunDescriptor& run, rtl::Cycle cycle);
  void see(const spec::morphological::LineDescriptor& line, rtl::Cycle cycle);
  struct Delivered {
    spec::morphological::Rgba8 pixel;
    spec::morphological::BlendProbe probe;
    bool first = false, last = false;  // framing signals of its beat: start of frame, end of row
    rtl::Cycle cycle;
  };
  // Records output pixel number `position` of the frame.
  void see(std::size_t position, const Delivered& pixel);
  // `golden`: null if disabled. `ended`: the frame is complete, so nothing more will be observed.
  PixelHistory history(const MorphologicalInput& frame, bool ended,
                       const golden::morphological::MorphologicalGolden* golden) const;

 private:
  template <class T>
  using Seen = std::vector<std::pair<T, rtl::Cycle>>;
  // The runs that lie along one side of the pixel.
  struct Side;
  bool is_at(const Side& side, const spec::morphological::RunDescriptor& run) const;
  bool is_near(const spec::morphological::RunDescriptor& run) const;
  void add_side(const Side& side, const golden::morphological::MorphologicalGolden* golden,
                const PixelSides& came, PixelHistory& all) const;

  PixelAddress pixel_;
  int width_ = 0;
  Seen<spec::morphological::RunDescriptor> runs_;
  Seen<spec::morphological::LineDescriptor> lines_;
  std::vector<Delivered> delivered_;  // one, if the engine is correct
};

}  // namespace deburr::tb
