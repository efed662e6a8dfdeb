// SPDX-License-Identifier: MIT
// Edges by colour: left and top edge bits from the largest step of R, G and B.
//
// In place of luma.h where source = colour, with the local contrast of edges.h said once more for
// steps of a byte, whole rows at a time; docs/reference/morphological/algorithm.md,
// "Edges". Ours.
#pragma once

#include "golden/morphological/planes.h"
#include "spec/morphological/parameters.h"

namespace deburr::golden::morphological {

EdgePlanes colour_edges(const spec::morphological::Parameters& parameters, const ImageView& image);

}  // namespace deburr::golden::morphological
