// SPDX-License-Identifier: MIT
// Inputs of the smoothing engines: pixels and depths.
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

// The views refer to the arrays, or to a copy where the layout differs.
struct FramePixels {
  py::array array;
  golden::morphological::ViewOf<Rgba8> view;
};
FramePixels frame_pixels(const py::handle& given);

// Depths of a frame: near / w, 0..1, as float32, or U24 codes as uint32.
struct FrameDepth {
  std::vector<std::uint32_t> codes;
  golden::morphological::ViewOf<std::uint32_t> view;  // empty: no depth was given
};
// Raises a ValueError or a warning by spec/depth_check.h. `depths` is float32 or uint32, in rows
// without gaps. The warning names the caller at this stack level: 1 is the calling Python function,
// 2 its caller.
void check_depths(const py::array& depths, py::ssize_t level);
FrameDepth frame_depth(const py::handle& given, int width, int height);

// A predicate: memory answers the line at this address with an error. `given` lists the addresses.
std::function<bool(std::uint32_t)> error_lines(const py::handle& given);

}  // namespace deburr::python
