// SPDX-License-Identifier: MIT
// The texture unit as software sees it: textures into memory, descriptors, the cache, counters.
// Quads come and colours go over its links.
//
//   TextureMemory textures;
//   const int handle = textures.add(levels, sampler);
//   TextureDriver driver(registers, memory);
//   driver.identify();
//   driver.load(textures.bytes());
//   driver.set_texture(handle, textures.descriptors()[handle]);      // a reset forgets it
//   // ... quads in, until driver.idle() and all colours are out
//
// A driver takes no simulated time but what its buses take. The unit gives colours of zero for a
// descriptor that is not valid, and takes one that is written while it is busy: both are errors
// here.
#pragma once

#include <cstdint>
#include <span>

#include "rtl_model/platform/engine_driver.h"
#include "rtl_model/platform/host.h"
#include "rtl_model/platform/texture_memory.h"
#include "spec/texture/descriptor.h"

namespace deburr::platform {

// Since the counters were cleared.
struct TextureWork {
  std::uint32_t fragments = 0, bilinears = 0, line_fills = 0, clamped = 0, saturated = 0,
                memory_errors = 0, invalid_fragments = 0;
};

class TextureDriver final : public EngineDriver {
 public:
  // Both must outlive the driver.
  TextureDriver(RegisterBus& registers, HostMemory& memory)
      : EngineDriver(registers, layout()), memory_(memory) {}

  // Bytes from address 0 on. ConfigError if memory is too small.
  void load(std::span<const std::uint8_t> bytes);
  // ConfigError for a handle, size, number of levels or base out of range, levels that overlap or
  // lie beyond the memory.
  void set_texture(int handle, const spec::texture::Descriptor& descriptor);
  // What is in the cache counts no more: after a change of memory.
  void invalidate();

  TextureWork work();

 private:
  static DriverLayout layout();
  void check(int handle, const spec::texture::Descriptor& descriptor) const;

  HostMemory& memory_;
};

}  // namespace deburr::platform
