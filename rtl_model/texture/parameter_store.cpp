// SPDX-License-Identifier: MIT
#include "rtl_model/texture/parameter_store.h"

#include <algorithm>
#include <bit>
#include <deque>
#include <string>
#include <utility>
#include <vector>

namespace deburr::rtl::texture {
namespace {

namespace reg = spec::texture::reg;

constexpr std::size_t kDescriptorRegisters = reg::kLevelBase / 4 + spec::texture::kMaxLevels;

Access fabric_access(spec::Access access) {
  switch (access) {
    case spec::Access::kReadOnly:
      return Access::kReadOnly;
    case spec::Access::kReadWrite:
      return Access::kReadWrite;
    case spec::Access::kWriteOneToClear:
      return Access::kWriteOneToClear;
    case spec::Access::kCommand:
      break;
  }
  return Access::kWriteOnly;
}

}  // namespace

std::span<const RegisterDescription> register_table() {
  static std::deque<std::string> names;
  static const std::vector<RegisterDescription> table = [] {
    std::vector<RegisterDescription> all;
    for (const spec::RegisterInfo& info : spec::texture::kRegisters)
      all.push_back({info.offset, info.name.data(), fabric_access(info.access), info.reset,
                     info.meaning.data()});
    for (std::uint32_t h = 0; h < spec::texture::kMaxTextures; ++h) {
      const auto add = [&](std::uint32_t offset, const std::string& name, const char* meaning) {
        names.push_back("TEXTURE" + std::to_string(h) + "_" + name);
        all.push_back({reg::kTextureBase + h * reg::kTextureStride + offset, names.back().c_str(),
                       Access::kReadWrite, 0, meaning});
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

namespace {

std::size_t index_at(std::uint32_t offset) {
  const auto table = register_table();
  const auto found = std::find_if(table.begin(), table.end(),
                                  [&](const RegisterDescription& r) { return r.offset == offset; });
  DEBURR_CHECK(found != table.end(), "no register at offset " + std::to_string(offset));
  return static_cast<std::size_t>(found - table.begin());
}

// Bits [high:low] of a register.
constexpr std::uint32_t bits(std::uint32_t value, int high, int low) {
  return (value >> low) & ((1u << (high - low + 1)) - 1);
}

std::uint32_t encode_rules(const spec::texture::Parameters& p) {
  return static_cast<std::uint32_t>(p.footprint) | static_cast<std::uint32_t>(p.log2) << 4 |
         static_cast<std::uint32_t>(p.count) << 8 | static_cast<std::uint32_t>(p.count_cap) << 9 |
         static_cast<std::uint32_t>(p.kernel) << 10 | static_cast<std::uint32_t>(p.spread) << 16;
}

// Bits needed to number n things, n > 0: lb n, rounded up.
std::uint8_t ceil_log2(std::uint32_t n) { return static_cast<std::uint8_t>(std::bit_width(n - 1)); }

}  // namespace

ParameterStore::ParameterStore(const sc_core::sc_module_name& name, ClockDomain& clock,
                               const spec::texture::Parameters& parameters)
    : Unit(name, clock),
      registers("registers", register_table()),
      rules_(encode_rules(parameters)),
      idle_([] { return true; }),
      invalidate_([] {}),
      clear_counters_([] {}) {
  registers.on_write(index_at(reg::kControl), [this](std::uint32_t v) { write_control(v); });
  registers.on_write(index_at(reg::kStatus), [this](std::uint32_t v) { sticky_ &= ~v; });
  registers.on_read(index_at(reg::kStatus),
                    [this] { return sticky_ | (idle_() ? reg::kStatusIdle : 0); });
  for (std::uint8_t h = 0; h < spec::texture::kMaxTextures; ++h)
    for (std::size_t i = 0; i < kDescriptorRegisters; ++i)
      registers.on_write(spec::texture::kRegisters.size() + h * kDescriptorRegisters + i,
                         [this, h](std::uint32_t) { write_descriptor(h); });
  registers.set(index_at(reg::kRules), rules_);
}

void ParameterStore::show(std::uint32_t offset, const Counter& counter) {
  registers.show(index_at(offset), counter);
}

void ParameterStore::connect(std::function<bool()> idle, std::function<void()> invalidate,
                             std::function<void()> clear_counters) {
  idle_ = std::move(idle);
  invalidate_ = std::move(invalidate);
  clear_counters_ = std::move(clear_counters);
}

// Works when it is written to and when it is asked, never at an edge.
Activity ParameterStore::tick(Cycle) { return kIdle; }

void ParameterStore::reset() {
  registers.reset();
  registers.set(index_at(reg::kRules), rules_);
  textures_.fill({});
  enabled_ = true;
  sticky_ = 0;
}

void ParameterStore::write_control(std::uint32_t value) {
  enabled_ = value & reg::kControlEnable;
  if (value & reg::kControlInvalidate) {
    if (idle_())
      invalidate_();
    else
      sticky_ |= reg::kStatusWrittenWhileBusy;
  }
  if (value & reg::kControlClearCounters) clear_counters_();
  registers.set(index_at(reg::kControl), value & reg::kControlEnable);
}

void ParameterStore::write_descriptor(std::uint8_t handle) {
  if (!idle_()) sticky_ |= reg::kStatusWrittenWhileBusy;
  decode(handle);
}

std::uint32_t ParameterStore::field(std::uint8_t handle, std::uint32_t offset) const {
  return registers.get(spec::texture::kRegisters.size() + handle * kDescriptorRegisters +
                       offset / 4);
}

void ParameterStore::decode(std::uint8_t handle) {
  const std::uint32_t size = field(handle, reg::kSize), mode = field(handle, reg::kMode),
                      clamp = field(handle, reg::kLodClamp);
  const std::uint32_t format = bits(mode, 2, 0), wrap_s = bits(mode, 9, 8),
                      wrap_t = bits(mode, 11, 10), min_filter = bits(mode, 14, 12),
                      levels = bits(mode, 23, 20), max_count_log2 = bits(mode, 26, 24);
  TextureState& t = textures_[handle];
  t = {};
  t.width = static_cast<std::uint16_t>(bits(size, 15, 0));
  t.height = static_cast<std::uint16_t>(bits(size, 31, 16));
  const std::uint32_t longest = std::max(t.width, t.height);
  bool valid = t.width >= 1 && t.height >= 1 && longest <= spec::texture::kMaxTextureSize &&
               levels >= 1 && levels <= static_cast<std::uint32_t>(std::bit_width(longest)) &&
               format < spec::texture::kFormatNames.size() &&
               wrap_s < spec::texture::kWrapNames.size() &&
               wrap_t < spec::texture::kWrapNames.size() &&
               min_filter < spec::texture::kMinFilterNames.size() && max_count_log2 <= 4;
  if (!valid) return;

  t.levels = static_cast<std::uint8_t>(levels);
  t.format = static_cast<spec::texture::Format>(format);
  t.layout = static_cast<spec::texture::Layout>(bits(mode, 4, 4));
  t.wrap_s = static_cast<spec::texture::Wrap>(wrap_s);
  t.wrap_t = static_cast<spec::texture::Wrap>(wrap_t);
  t.min_filter = static_cast<spec::texture::MinFilter>(min_filter);
  t.mag_filter = static_cast<spec::texture::MagFilter>(bits(mode, 16, 16));
  t.max_count_log2 = static_cast<std::uint8_t>(max_count_log2);
  t.bias = static_cast<std::int16_t>(bits(field(handle, reg::kLodBias), 15, 0)) * 16;
  t.min_lod = static_cast<std::int32_t>(bits(clamp, 15, 0) << 4);
  t.max_lod = static_cast<std::int32_t>(bits(clamp, 31, 16) << 4);
  const std::uint32_t bytes = spec::texture::kFormatBytes[format];
  t.texel_log2 = ceil_log2(bytes);
  const std::uint32_t tile_width = spec::texture::kTileWidth[bytes],
                      tile_height = spec::texture::kTileHeight[bytes];
  for (std::uint32_t k = 0; k < levels; ++k) {
    LevelGeometry& g = t.level[k];
    g.base = field(handle, reg::kLevelBase + 4 * k);
    g.width = static_cast<std::uint16_t>(std::max(1, t.width >> k));
    g.height = static_cast<std::uint16_t>(std::max(1, t.height >> k));
    g.pitch = (g.width * bytes + 63) & ~63u;
    g.tiles_x_log2 = ceil_log2((g.width + tile_width - 1) / tile_width);
    g.tiles_y_log2 = ceil_log2((g.height + tile_height - 1) / tile_height);
    valid = valid && g.base % spec::texture::kTileBytes == 0;
  }
  t.valid = valid;
}

}  // namespace deburr::rtl::texture
