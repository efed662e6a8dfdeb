// SPDX-License-Identifier: MIT
#include "tb/engines/texture/texture_setup.h"

#include <algorithm>

#include "rtl_model/texture/texture_unit.h"

namespace deburr::tb {

std::int32_t fifo_depth(const TextureSetup& setup) {
  if (setup.texture.cache_fifo_depth != 0) return setup.texture.cache_fifo_depth;
  constexpr std::int32_t kMost = 4096;
  const std::int32_t bytes = setup.memory.bytes_per_clock, line = setup.texture.cache_line_bytes;
  const std::int32_t transfer = bytes == 0 ? 1 : std::max(1, line / bytes);
  const std::int32_t latency = std::max(setup.memory.latency, setup.memory.latency_max);
  return std::min(rtl::texture::LatencyFifo::depth_for(latency, transfer), kMost);
}

}  // namespace deburr::tb
