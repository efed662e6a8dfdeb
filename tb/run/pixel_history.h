// SPDX-License-Identifier: MIT
// Everything that happened to one pixel in a run, step by step, golden and hardware side by side:
// `pixel` of result.json, a table of the report, a few lines of the terminal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
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
void reject_outside(const PixelAddress& pixel, int width, int height);

struct PixelStep {
  std::string part;              // "fragment 0": which of several that the pixel has
  std::string step, item;        // "level", "samples"
  std::string golden, hardware;  // empty: not known there, or not there
  std::optional<std::uint64_t> clock{};
  bool differs = false;
  bool detail = false;  // the terminal leaves it out
};

// Which sides came so far: what such a side does not have then, it lacks.
struct PixelSides {
  bool golden = false, hardware = false;
};

struct PixelHistory {
  PixelAddress pixel{};
  std::string note{};  // why it is empty or not whole
  std::vector<PixelStep> steps{};

  // A value, which may be kept on one side alone: it differs where both texts are there and differ.
  void compare(PixelStep step);
  // An event: it differs too where one side has it and the other came so far and does not.
  void compare(PixelStep step, const PixelSides& came);
  // Records, so many on each side, in an order that both have. One that a side lacks spoils no
  // other. `same` compares two of them, and not their texts; `row` writes a step of one or both.
  using Record = std::optional<std::size_t>;
  void compare_records(std::size_t golden, std::size_t hardware,
                       const std::function<bool(std::size_t, std::size_t)>& same,
                       const std::function<PixelStep(Record, Record)>& row, const PixelSides& came);
  // The steps of another part of the engine, and its note.
  void append(const PixelHistory& other);
  std::size_t differences() const;
};

// The table for a terminal: no details but those that differ, so many rows at most; `report` has
// all of them.
std::string text_of(const PixelHistory& history, const std::string& report);

}  // namespace deburr::tb
