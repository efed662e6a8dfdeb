// SPDX-License-Identifier: MIT
// Parameters that replace the scene's camera.
#pragma once

#include <string>

#include "tb/scene/scenes.h"

namespace deburr::tb {

struct CameraParameters {
  std::string eye, target;
  double fov = 0, roll = 0;
};

template <class Visitor>
void describe(CameraParameters& p, Visitor& v) {
  v.text("eye", p.eye, "x,y,z or list",
         "Camera position that replaces the scene's own; a list gives one per frame.");
  v.text("target", p.target, "x,y,z or list",
         "Point that the camera looks at, instead of the scene's own; a list gives one per frame.");
  v.real("fov", p.fov, 0, 3.1, "radian", "Vertical field of view; 0: the scene's own.");
  v.real("roll", p.roll, -180, 180, "degree",
         "Turns the camera clockwise about its view direction.");
}

// Applies the camera to the scene. Throws ConfigError for an invalid position or a missing target.
void look(Scene& scene, const CameraParameters& parameters);

}  // namespace deburr::tb
