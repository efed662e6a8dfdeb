// SPDX-License-Identifier: MIT
#include "rtl_model/texture/descriptors.h"

#include <algorithm>
#include <bit>
#include <deque>
#include <string>
#include <vector>

namespace deburr::rtl::texture {
namespace {

namespace reg = spec::texture::reg;

// As the registers hold a descriptor, and whether it is valid: SIZE, MODE, bias, limits, and a base
// a level without the six bits that are 0.
constexpr std::uint32_t kWordBits = 26 + 19 + 16 + 32 + spec::texture::kMaxLevels * 26 + 1;

// Bits [high:low] of a register.
constexpr std::uint32_t bits(std::uint32_t value, int high, int low) {
  return (value >> low) & ((1u << (high - low + 1)) - 1);
}

// Bits needed to number n things, n > 0: lb n, rounded up.
std::uint8_t ceil_log2(std::uint32_t n) { return static_cast<std::uint8_t>(std::bit_width(n - 1)); }

}  // namespace

std::span<const spec::RegisterInfo> register_table() {
  static std::deque<std::string> names;
  static const std::vector<spec::RegisterInfo> table = [] {
    std::vector<spec::RegisterInfo> all(spec::texture::kRegisters.begin(),
                                        spec::texture::kRegisters.end());
    for (std::uint32_t h = 0; h < spec::texture::kMaxTextures; ++h) {
      const auto add = [&](std::uint32_t offset, const std::string& name, const char* meaning) {
        names.push_back("TEXTURE" + std::to_string(h) + "_" + name);
        all.push_back({reg::kTextureBase + h * reg::kTextureStride + offset, names.back(),
                       spec::Access::kReadWrite, 0, meaning});
      };
      add(reg::kSize, "SIZE", "Width [15:0], height [31:16], texels.");
      add(reg::kMode, "MODE",
          "Format [2:0], layout [4], wrap_s [9:8], wrap_t [11:10], min_filter [14:12], mag_filter "
          "[16], levels [23:20], lb N_max [26:24].");
      add(reg::kLodBias, "LOD_BIAS", "S7.8 [15:0].");
      add(reg::kLodClamp, "LOD_CLAMP", "min_lod U8.8 [15:0], max_lod U8.8 [31:16].");
      for (std::uint32_t k = 0; k < spec::texture::kMaxLevels; ++k)
        add(reg::kLevelBase + 4 * k, "BASE_" + std::to_string(k), "Byte address of the level.");
    }
    return all;
  }();
  return table;
}

ControlLayout control_layout() {
  return {.control = reg::kControl,
          .status = reg::kStatus,
          .enable = reg::kControlEnable,
          .clear_counters = reg::kControlClearCounters,
          .idle = reg::kStatusIdle,
          .written_while_busy = reg::kStatusWrittenWhileBusy,
          .busy_ignores_writes = false};
}

TextureState decode(const ControlRegisters& registers, std::uint32_t handle) {
  const auto field = [&](std::uint32_t offset) {
    return registers.value(reg::kTextureBase + handle * reg::kTextureStride + offset);
  };
  const std::uint32_t size = field(reg::kSize), mode = field(reg::kMode),
                      clamp = field(reg::kLodClamp);
  const std::uint32_t format = bits(mode, 2, 0), wrap_s = bits(mode, 9, 8),
                      wrap_t = bits(mode, 11, 10), min_filter = bits(mode, 14, 12),
                      levels = bits(mode, 23, 20), max_count_log2 = bits(mode, 26, 24);
  TextureState t;
  t.width = static_cast<std::uint16_t>(size);
  t.height = static_cast<std::uint16_t>(size >> 16);
  const std::uint32_t longest = std::max(t.width, t.height);
  bool valid = t.width >= 1 && t.height >= 1 && longest <= spec::texture::kMaxTextureSize &&
               levels >= 1 && levels <= static_cast<std::uint32_t>(std::bit_width(longest)) &&
               format < spec::texture::kFormatNames.size() &&
               wrap_s < spec::texture::kWrapNames.size() &&
               wrap_t < spec::texture::kWrapNames.size() &&
               min_filter < spec::texture::kMinFilterNames.size() && max_count_log2 <= 4;
  if (!valid) return {};

  t.levels = static_cast<std::uint8_t>(levels);
  t.format = static_cast<spec::texture::Format>(format);
  t.layout = static_cast<spec::texture::Layout>(bits(mode, 4, 4));
  t.wrap_s = static_cast<spec::texture::Wrap>(wrap_s);
  t.wrap_t = static_cast<spec::texture::Wrap>(wrap_t);
  t.min_filter = static_cast<spec::texture::MinFilter>(min_filter);
  t.mag_filter = static_cast<spec::texture::MagFilter>(bits(mode, 16, 16));
  t.max_count_log2 = static_cast<std::uint8_t>(max_count_log2);
  t.bias = static_cast<std::int16_t>(field(reg::kLodBias)) * 16;
  t.min_lod = static_cast<std::int32_t>(bits(clamp, 15, 0) << 4);
  t.max_lod = static_cast<std::int32_t>(clamp >> 16 << 4);
  const std::uint32_t bytes = spec::texture::kFormatBytes[format];
  t.texel_log2 = ceil_log2(bytes);
  const std::uint32_t tile_width = spec::texture::kTileWidth[bytes],
                      tile_height = spec::texture::kTileHeight[bytes];
  t.tile_width_log2 = ceil_log2(tile_width);
  t.tile_height_log2 = ceil_log2(tile_height);
  for (std::uint32_t k = 0; k < levels; ++k) {
    LevelGeometry& g = t.level[k];
    g.base = field(reg::kLevelBase + 4 * k);
    g.width = static_cast<std::uint16_t>(std::max(1, t.width >> k));
    g.height = static_cast<std::uint16_t>(std::max(1, t.height >> k));
    g.pitch = (g.width * bytes + 63) & ~63u;
    g.mixed_log2 = std::min(ceil_log2((g.width + tile_width - 1) / tile_width),
                            ceil_log2((g.height + tile_height - 1) / tile_height));
    valid = valid && g.base % spec::texture::kTileBytes == 0;
  }
  t.valid = valid;
  return t;
}

Descriptors::Descriptors(const char* name, ControlRegisters& registers)
    : memory_(name, {.words = spec::texture::kMaxTextures,
                     .word_bits = kWordBits,
                     .kind = MemoryKind::kFlops,
                     .read_ports = 3,
                     .write_ports = 1,
                     .latency = 0,
                     .content = "texture descriptors"}) {
  registers.on_change([this, &registers](std::uint32_t offset) { written(registers, offset); });
}

void Descriptors::written(const ControlRegisters& registers, std::uint32_t offset) {
  if (offset < reg::kTextureBase) return;
  const std::uint32_t handle = (offset - reg::kTextureBase) / reg::kTextureStride;
  words_[handle] = decode(registers, handle);
}

}  // namespace deburr::rtl::texture
