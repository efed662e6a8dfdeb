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

// Of a composition, where others have memories too.
inline constexpr std::string_view kMorphologicalMemory = "frame_memory";

struct MorphologicalSetup {
  spec::morphological::Parameters morphological;
  MemoryParameters memory;   // storage = memory only
  bool descriptors = false;  // runs and lines inside the engine are compared too
  std::uint32_t pixel_base = 0;
  // Loaded before the first frame; else the engine has those that it was built with.
  std::optional<golden::morphological::WeightTables> weights = std::nullopt;
  // A golden model that has worked on the frames, which are all the same, already; null: it works
  // here. Its parameters may differ in what is built. Never with errors of memory.
  std::shared_ptr<const golden::morphological::MorphologicalGolden> expectation = nullptr;
};

}  // namespace deburr::tb
