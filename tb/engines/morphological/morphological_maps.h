// SPDX-License-Identifier: MIT
// Per-pixel maps of the morphological engine: edges, run lengths, steps of the predictors. Their
// sources are the beats that it delivers and the run descriptors that it stores.
#pragma once

#include <cstddef>
#include <vector>

#include "rtl_model/morphological/morphological_engine.h"
#include "spec/morphological/packets.h"
#include "tb/run/picture_map.h"

namespace deburr::tb {

class MorphologicalMaps {
 public:
  // Starts the next frame and discards observations of the previous one.
  void begin(int width, int height);
  void see(std::size_t position, const spec::morphological::BlendProbe& probe);
  void see(const spec::morphological::RunDescriptor& run);
  void see(const spec::morphological::LineDescriptor& line);
  // `only_frame`: the engine's counters cover this frame only, so the totals of the maps are
  // checked against them.
  std::vector<PictureMap> maps(const rtl::morphological::MorphologicalEngine& engine,
                               bool only_frame) const;

 private:
  std::vector<PictureMap> maps_;  // edges, run_length, steps; empty before the first frame
};

}  // namespace deburr::tb
