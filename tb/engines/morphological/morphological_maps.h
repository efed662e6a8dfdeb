// SPDX-License-Identifier: MIT
// What the morphological engine found and did for each pixel of a frame: edges, lengths of runs,
// steps of the predictors. From the beats that it delivers and the records that it stores.
#pragma once

#include <cstddef>
#include <vector>

#include "rtl_model/morphological/morphological_engine.h"
#include "spec/morphological/packets.h"
#include "tb/run/picture_map.h"

namespace deburr::tb {

class MorphologicalMaps {
 public:
  // The next frame; what was seen of the one before is forgotten.
  void begin(int width, int height);
  void see(std::size_t position, const spec::morphological::BlendProbe& probe);
  void see(const spec::morphological::RunDescriptor& run);
  void see(const spec::morphological::LineDescriptor& line);
  // `only_frame`: the engine's counters are of this frame, and its maps must come to them.
  std::vector<PictureMap> maps(const rtl::morphological::MorphologicalEngine& engine,
                               bool only_frame) const;

 private:
  std::vector<PictureMap> maps_;  // edges, run_length, steps; none before a frame has begun
};

}  // namespace deburr::tb
