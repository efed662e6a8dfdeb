// SPDX-License-Identifier: MIT
// The rules of the frame under way, decoded from the registers, and where its pixels lie.
//
// Where: beside the pipe; every unit reads the rules, which stand still while a frame is under way.
// Timing: a write counts from the next clock edge on; the rules are latched when START is judged. A
// write while a frame is under way is ignored (CONTROL and STATUS excepted) and sets a sticky bit.
// Codes of RULES that no choice has count as code 0. Cost: the registers, and 60 bits of sizes.
// Made for 250 MHz; longest path: 11 x 11 multiply (words of the TouchedMap).
#pragma once

#include <cstdint>

#include "rtl_model/fabric/control_registers.h"
#include "spec/geometric/parameters.h"
#include "spec/geometric/registers.h"

namespace deburr::rtl::geometric {

struct FrameRules {
  std::int32_t width = 0, height = 0;  // U14, pixels
  spec::geometric::Select select{};
  spec::geometric::Crease crease{};
  spec::geometric::DepthTest depth_test{};
  std::uint32_t depth_bias = 1;  // U5, 1..24
  spec::geometric::Combine combine{};
  bool linear_light = false, mark = false, tiled = false, frame_copy = false;
  std::uint32_t edge_count = 0, vertex_count = 0, face_count = 0;
  std::uint32_t edge_base = 0, vertex_base = 0, face_base = 0, depth_base = 0, colour_base = 0,
                weight_base = 0, copy_base = 0;
  std::uint32_t blocks_across = 0, blocks_down = 0;  // U12
  std::uint32_t words_across = 0;                    // U5, words of the TouchedMap in a row
  std::uint32_t touched_words = 0;                   // U16
  std::uint32_t lines_across = 0;  // raster: lines of memory a row; tiled: tiles across

  // Lines of memory of the colours.
  std::uint32_t frame_lines() const {
    return tiled ? 4 * lines_across * ((static_cast<std::uint32_t>(height) + 7) / 8)
                 : lines_across * static_cast<std::uint32_t>(height);
  }
  // Byte offset of the line of memory (u, v): a multiply 13 x 10.
  std::uint32_t line_offset(std::uint32_t u, std::uint32_t v) const {
    if (!tiled) return (v * lines_across + u) << 6;
    return ((v >> 1) * lines_across + (u >> 1)) << 8 | (v & 1) << 7 | (u & 1) << 6;
  }
};

// CONTROL and STATUS, for the engine's ControlRegisters.
ControlLayout control_layout();

// What the registers say of a frame.
FrameRules decode(const ControlRegisters& registers);
// Why it is not drawn.
spec::geometric::Refusal refusal(const FrameRules& rules, bool enabled,
                                 const spec::geometric::Parameters& parameters);

class ParameterStore {
 public:
  // Gives the registers the reset values that parameters set.
  ParameterStore(ControlRegisters& registers, const spec::geometric::Parameters& parameters);

  // --- Wires to the blocks ---
  const FrameRules& rules() const { return rules_; }
  void set_sticky(std::uint32_t status_bits) { registers_.set_sticky(status_bits); }
  bool enabled() const { return registers_.enabled(); }

  // The registers as they are become the rules; gives what stands against it.
  spec::geometric::Refusal latch(bool enabled);

 private:
  ControlRegisters& registers_;
  const spec::geometric::Parameters parameters_;
  FrameRules rules_;
};

}  // namespace deburr::rtl::geometric
