// SPDX-License-Identifier: MIT
// History of one pixel in a run, step by step, with golden model and hardware side by side. It is
// shown under `pixel` in result.json, as a table in the report, and on the terminal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace deburr::tb {

struct PixelAddress {
  int x = 0, y = 0;  // from left, from top
  friend bool operator==(const PixelAddress&, const PixelAddress&) = default;
};
// Parses "X,Y"; throws ConfigError for anything else.
PixelAddress pixel_of(const std::string& text);
// Throws ConfigError for a pixel outside a picture of this size.
void reject_outside(const PixelAddress& pixel, int width, int height);

struct PixelStep {
  std::string part;              // "fragment 0": which of several parts of the pixel
  std::string step, item;        // "level", "samples"
  std::string golden, hardware;  // empty: unknown or missing on that side
  std::optional<std::uint64_t> clock{};
  bool differs = false;
  bool detail = false;  // omitted on the terminal
};

// Which sides have progressed past this step. If such a side does not have the step, the step is
// missing there.
struct PixelSides {
  bool golden = false, hardware = false;
};

struct PixelHistory {
  PixelAddress pixel{};
  std::string note{};  // why the history is empty or incomplete
  std::vector<PixelStep> steps{};

  // Adds a value, which may exist on one side only. The step counts as different if both texts
  // exist and differ.
  void compare(PixelStep step);
  // Adds an event. The step also counts as different if only one side has the event and the other
  // side has progressed past it.
  void compare(PixelStep step, const PixelSides& came);
  // Aligns the records of both sides, which are in the same order. If a record is missing, later
  // records are still aligned. `same` compares two records, not their texts; `row` makes a step
  // from one record or from both.
  using Record = std::optional<std::size_t>;
  void compare_records(std::size_t golden, std::size_t hardware,
                       const std::function<bool(std::size_t, std::size_t)>& same,
                       const std::function<PixelStep(Record, Record)>& row, const PixelSides& came);
  // Appends the steps and the note of another part of the engine.
  void append(const PixelHistory& other);
  std::size_t differences() const;
};

// Table for the terminal, with a limited number of rows and only those details that differ;
// `report` names the file with all of them.
std::string text_of(const PixelHistory& history, const std::string& report);

}  // namespace deburr::tb
