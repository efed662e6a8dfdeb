// SPDX-License-Identifier: MIT
// The texture unit's contract: modes, texture descriptors, parameters, register map. No algorithm.
// Meaning, formats and rounding: docs/texture_unit.md and docs/number_formats.md.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "spec/parameters.h"
#include "spec/registers.h"

namespace deburr::spec {

// ---- sampler and texture state ------------------------------------------------------------------

// GL_TEXTURE_MIN_FILTER, in the order of the register field.
enum class MinFilter : std::uint8_t {
  kNearest,
  kLinear,
  kNearestMipmapNearest,
  kLinearMipmapNearest,
  kNearestMipmapLinear,
  kLinearMipmapLinear
};
inline constexpr std::array<std::string_view, 6> kMinFilterNames = {"nearest",
                                                                    "linear",
                                                                    "nearest_mipmap_nearest",
                                                                    "linear_mipmap_nearest",
                                                                    "nearest_mipmap_linear",
                                                                    "linear_mipmap_linear"};

enum class MagFilter : std::uint8_t { kNearest, kLinear };
inline constexpr std::array<std::string_view, 2> kMagFilterNames = {"nearest", "linear"};

enum class Wrap : std::uint8_t { kRepeat, kMirroredRepeat, kClampToEdge };
inline constexpr std::array<std::string_view, 3> kWrapNames = {"repeat", "mirrored_repeat",
                                                               "clamp_to_edge"};

enum class Layout : std::uint8_t { kLinear, kTiled };
inline constexpr std::array<std::string_view, 2> kLayoutNames = {"linear", "tiled"};

enum class Format : std::uint8_t { kRgba8, kRgb565, kRgba4444, kL8, kSrgb8A8 };
inline constexpr std::array<std::string_view, 5> kFormatNames = {"rgba8", "rgb565", "rgba4444",
                                                                 "l8", "srgb8_a8"};
inline constexpr std::array<std::uint8_t, 5> kFormatBytes = {4, 2, 2, 1, 4};

inline constexpr int kMaxTextures = 16;
inline constexpr int kMaxTextureSize = 4096;
inline constexpr int kMaxLevels = 13;
inline constexpr int kTileBytes = 64;
// Tile size in texels by bytes a texel (index 1, 2, 4): 8 x 8, 8 x 4, 4 x 4.
inline constexpr std::array<std::uint8_t, 5> kTileWidth = {0, 8, 8, 0, 4};
inline constexpr std::array<std::uint8_t, 5> kTileHeight = {0, 8, 4, 0, 4};

// One texture with its sampler state, as the ParameterStore holds it.
struct TextureDescriptor {
  std::uint16_t width = 0, height = 0;  // texels of level 0, 1..4096
  std::uint8_t levels = 0;              // levels present, 1..1 + floor(lb max(width, height))
  Format format = Format::kRgba8;
  Layout layout = Layout::kTiled;
  Wrap wrap_s = Wrap::kRepeat, wrap_t = Wrap::kRepeat;
  MinFilter min_filter = MinFilter::kLinearMipmapLinear;
  MagFilter mag_filter = MagFilter::kLinear;
  std::uint8_t max_anisotropy_log2 = 0;          // N_max = 1, 2, 4, 8, 16
  std::int16_t lod_bias = 0;                     // S7.8
  std::uint16_t min_lod = 0;                     // U8.8
  std::uint16_t max_lod = 12 << 8;               // U8.8
  std::array<std::uint32_t, kMaxLevels> base{};  // byte address of each level, multiple of 64
  friend bool operator==(const TextureDescriptor&, const TextureDescriptor&) = default;
};

// ---- parameters ---------------------------------------------------------------------------------

enum class FootprintRule : std::uint8_t { kHalf, kQuarter, kTwoSegment, kExact, kMax };
inline constexpr std::array<std::string_view, 5> kFootprintNames = {"half", "quarter",
                                                                    "two_segment", "exact", "max"};
enum class Log2Rule : std::uint8_t { kMitchell, kCorrected, kSegments, kExact };
inline constexpr std::array<std::string_view, 4> kLog2Names = {"mitchell", "corrected", "segments",
                                                               "exact"};
enum class CountRule : std::uint8_t { kFloor, kCeil };
inline constexpr std::array<std::string_view, 2> kCountNames = {"floor", "ceil"};
enum class CountCap : std::uint8_t { kNone, kTexel };
inline constexpr std::array<std::string_view, 2> kCountCapNames = {"none", "texel"};
enum class Kernel : std::uint8_t { kBox, kTent };
inline constexpr std::array<std::string_view, 2> kKernelNames = {"box", "tent"};
enum class Replacement : std::uint8_t { kLru, kFifo, kRandom };
inline constexpr std::array<std::string_view, 3> kReplacementNames = {"lru", "fifo", "random"};

struct TextureParameters {
  FootprintRule footprint = FootprintRule::kHalf;
  Log2Rule log2 = Log2Rule::kMitchell;
  CountRule count = CountRule::kFloor;
  CountCap count_cap = CountCap::kNone;
  Kernel kernel = Kernel::kBox;
  std::int32_t spread = 64;
  std::int32_t cache_bytes = 16384;
  std::int32_t cache_line_bytes = 64;
  std::int32_t cache_ways = 2;
  Replacement cache_replacement = Replacement::kLru;
  std::int32_t cache_outstanding = 64;
  std::int32_t cache_fifo_depth = 160;
};

template <class Visitor>
void describe(TextureParameters& p, Visitor& v) {
  v.choice("footprint", p.footprint, kFootprintNames,
           "Rule for the length of a footprint side from its two components.");
  v.choice("log2", p.log2, kLog2Names, "Rule for the binary logarithm of a footprint side.");
  v.choice("count", p.count, kCountNames,
           "Rounding of L when the sample count N = 2^L is formed: floor is the paper.");
  v.choice("count_cap", p.count_cap, kCountCapNames,
           "texel: never place samples closer together than a texel of level 0.");
  v.choice("kernel", p.kernel, kKernelNames,
           "Weights of the N samples: equal (the paper) or an integer tent.");
  v.integer("spread", p.spread, 0, 128, "1/64 axis",
            "Length over which the samples are spread, U1.6 of the major axis.");
  v.integer("cache.bytes", p.cache_bytes, 256, 1 << 20, "byte",
            "Capacity of the texture cache; a power of two.");
  v.integer("cache.line_bytes", p.cache_line_bytes, 32, 128, "byte",
            "Size of a cache line; a power of two.");
  v.integer("cache.ways", p.cache_ways, 1, 16, "way", "Associativity; a power of two.");
  v.choice("cache.replacement", p.cache_replacement, kReplacementNames,
           "Which way of a full set is replaced.");
  v.integer("cache.outstanding", p.cache_outstanding, 4, 256, "line",
            "Line fills in flight: entries of the miss queue and of the fill buffer.");
  v.integer("cache.fifo_depth", p.cache_fifo_depth, 2, 4096, "request",
            "Depth of the latency FIFO between tag check and data read.");
}

// ---- registers (32 bits each, byte addresses) ---------------------------------------------------

namespace texture_register {
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
inline constexpr std::uint32_t kStatusIdle = 1u << 0;
inline constexpr std::uint32_t kStatusMemoryError = 1u << 1;
inline constexpr std::uint32_t kStatusInvalidTexture = 1u << 2;
inline constexpr std::uint32_t kStatusWrittenWhileBusy = 1u << 3;
inline constexpr std::uint32_t kControlEnable = 1u << 0;
inline constexpr std::uint32_t kControlInvalidate = 1u << 1;
inline constexpr std::uint32_t kControlClearCounters = 1u << 2;
}  // namespace texture_register

inline constexpr std::array<RegisterInfo, 11> kTextureRegisters = {{
    {texture_register::kId, "ID", Access::kReadOnly, texture_register::kIdValue,
     "Identifies the unit and the version of its register map."},
    {texture_register::kControl, "CONTROL", Access::kReadWrite, 1,
     "Bit 0 enable: quads are taken. Bit 1 invalidate the cache (command, reads 0; when idle "
     "only). "
     "Bit 2 clear the counters (command, reads 0)."},
    {texture_register::kStatus, "STATUS", Access::kWriteOneToClear, 1,
     "Bit 0 idle (read only). Sticky: bit 1 memory error response, bit 2 quad with an invalid "
     "descriptor, bit 3 descriptor written while busy."},
    {texture_register::kRules, "RULES", Access::kReadOnly, 0,
     "The variant built: footprint [2:0], log2 [5:4], count [8], count_cap [9], kernel [10], "
     "spread "
     "[23:16]."},
    {texture_register::kFragments, "FRAGMENTS", Access::kReadOnly, 0, "Colours delivered."},
    {texture_register::kBilinears, "BILINEARS", Access::kReadOnly, 0,
     "Bilinear requests sent to the cache."},
    {texture_register::kLineFills, "LINE_FILLS", Access::kReadOnly, 0, "Cache lines requested."},
    {texture_register::kClamped, "CLAMPED", Access::kReadOnly, 0,
     "Covered fragments whose coordinates were clamped before the unit."},
    {texture_register::kSaturated, "SATURATED", Access::kReadOnly, 0,
     "Covered fragments with a derivative beyond U15.16 texels."},
    {texture_register::kMemoryErrors, "MEMORY_ERRORS", Access::kReadOnly, 0,
     "Line fills answered with an error; such a line reads as zero."},
    {texture_register::kInvalidFragments, "INVALID_FRAGMENTS", Access::kReadOnly, 0,
     "Covered fragments of quads with an invalid descriptor; their colour is zero."},
}};

}  // namespace deburr::spec
