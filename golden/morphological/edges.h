// SPDX-License-Identifier: MIT
// Left and top edge bits of a frame: raw edges from luma, depth or both, then local contrast.
//
// Second block; docs/reference/morphological/algorithm.md, "Edges". Source: equations (2) and (3)
// of paper 003; the symmetric local contrast and the dynamic luma except `current` are from this
// project.
#pragma once

#include <cstdint>

#include "golden/morphological/luma.h"
#include "golden/morphological/planes.h"
#include "spec/morphological/parameters.h"

namespace deburr::golden::morphological {

// The two pixels of an edge, which is the left or the top edge of p.
struct PixelPair {
  std::int32_t luma_p = 0, luma_q = 0;     // U8.16
  std::uint32_t depth_p = 0, depth_q = 0;  // U24
};

// Whether the dynamic threshold of the pair is the floor.
bool floor_decides(const spec::morphological::Parameters& parameters, const PixelPair& pair);

// The edges of a frame. A missing depth reads as 0.
EdgePlanes find_edges(const spec::morphological::Parameters& parameters, const ImageView& image,
                      const DepthView& depth = {});

}  // namespace deburr::golden::morphological
