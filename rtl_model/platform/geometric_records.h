// SPDX-License-Identifier: MIT
// Memory images that software writes for the geometric engine, as bytes:
// docs/reference/geometric/memory.md, "What is in memory".
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "spec/geometric/packets.h"
#include "spec/geometric/parameters.h"
#include "spec/geometric/records.h"

namespace deburr::platform {

std::vector<std::uint8_t> edge_records(std::span<const spec::geometric::Edge> edges);
// records = split: faces and flags of all edges; vertices of the boundaries, or of all other edges.
std::vector<std::uint8_t> face_records(std::span<const spec::geometric::Edge> edges);
std::vector<std::uint8_t> pair_records(std::span<const spec::geometric::Edge> edges,
                                       bool boundaries);
std::uint64_t boundaries_of(std::span<const spec::geometric::Edge> edges);
// Bytes of an array with that many records, rounded up to whole lines.
std::uint64_t split_bytes(std::uint64_t records);
std::vector<std::uint8_t> vertex_records(std::span<const spec::geometric::Vertex> vertices);
std::vector<std::uint8_t> facing_bits(const std::vector<bool>& faces);

// Pixel offsets from the base of colours, depths or the copy.
class PixelLayout {
 public:
  PixelLayout(spec::geometric::Layout layout, int width, int height);
  std::uint32_t offset_of(int x, int y) const;
  std::uint64_t bytes() const;
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  bool tiled_;
  int width_, height_;
};

// The buffer of a whole frame, from values row by row; padding between rows and tiles is 0.
std::vector<std::uint8_t> depth_buffer(const PixelLayout& layout,
                                       std::span<const std::uint32_t> depths);
// The coarse depth of a frame, 16 bits per tile of 8 x 8 pixels (coarse_lines).
std::vector<std::uint8_t> coarse_depth(int width, int height,
                                       std::span<const std::uint32_t> depths);
// Its size in bytes, whole lines.
std::uint64_t coarse_bytes(int width, int height);
std::vector<std::uint8_t> colour_buffer(const PixelLayout& layout,
                                        std::span<const spec::geometric::Rgba8> colours);
// Reads the colours back from a buffer.
std::vector<spec::geometric::Rgba8> colours_of(const PixelLayout& layout,
                                               std::span<const std::uint8_t> buffer);

}  // namespace deburr::platform
