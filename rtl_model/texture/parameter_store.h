// SPDX-License-Identifier: MIT
// Texture descriptors, control, status and counters behind the register socket; decodes a
// descriptor when it is written.
//
// Where: beside the pipeline; every block of the address unit reads the decoded descriptor of the
// fragment in hand in the same clock (a 16-entry register file). Timing: a write counts from the
// next clock edge on. Descriptors are static while the unit is busy: a write then sets a sticky
// status bit. Formats: docs/texture_unit.md, registers of a descriptor. Cost: 16 x 544 flip-flops,
// the decoded geometry of each level, a 16-to-1 multiplexer a reader. Source: paper 2.1, the
// parameter store.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <systemc>

#include "rtl_model/fabric/register_block.h"
#include "rtl_model/fabric/unit.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/parameters.h"
#include "spec/texture/registers.h"

namespace deburr::rtl::texture {

// One mip level, decoded.
struct LevelGeometry {
  std::uint32_t base;                       // U32, byte address
  std::uint32_t pitch;                      // U15, bytes a row, layout linear
  std::uint16_t width, height;              // U13, texels
  std::uint8_t tiles_x_log2, tiles_y_log2;  // U4, rounded-up tiles each way, layout tiled
};

// A descriptor, decoded.
struct TextureState {
  bool valid = false;
  std::uint16_t width = 0, height = 0;  // U13
  std::uint8_t levels = 0;              // U4
  std::uint8_t texel_log2 = 0;          // U2, lb of the bytes a texel
  std::uint8_t max_count_log2 = 0;      // U3, lb N_max
  spec::texture::Format format{};
  spec::texture::Layout layout{};
  spec::texture::Wrap wrap_s{}, wrap_t{};
  spec::texture::MinFilter min_filter{};
  spec::texture::MagFilter mag_filter{};
  std::int32_t bias = 0;                  // S7.12
  std::int32_t min_lod = 0, max_lod = 0;  // U8.12
  std::array<LevelGeometry, spec::texture::kMaxLevels> level{};
};

// As the bus shows them, and the docs: those of spec::texture::kRegisters, then each descriptor's.
std::span<const RegisterDescription> register_table();

class ParameterStore final : public Unit {
 public:
  RegisterBlock registers;

  ParameterStore(const sc_core::sc_module_name& name, ClockDomain& clock,
                 const spec::texture::Parameters& parameters);

  Activity tick(Cycle cycle) override;
  void reset() override;

  // --- Wires to the blocks ---
  // A handle beyond the last gives a descriptor that is not valid.
  const TextureState& texture(std::uint8_t handle) const {
    return textures_[handle < spec::texture::kMaxTextures ? handle : spec::texture::kMaxTextures];
  }
  bool enabled() const { return enabled_; }
  void set_sticky(std::uint32_t status_bits) { sticky_ |= status_bits; }

  // --- Wiring, while the unit is built ---
  void show(std::uint32_t offset, const Counter& counter);
  // Whether anything is in the unit; what CONTROL's two commands do.
  void connect(std::function<bool()> idle, std::function<void()> invalidate,
               std::function<void()> clear_counters);

 private:
  void write_control(std::uint32_t value);
  void write_descriptor(std::uint8_t handle);
  void decode(std::uint8_t handle);
  std::uint32_t field(std::uint8_t handle, std::uint32_t offset) const;

  std::array<TextureState, spec::texture::kMaxTextures + 1>
      textures_{};  // the last one is never valid
  bool enabled_ = true;
  std::uint32_t sticky_ = 0;
  std::uint32_t rules_ = 0;
  std::function<bool()> idle_;
  std::function<void()> invalidate_, clear_counters_;
};

}  // namespace deburr::rtl::texture
