// SPDX-License-Identifier: MIT
#include "tb/scene/motion.h"

#include "tb/scene/exact_math.h"

namespace deburr::tb {

Camera rolled(const Camera& camera, double degrees) {
  if (degrees == 0) return camera;
  const Imath::V3d forward = (camera.target - camera.eye).normalized();
  const Imath::V3d right = forward.cross(camera.up).normalized(), up = right.cross(forward);
  const SinCos turn = sin_cos(degrees * kPi / 180);
  Camera result = camera;
  result.up = up * turn.cos + right * turn.sin;
  return result;
}

Camera moved(const Camera& camera, Motion motion, int frame) {
  Camera result = camera;
  switch (motion) {
    case Motion::kZoom:
      for (int i = 0; i < frame; ++i) result.fov_y *= 0.99;
      break;
    case Motion::kRoll:
      return rolled(camera, 3.0 * frame);
    case Motion::kPan: {
      const Imath::V3d forward = camera.target - camera.eye;
      const Imath::V3d right = forward.cross(camera.up).normalized();
      result.target +=
          right * (forward.length() * tangent(camera.fov_y * static_cast<double>(frame) / 400));
      break;
    }
  }
  return result;
}

}  // namespace deburr::tb
