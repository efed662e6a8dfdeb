// SPDX-License-Identifier: MIT
#include "golden/morphological/configuration.h"

#include <string>

#include "spec/error.h"
#include "spec/range_check.h"

namespace deburr::golden::morphological {
namespace {

// The row of kQualities that p names.
void apply_quality(spec::morphological::Parameters& p) {
  for (const spec::morphological::QualityRow& row : spec::morphological::kQualities) {
    if (row.quality != p.quality) continue;
    p.threshold = row.threshold;
    p.search_steps = row.search_steps;
    p.diagonals = row.diagonals;
    p.diagonal_steps = row.diagonal_steps;
    p.round_corners = row.round_corners;
    p.corner_rounding = row.corner_rounding;
    p.window_rows = row.window_rows;
  }
}

}  // namespace

spec::morphological::Parameters preset_parameters(spec::morphological::Preset preset,
                                                  spec::morphological::Quality quality) {
  spec::morphological::Parameters p;
  p.quality = quality;
  for (const spec::morphological::PresetRow& row : spec::morphological::kPresets) {
    if (row.preset != preset) continue;
    if (row.has_qualities) apply_quality(p);
    p.preset = row.preset;
    p.edge_source = row.edge_source;
    p.threshold_mode = row.threshold_mode;
    p.dynamic_luma = row.dynamic_luma;
    if (row.threshold != 0) p.threshold = row.threshold;
    p.local_contrast = row.local_contrast;
    p.predictor = row.predictor;
    p.steps = row.steps;
    p.contiguous = row.contiguous;
    p.safe = row.safe;
    p.trim = row.trim;
    p.area = row.area;
    p.ends = row.ends;
    p.blend = row.blend;
  }
  return p;
}

spec::morphological::Parameters following_geometric(spec::morphological::Parameters p) {
  const spec::morphological::FollowingRules rules;
  p.leave = rules.leave;
  if (p.threshold_mode == spec::morphological::ThresholdMode::kDynamic) return p;
  p.edge_source = rules.edge_source;
  p.threshold_on_depth_edge = rules.threshold_on_depth_edge;
  p.threshold_off_depth_edge = rules.threshold_off_depth_edge;
  return p;
}

void check_parameters(const spec::morphological::Parameters& parameters) {
  spec::morphological::Parameters p = parameters;
  const spec::RangeCheck ranges{"morphological"};
  describe(p, ranges);
  if (p.window_rows % 2 != 0) {
    throw spec::ConfigError("morphological window_rows = " + std::to_string(p.window_rows) +
                            " is odd; use an even number of rows");
  }
  if (p.steps > reach_rows(p) - 1) {
    throw spec::ConfigError(
        "morphological steps = " + std::to_string(p.steps) + " reach beyond a window of " +
        std::to_string(p.window_rows) +
        " rows; at most window_rows / 2 - 2 = " + std::to_string(reach_rows(p) - 1) + " fit");
  }
  if (p.diagonals && p.diagonal_steps > reach_rows(p)) {
    throw spec::ConfigError("morphological diagonal_steps = " + std::to_string(p.diagonal_steps) +
                            " reach beyond a window of " + std::to_string(p.window_rows) +
                            " rows; they need window_rows of at least " +
                            std::to_string(2 * p.diagonal_steps + 2));
  }
  if (p.threshold_mode == spec::morphological::ThresholdMode::kDynamic) {
    if (p.edge_source == spec::morphological::EdgeSource::kPredicated) {
      throw spec::ConfigError(
          "morphological edges.source = predicated has thresholds of its own; "
          "use edges.threshold_mode = fixed");
    }
    if (p.edge_source == spec::morphological::EdgeSource::kColour) {
      throw spec::ConfigError(
          "morphological edges.source = colour has no luma for a dynamic threshold; "
          "use edges.threshold_mode = fixed, or edges.source = luma");
    }
  }
  if (p.area == spec::morphological::AreaSource::kLearned && (p.diagonals || p.round_corners)) {
    throw spec::ConfigError(
        "morphological area = learned goes with neither diagonals nor round_corners, without which "
        "its shares were learned");
  }
}

void check_frame(const spec::morphological::Parameters& parameters, int width, int height) {
  const std::string size = std::to_string(width) + " x " + std::to_string(height);
  if (width < 1 || height < 1 || width > spec::morphological::kMaxFrameSize ||
      height > spec::morphological::kMaxFrameSize) {
    throw spec::ConfigError("a frame of " + size + " pixels; 1..8192 each way are possible");
  }
  if (width > parameters.line_pixels) {
    throw spec::ConfigError("a frame of " + size + " pixels does not fit line buffers of " +
                            std::to_string(parameters.line_pixels) + " pixels; raise line_pixels");
  }
}

}  // namespace deburr::golden::morphological
