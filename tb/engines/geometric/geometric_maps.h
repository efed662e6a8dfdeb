// SPDX-License-Identifier: MIT
// What the geometric engine did for each pixel of a frame: lines across it, candidates that passed,
// reads of its depth, the share that it took of its neighbours. From the observers of the engine
// and the accesses that its memory saw.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "rtl_model/geometric/geometric_engine.h"
#include "spec/geometric/packets.h"
#include "tb/run/picture_map.h"

namespace deburr::tb {

class GeometricMaps {
 public:
  // The next frame; what was seen of the one before is forgotten.
  void begin(int width, int height);
  void see(const spec::geometric::Candidate& candidate);
  void see(const spec::geometric::BlockRecord& block);
  // `line_of`: the address of the line of memory with the depth of a pixel. `reads`: every line
  // that was read since the frame began. `only_frame`: the engine's counters are of this frame, and
  // its maps must come to them.
  std::vector<PictureMap> maps(const rtl::geometric::GeometricEngine& engine,
                               const std::function<std::uint64_t(int x, int y)>& line_of,
                               std::span<const std::uint64_t> reads, bool only_frame) const;

 private:
  std::vector<PictureMap> maps_;  // lines, passed, weight, depth_reads; none before a frame
};

}  // namespace deburr::tb
