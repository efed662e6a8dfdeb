// SPDX-License-Identifier: MIT
#include "python/bindings/frames.h"

#include <algorithm>
#include <bit>

#include "golden/c/frame_handle.h"
#include "golden/morphological/convert.h"

namespace deburr::python {
namespace {

constexpr py::ssize_t kMaxSide = 8192;
constexpr const char* kPixelsWanted = "uint8 of (height, width, 4)";
constexpr const char* kDepthWanted = "float32 or uint32 of (height, width)";

}  // namespace

FramePixels frame_pixels(const py::handle& given) {
  if (!py::isinstance<py::array>(given)) reject_array("pixels", kPixelsWanted, given);
  auto array = py::reinterpret_borrow<py::array>(given);
  if (array.ndim() != 3 || array.shape(2) != 4 ||
      !array.dtype().equal(py::dtype::of<std::uint8_t>()))
    reject_array("pixels", kPixelsWanted, given);
  const py::ssize_t height = array.shape(0), width = array.shape(1);
  golden::c::require(width >= 1 && height >= 1 && width <= kMaxSide && height <= kMaxSide,
                     "a frame of " + std::to_string(width) + " x " + std::to_string(height) +
                         " pixels; width and height must be 1..8192");
  // Rows may have gaps; any other layout is copied.
  const bool in_rows = array.strides(2) == 1 && array.strides(1) == 4 &&
                       array.strides(0) >= 4 * width && array.strides(0) % 4 == 0;
  if (!in_rows) array = py::array::ensure(array, py::array::c_style);
  if (!array) throw py::error_already_set();
  const auto stride = static_cast<std::size_t>(array.strides(0) / 4);
  const auto rows = static_cast<std::size_t>(height), columns = static_cast<std::size_t>(width);
  const std::span<const Rgba8> pixels(static_cast<const Rgba8*>(array.data()),
                                      (rows - 1) * stride + columns);
  return {array, {pixels, static_cast<int>(width), static_cast<int>(height), stride}};
}

void check_depths(const py::array& depths, py::ssize_t level) {
  const auto size = static_cast<std::size_t>(depths.size());
  const auto width = static_cast<std::size_t>(depths.shape(1));
  spec::DepthCheck check;
  if (depths.dtype().equal(py::dtype::of<float>())) {
    const auto* const values = static_cast<const float*>(depths.data());
    for (std::size_t i = 0; i < size; ++i)
      check.add_binary32(std::bit_cast<std::uint32_t>(values[i]));
  } else {
    const auto* const values = static_cast<const std::uint32_t*>(depths.data());
    for (std::size_t i = 0; i < size; ++i) check.add_code(values[i]);
  }
  golden::c::require_depths(check, width);
  if (const std::string note = check.note(width);
      !note.empty() && PyErr_WarnEx(PyExc_UserWarning, ("depth: " + note).c_str(), level) != 0)
    throw py::error_already_set();
}

FrameDepth frame_depth(const py::handle& given, int width, int height) {
  FrameDepth depth;
  if (given.is_none()) return depth;
  if (!py::isinstance<py::array>(given)) reject_array("depth", kDepthWanted, given);
  const auto any = py::reinterpret_borrow<py::array>(given);
  const bool is_float = any.dtype().equal(py::dtype::of<float>());
  const py::array array =
      checked(given, "depth", is_float ? py::dtype::of<float>() : py::dtype::of<std::uint32_t>(), 2,
              kDepthWanted);
  if (array.shape(0) != height || array.shape(1) != width)
    reject_array(
        "depth",
        "the size of the pixels, (" + std::to_string(height) + ", " + std::to_string(width) + ")",
        given);
  check_depths(array, 2);  // the caller of deburr.golden
  const auto size = static_cast<std::size_t>(array.size());
  depth.codes.resize(size);
  if (is_float) {
    const auto* const values = static_cast<const float*>(array.data());
    for (std::size_t i = 0; i < size; ++i)
      depth.codes[i] =
          golden::morphological::depth_from_binary32(std::bit_cast<std::uint32_t>(values[i]));
  } else {
    const auto* const values = static_cast<const std::uint32_t*>(array.data());
    std::copy_n(values, size, depth.codes.begin());
  }
  depth.view = {depth.codes, width, height};
  return depth;
}

std::function<bool(std::uint32_t)> error_lines(const py::handle& given) {
  if (given.is_none()) return nullptr;
  const py::array array = checked_list<std::uint32_t>(
      given, "error_lines", "uint32 of (lines,), addresses of memory lines");
  const auto addresses = elements<std::uint32_t>(array);
  auto lines =
      std::make_shared<std::unordered_set<std::uint32_t>>(addresses.begin(), addresses.end());
  return [lines](std::uint32_t address) { return lines->contains(address); };
}

}  // namespace deburr::python
