// SPDX-License-Identifier: MIT
// Texture and sampler state of the texture unit, as in its registers. Meaning:
// docs/reference/texture/index.md.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace deburr::spec::texture {

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

// From kBc1 on: blocks of 4 x 4 texels (docs/reference/texture/compressed.md).
enum class Format : std::uint8_t {
  kRgba8,
  kRgb565,
  kRgba4444,
  kL8,
  kSrgb8A8,
  kBc1,
  kBc3,
  kBc4,
  kBc5,
  kEtc2Rgb,
  kEtc2RgbA1,
  kEtc2Rgba8
};
inline constexpr std::array<std::string_view, 12> kFormatNames = {
    "rgba8", "rgb565", "rgba4444", "l8",       "srgb8_a8",    "bc1",
    "bc3",   "bc4",    "bc5",      "etc2_rgb", "etc2_rgb_a1", "etc2_rgba8"};
// Bytes of a texel; 0 if the format has blocks.
inline constexpr std::array<std::uint8_t, 12> kFormatBytes = {4, 2, 2, 1, 4};
// Bytes of a block; 0 if the format has none.
inline constexpr std::array<std::uint8_t, 12> kFormatBlockBytes = {0,  0, 0,  0, 0, 8,
                                                                   16, 8, 16, 8, 8, 16};
constexpr bool is_compressed(Format format) {
  return format >= Format::kBc1 && format <= Format::kEtc2Rgba8;
}
// Formats whose blocks may hold sRGB codes (Descriptor::srgb).
constexpr bool may_be_srgb(Format format) {
  return is_compressed(format) && format != Format::kBc4 && format != Format::kBc5;
}

inline constexpr int kMaxTextures = 16;
inline constexpr int kMaxTextureSize = 4096;
inline constexpr int kMaxLevels = 13;
inline constexpr int kTileBytes = 64;
// Tile size in texels, indexed by bytes per texel (1, 2, 4): 8 x 8, 8 x 4, 4 x 4.
inline constexpr std::array<std::uint8_t, 5> kTileWidth = {0, 8, 8, 0, 4};
inline constexpr std::array<std::uint8_t, 5> kTileHeight = {0, 8, 4, 0, 4};

// A texture with its sampler state, as in the ParameterStore.
struct Descriptor {
  std::uint16_t width = 0, height = 0;  // texels of level 0, 1..4096
  std::uint8_t levels = 0;              // number of levels, 1..1 + floor(lb max(width, height))
  Format format = Format::kRgba8;
  bool srgb = false;  // R, G and B of the blocks are sRGB codes; only with may_be_srgb()
  Layout layout = Layout::kTiled;
  Wrap wrap_s = Wrap::kRepeat, wrap_t = Wrap::kRepeat;
  MinFilter min_filter = MinFilter::kLinearMipmapLinear;
  MagFilter mag_filter = MagFilter::kLinear;
  std::uint8_t max_anisotropy_log2 = 0;          // N_max = 1, 2, 4, 8, 16
  std::int16_t lod_bias = 0;                     // S7.8
  std::uint16_t min_lod = 0;                     // U8.8
  std::uint16_t max_lod = 12 << 8;               // U8.8
  std::array<std::uint32_t, kMaxLevels> base{};  // byte address of each level, a multiple of 64
  friend bool operator==(const Descriptor&, const Descriptor&) = default;
};

}  // namespace deburr::spec::texture
