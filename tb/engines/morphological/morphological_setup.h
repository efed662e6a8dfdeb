// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "golden/morphological/morphological_golden.h"
#include "spec/morphological/parameters.h"
#include "tb/env/memory_parameters.h"

namespace deburr::tb {

// Name in a composition with several memories.
inline constexpr std::string_view kMorphologicalMemory = "frame_memory";

struct MorphologicalSetup {
  spec::morphological::Parameters morphological;
  MemoryParameters memory;   // only for storage = memory
  bool descriptors = false;  // also compare runs and lines inside the engine
  std::uint32_t pixel_base = 0;
  // Loaded before the first frame; if absent, the engine keeps the weights of its ROMs.
  std::optional<golden::morphological::WeightTables> weights = std::nullopt;
  // A golden model that has already processed the frames, which must be identical; null: it runs
  // with the hardware. Its build parameters may differ. Must be null with memory errors.
  std::shared_ptr<const golden::morphological::MorphologicalGolden> expectation = nullptr;
};

}  // namespace deburr::tb
