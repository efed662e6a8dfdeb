// SPDX-License-Identifier: MIT
#include "golden/texture/sampling.h"

#include <bit>

namespace deburr::golden::texture {
namespace {

std::uint32_t block_bytes(const spec::texture::Descriptor& descriptor) {
  return spec::texture::kFormatBlockBytes[static_cast<std::size_t>(descriptor.format)];
}
std::uint32_t texel_bytes(const spec::texture::Descriptor& descriptor) {
  return spec::texture::kFormatBytes[static_cast<std::size_t>(descriptor.format)];
}

// Rectangles of texels that are stored one after the other: tiles, or blocks.
struct TileGrid {
  std::uint32_t tile_width, tile_height;  // texels
  std::uint32_t tile_bytes;
  std::uint32_t columns, rows;
  int lb_columns, lb_rows;  // of the grid, rounded up to a power of two
};

int ceil_log2(std::uint32_t x) { return static_cast<int>(std::bit_width(x - 1)); }

TileGrid tile_grid(const spec::texture::Descriptor& descriptor, int level) {
  const bool blocks = spec::texture::is_compressed(descriptor.format);
  const std::uint32_t bytes = texel_bytes(descriptor);
  TileGrid grid{};
  grid.tile_width = blocks ? 4 : spec::texture::kTileWidth[bytes];
  grid.tile_height = blocks ? 4 : spec::texture::kTileHeight[bytes];
  grid.tile_bytes = blocks ? block_bytes(descriptor) : spec::texture::kTileBytes;
  const auto width = static_cast<std::uint32_t>(level_size(descriptor.width, level));
  const auto height = static_cast<std::uint32_t>(level_size(descriptor.height, level));
  grid.columns = (width + grid.tile_width - 1) / grid.tile_width;
  grid.rows = (height + grid.tile_height - 1) / grid.tile_height;
  grid.lb_columns = ceil_log2(grid.columns);
  grid.lb_rows = ceil_log2(grid.rows);
  return grid;
}

// Interleaves the bits of column and row, column bits in the even positions; the extra bits of the
// longer axis are above them.
std::uint32_t morton_index(std::uint32_t column, std::uint32_t row, const TileGrid& grid) {
  const int common = std::min(grid.lb_columns, grid.lb_rows);
  std::uint32_t index = 0;
  for (int bit = 0; bit < common; ++bit) {
    index |= (column >> bit & 1) << (2 * bit) | (row >> bit & 1) << (2 * bit + 1);
  }
  return index | (column >> common | row >> common) << (2 * common);
}

// Rows of texels, or of blocks, in the layout `linear`.
struct Rows {
  std::uint32_t pitch, count;
};
Rows rows_of(const spec::texture::Descriptor& descriptor, int level) {
  std::uint32_t bytes = 0, count = 0;
  if (spec::texture::is_compressed(descriptor.format)) {
    const TileGrid grid = tile_grid(descriptor, level);
    bytes = grid.columns * grid.tile_bytes;
    count = grid.rows;
  } else {
    bytes =
        static_cast<std::uint32_t>(level_size(descriptor.width, level)) * texel_bytes(descriptor);
    count = static_cast<std::uint32_t>(level_size(descriptor.height, level));
  }
  return {(bytes + 63) / 64 * 64, count};
}

}  // namespace

std::uint32_t texel_address(const spec::texture::Descriptor& descriptor, int level, std::int32_t x,
                            std::int32_t y) {
  const std::uint32_t base = descriptor.base[static_cast<std::size_t>(level)];
  const auto column = static_cast<std::uint32_t>(x), row = static_cast<std::uint32_t>(y);
  const bool blocks = spec::texture::is_compressed(descriptor.format);
  const std::uint32_t bytes = texel_bytes(descriptor);
  if (descriptor.layout == spec::texture::Layout::kLinear) {
    const std::uint32_t pitch = rows_of(descriptor, level).pitch;
    if (blocks) return base + row / 4 * pitch + column / 4 * block_bytes(descriptor);
    return base + row * pitch + column * bytes;
  }
  const TileGrid grid = tile_grid(descriptor, level);
  const std::uint32_t tile = morton_index(column / grid.tile_width, row / grid.tile_height, grid);
  const std::uint32_t inside = row % grid.tile_height * grid.tile_width + column % grid.tile_width;
  return base + tile * grid.tile_bytes + (blocks ? 0 : inside * bytes);
}

// The sum is possible in both layouts: a tile number interleaves the bits of its column and its
// row.
LevelAddresses level_addresses(const spec::texture::Descriptor& descriptor, int level) {
  LevelAddresses addresses;
  const std::uint32_t base = texel_address(descriptor, level, 0, 0);
  for (std::int32_t x = 0; x < level_size(descriptor.width, level); ++x) {
    addresses.column.push_back(texel_address(descriptor, level, x, 0) - base);
  }
  for (std::int32_t y = 0; y < level_size(descriptor.height, level); ++y) {
    addresses.row.push_back(texel_address(descriptor, level, 0, y));
  }
  return addresses;
}

std::uint64_t level_bytes(const spec::texture::Descriptor& descriptor, int level) {
  if (descriptor.layout == spec::texture::Layout::kLinear) {
    const Rows rows = rows_of(descriptor, level);
    return std::uint64_t{rows.pitch} * rows.count;
  }
  const TileGrid grid = tile_grid(descriptor, level);
  return std::uint64_t{grid.tile_bytes} << (grid.lb_columns + grid.lb_rows);
}

const char* descriptor_fault(const spec::texture::Descriptor& descriptor,
                             spec::texture::Decode decode) {
  const auto known = [](auto code, const auto& names) {
    return static_cast<std::size_t>(code) < names.size();
  };
  if (descriptor.width == 0 || descriptor.height == 0) return "width or height is zero";
  if (descriptor.width > spec::texture::kMaxTextureSize ||
      descriptor.height > spec::texture::kMaxTextureSize) {
    return "width or height is over 4096";
  }
  const std::uint32_t longest = std::max(descriptor.width, descriptor.height);
  if (descriptor.levels == 0) return "no level";
  if (descriptor.levels > std::bit_width(longest)) return "more levels than the size allows";
  if (!known(descriptor.format, spec::texture::kFormatNames)) return "unknown format";
  if (spec::texture::is_compressed(descriptor.format) && decode == spec::texture::Decode::kNone)
    return "the format is compressed, and decode is none";
  if (descriptor.srgb && !spec::texture::may_be_srgb(descriptor.format))
    return "srgb is set, which only bc1, bc3 and etc2 have";
  if (!known(descriptor.layout, spec::texture::kLayoutNames)) return "unknown layout";
  if (!known(descriptor.wrap_s, spec::texture::kWrapNames) ||
      !known(descriptor.wrap_t, spec::texture::kWrapNames)) {
    return "unknown wrap mode";
  }
  if (!known(descriptor.min_filter, spec::texture::kMinFilterNames) ||
      !known(descriptor.mag_filter, spec::texture::kMagFilterNames)) {
    return "unknown filter";
  }
  if (descriptor.max_anisotropy_log2 > 4) return "N_max is over 16";
  for (std::size_t level = 0; level < descriptor.levels; ++level) {
    if (descriptor.base[level] % 64 != 0) return "the base of a level is not a multiple of 64";
  }
  return nullptr;
}

}  // namespace deburr::golden::texture
