// SPDX-License-Identifier: MIT
#include "tb/engines/texture/texture_setup.h"

#include <algorithm>

namespace deburr::tb {

rtl::texture::LatencyFifo::MemoryClocks memory_clocks(const TextureSetup& setup) {
  const std::int32_t bytes = setup.memory.bytes_per_clock, line = setup.texture.cache_line_bytes;
  const std::int32_t transfer = bytes == 0 ? 1 : std::max(1, line / bytes);
  return {std::max(setup.memory.latency, setup.memory.latency_max), transfer};
}

}  // namespace deburr::tb
