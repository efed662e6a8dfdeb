// SPDX-License-Identifier: MIT
// Per-pixel maps of the geometric engine: lines across a pixel, passed candidates, depth reads,
// blend weight of the neighbours. Their sources are the engine's observers and recorded memory
// accesses.
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
  // Starts the next frame and discards observations of the previous one.
  void begin(int width, int height);
  void see(const spec::geometric::Candidate& candidate);
  void see(const spec::geometric::BlockRecord& block);
  // `line_of`: address of the memory line with the depth of a pixel. `reads`: every line read since
  // the frame started. `only_frame`: the engine's counters cover this frame only, so the totals of
  // the maps are checked against them.
  std::vector<PictureMap> maps(const rtl::geometric::GeometricEngine& engine,
                               const std::function<std::uint64_t(int x, int y)>& line_of,
                               std::span<const std::uint64_t> reads, bool only_frame) const;

 private:
  // Lines, passed, weight, depth_reads; empty before the first frame.
  std::vector<PictureMap> maps_;
};

}  // namespace deburr::tb
