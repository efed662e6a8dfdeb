// SPDX-License-Identifier: MIT
#include "golden/c/frame_handle.h"

#include <algorithm>
#include <cstring>

namespace deburr::golden::c {
namespace {

constexpr std::uint32_t kMaxFrameSide = 8192;
constexpr std::uint32_t kPixelBytes = 4;

// Index of a plane; ArgumentError if it is unknown or was not computed.
std::size_t plane_named(const FrameHandle& handle, const char* name) {
  require_pointer(name, "plane");
  const std::span<const Plane> planes = handle.planes();
  const auto found = std::find_if(planes.begin(), planes.end(),
                                  [&](const Plane& plane) { return plane.name == name; });
  if (found == planes.end()) {
    std::vector<std::string> known;
    for (const Plane& plane : planes) known.emplace_back(plane.name);
    reject_name("plane", name, known);
  }
  require(handle.result_size().width != 0,
          "no frame has been smoothed: call deburr_frame_process first");
  require(!found->detail || handle.has_detail(),
          "the plane '" + std::string(name) +
              "' was not kept: call deburr_frame_detail with 1 before deburr_frame_process");
  return static_cast<std::size_t>(found - planes.begin());
}

void require_pixel(std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height) {
  require_below(x, width, "x");
  require_below(y, height, "y");
}

}  // namespace

void require_depths(const spec::DepthCheck& check, std::size_t width) {
  if (const std::string error = check.error(width); !error.empty())
    throw ArgumentError("depth: " + error);
}

void require_frame(const FrameHandle& handle) {
  require(handle.width != 0, "no frame was begun: call deburr_frame_begin first");
}

}  // namespace deburr::golden::c

using deburr::golden::c::array_of;
using deburr::golden::c::call_of;
using deburr::golden::c::FrameHandle;
using deburr::golden::c::require;
using deburr::golden::c::require_depths;
using deburr::golden::c::require_frame;
using deburr::golden::c::require_pointer;
using deburr::golden::c::row_distance;

