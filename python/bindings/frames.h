// SPDX-License-Identifier: MIT
// What engines that smooth frames are given: pixels and depths.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <unordered_set>
#include <vector>

#include "golden/morphological/planes.h"
#include "python/bindings/arrays.h"

namespace deburr::python {

using Rgba8 = std::array<std::uint8_t, 4>;

// The views look into the arrays, or into a copy of them where the elements lie otherwise.
struct FramePixels {
  py::array array;
  golden::morphological::ViewOf<Rgba8> view;
};
FramePixels frame_pixels(const py::handle& given);

// Depths of a frame: near / w, 0..1, as float32, or the codes themselves, U24 as uint32.
struct FrameDepth {
  std::vector<std::uint32_t> codes;
  golden::morphological::ViewOf<std::uint32_t> view;  // empty: no depth was given
};
// ValueError, or a warning, by spec/depth_check.h; of float32 or uint32, in rows without gaps. The
// warning names the line of the Python function at this level: 1 called here, 2 is its caller.
void check_depths(const py::array& depths, py::ssize_t level);
FrameDepth frame_depth(const py::handle& given, int width, int height);

// Whether memory answers a line with an error: of those that begin at these addresses.
std::function<bool(std::uint32_t)> error_lines(const py::handle& given);

}  // namespace deburr::python
