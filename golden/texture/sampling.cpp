// SPDX-License-Identifier: MIT
#include "golden/texture/sampling.h"

#include <bit>

namespace deburr::golden::texture {
namespace {

struct TileGrid {
  std::uint32_t tile_width, tile_height;  // texels
  int lb_columns, lb_rows;                // of the grid, rounded up to a power of two
};

int ceil_log2(std::uint32_t x) { return static_cast<int>(std::bit_width(x - 1)); }

TileGrid tile_grid(const spec::texture::Descriptor& descriptor, int level) {
  const std::size_t bytes =
      spec::texture::kFormatBytes[static_cast<std::size_t>(descriptor.format)];
  const std::uint32_t tile_width = spec::texture::kTileWidth[bytes],
                      tile_height = spec::texture::kTileHeight[bytes];
  const auto width = static_cast<std::uint32_t>(level_size(descriptor.width, level));
  const auto height = static_cast<std::uint32_t>(level_size(descriptor.height, level));
  return {tile_width, tile_height, ceil_log2((width + tile_width - 1) / tile_width),
          ceil_log2((height + tile_height - 1) / tile_height)};
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

std::uint32_t texel_bytes(const spec::texture::Descriptor& descriptor) {
  return spec::texture::kFormatBytes[static_cast<std::size_t>(descriptor.format)];
}

std::uint32_t row_pitch(const spec::texture::Descriptor& descriptor, int level) {
  const auto width = static_cast<std::uint32_t>(level_size(descriptor.width, level));
  return (width * texel_bytes(descriptor) + 63) / 64 * 64;
}

}  // namespace

std::uint32_t texel_address(const spec::texture::Descriptor& descriptor, int level, std::int32_t x,
                            std::int32_t y) {
  const std::uint32_t base = descriptor.base[static_cast<std::size_t>(level)];
  const auto column = static_cast<std::uint32_t>(x), row = static_cast<std::uint32_t>(y);
  const std::uint32_t bytes = texel_bytes(descriptor);
  if (descriptor.layout == spec::texture::Layout::kLinear) {
    return base + row * row_pitch(descriptor, level) + column * bytes;
  }
  const TileGrid grid = tile_grid(descriptor, level);
  const std::uint32_t tile = morton_index(column / grid.tile_width, row / grid.tile_height, grid);
  const std::uint32_t inside = row % grid.tile_height * grid.tile_width + column % grid.tile_width;
  return base + tile * spec::texture::kTileBytes + inside * bytes;
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
    return std::uint64_t{row_pitch(descriptor, level)} *
           static_cast<std::uint32_t>(level_size(descriptor.height, level));
  }
  const TileGrid grid = tile_grid(descriptor, level);
  return std::uint64_t{spec::texture::kTileBytes} << (grid.lb_columns + grid.lb_rows);
}

const char* descriptor_fault(const spec::texture::Descriptor& descriptor) {
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
