// SPDX-License-Identifier: MIT
// The morphological engine as software sees it: rules, size and place of its frames, the learned
// weights, counters. Pixels come and go over its links, a beat at a time (pixel_beat()).
//
//   MorphologicalDriver driver(registers, parameters, &memory);   // as the engine was built
//   driver.identify();
//   driver.place(base);                  // with storage = memory
//   driver.set_size(width, height);      // of the frames to come; a reset puts it back to 0
//   // ... beats in, until driver.idle() and all beats are out
//   work = driver.work();
//
// A driver takes no simulated time but what its bus takes. The engine takes a frame whatever lies
// in memory, and ignores what is written while a frame is inside: both are errors here.
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
  // Both must outlive the driver. Of `memory`, with storage = memory, the size alone counts: that a
  // frame fits into it; nullptr: unknown.
  MorphologicalDriver(RegisterBus& registers, const spec::morphological::Parameters& built,
                      const HostMemory* memory = nullptr)
      : EngineDriver(registers, layout()), built_(built), memory_(memory) {}

  // The rules and thresholds of the frames to come; of blocks that are not built they stay off.
  void set_configuration(const spec::morphological::Parameters& configuration);
  // Where frames lie with storage = memory. ConfigError unless it is a multiple of 64.
  void place(std::uint32_t base);
  // ConfigError for 0, over 8192, wider than line_pixels, or more than fits into memory from the
  // base on.
  void set_size(int width, int height);
  // All of the learned weights, as they are from the next frame on; a reset leaves them.
  // SimulationError if the engine's sum of them is another one.
  void load_weights(std::span<const std::int8_t> entries);

  // Since the counters were cleared.
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
