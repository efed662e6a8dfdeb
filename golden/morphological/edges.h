// SPDX-License-Identifier: MIT
// Left and top edge bits of a frame: raw edges from luma, depth or both, then local contrast.
//
// Second block; docs/reference/morphological/algorithm.md, "Edges". Equations (2) and (3) of paper
// 003; the symmetric form of local contrast, and all but `current` of the dynamic luma, are ours.
#pragma once

#include <cstdint>

#include "golden/morphological/luma.h"
#include "golden/morphological/planes.h"
#include "spec/morphological/parameters.h"

namespace deburr::golden::morphological {

// Two pixels beside an edge: the edge is the left or top edge of p.
struct PixelPair {
  std::int32_t luma_p = 0, luma_q = 0;     // U8.16
  std::uint32_t depth_p = 0, depth_q = 0;  // U24
};

// Whether the floor is what a dynamic threshold compares the pair with.
bool floor_decides(const spec::morphological::Parameters& parameters, const PixelPair& pair);

// The edges of a whole frame. A missing depth reads 0 everywhere.
EdgePlanes find_edges(const spec::morphological::Parameters& parameters, const ImageView& image,
                      const DepthView& depth = {});

}  // namespace deburr::golden::morphological
