// SPDX-License-Identifier: MIT
// Checks the depths of a frame and gives the error text of the command, the C interface and Python.
// Depths are near / w as real numbers, or codes U24 (docs/reference/morphological/algorithm.md,
// "Conversion of images").
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace deburr::spec {

inline constexpr std::uint32_t kLargestDepth = 0xFFFFFF;  // U24

// Number of values with a property, and the index of the first one.
struct Found {
  std::size_t number = 0, first = 0;
  void add(std::size_t index) {
    if (number++ == 0) first = index;
  }
  // "12 of 300 values ..., the first at (3, 4)"
  std::string in_words(std::size_t values, std::size_t width, std::string_view what) const {
    return std::to_string(number) + " of " + std::to_string(values) + " values " +
           std::string(what) + ", the first at (" + std::to_string(first % width) + ", " +
           std::to_string(first / width) + ")";
  }
};

class DepthCheck {
 public:
  // Adds the next value; a real number as its binary32 pattern.
  void add_binary32(std::uint32_t pattern) {
    constexpr std::uint32_t kOne = 0x3F800000, kInfinity = 0x7F800000, kSign = 0x80000000;
    const std::uint32_t magnitude = pattern & ~kSign;
    if (magnitude > kInfinity)
      nan_.add(values_);
    else if (magnitude > kOne || pattern > kSign)
      outside_.add(values_);
    ++values_;
  }
  void add_code(std::uint32_t code) {
    if (code > kLargestDepth) wide_.add(values_);
    ++values_;
  }

  // The reason to reject the depths, or an empty text.
  std::string error(std::size_t width) const {
    if (nan_.number > 0)
      return nan_.in_words(values_, width, "are NaN") +
             ": write 0 (infinitely far) for empty pixels, and render the others again";
    if (wide_.number > 0)
      return wide_.in_words(values_, width, "lie outside 0.." + std::to_string(kLargestDepth)) +
             ": a depth has 24 bits; clear the bits above them, such as a stencil";
    return {};
  }
  // The conversion applied to the depths, or an empty text.
  std::string note(std::size_t width) const {
    if (outside_.number == 0) return {};
    return outside_.in_words(values_, width, "lie outside [0, 1]") +
           ": they are clamped for edges from depth, so steps between them are lost";
  }

 private:
  std::size_t values_ = 0;
  Found nan_, outside_, wide_;
};

}  // namespace deburr::spec
