// SPDX-License-Identifier: MIT
#include "golden/morphological/configuration.h"

#include <string>

#include "spec/error.h"

namespace deburr::golden::morphological {

spec::morphological::Parameters following_geometric(spec::morphological::Parameters p) {
  const spec::morphological::FollowingRules configuration;
  p.bypass = configuration.bypass;
  if (p.threshold_mode == spec::morphological::ThresholdMode::kDynamic) return p;
  p.edge_source = configuration.edge_source;
  p.threshold_on_depth_edge = configuration.threshold_on_depth_edge;
  p.threshold_off_depth_edge = configuration.threshold_off_depth_edge;
  return p;
}

void check_frame(const spec::morphological::Parameters& parameters, int width, int height) {
  const std::string size = std::to_string(width) + " x " + std::to_string(height);
  if (width < 1 || height < 1 || width > spec::morphological::kMaxFrameSize ||
      height > spec::morphological::kMaxFrameSize) {
    throw spec::ConfigError("a frame of " + size + " pixels; width and height must be 1..8192");
  }
  if (width > parameters.line_pixels) {
    throw spec::ConfigError("a frame of " + size + " pixels is wider than the line buffers of " +
                            std::to_string(parameters.line_pixels) + " pixels; raise line_pixels");
  }
}

}  // namespace deburr::golden::morphological
