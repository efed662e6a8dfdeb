// SPDX-License-Identifier: MIT
// Everything that happened to one pixel in a run, step by step, golden and hardware side by side:
// `pixel` of result.json, a table of the report, a few lines of the terminal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace deburr::tb {

struct PixelAddress {
  int x = 0, y = 0;  // from the left, from the top
  friend bool operator==(const PixelAddress&, const PixelAddress&) = default;
};
// "X,Y"; ConfigError for anything else.
PixelAddress pixel_of(const std::string& text);
// ConfigError for a pixel outside of a picture of this size.
void refuse_outside(const PixelAddress& pixel, int width, int height);

struct PixelStep {
  std::string part;              // "fragment 0": which of several that the pixel has
  std::string step, item;        // "level", "samples"
  std::string golden, hardware;  // empty: it is not known there
  std::optional<std::uint64_t> clock{};
  bool differs = false;
  bool detail = false;  // the terminal leaves it out
};

struct PixelHistory {
  PixelAddress pixel{};
  std::string note{};  // why it is empty or not whole
  std::vector<PixelStep> steps{};

  // A step that both sides know: it differs where their texts do.
  void compare(PixelStep step);
  // The steps of another part of the engine, and its note.
  void append(const PixelHistory& other);
  std::size_t differences() const;
};

// The table for a terminal: no details but those that differ, so many rows at most; `report` has
// all of them.
std::string text_of(const PixelHistory& history, const std::string& report);

}  // namespace deburr::tb
