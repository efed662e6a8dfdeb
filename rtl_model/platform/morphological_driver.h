// SPDX-License-Identifier: MIT
// Software driver of the morphological engine: configuration, frame size and position, learned
// weights, counters. Pixels are transferred over its links, one beat at a time (pixel_beat()).
//
//   MorphologicalDriver driver(registers, parameters, &memory);   // as the engine was built
//   driver.identify();
//   driver.place(base);                  // with storage = memory
//   driver.set_size(width, height);      // of the frames to come; a reset puts it back to 0
//   // ... beats in, until driver.idle() and all beats are out
//   work = driver.work();
//
// A driver advances simulated time only through its bus. The engine does not check the frame's
// position in memory and ignores writes while a frame is inside: both are errors here.
#pragma once

#include <cstdint>
#include <span>

#include "rtl_model/platform/engine_driver.h"
#include "rtl_model/platform/host.h"
#include "rtl_model/platform/morphological_records.h"
#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"

namespace deburr::platform {

class MorphologicalDriver final : public EngineDriver {
 public:
  // Both must outlive the driver. Of `memory` only the size is used (storage = memory), to check
  // that a frame fits; nullptr: unknown size.
  MorphologicalDriver(RegisterBus& registers, const spec::morphological::Parameters& built,
                      const HostMemory* memory = nullptr)
      : EngineDriver(registers, layout()), built_(built), memory_(memory) {}

  // Sets the configuration and thresholds of the next frames; units that are not built stay off.
  void set_configuration(const spec::morphological::Parameters& configuration);
  // Sets the frame base for storage = memory. ConfigError unless it is a multiple of 64.
  void place(std::uint32_t base);
  // ConfigError for 0, over 8192, wider than line_pixels, or more than fits into memory from the
  // base on.
  void set_size(int width, int height);
  // Loads all learned weights, effective from the next frame on; a reset keeps them.
  // SimulationError if the engine's checksum differs.
  void load_weights(std::span<const std::int8_t> entries);

  // Counts since the counters were cleared.
  spec::morphological::Work work();
  // Cycles of the last frame, from its first input beat to its last output beat.
  std::uint32_t frame_cycles();

 private:
  static DriverLayout layout();

  spec::morphological::Parameters built_;
  const HostMemory* memory_;
  std::uint32_t base_ = 0;
};

}  // namespace deburr::platform
