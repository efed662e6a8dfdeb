// SPDX-License-Identifier: MIT
// Texture descriptors, decoded from the registers for the pipeline.
//
// Position  Next to the AddressUnit; three of its units read the descriptor of the current
//           fragment.
// Timing    Stored as in the registers, read by handle, written by the register bus one register at
//           a time. A read returns the word in the same cycle; a write takes effect at the next
//           clock edge. Descriptors must not change while the unit is busy: a write then sets a
//           sticky status bit.
// Note      Level size, pitch and tiles are derived after the mux by wires, shifts and small
//           adders. Formats: docs/reference/texture/index.md, registers of a descriptor.
// Source    Paper 2.1, the parameter store.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "rtl_model/fabric/control_registers.h"
#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/memory.h"
#include "spec/registers.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/parameters.h"
#include "spec/texture/registers.h"

namespace deburr::rtl::texture {

// One mip level. One that the descriptor lacks has one texel: requests in flight may select it
// after a write while the unit is busy.
struct LevelGeometry {
  std::uint16_t width = 1, height = 1;  // U13, texels
  // The address of texel (x, y), or of its block, is column[x] + row[y]. The model tabulates the
  // two parts, which the hardware computes; rows include the base.
  std::vector<std::uint32_t> column{0}, row{0};
};

// A decoded descriptor.
struct TextureState {
  bool valid = false;
  std::uint16_t width = 0, height = 0;  // U13
  std::uint8_t levels = 0;              // U4
  std::uint8_t max_count_log2 = 0;      // U3, lb N_max
  spec::texture::Format format{};       // that the FilterPipeline unpacks
  std::uint8_t codec = 0;               // of its blocks, codec_of()
  spec::texture::Layout layout{};
  spec::texture::Wrap wrap_s{}, wrap_t{};
  spec::texture::MinFilter min_filter{};
  spec::texture::MagFilter mag_filter{};
  std::int32_t bias = 0;                  // S7.12
  std::int32_t min_lod = 0, max_lod = 0;  // U8.12
  std::array<LevelGeometry, spec::texture::kMaxLevels> level{};
};

// All registers of the unit: spec::texture::kRegisters, then those of each descriptor.
std::span<const spec::RegisterInfo> register_table();
// Layout of CONTROL and STATUS.
ControlLayout control_layout();
// Decodes descriptor `handle` from the registers, for a unit with or without decoders.
TextureState decode(const ControlRegisters& registers, std::uint32_t handle,
                    spec::texture::Decode decoders = spec::texture::Decode::kNone);

class Descriptors {
 public:
  // One port per reading unit.
  class Reader {
   public:
    // A handle out of range returns an invalid descriptor.
    const TextureState& read(Cycle cycle, std::uint8_t handle) {
      if (handle >= spec::texture::kMaxTextures) [[unlikely]]
        return invalid_;
      port_.read(cycle, handle);
      return (*words_)[handle];
    }

   private:
    friend class Descriptors;
    using Words = std::array<TextureState, spec::texture::kMaxTextures>;
    Reader(Memory<void>& memory, const char* user, const Words& words)
        : port_(memory, user), words_(&words) {}
    static inline const TextureState invalid_{};
    ReadPort<void> port_;
    const Words* words_;
  };

  // Decodes a descriptor whenever one of its registers is written.
  Descriptors(const char* name, ControlRegisters& registers,
              const spec::texture::Build& build = {});

  static Datasheet datasheet(const spec::texture::Build& build = {});

 private:
  void written(const ControlRegisters& registers, std::uint32_t offset);

  const spec::texture::Decode decoders_;
  Memory<void> memory_;
  WritePort<void> bus_{memory_, "register bus"};  // not clocked, like the bus: never issued
  Reader::Words words_{};

 public:
  Reader for_derivatives{memory_, "derivative", words_}, for_levels{memory_, "level", words_},
      for_texels{memory_, "addresser", words_};
  // Above width 1, for the second quad of a group of requests.
  std::optional<Reader> for_younger_texels;
};

}  // namespace deburr::rtl::texture
