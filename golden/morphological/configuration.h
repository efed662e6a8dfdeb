// SPDX-License-Identifier: MIT
// Which frames the engine accepts: docs/reference/morphological/index.md, "Configuration errors".
// Parameters: spec/morphological/check_build.h.
#pragma once

#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"

namespace deburr::golden::morphological {

using spec::morphological::preset_parameters;

// These with what following the geometric engine sets; edges stay as they are where the threshold
// is dynamic.
spec::morphological::Parameters following_geometric(spec::morphological::Parameters parameters);

// Throws ConfigError: no pixels, over 8192 pixels a side, wider than the line buffers.
void check_frame(const spec::morphological::Parameters& parameters, int width, int height);

// R, the reach in rows.
inline int search_rows(const spec::morphological::Parameters& p) { return p.window_rows / 2 - 1; }
// Longest run of an axis, and how far a run may be extended.
inline int search_range(const spec::morphological::Parameters& p, spec::morphological::Axis axis) {
  return axis == spec::morphological::Axis::kHorizontal ? p.search_columns : search_rows(p);
}

}  // namespace deburr::golden::morphological
