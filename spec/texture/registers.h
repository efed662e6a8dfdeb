// SPDX-License-Identifier: MIT
// Register map of the texture unit: 32 bits each, byte addresses. Codes of fields are those of the
// enumerations in spec/texture/.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "spec/registers.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/parameters.h"

namespace deburr::spec::texture {

namespace reg {
inline constexpr std::uint32_t kId = 0x00;
inline constexpr std::uint32_t kControl = 0x04;
inline constexpr std::uint32_t kStatus = 0x08;
inline constexpr std::uint32_t kConfiguration = 0x0C;
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
inline constexpr std::uint32_t kIdValue = 0xDEB00002;

// Fields, lowest bit first.
namespace id {
inline constexpr std::array kFields = number(Access::kConstant, kIdValue);
}  // namespace id
namespace control {
inline constexpr Field kEnable{
    "enable", 0, 0, Access::kReadWrite, "enables the acceptance of quads", {}, 1};
inline constexpr Field kInvalidate{"invalidate", 1, 1, Access::kCommand,
                                   "empties the cache; when idle only"};
inline constexpr Field kClearCounters{"clear_counters", 2, 2, Access::kCommand,
                                      "sets every counter to 0"};
inline constexpr std::array kFields = {kEnable, kInvalidate, kClearCounters};
}  // namespace control
namespace status {
inline constexpr Field kIdle{"idle", 0, 0, Access::kReadOnly, "no work in progress", {}, 1};
inline constexpr Field kMemoryError{"memory_error", 1, 1, Access::kWriteOneToClear,
                                    "a memory response had an error"};
inline constexpr Field kInvalidTexture{"invalid_texture", 2, 2, Access::kWriteOneToClear,
                                       "a quad selected an invalid descriptor"};
inline constexpr Field kWrittenWhileBusy{"written_while_busy", 3, 3, Access::kWriteOneToClear,
                                         "a descriptor was written while busy"};
inline constexpr std::array kFields = {kIdle, kMemoryError, kInvalidTexture, kWrittenWhileBusy};
}  // namespace status
namespace configuration {
inline constexpr Field kFootprint{"footprint", 2, 0, Access::kConstant, {}, kFootprintNames};
inline constexpr Field kLog2{"log2", 5, 4, Access::kConstant, {}, kLog2Names};
inline constexpr Field kAxes{"axes", 7, 6, Access::kConstant, {}, kAxesNames};
inline constexpr Field kCount{"count", 9, 8, Access::kConstant, {}, kCountNames};
inline constexpr Field kCountCap{"count_cap", 10, 10, Access::kConstant, {}, kCountCapNames};
inline constexpr Field kKernel{"kernel",          11, 11,
                               Access::kConstant, {}, std::span(kKernelNames).first(2)};
inline constexpr Field kSrgbOutput{"srgb_output", 12, 12, Access::kConstant, {}, kSrgbOutputNames};
inline constexpr Field kBlend{"blend", 13, 13, Access::kConstant, {}, kBlendNames};
inline constexpr Field kDerivatives{"derivatives",     14, 14,
                                    Access::kConstant, {}, kDerivativesNames};
inline constexpr Field kKernelAxis{"kernel_axis", 15, 15, Access::kConstant,
                                   "kernel = axis; the field kernel is then 0"};
inline constexpr Field kSpread{"spread", 23, 16, Access::kConstant, "U2.6 of the major axis"};
inline constexpr Field kDecode{"decode", 25, 24, Access::kConstant, {}, kDecodeNames};
inline constexpr Field kBc{"bc", 26, 26, Access::kConstant, {}, kBlockRuleNames};
inline constexpr std::array kFields = {kFootprint, kLog2,       kAxes,  kCount,       kCountCap,
                                       kKernel,    kSrgbOutput, kBlend, kDerivatives, kKernelAxis,
                                       kSpread,    kDecode,     kBc};
}  // namespace configuration
namespace size {
inline constexpr Field kWidth{"width", 15, 0, Access::kReadWrite, "texels"};
inline constexpr Field kHeight{"height", 31, 16, Access::kReadWrite, "texels"};
inline constexpr std::array kFields = {kWidth, kHeight};
}  // namespace size
namespace mode {
inline constexpr Field kFormat{"format", 3, 0, Access::kReadWrite, {}, kFormatNames};
inline constexpr Field kLayout{"layout", 4, 4, Access::kReadWrite, {}, kLayoutNames};
inline constexpr Field kSrgb{"srgb", 5, 5, Access::kReadWrite,
                             "the blocks hold sRGB codes; only bc1, bc3 and etc2"};
inline constexpr Field kWrapS{"wrap_s", 9, 8, Access::kReadWrite, {}, kWrapNames};
inline constexpr Field kWrapT{"wrap_t", 11, 10, Access::kReadWrite, {}, kWrapNames};
inline constexpr Field kMinFilter{"min_filter", 14, 12, Access::kReadWrite, {}, kMinFilterNames};
inline constexpr Field kMagFilter{"mag_filter", 16, 16, Access::kReadWrite, {}, kMagFilterNames};
inline constexpr Field kLevels{"levels", 23, 20, Access::kReadWrite,
                               "number of levels, at least 1"};
inline constexpr Field kMaxCount{"max_count_log2", 26, 24, Access::kReadWrite, "lb N_max, 0..4"};
inline constexpr std::array kFields = {kFormat,    kLayout,    kSrgb,   kWrapS,   kWrapT,
                                       kMinFilter, kMagFilter, kLevels, kMaxCount};
}  // namespace mode
namespace lod_bias {
inline constexpr Field kBias{"bias", 15, 0, Access::kReadWrite, "S7.8"};
inline constexpr std::array kFields = {kBias};
}  // namespace lod_bias
namespace lod_clamp {
inline constexpr Field kMinLod{"min_lod", 15, 0, Access::kReadWrite, "U8.8"};
inline constexpr Field kMaxLod{"max_lod", 31, 16, Access::kReadWrite, "U8.8"};
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

// Writes are accepted while the unit is busy.
inline constexpr bool kBusyIgnoresWrites = false;
inline constexpr std::array<RegisterInfo, 11> kRegisters = {{
    {reg::kId, "ID", "Identifies the unit and the version of its register map.", reg::id::kFields},
    {reg::kControl, "CONTROL", "Enable bit and commands.", reg::control::kFields},
    {reg::kStatus, "STATUS", "State and events.", reg::status::kFields},
    {reg::kConfiguration, "CONFIG", "Variant as built.", reg::configuration::kFields},
    {reg::kFragments, "FRAGMENTS", "Colours delivered.", kCounter},
    {reg::kBilinears, "BILINEARS", "Bilinear requests sent to the cache.", kCounter},
    {reg::kLineFills, "LINE_FILLS", "Lines that the cache requested.", kCounter},
    {reg::kClamped, "CLAMPED", "Covered fragments whose coordinates were clamped before the unit.",
     kCounter},
    {reg::kSaturated, "SATURATED", "Covered fragments with a derivative beyond U15.16 texels.",
     kCounter},
    {reg::kMemoryErrors, "MEMORY_ERRORS",
     "Responses of memory with an error; the bytes of such a line read as zero.", kCounter},
    {reg::kInvalidFragments, "INVALID_FRAGMENTS",
     "Covered fragments of quads with an invalid descriptor; their colour is zero.", kCounter},
}};
static_assert(fields_are_in_order(kRegisters));

// The registers of a descriptor before its bases; offsets from its start.
inline constexpr std::array<RegisterInfo, 4> kDescriptorRegisters = {{
    {reg::kSize, "SIZE", "Size of level 0.", reg::size::kFields},
    {reg::kMode, "MODE", "Texel format, layout and sampler state.", reg::mode::kFields},
    {reg::kLodBias, "LOD_BIAS", "Added to the level of detail.", reg::lod_bias::kFields},
    {reg::kLodClamp, "LOD_CLAMP", "Limits of the level of detail.", reg::lod_clamp::kFields},
}};
static_assert(fields_are_in_order(kDescriptorRegisters));

// CONFIG of a build.
constexpr std::uint32_t configuration_word(const Parameters& p) {
  const auto code = [](auto value) { return static_cast<std::uint32_t>(value); };
  namespace configuration = reg::configuration;
  return configuration::kFootprint.in(code(p.footprint)) | configuration::kLog2.in(code(p.log2)) |
         configuration::kAxes.in(code(p.axes)) | configuration::kCount.in(code(p.count)) |
         configuration::kCountCap.in(code(p.count_cap)) |
         configuration::kKernel.in(p.kernel == Kernel::kTent) |
         configuration::kKernelAxis.in(p.kernel == Kernel::kAxis) |
         configuration::kSrgbOutput.in(code(p.srgb_output)) |
         configuration::kBlend.in(code(p.blend)) |
         configuration::kDerivatives.in(code(p.derivatives)) |
         configuration::kSpread.in(code(p.spread)) | configuration::kDecode.in(code(p.decode)) |
         configuration::kBc.in(code(p.bc));
}
// Registers whose values come from the parameters.
constexpr std::array<LoadedRegister, 1> loaded_registers(const Parameters& p) {
  return {{{reg::kConfiguration, configuration_word(p)}}};
}
// The words of a descriptor before its bases.
constexpr std::uint32_t size_word(const Descriptor& d) {
  return reg::size::kWidth.in(d.width) | reg::size::kHeight.in(d.height);
}
constexpr std::uint32_t mode_word(const Descriptor& d) {
  const auto code = [](auto value) { return static_cast<std::uint32_t>(value); };
  namespace mode = reg::mode;
  return mode::kFormat.in(code(d.format)) | mode::kLayout.in(code(d.layout)) |
         mode::kSrgb.in(code(d.srgb)) | mode::kWrapS.in(code(d.wrap_s)) |
         mode::kWrapT.in(code(d.wrap_t)) | mode::kMinFilter.in(code(d.min_filter)) |
         mode::kMagFilter.in(code(d.mag_filter)) | mode::kLevels.in(d.levels) |
         mode::kMaxCount.in(d.max_anisotropy_log2);
}
constexpr std::uint32_t lod_bias_word(const Descriptor& d) {
  return reg::lod_bias::kBias.in(static_cast<std::uint16_t>(d.lod_bias));
}
constexpr std::uint32_t lod_clamp_word(const Descriptor& d) {
  return reg::lod_clamp::kMinLod.in(d.min_lod) | reg::lod_clamp::kMaxLod.in(d.max_lod);
}

}  // namespace deburr::spec::texture
