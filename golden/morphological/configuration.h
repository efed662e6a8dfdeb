// SPDX-License-Identifier: MIT
// Which parameters and frames the engine accepts, and the parameters of a preset.
//
// docs/morphological_engine.md, "Configuration errors"; docs/morphological_smaa.md, "Presets" and
// "Errors".
#pragma once

#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"

namespace deburr::golden::morphological {

// The defaults with the rules of a preset applied, after those of the quality if it has any.
spec::morphological::Parameters preset_parameters(
    spec::morphological::Preset preset,
    spec::morphological::Quality quality = spec::morphological::Quality::kHigh);

// These with what following the geometric engine sets; edges stay as they are where the threshold
// is dynamic.
spec::morphological::Parameters following_geometric(spec::morphological::Parameters parameters);

// Throws ConfigError: a value out of its range, or a mix that the engine does not have.
void check_parameters(const spec::morphological::Parameters& parameters);
// Throws ConfigError: no pixels, over 8192 pixels a side, wider than the line buffers.
void check_frame(const spec::morphological::Parameters& parameters, int width, int height);

// R, the reach in rows.
inline int reach_rows(const spec::morphological::Parameters& p) { return p.window_rows / 2 - 1; }
// Longest run of an axis, and how far a run may be extended.
inline int reach(const spec::morphological::Parameters& p, spec::morphological::Axis axis) {
  return axis == spec::morphological::Axis::kHorizontal ? p.reach_columns : reach_rows(p);
}

}  // namespace deburr::golden::morphological
