// SPDX-License-Identifier: MIT
#include "rtl_model/texture/descriptors.h"

#include <algorithm>
#include <bit>
#include <deque>
#include <string>
#include <vector>

#include "rtl_model/texture/datasheets.h"
#include "rtl_model/texture/tokens.h"

namespace deburr::rtl::texture {
namespace {

namespace reg = spec::texture::reg;

// Descriptor bits in the registers: SIZE, MODE, bias, limits, per level a base without its six zero
// bits; and a valid bit. Formats of blocks and `srgb` take two bits more.
std::uint32_t word_bits(const spec::texture::Build& p) {
  return 26 + (p.decode != spec::texture::Decode::kNone ? 21 : 19) + 16 + 32 +
         spec::texture::kMaxLevels * 26 + 1;
}

// Bits needed to number n > 0 things: lb n, rounded up.
std::uint8_t ceil_log2(std::uint32_t n) { return static_cast<std::uint8_t>(std::bit_width(n - 1)); }

// Counts from `first` in the bits of `field`, which need not be adjacent.
std::vector<std::uint32_t> count_in(std::uint32_t field, std::uint32_t first, std::uint32_t size) {
  std::vector<std::uint32_t> numbers(size);
  std::uint32_t number = 0;
  for (std::uint32_t& next : numbers) {
    next = first + number;
    number = (number - field) & field;
  }
  return numbers;
}

// Columns and rows of a level in tiles: in a tile by rows, tiles in Morton order. The low bits of
// their numbers interleave, columns in the even bits, as many as the shorter side has; the
// remaining bits are above.
void tabulate_tiles(LevelGeometry& level, std::uint32_t base, std::uint32_t bytes) {
  const std::uint32_t width = spec::texture::kTileWidth[bytes],
                      height = spec::texture::kTileHeight[bytes];
  const int shorter = std::min(ceil_log2((level.width + width - 1) / width),
                               ceil_log2((level.height + height - 1) / height));
  const std::uint32_t above = ~0U << 2 * shorter;
  level.column = count_in((width - 1) * bytes | (0x5555'5555 | above) * spec::texture::kTileBytes,
                          0, level.width);
  level.row =
      count_in((height - 1) * width * bytes | (0xAAAA'AAAA | above) * spec::texture::kTileBytes,
               base, level.height);
}

void tabulate_rows(LevelGeometry& level, std::uint32_t base, std::uint32_t bytes) {
  const std::uint32_t pitch = (level.width * bytes + 63) & ~63u;
  level.column.resize(level.width);
  for (std::uint32_t x = 0; x < level.width; ++x) level.column[x] = x * bytes;
  level.row.resize(level.height);
  for (std::uint32_t y = 0; y < level.height; ++y) level.row[y] = base + y * pitch;
}

// The same for blocks, which are in the places of tiles. Four texels of a row or column share one.
void tabulate_blocks(LevelGeometry& level, std::uint32_t base, std::uint32_t bytes,
                     spec::texture::Layout layout) {
  LevelGeometry blocks;
  blocks.width = static_cast<std::uint16_t>((level.width + 3) / 4);
  blocks.height = static_cast<std::uint16_t>((level.height + 3) / 4);
  if (layout == spec::texture::Layout::kLinear) {
    tabulate_rows(blocks, base, bytes);
  } else {
    const std::uint32_t above = ~0U
                                << 2 * std::min(ceil_log2(blocks.width), ceil_log2(blocks.height));
    blocks.column = count_in((0x5555'5555 | above) * bytes, 0, blocks.width);
    blocks.row = count_in((0xAAAA'AAAA | above) * bytes, base, blocks.height);
  }
  level.column.resize(level.width);
  for (std::uint32_t x = 0; x < level.width; ++x) level.column[x] = blocks.column[x / 4];
  level.row.resize(level.height);
  for (std::uint32_t y = 0; y < level.height; ++y) level.row[y] = blocks.row[y / 4];
}

}  // namespace

std::span<const spec::RegisterInfo> register_table() {
  static std::deque<std::string> names;
  static const std::vector<spec::RegisterInfo> table = [] {
    std::vector<spec::RegisterInfo> all(spec::texture::kRegisters.begin(),
                                        spec::texture::kRegisters.end());
    for (std::uint32_t h = 0; h < spec::texture::kMaxTextures; ++h) {
      const std::uint32_t descriptor = reg::kTextureBase + h * reg::kTextureStride;
      const auto add = [&](spec::RegisterInfo info, const std::string& name) {
        names.push_back("TEXTURE" + std::to_string(h) + "_" + name);
        info.name = names.back();
        info.offset += descriptor;
        all.push_back(info);
      };
      for (const spec::RegisterInfo& info : spec::texture::kDescriptorRegisters)
        add(info, std::string(info.name));
      for (std::uint32_t k = 0; k < spec::texture::kMaxLevels; ++k)
        add({reg::kLevelBase + 4 * k,
             {},
             "Byte address of the level, a multiple of 64.",
             spec::kNumber},
            "BASE_" + std::to_string(k));
    }
    return all;
  }();
  return table;
}

ControlLayout control_layout() {
  return rtl::control_layout(spec::texture::kRegisters, spec::texture::kBusyIgnoresWrites);
}

TextureState decode(const ControlRegisters& registers, std::uint32_t handle,
                    spec::texture::Decode decoders) {
  const auto field = [&](std::uint32_t offset) {
    return registers.value(reg::kTextureBase + handle * reg::kTextureStride + offset);
  };
  const std::uint32_t size = field(reg::kSize), mode = field(reg::kMode),
                      clamp = field(reg::kLodClamp);
  namespace f = reg::mode;
  const std::uint32_t format = f::kFormat.of(mode), wrap_s = f::kWrapS.of(mode),
                      wrap_t = f::kWrapT.of(mode), min_filter = f::kMinFilter.of(mode),
                      levels = f::kLevels.of(mode), max_count_log2 = f::kMaxCount.of(mode);
  const std::uint32_t width = reg::size::kWidth.of(size), height = reg::size::kHeight.of(size),
                      longest = std::max(width, height);
  bool valid = width >= 1 && height >= 1 && longest <= spec::texture::kMaxTextureSize &&
               levels >= 1 && levels <= static_cast<std::uint32_t>(std::bit_width(longest)) &&
               format < spec::texture::kFormatNames.size() &&
               wrap_s < spec::texture::kWrapNames.size() &&
               wrap_t < spec::texture::kWrapNames.size() &&
               min_filter < spec::texture::kMinFilterNames.size() && max_count_log2 <= 4;
  const auto stored = static_cast<spec::texture::Format>(format);
  const bool compressed = spec::texture::is_compressed(stored), srgb = f::kSrgb.of(mode) != 0;
  if (decoders == spec::texture::Decode::kNone)
    valid = valid && !compressed && !srgb;
  else
    valid = valid && (!srgb || spec::texture::may_be_srgb(stored));
  if (!valid) return {};

  TextureState t;
  t.width = static_cast<std::uint16_t>(width);
  t.height = static_cast<std::uint16_t>(height);
  t.levels = static_cast<std::uint8_t>(levels);
  t.format = !compressed ? stored
             : srgb      ? spec::texture::Format::kSrgb8A8
                         : spec::texture::Format::kRgba8;
  t.codec = codec_of(stored);
  t.layout = static_cast<spec::texture::Layout>(f::kLayout.of(mode));
  t.wrap_s = static_cast<spec::texture::Wrap>(wrap_s);
  t.wrap_t = static_cast<spec::texture::Wrap>(wrap_t);
  t.min_filter = static_cast<spec::texture::MinFilter>(min_filter);
  t.mag_filter = static_cast<spec::texture::MagFilter>(f::kMagFilter.of(mode));
  t.max_count_log2 = static_cast<std::uint8_t>(max_count_log2);
  t.bias = static_cast<std::int16_t>(reg::lod_bias::kBias.of(field(reg::kLodBias))) * 16;
  t.min_lod = static_cast<std::int32_t>(reg::lod_clamp::kMinLod.of(clamp) << 4);
  t.max_lod = static_cast<std::int32_t>(reg::lod_clamp::kMaxLod.of(clamp) << 4);
  const std::uint32_t bytes = spec::texture::kFormatBytes[format];
  for (std::uint32_t k = 0; k < levels; ++k) {
    LevelGeometry& g = t.level[k];
    g.width = static_cast<std::uint16_t>(std::max(1, t.width >> k));
    g.height = static_cast<std::uint16_t>(std::max(1, t.height >> k));
    const std::uint32_t base = field(reg::kLevelBase + 4 * k);
    if (compressed)
      tabulate_blocks(g, base, spec::texture::kFormatBlockBytes[format], t.layout);
    else if (t.layout == spec::texture::Layout::kLinear)
      tabulate_rows(g, base, bytes);
    else
      tabulate_tiles(g, base, bytes);
    valid = valid && base % spec::texture::kTileBytes == 0;
  }
  t.valid = valid;
  return t;
}

Descriptors::Descriptors(const char* name, ControlRegisters& registers,
                         const spec::texture::Build& p)
    : decoders_(p.decode),
      memory_(name, {.words = spec::texture::kMaxTextures,
                     .word_bits = word_bits(p),
                     .kind = MemoryKind::kFlops,
                     .read_ports = p.width == 1 ? 3U : 4U,
                     .write_ports = 1,
                     .latency = 0,
                     .content = "texture descriptors"}) {
  if (p.width != 1) for_younger_texels = Reader(memory_, "addresser_younger", words_);
  registers.on_change([this, &registers](std::uint32_t offset) { written(registers, offset); });
}

void Descriptors::written(const ControlRegisters& registers, std::uint32_t offset) {
  if (offset < reg::kTextureBase) return;
  const std::uint32_t handle = (offset - reg::kTextureBase) / reg::kTextureStride;
  words_[handle] = decode(registers, handle, decoders_);
}

Datasheet Descriptors::datasheet(const spec::texture::Build& p) {
  return {.unit = "Descriptors",
          .variant = p.decode != spec::texture::Decode::kNone ? with_blocks(p).substr(2) : "",
          .does = "Stores 16 texture descriptors as in the registers.",
          .latency = {0, "0: flip-flops without output register"},
          .stages = {
              {.clock = "-",
               .work = "descriptor selected; of one that is written, is it valid?",
               .operators = {op::maximum(13), op::leading_one(13), op::compare(4), op::logic(60)},
               .longest = {op::mux(word_bits(p), spec::texture::kMaxTextures)}}}};
}

}  // namespace deburr::rtl::texture
