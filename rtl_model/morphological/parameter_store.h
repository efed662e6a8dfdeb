// SPDX-License-Identifier: MIT
// Size, rules, thresholds, control, status and counters behind the register socket; the rules of
// the frame inside, decoded.
//
// Where: beside the pipe; every block reads the rules of the frame, which stand still while one is
// inside. Timing: a write counts from the next clock edge on; rules are latched with the first
// beat of a frame. A write while a frame is inside is ignored (CONTROL and STATUS excepted) and
// sets a sticky bit. Codes of RULES that no choice has count as code 0; steps are limited to
// window_rows / 2 - 2; what was not built (depth lines with source = luma) reads as 0, and the rule
// `contiguous` counts as off in an engine that was built without it.
// A reset gives every register its reset value; SIZE is 0 then and must be written again.
// Cost: 12 x 32 flip-flops, thrice (register, frame, decoded products).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <systemc>

#include "rtl_model/fabric/register_block.h"
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
  bool dynamic = false, dynamic_max = false;
  spec::morphological::LocalContrast local_contrast{};
  // Thresholds of luma steps, U8.16: 255 x register.
  std::uint32_t threshold = 0, threshold_on = 0, threshold_off = 0, floor = 0;
  std::uint32_t alpha = 0, depth_threshold = 0;  // U0.16
  spec::morphological::Predictor predictor{};
  std::int32_t steps = 0;  // U5
  bool contiguous = false, safe = false, trim = false, linear_light = false;
  std::uint32_t pixel_base = 0;  // bytes
};

// As the bus shows them, and the docs.
std::span<const RegisterDescription> register_table();

class ParameterStore final : public sc_core::sc_module {
 public:
  RegisterBlock registers;

  ParameterStore(const sc_core::sc_module_name& name,
                 const spec::morphological::Parameters& parameters);
  const char* kind() const override { return "deburr_parameter_store"; }

  // --- Wires to the blocks ---
  // Of the frame inside.
  const FrameRules& rules() const { return rules_; }
  bool enabled() const { return enabled_; }
  void set_sticky(std::uint32_t status_bits) { sticky_ |= status_bits; }
  // With the first beat of a frame, which from here to leave() is inside; false and a sticky bit if
  // SIZE is out of range.
  bool latch();
  void leave();
  bool frame_inside() const { return inside_; }
  void reset();

  int lanes() const { return lanes_; }
  int reach_rows() const { return reach_rows_; }  // R

  // --- Wiring, while the engine is built ---
  void show(std::uint32_t offset, const Counter& counter);
  void show_sum(std::uint32_t offset, const Counter& a, const Counter& b);
  void connect(std::function<void()> clear_counters);
  // As a bus write to SIZE, from outside of time.
  void write_size(int width, int height);

 private:
  void load();
  void written(std::size_t index, std::uint32_t value);
  std::uint32_t value_at(std::uint32_t offset) const;
  void decode();

  const spec::morphological::Parameters parameters_;
  int lanes_, reach_rows_;
  FrameRules rules_, next_;  // of the frame inside; as the registers say
  std::array<std::uint32_t, spec::morphological::kRegisters.size()> kept_{};  // before a write
  bool enabled_ = true, size_valid_ = false, inside_ = false;
  std::uint32_t sticky_ = 0;
  std::function<void()> clear_counters_ = [] {};
};

}  // namespace deburr::rtl::morphological
