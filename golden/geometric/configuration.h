// SPDX-License-Identifier: MIT
// Checks whether the engine accepts a frame: docs/reference/geometric/index.md, "START". Build
// parameters are checked in spec/geometric/check_build.h.
#pragma once

#include <cstdint>

#include "spec/geometric/parameters.h"
#include "spec/geometric/registers.h"

namespace deburr::golden::geometric {

using spec::geometric::preset_parameters;

// Sizes in the registers at START.
struct FrameCounts {
  int width = 0, height = 0;                                       // pixels
  std::uint64_t edge_count = 0, vertex_count = 0, face_count = 0;  // records, facing bits
  std::uint64_t boundary_count = 0;                                // boundary edges
};

// Returns the first reason that holds. Never kDisabled, which does not depend on sizes.
spec::geometric::Rejection rejection(const spec::geometric::Parameters& parameters,
                                     const FrameCounts& counts);
// Throws ConfigError with the reason and the limit.
void check_frame(const spec::geometric::Parameters& parameters, const FrameCounts& counts);

// W_t: words of touched bits that the frame needs.
constexpr std::int64_t touched_words(int width, int height) {
  constexpr int kPixels = spec::geometric::kBlocksInWord * spec::geometric::kBlockSize;
  return std::int64_t{(width + kPixels - 1) / kPixels} *
         ((height + spec::geometric::kBlockSize - 1) / spec::geometric::kBlockSize);
}

}  // namespace deburr::golden::geometric
