// SPDX-License-Identifier: MIT
// Register map of the texture unit: 32 bits each, byte addresses. Codes of fields are those of the
// enumerations in spec/texture/.
#pragma once

#include <array>
#include <cstdint>

#include "spec/registers.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/parameters.h"

namespace deburr::spec::texture {

namespace reg {
inline constexpr std::uint32_t kId = 0x00;
inline constexpr std::uint32_t kControl = 0x04;
inline constexpr std::uint32_t kStatus = 0x08;
inline constexpr std::uint32_t kRules = 0x0C;
inline constexpr std::uint32_t kFragments = 0x40;
inline constexpr std::uint32_t kBilinears = 0x44;
inline constexpr std::uint32_t kLineFills = 0x48;
inline constexpr std::uint32_t kClamped = 0x4C;
inline constexpr std::uint32_t kSaturated = 0x50;
inline constexpr std::uint32_t kMemoryErrors = 0x54;
inline constexpr std::uint32_t kInvalidFragments = 0x58;
inline constexpr std::uint32_t kTextureBase =
    0x100;  // descriptor h starts at kTextureBase + h * stride
inline constexpr std::uint32_t kTextureStride = 0x80;
inline constexpr std::uint32_t kSize = 0x00;  // offsets inside a descriptor
inline constexpr std::uint32_t kMode = 0x04;
inline constexpr std::uint32_t kLodBias = 0x08;
inline constexpr std::uint32_t kLodClamp = 0x0C;
inline constexpr std::uint32_t kLevelBase = 0x10;  // + 4 k for level k
inline constexpr std::uint32_t kIdValue = 0xDEB00001;

// Fields, from the lowest bit on.
namespace control {
inline constexpr Field kEnable{"enable", 0, 0, "quads are taken"};
inline constexpr Field kInvalidate{"invalidate", 1, 1,
                                   "command, reads 0: empties the cache; when idle only"};
inline constexpr Field kClearCounters{"clear_counters", 2, 2, "command, reads 0"};
inline constexpr std::array kFields = {kEnable, kInvalidate, kClearCounters};
}  // namespace control
namespace status {
inline constexpr Field kIdle{"idle", 0, 0, "read only"};
inline constexpr Field kMemoryError{"memory_error", 1, 1, "sticky: memory answered with an error"};
inline constexpr Field kInvalidTexture{"invalid_texture", 2, 2,
                                       "sticky: a quad named an invalid descriptor"};
inline constexpr Field kWrittenWhileBusy{"written_while_busy", 3, 3,
                                         "sticky: a descriptor was written while busy"};
inline constexpr std::array kFields = {kIdle, kMemoryError, kInvalidTexture, kWrittenWhileBusy};
}  // namespace status
namespace rules {
inline constexpr Field kFootprint{"footprint", 2, 0, {}, kFootprintNames};
inline constexpr Field kLog2{"log2", 5, 4, {}, kLog2Names};
inline constexpr Field kAxes{"axes", 7, 6, {}, kAxesNames};
inline constexpr Field kCount{"count", 9, 8, {}, kCountNames};
inline constexpr Field kCountCap{"count_cap", 10, 10, {}, kCountCapNames};
inline constexpr Field kKernel{"kernel", 11, 11, {}, kKernelNames};
inline constexpr Field kSrgbOutput{"srgb_output", 12, 12, {}, kSrgbOutputNames};
inline constexpr Field kSpread{"spread", 23, 16, "U2.6 of the major axis"};
inline constexpr std::array kFields = {kFootprint, kLog2,   kAxes,       kCount,
                                       kCountCap,  kKernel, kSrgbOutput, kSpread};
}  // namespace rules
namespace size {
inline constexpr Field kWidth{"width", 15, 0, "texels"};
inline constexpr Field kHeight{"height", 31, 16, "texels"};
inline constexpr std::array kFields = {kWidth, kHeight};
}  // namespace size
namespace mode {
inline constexpr Field kFormat{"format", 2, 0, {}, kFormatNames};
inline constexpr Field kLayout{"layout", 4, 4, {}, kLayoutNames};
inline constexpr Field kWrapS{"wrap_s", 9, 8, {}, kWrapNames};
inline constexpr Field kWrapT{"wrap_t", 11, 10, {}, kWrapNames};
inline constexpr Field kMinFilter{"min_filter", 14, 12, {}, kMinFilterNames};
inline constexpr Field kMagFilter{"mag_filter", 16, 16, {}, kMagFilterNames};
inline constexpr Field kLevels{"levels", 23, 20, "present, from 1 on"};
inline constexpr Field kMaxCount{"max_count_log2", 26, 24, "lb N_max, 0..4"};
inline constexpr std::array kFields = {kFormat,    kLayout,    kWrapS,  kWrapT,
                                       kMinFilter, kMagFilter, kLevels, kMaxCount};
}  // namespace mode
namespace lod_bias {
inline constexpr Field kBias{"bias", 15, 0, "S7.8"};
inline constexpr std::array kFields = {kBias};
}  // namespace lod_bias
namespace lod_clamp {
inline constexpr Field kMinLod{"min_lod", 15, 0, "U8.8"};
inline constexpr Field kMaxLod{"max_lod", 31, 16, "U8.8"};
inline constexpr std::array kFields = {kMinLod, kMaxLod};
}  // namespace lod_clamp

inline constexpr std::uint32_t kStatusIdle = status::kIdle.mask();
inline constexpr std::uint32_t kStatusMemoryError = status::kMemoryError.mask();
inline constexpr std::uint32_t kStatusInvalidTexture = status::kInvalidTexture.mask();
inline constexpr std::uint32_t kStatusWrittenWhileBusy = status::kWrittenWhileBusy.mask();
inline constexpr std::uint32_t kControlEnable = control::kEnable.mask();
inline constexpr std::uint32_t kControlInvalidate = control::kInvalidate.mask();
inline constexpr std::uint32_t kControlClearCounters = control::kClearCounters.mask();
}  // namespace reg

inline constexpr std::array<RegisterInfo, 11> kRegisters = {{
    {reg::kId, "ID", Access::kReadOnly, reg::kIdValue,
     "Identifies the unit and the version of its register map."},
    {reg::kControl, "CONTROL", Access::kReadWrite, 1, "Switch and commands.",
     reg::control::kFields},
    {reg::kStatus, "STATUS", Access::kWriteOneToClear, 1, "State, and what has happened.",
     reg::status::kFields},
    {reg::kRules, "RULES", Access::kReadOnly, 0, "The variant built.", reg::rules::kFields},
    {reg::kFragments, "FRAGMENTS", Access::kReadOnly, 0, "Colours delivered."},
    {reg::kBilinears, "BILINEARS", Access::kReadOnly, 0, "Bilinear requests sent to the cache."},
    {reg::kLineFills, "LINE_FILLS", Access::kReadOnly, 0, "Cache lines requested."},
    {reg::kClamped, "CLAMPED", Access::kReadOnly, 0,
     "Covered fragments whose coordinates were clamped before the unit."},
    {reg::kSaturated, "SATURATED", Access::kReadOnly, 0,
     "Covered fragments with a derivative beyond U15.16 texels."},
    {reg::kMemoryErrors, "MEMORY_ERRORS", Access::kReadOnly, 0,
     "Line fills answered with an error; such a line reads as zero."},
    {reg::kInvalidFragments, "INVALID_FRAGMENTS", Access::kReadOnly, 0,
     "Covered fragments of quads with an invalid descriptor; their colour is zero."},
}};
static_assert(fields_are_in_order(kRegisters));

// The registers of a descriptor before its bases, offsets from its start.
inline constexpr std::array<RegisterInfo, 4> kDescriptorRegisters = {{
    {reg::kSize, "SIZE", Access::kReadWrite, 0, "Size of level 0.", reg::size::kFields},
    {reg::kMode, "MODE", Access::kReadWrite, 0, "Texels, and how they are sampled.",
     reg::mode::kFields},
    {reg::kLodBias, "LOD_BIAS", Access::kReadWrite, 0, "Added to the level of detail.",
     reg::lod_bias::kFields},
    {reg::kLodClamp, "LOD_CLAMP", Access::kReadWrite, 0, "Limits of the level of detail.",
     reg::lod_clamp::kFields},
}};
static_assert(fields_are_in_order(kDescriptorRegisters));

// RULES of a build.
constexpr std::uint32_t rules_word(const Parameters& p) {
  const auto code = [](auto value) { return static_cast<std::uint32_t>(value); };
  namespace rules = reg::rules;
  return rules::kFootprint.in(code(p.footprint)) | rules::kLog2.in(code(p.log2)) |
         rules::kAxes.in(code(p.axes)) | rules::kCount.in(code(p.count)) |
         rules::kCountCap.in(code(p.count_cap)) | rules::kKernel.in(code(p.kernel)) |
         rules::kSrgbOutput.in(code(p.srgb_output)) | rules::kSpread.in(code(p.spread));
}
// The words of a descriptor before its bases.
constexpr std::uint32_t size_word(const Descriptor& d) {
  return reg::size::kWidth.in(d.width) | reg::size::kHeight.in(d.height);
}
constexpr std::uint32_t mode_word(const Descriptor& d) {
  const auto code = [](auto value) { return static_cast<std::uint32_t>(value); };
  namespace mode = reg::mode;
  return mode::kFormat.in(code(d.format)) | mode::kLayout.in(code(d.layout)) |
         mode::kWrapS.in(code(d.wrap_s)) | mode::kWrapT.in(code(d.wrap_t)) |
         mode::kMinFilter.in(code(d.min_filter)) | mode::kMagFilter.in(code(d.mag_filter)) |
         mode::kLevels.in(d.levels) | mode::kMaxCount.in(d.max_anisotropy_log2);
}
constexpr std::uint32_t lod_bias_word(const Descriptor& d) {
  return reg::lod_bias::kBias.in(static_cast<std::uint16_t>(d.lod_bias));
}
constexpr std::uint32_t lod_clamp_word(const Descriptor& d) {
  return reg::lod_clamp::kMinLod.in(d.min_lod) | reg::lod_clamp::kMaxLod.in(d.max_lod);
}

}  // namespace deburr::spec::texture