extern "C" {

int deburr_frame_begin(deburr_golden* golden, uint32_t width, uint32_t height) {
  return call_of<FrameHandle>(golden, __func__, [&](FrameHandle& h) {
    constexpr std::uint32_t kMax = deburr::golden::c::kMaxFrameSide;
    require(width >= 1 && height >= 1 && width <= kMax && height <= kMax,
            "a frame of " + std::to_string(width) + " x " + std::to_string(height) +
                " pixels; width and height must be 1..8192");
    const std::size_t count = std::size_t{width} * height;
    // Allocate both before any change: without memory nothing changes.
    std::vector<deburr::golden::c::Rgba8> pixels(count, {0, 0, 0, 255});
    std::vector<std::uint32_t> depth(count);
    h.begin_frame();
    h.pixels.swap(pixels);
    h.depth.swap(depth);
    h.has_depth = false;
    h.width = width;
    h.height = height;
  });
}

int deburr_frame_pixels(deburr_golden* golden, const uint8_t* pixels, size_t pixels_size,
                        uint32_t stride) {
  return call_of<FrameHandle>(golden, __func__, [&](FrameHandle& h) {
    require_frame(h);
    const auto given = array_of(pixels, pixels_size, "pixels");
    const std::size_t row = std::size_t{h.width} * deburr::golden::c::kPixelBytes;
    const std::size_t distance = row_distance("pixels", pixels_size, row, h.height, stride);
    for (std::uint32_t y = 0; y < h.height; ++y)
      std::memcpy(h.pixels.data() + h.index(0, y), given.data() + y * distance, row);
  });
}

int deburr_frame_depth(deburr_golden* golden, const uint32_t* depth, size_t depth_size,
                       uint32_t stride) {
  return call_of<FrameHandle>(golden, __func__, [&](FrameHandle& h) {
    require_frame(h);
    const auto given = array_of(depth, depth_size, "depth");
    const std::size_t distance = row_distance("depth", depth_size, h.width, h.height, stride);
    deburr::spec::DepthCheck check;
    for (std::uint32_t y = 0; y < h.height; ++y)
      for (std::uint32_t x = 0; x < h.width; ++x) check.add_code(given[y * distance + x]);
    require_depths(check, h.width);
    for (std::uint32_t y = 0; y < h.height; ++y)
      for (std::uint32_t x = 0; x < h.width; ++x) h.depth[h.index(x, y)] = given[y * distance + x];
    h.has_depth = true;
  });
}

int deburr_frame_put(deburr_golden* golden, uint32_t x, uint32_t y, uint32_t rgba, uint32_t depth) {
  return call_of<FrameHandle>(golden, __func__, [&](FrameHandle& h) {
    require_frame(h);
    deburr::golden::c::require_pixel(x, y, h.width, h.height);
    deburr::golden::c::require_below(depth, std::uint64_t{deburr::spec::kLargestDepth} + 1,
                                     "depth");
    for (std::size_t i = 0; i < 4; ++i)
      h.pixels[h.index(x, y)][i] = static_cast<std::uint8_t>(rgba >> (8 * i));
    h.depth[h.index(x, y)] = depth;
    h.has_depth = true;
  });
}

int deburr_frame_detail(deburr_golden* golden, uint32_t everything) {
  return call_of<FrameHandle>(golden, __func__, [&](FrameHandle& h) {
    require(everything <= 1, "everything is " + std::to_string(everything) + "; it must be 0 or 1");
    h.keep_everything(everything == 1);
  });
}

int deburr_frame_process(deburr_golden* golden) {
  return call_of<FrameHandle>(golden, __func__, [](FrameHandle& h) {
    require_frame(h);
    h.process();
  });
}

int deburr_plane_shape(deburr_golden* golden, const char* plane, uint32_t* width, uint32_t* height,
                       uint32_t* pixel_bytes) {
  return call_of<FrameHandle>(golden, __func__, [&](FrameHandle& h) {
    require_pointer(width, "width");
    require_pointer(height, "height");
    require_pointer(pixel_bytes, "pixel_bytes");
    *pixel_bytes = h.planes()[deburr::golden::c::plane_named(h, plane)].pixel_bytes;
    *width = h.result_size().width;
    *height = h.result_size().height;
  });
}

int deburr_plane(deburr_golden* golden, const char* plane, uint8_t* values, size_t values_size,
                 uint32_t stride) {
  return call_of<FrameHandle>(golden, __func__, [&](FrameHandle& h) {
    const std::size_t which = deburr::golden::c::plane_named(h, plane);
    const std::size_t bytes = h.planes()[which].pixel_bytes;
    const auto to = array_of(values, values_size, "values");
    const auto [width, height] = h.result_size();
    const std::size_t distance = row_distance("values", values_size, width * bytes, height, stride);
    for (std::uint32_t y = 0; y < height; ++y) {
      for (std::uint32_t x = 0; x < width; ++x) {
        const auto pixel = h.plane_pixel(which, static_cast<int>(x), static_cast<int>(y));
        std::memcpy(to.data() + y * distance + x * bytes, pixel.data(), bytes);
      }
    }
  });
}

int deburr_plane_pixel(deburr_golden* golden, const char* plane, uint32_t x, uint32_t y,
                       uint32_t* value) {
  return call_of<FrameHandle>(golden, __func__, [&](FrameHandle& h) {
    const std::size_t which = deburr::golden::c::plane_named(h, plane);
    require_pointer(value, "value");
    deburr::golden::c::require_pixel(x, y, h.result_size().width, h.result_size().height);
    const auto pixel = h.plane_pixel(which, static_cast<int>(x), static_cast<int>(y));
    *value = 0;
    for (std::size_t i = 0; i < h.planes()[which].pixel_bytes; ++i)
      *value |= std::uint32_t{pixel[i]} << (8 * i);
  });
}

}  // extern "C"
