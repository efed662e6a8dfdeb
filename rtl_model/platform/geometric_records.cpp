// SPDX-License-Identifier: MIT
#include "rtl_model/platform/geometric_records.h"

#include <algorithm>
#include <initializer_list>

namespace deburr::platform {
namespace {

void put_words(std::vector<std::uint8_t>& bytes, std::initializer_list<std::uint32_t> words) {
  for (const std::uint32_t word : words)
    for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(word >> (8 * i)));
}

// Stores record n of an array of six-byte records, ten per line, from the low 48 bits of `record`.
void put_split(std::vector<std::uint8_t>& bytes, std::size_t n, std::uint64_t record) {
  bytes.resize(split_bytes(n + 1));
  const std::size_t first = n / spec::geometric::kSplitInLine * spec::geometric::kLineBytes +
                            n % spec::geometric::kSplitInLine * spec::geometric::kSplitBytes;
  for (std::size_t i = 0; i < spec::geometric::kSplitBytes; ++i)
    bytes[first + i] = static_cast<std::uint8_t>(record >> (8 * i));
}

bool is_boundary(const spec::geometric::Edge& edge) {
  return edge.flags & spec::geometric::flag::kBoundary;
}

// Calls pixel(index, offset) for each pixel of the frame, row by row.
template <class Pixel>
void each_pixel(const PixelLayout& layout, Pixel&& pixel) {
  std::size_t index = 0;
  for (int y = 0; y < layout.height(); ++y)
    for (int x = 0; x < layout.width(); ++x) pixel(index++, layout.offset_of(x, y));
}

}  // namespace

std::vector<std::uint8_t> edge_records(std::span<const spec::geometric::Edge> edges) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(edges.size() * spec::geometric::kEdgeBytes);
  for (const spec::geometric::Edge& e : edges)
    put_words(bytes,
              {e.v0, e.v1, e.f0 | std::uint32_t{e.flags} << spec::geometric::kFlagShift, e.f1});
  return bytes;
}

std::uint64_t split_bytes(std::uint64_t records) {
  constexpr std::uint64_t kInLine = spec::geometric::kSplitInLine;
  return (records + kInLine - 1) / kInLine * spec::geometric::kLineBytes;
}

std::uint64_t boundaries_of(std::span<const spec::geometric::Edge> edges) {
  return static_cast<std::uint64_t>(std::count_if(edges.begin(), edges.end(), is_boundary));
}

std::vector<std::uint8_t> face_records(std::span<const spec::geometric::Edge> edges) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(split_bytes(edges.size()));
  const auto face = [](std::uint32_t f) {
    // An index out of range stays out of range.
    return std::uint64_t{std::min(f, spec::geometric::kSplitFaceMask)};
  };
  std::size_t n = 0;
  for (const spec::geometric::Edge& e : edges)
    put_split(bytes, n++,
              face(e.f0) | face(e.f1) << spec::geometric::kSplitFaceBits |
                  std::uint64_t{e.flags & 0xFu} << spec::geometric::kSplitFlagShift);
  return bytes;
}

std::vector<std::uint8_t> pair_records(std::span<const spec::geometric::Edge> edges,
                                       bool boundaries) {
  std::vector<std::uint8_t> bytes;
  std::size_t n = 0;
  for (const spec::geometric::Edge& e : edges)
    if (is_boundary(e) == boundaries)
      put_split(bytes, n++,
                std::uint64_t{e.v0 & spec::geometric::kIndexMask} |
                    std::uint64_t{e.v1 & spec::geometric::kIndexMask}
                        << spec::geometric::kSplitVertexBits);
  return bytes;
}

std::vector<std::uint8_t> vertex_records(std::span<const spec::geometric::Vertex> vertices) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(vertices.size() * spec::geometric::kVertexBytes);
  for (const spec::geometric::Vertex& v : vertices)
    put_words(bytes, {static_cast<std::uint32_t>(v.x), static_cast<std::uint32_t>(v.y), v.depth,
                      std::uint32_t{v.usable}});
  return bytes;
}

std::vector<std::uint8_t> facing_bits(const std::vector<bool>& faces) {
  std::vector<std::uint8_t> bytes((faces.size() + 7) / 8);
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (faces[f]) bytes[f / 8] = static_cast<std::uint8_t>(bytes[f / 8] | 1u << f % 8);
  return bytes;
}

PixelLayout::PixelLayout(spec::geometric::Layout layout, int width, int height)
    : tiled_(layout == spec::geometric::Layout::kTiled), width_(width), height_(height) {}

