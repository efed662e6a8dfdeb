// SPDX-License-Identifier: MIT
// Checks whether the engine accepts a frame: docs/reference/morphological/index.md, "Configuration
// errors". Build parameters are checked in spec/morphological/check_build.h.
#pragma once

#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"

namespace deburr::golden::morphological {

using spec::morphological::preset_parameters;

// The parameters for a frame from the geometric engine. With a dynamic threshold the edge
// parameters are unchanged.
spec::morphological::Parameters following_geometric(spec::morphological::Parameters parameters);

// Throws ConfigError if the frame is empty, over 8192 pixels per side, or wider than the line
// buffers.
void check_frame(const spec::morphological::Parameters& parameters, int width, int height);

// R: search range in rows.
inline int search_rows(const spec::morphological::Parameters& p) { return p.window_rows / 2 - 1; }
// Search range of an axis: the longest run, and the limit of its extension.
inline int search_range(const spec::morphological::Parameters& p, spec::morphological::Axis axis) {
  return axis == spec::morphological::Axis::kHorizontal ? p.search_columns : search_rows(p);
}

}  // namespace deburr::golden::morphological
