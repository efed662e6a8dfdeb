// SPDX-License-Identifier: MIT
// Edges from colour: left and top edge bits from the largest step of R, G and B.
//
// Replaces luma.h and edges.h with source = colour; local contrast as in edges.h, for steps of one
// byte and whole rows at a time. docs/reference/morphological/learned_weights.md, "Options".
// Source: this project.
#pragma once

#include "golden/morphological/planes.h"
#include "spec/morphological/parameters.h"

namespace deburr::golden::morphological {

EdgePlanes colour_edges(const spec::morphological::Parameters& parameters, const ImageView& image);

}  // namespace deburr::golden::morphological
