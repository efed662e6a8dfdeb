// SPDX-License-Identifier: MIT
// Cameras that move: the sequences of pictures on which flicker is seen.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "tb/scene/scenes.h"

namespace deburr::tb {

enum class Motion : std::uint8_t {
  kZoom,  // the field of view shrinks by 1 % a frame
  kRoll,  // 3 degrees a frame about the view direction: 30 frames show every direction once
  kPan    // sideways by 1/400 of the field of view a frame
};
inline constexpr std::array<std::string_view, 3> kMotionNames = {"zoom", "roll", "pan"};

// Which frame of which motion of the camera.
struct CameraMove {
  Motion motion = Motion::kRoll;
  int frame = 0;
};

// Turned clockwise about the view direction; 0 gives the camera itself, to the bit.
Camera rolled(const Camera& camera, double degrees);

// The camera at frame 0, 1, 2, ... of a motion; frame 0 is the camera itself, to the bit.
Camera moved(const Camera& camera, Motion motion, int frame);

}  // namespace deburr::tb
