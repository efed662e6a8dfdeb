// SPDX-License-Identifier: MIT
#include "tb/env/camera_parameters.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "spec/error.h"
#include "tb/scene/motion.h"

namespace deburr::tb {
namespace {

Imath::V3d parse_vector(std::string_view name, std::string_view text) {
  std::array<double, 3> values{};
  const char* at = text.data();
  const char* end = at + text.size();
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [next, error] = std::from_chars(at, end, values[i]);
    const bool last = i == 2;
    if (error != std::errc() || !std::isfinite(values[i]) ||
        (last ? next != end : next == end || *next != ','))
      throw spec::ConfigError(
          fmt::format("'{}' = '{}' must be three numbers separated by commas: x,y,z", name, text));
    at = next + 1;
  }
  return {values[0], values[1], values[2]};
}

}  // namespace

void look(Scene& scene, const CameraParameters& p) {
  if (p.eye.empty() && p.target.empty() && p.fov == 0 && p.roll == 0) return;
  Camera camera = scene.camera;
  if (!p.eye.empty()) {
    camera.eye = parse_vector("scene.eye", p.eye);
    // The scene's near plane was chosen for its own eye position.
    camera.near_plane = Camera{}.near_plane;
  }
  if (!p.target.empty()) camera.target = parse_vector("scene.target", p.target);
  if (p.fov > 0) camera.fov_y = p.fov;
  if (!((camera.target - camera.eye).length() > 0))
    throw spec::ConfigError("'scene.eye' and 'scene.target' are the same point");
  scene.camera = rolled(camera, p.roll);
}

}  // namespace deburr::tb
