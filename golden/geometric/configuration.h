// SPDX-License-Identifier: MIT
// Which frames the engine accepts: docs/reference/geometric/index.md, "START". Parameters:
// spec/geometric/check_build.h.
#pragma once

#include <cstdint>

#include "spec/geometric/parameters.h"
#include "spec/geometric/registers.h"

namespace deburr::golden::geometric {

using spec::geometric::preset_parameters;

// What the registers of a start say of its size.
struct FrameCounts {
  int width = 0, height = 0;                                       // pixels
  std::uint64_t edge_count = 0, vertex_count = 0, face_count = 0;  // records, facing bits
  std::uint64_t boundary_count = 0;                                // of the edges
};

// Why the engine rejects a start: the first reason that holds. Never kDisabled, which is not a
// matter of sizes.
spec::geometric::Rejection rejection(const spec::geometric::Parameters& parameters,
                                     const FrameCounts& counts);
// Throws ConfigError that names the rejection and what would be possible.
void check_frame(const spec::geometric::Parameters& parameters, const FrameCounts& counts);

// W_t: words of touched bits that a frame needs.
constexpr std::int64_t touched_words(int width, int height) {
  constexpr int kPixels = spec::geometric::kBlocksInWord * spec::geometric::kBlockSize;
  return std::int64_t{(width + kPixels - 1) / kPixels} *
         ((height + spec::geometric::kBlockSize - 1) / spec::geometric::kBlockSize);
}

}  // namespace deburr::golden::geometric
