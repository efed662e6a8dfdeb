// SPDX-License-Identifier: MIT
// Camera motions for sequences in which flicker is measured.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "tb/scene/scenes.h"

namespace deburr::tb {

enum class Motion : std::uint8_t {
  kZoom,  // the field of view shrinks by 1 % per frame
  kRoll,  // 3 degrees per frame about the view direction: 30 frames cover every direction once
  kPan    // sideways by 1/400 of the field of view per frame
};
inline constexpr std::array<std::string_view, 3> kMotionNames = {"zoom", "roll", "pan"};

// A frame of a camera motion.
struct CameraMove {
  Motion motion = Motion::kRoll;
  int frame = 0;
};

// The camera, rotated clockwise about the view direction; 0 returns it unchanged, bit for bit.
Camera rolled(const Camera& camera, double degrees);

// The camera at frame 0, 1, 2, ... of a motion; frame 0 is the camera unchanged, bit for bit.
Camera moved(const Camera& camera, Motion motion, int frame);

}  // namespace deburr::tb
