// SPDX-License-Identifier: MIT
// Software driver of the texture unit: loads textures, writes descriptors, invalidates the cache,
// reads counters. Quads and colours are transferred over its links.
//
//   TextureMemory textures;
//   const int handle = textures.add(levels, sampler);
//   TextureDriver driver(registers, memory);
//   driver.identify();
//   driver.load(textures.bytes());
//   driver.set_texture(handle, textures.descriptors()[handle]);      // a reset clears it
//   // ... quads in, until driver.idle() and all colours are out
//
// A driver advances simulated time only through its buses. The unit returns zero for an invalid
// descriptor and accepts one that is written while it is busy: both are errors here.
#pragma once

#include <cstdint>
#include <span>

#include "rtl_model/platform/engine_driver.h"
#include "rtl_model/platform/host.h"
#include "rtl_model/platform/texture_memory.h"
#include "spec/texture/descriptor.h"

namespace deburr::platform {

// Counts since the counters were cleared.
struct TextureWork {
  std::uint32_t fragments = 0, bilinears = 0, line_fills = 0, clamped = 0, saturated = 0,
                memory_errors = 0, invalid_fragments = 0;
};

class TextureDriver final : public EngineDriver {
 public:
  // Both must outlive the driver.
  TextureDriver(RegisterBus& registers, HostMemory& memory)
      : EngineDriver(registers, layout()), memory_(memory) {}

  // Writes bytes from address 0 on. ConfigError if the memory is too small.
  void load(std::span<const std::uint8_t> bytes);
  // ConfigError if handle, size, number of levels or a base is out of range, or levels overlap or
  // exceed the memory.
  void set_texture(int handle, const spec::texture::Descriptor& descriptor);
  // Invalidates the cache after a change of memory.
  void invalidate();

  TextureWork work();

 private:
  static DriverLayout layout();
  void check(int handle, const spec::texture::Descriptor& descriptor) const;

  HostMemory& memory_;
};

}  // namespace deburr::platform