std::uint32_t PixelLayout::offset_of(int x, int y) const {
  constexpr std::uint32_t kPixel = spec::geometric::kPixelBytes,
                          kLine = spec::geometric::kLineBytes;
  const auto column = static_cast<std::uint32_t>(x), row = static_cast<std::uint32_t>(y),
             across = static_cast<std::uint32_t>(width_);
  if (!tiled_) return row * ((kPixel * across + kLine - 1) / kLine * kLine) + kPixel * column;
  const std::uint32_t tile = row / 8 * ((across + 7) / 8) + column / 8;
  const std::uint32_t block = row / 4 % 2 * 2 + column / 4 % 2;
  return (4 * tile + block) * kLine + kPixel * (row % 4 * 4 + column % 4);
}

std::uint64_t PixelLayout::bytes() const {
  constexpr std::uint64_t kLine = spec::geometric::kLineBytes;
  const auto across = static_cast<std::uint64_t>(width_),
             down = static_cast<std::uint64_t>(height_);
  const std::uint64_t lines =
      tiled_
          ? 4 * ((across + 7) / 8) * ((down + 7) / 8)
          : down * ((across + spec::geometric::kPixelsInLine - 1) / spec::geometric::kPixelsInLine);
  return lines * kLine;
}

std::vector<std::uint8_t> depth_buffer(const PixelLayout& layout,
                                       std::span<const std::uint32_t> depths) {
  std::vector<std::uint8_t> bytes(layout.bytes());
  each_pixel(layout, [&](std::size_t index, std::uint32_t offset) {
    for (std::size_t i = 0; i < 4; ++i)
      bytes[offset + i] = static_cast<std::uint8_t>(depths[index] >> (8 * i));
  });
  return bytes;
}

std::uint64_t coarse_bytes(int width, int height) {
  constexpr int kAcross = spec::geometric::kTileSize * spec::geometric::kCoarseAcross,
                kDown = spec::geometric::kTileSize * spec::geometric::kCoarseDown;
  const auto lines = [](int size, int of) {
    return static_cast<std::uint64_t>((size + of - 1) / of);
  };
  return spec::geometric::kLineBytes * lines(width, kAcross) * lines(height, kDown);
}

std::vector<std::uint8_t> coarse_depth(int width, int height,
                                       std::span<const std::uint32_t> depths) {
  constexpr std::size_t kTile = spec::geometric::kTileSize,
                        kAcross = spec::geometric::kCoarseAcross,
                        kDown = spec::geometric::kCoarseDown;
  const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  const std::size_t lines_across = (columns + kTile * kAcross - 1) / (kTile * kAcross);
  std::vector<std::uint8_t> bytes(coarse_bytes(width, height));
  for (std::size_t ty = 0; ty * kTile < rows; ++ty)
    for (std::size_t tx = 0; tx * kTile < columns; ++tx) {
      std::uint32_t least = 0xFFFFFF;
      for (std::size_t y = ty * kTile; y < std::min(rows, (ty + 1) * kTile); ++y)
        for (std::size_t x = tx * kTile; x < std::min(columns, (tx + 1) * kTile); ++x)
          least = std::min(least, depths[y * columns + x] & 0xFFFFFF);
      const std::size_t at =
          spec::geometric::kLineBytes * (ty / kDown * lines_across + tx / kAcross) +
          spec::geometric::kCoarseBytes * (ty % kDown * kAcross + tx % kAcross);
      bytes[at] = static_cast<std::uint8_t>(least >> spec::geometric::kCoarseShift);
      bytes[at + 1] = static_cast<std::uint8_t>(least >> (spec::geometric::kCoarseShift + 8));
    }
  return bytes;
}

std::vector<std::uint8_t> colour_buffer(const PixelLayout& layout,
                                        std::span<const spec::geometric::Rgba8> colours) {
  std::vector<std::uint8_t> bytes(layout.bytes());
  each_pixel(layout, [&](std::size_t index, std::uint32_t offset) {
    std::copy(colours[index].begin(), colours[index].end(),
              bytes.begin() + static_cast<std::ptrdiff_t>(offset));
  });
  return bytes;
}

std::vector<spec::geometric::Rgba8> colours_of(const PixelLayout& layout,
                                               std::span<const std::uint8_t> buffer) {
  std::vector<spec::geometric::Rgba8> colours(static_cast<std::size_t>(layout.width()) *
                                              static_cast<std::size_t>(layout.height()));
  each_pixel(layout, [&](std::size_t index, std::uint32_t offset) {
    std::copy_n(buffer.begin() + static_cast<std::ptrdiff_t>(offset), colours[index].size(),
                colours[index].begin());
  });
  return colours;
}

}  // namespace deburr::platform
