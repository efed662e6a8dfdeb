// SPDX-License-Identifier: MIT
// Inputs of a morphological engine in the bindings to other languages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "golden/c/parameter_texts.h"
#include "golden/morphological/planes.h"
#include "spec/morphological/parameters.h"

namespace deburr::golden::c {

inline ParameterTexts<spec::morphological::Parameters> morphological_texts() {
  return {"morphological", [](const spec::morphological::Parameters& p) {
            return spec::morphological::preset_parameters(p.preset, p.quality);
          }};
}

// Edges of a frame, one byte per pixel, rows `distance` bytes apart: bit 0 to the left neighbour,
// bit 1 to the upper one. Throws ArgumentError if the neighbour is outside the frame.
morphological::EdgePlanes edge_planes(std::span<const std::uint8_t> edges, std::size_t distance,
                                      int width, int height);

}  // namespace deburr::golden::c
