// SPDX-License-Identifier: MIT
#include "golden/c/texture_handle.h"

#include <algorithm>
#include <cstring>

#include "golden/texture/sampling.h"
#include "spec/error.h"

namespace deburr::golden::c {
namespace {

namespace reg = spec::texture::reg;

std::string level_name(int level) { return "base" + std::to_string(level); }

// Sets a field of a descriptor's registers, or the base of a level.
void set_field(DescriptorWords& words, std::string_view name, std::string_view text) {
  for (std::uint32_t level = 0; level < spec::texture::kMaxLevels; ++level) {
    if (name != level_name(static_cast<int>(level))) continue;
    words[reg::kLevelBase / 4 + level] =
        static_cast<std::uint32_t>(number_in_range(name, text, 0, 0xFFFFFFFF));
    return;
  }
  std::vector<std::string> known;
  for (const spec::RegisterInfo& info : spec::texture::kDescriptorRegisters) {
    for (const spec::Field& field : info.fields) {
      known.emplace_back(field.name);
      if (field.name != name) continue;
      std::int64_t value = 0;
      if (!field.codes.empty()) {
        value = static_cast<std::int64_t>(code_of(name, text, field.codes));
      } else {
        const std::int64_t most = field.of(field.mask());
        const bool has_sign = field.name == reg::lod_bias::kBias.name;
        value = has_sign ? number_in_range(name, text, -(most / 2) - 1, most / 2)
                         : number_in_range(name, text, 0, most);
      }
      std::uint32_t& word = words[info.offset / 4];
      word = (word & ~field.mask()) | field.in(static_cast<std::uint32_t>(value));
      return;
    }
  }
  known.push_back(level_name(0) + " to " + level_name(spec::texture::kMaxLevels - 1));
  reject_name("field of a texture", name, known);
}

// A level as it is given: rows of texels, or of blocks of 4 x 4 texels.
struct LevelRows {
  std::size_t side;  // texels of an item in each direction
  std::size_t bytes, columns, rows;
};
LevelRows rows_of(const spec::texture::Descriptor& d, int level) {
  const auto format = static_cast<std::size_t>(d.format);
  const std::size_t side = spec::texture::is_compressed(d.format) ? 4 : 1;
  const auto count = [&](std::uint32_t size) {
    return (static_cast<std::size_t>(texture::level_size(size, level)) + side - 1) / side;
  };
  return {
      side,
      std::size_t{spec::texture::kFormatBytes[format]} + spec::texture::kFormatBlockBytes[format],
      count(d.width), count(d.height)};
}

// Writes the texels or blocks of a level, row by row, to their addresses.
void put_rows(TextureHandle& h, const spec::texture::Descriptor& d, int level,
              const std::uint8_t* texels, std::size_t distance) {
  const texture::LevelAddresses addresses = texture::level_addresses(d, level);
  const LevelRows of = rows_of(d, level);
  for (std::size_t y = 0; y < of.rows; ++y)
    for (std::size_t x = 0; x < of.columns; ++x)
      std::memcpy(h.memory.data() + (addresses.column[x * of.side] + addresses.row[y * of.side]),
                  texels + y * distance + x * of.bytes, of.bytes);
}

void require_valid(const TextureHandle& h, std::uint32_t texture,
                   const spec::texture::Descriptor& d) {
  if (const char* fault = texture::descriptor_fault(d, h.texts.values().decode))
    throw spec::ConfigError("texture " + std::to_string(texture) + ": " + fault);
}

}  // namespace

spec::texture::Descriptor descriptor_of(const DescriptorWords& words) {
  const std::uint32_t size = words[reg::kSize / 4], mode = words[reg::kMode / 4];
  const std::uint32_t clamp = words[reg::kLodClamp / 4];
  spec::texture::Descriptor d;
  d.width = static_cast<std::uint16_t>(reg::size::kWidth.of(size));
  d.height = static_cast<std::uint16_t>(reg::size::kHeight.of(size));
  d.levels = static_cast<std::uint8_t>(reg::mode::kLevels.of(mode));
  d.format = static_cast<spec::texture::Format>(reg::mode::kFormat.of(mode));
  d.srgb = reg::mode::kSrgb.of(mode) != 0;
  d.layout = static_cast<spec::texture::Layout>(reg::mode::kLayout.of(mode));
  d.wrap_s = static_cast<spec::texture::Wrap>(reg::mode::kWrapS.of(mode));
  d.wrap_t = static_cast<spec::texture::Wrap>(reg::mode::kWrapT.of(mode));
  d.min_filter = static_cast<spec::texture::MinFilter>(reg::mode::kMinFilter.of(mode));
  d.mag_filter = static_cast<spec::texture::MagFilter>(reg::mode::kMagFilter.of(mode));
  d.max_anisotropy_log2 = static_cast<std::uint8_t>(reg::mode::kMaxCount.of(mode));
  d.lod_bias = static_cast<std::int16_t>(reg::lod_bias::kBias.of(words[reg::kLodBias / 4]));
  d.min_lod = static_cast<std::uint16_t>(reg::lod_clamp::kMinLod.of(clamp));
  d.max_lod = static_cast<std::uint16_t>(reg::lod_clamp::kMaxLod.of(clamp));
  std::copy_n(words.begin() + reg::kLevelBase / 4, d.base.size(), d.base.begin());
  return d;
}

void require_in_memory(const TextureHandle& h, std::uint64_t address, std::uint64_t bytes,
                       const std::string& what) {
  require(address <= h.memory.size() && bytes <= h.memory.size() - address,
          what + ", " + std::to_string(bytes) + " bytes from " + std::to_string(address) +
              ", is outside the memory of " + std::to_string(h.memory.size()) + " bytes; " +
              std::string(h.remedy));
}

spec::texture::Descriptor valid_descriptor(TextureHandle& h, std::uint32_t texture) {
  const spec::texture::Descriptor d = descriptor_of(h.words(texture));
  require_valid(h, texture, d);
  return d;
}

void resize_memory(TextureHandle& h, std::uint64_t bytes) {
  require(bytes <= kMostMemory, std::to_string(bytes) + " bytes; at most 2^32 are addressable");
  std::vector<std::uint8_t> memory(static_cast<std::size_t>(bytes));
  std::copy_n(h.memory.begin(), std::min(h.memory.size(), memory.size()), memory.begin());
  // The model refers to the old memory.
  h.golden.reset();
  h.memory.swap(memory);
}

void set_register(TextureHandle& h, std::uint32_t texture, std::uint32_t offset,
                  std::uint32_t word) {
  auto words = h.words(texture);
  require(offset % 4 == 0 && offset / 4 < words.size(),
          "offset " + std::to_string(offset) +
              " is not a register of a descriptor; expected 0, 4, .. " +
              std::to_string(4 * (words.size() - 1)));
  words[offset / 4] = word;
  h.put_words(texture, words);
}

void set_field(TextureHandle& h, std::uint32_t texture, std::string_view name,
               std::string_view text) {
  auto words = h.words(texture);
  set_field(words, name, text);
  h.put_words(texture, words);
}

std::uint64_t place(TextureHandle& h, std::uint32_t texture, std::uint64_t address) {
  auto words = h.words(texture);
  require(address % 64 == 0, "address " + std::to_string(address) + " is not a multiple of 64");
  // Old bases must not make the descriptor invalid.
  std::fill(words.begin() + reg::kLevelBase / 4, words.end(), 0);
  const auto d = descriptor_of(words);
  require_valid(h, texture, d);
  std::uint64_t next = address;
  for (std::uint32_t level = 0; level < d.levels; ++level) {
    words[reg::kLevelBase / 4 + level] = static_cast<std::uint32_t>(next);
    next += (texture::level_bytes(d, static_cast<int>(level)) + 63) / 64 * 64;
    require(address < kMostMemory && next <= kMostMemory,
            "the texture would end past address 2^32");
  }
  h.put_words(texture, words);
  return next;
}

void put_level(TextureHandle& h, std::uint32_t texture, std::uint32_t level,
               std::span<const std::uint8_t> texels, std::uint32_t stride) {
  const auto d = valid_descriptor(h, texture);
  require_below(level, d.levels, "level");
  const int k = static_cast<int>(level);
  const LevelRows of = rows_of(d, k);
  const std::size_t distance =
      row_distance("texels", texels.size(), of.columns * of.bytes, of.rows, stride);
  require_in_memory(h, d.base[level], texture::level_bytes(d, k), "level " + std::to_string(level));
  put_rows(h, d, k, texels.data(), distance);
}

}  // namespace deburr::golden::c
