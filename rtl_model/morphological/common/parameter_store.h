// SPDX-License-Identifier: MIT
// The rules of the frame inside, decoded from the registers.
//
// Where: beside the pipe; every block reads the rules of the frame, which stand still while one is
// inside. Timing: a write counts from the next clock edge on; rules are latched with the first
// beat of a frame. A write while a frame is inside is ignored (CONTROL and STATUS excepted) and
// sets a sticky bit. Codes of RULES that no choice has count as code 0; steps are limited to
// window_rows / 2 - 2, those of SMAA's searches to their ranges; what was not built (depth lines
// with source = luma) reads as 0, and `contiguous`, crossings, clamp, tables, diagonals, corners
// and the text guard count as off in an engine that was built without them, and so do learned
// shares, whose registers read 0 then (else: SharesLoader). A reset gives every register its reset
// value; SIZE is 0 then and must be written again. Cost: 15 x 32 flip-flops twice (registers,
// decoded values of the frame inside). Made for 300 MHz; longest path: the least of three 5-bit
// numbers.
#pragma once

#include <cstdint>

#include "rtl_model/fabric/control_registers.h"
#include "spec/morphological/parameters.h"
#include "spec/morphological/registers.h"

namespace deburr::rtl::morphological {

// The frame inside, decoded.
struct FrameRules {
  std::int32_t width = 0, height = 0;  // U14, pixels
  std::uint32_t beats = 0;             // U14, beats a row
  std::uint32_t rows = 0;              // U14, rows of slots: height + R + 5
  std::int32_t last_count = 0;         // U3, lanes of the last beat of a row
  spec::morphological::EdgeSource source{};
  bool dynamic = false;
  spec::morphological::DynamicLuma dynamic_luma{};
  spec::morphological::LocalContrast local_contrast{};
  // Thresholds of luma steps, U8.16.
  std::uint32_t threshold = 0, threshold_on = 0, threshold_off = 0, floor = 0;
  std::uint32_t alpha = 0;            // U0.24
  std::uint32_t depth_threshold = 0;  // U0.16
  spec::morphological::Predictor predictor{};
  std::int32_t steps = 0;  // U5
  bool contiguous = false, safe = false, trim = false, linear_light = false;
  bool crossings = false;               // where runs end
  bool clamp = false;                   // edges beyond the frame are those of the nearest pixel
  bool table = false, learned = false;  // where areas come from
  std::int32_t search_steps = 0;        // U7, 1..112
  std::int32_t diagonal_steps = 0;      // U5, 0: none
  bool corners = false;                 // are rounded
  std::int32_t corner_loss = 0;         // U9, 256 - corner_rounding
  bool strongest = false;               // blend
  spec::morphological::Leave leave{};
  bool text_guard = false;
  std::uint32_t pixel_base = 0;  // bytes
};

// CONTROL and STATUS, for the engine's ControlRegisters.
ControlLayout control_layout();

// What the registers say of a frame; `valid`: its size is one that the engine takes.
struct Decoded {
  FrameRules rules;
  bool valid;
};
Decoded decode(const ControlRegisters& registers, const spec::morphological::Parameters& p);

class ParameterStore {
 public:
  // Gives the registers the reset values that parameters set.
  ParameterStore(ControlRegisters& registers, const spec::morphological::Parameters& parameters);

  // --- Wires to the blocks ---
  // Of the frame inside.
  const FrameRules& rules() const { return rules_; }
  bool enabled() const { return registers_.enabled(); }
  void set_sticky(std::uint32_t status_bits) { registers_.set_sticky(status_bits); }
  // With the first beat of a frame, which from here to leave() is inside; false and a sticky bit if
  // SIZE is out of range.
  bool latch();
  void leave();
  bool frame_inside() const { return inside_; }
  void reset() { inside_ = false; }

  int lanes() const { return lanes_; }
  int reach_rows() const { return reach_rows_; }  // R
  bool has_text_guard() const { return parameters_.text_guard; }

 private:
  ControlRegisters& registers_;
  const spec::morphological::Parameters parameters_;
  const int lanes_, reach_rows_;
  FrameRules rules_;
  bool inside_ = false;
};

}  // namespace deburr::rtl::morphological
