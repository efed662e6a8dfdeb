// SPDX-License-Identifier: MIT
// What software puts into memory for the geometric engine, as bytes:
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
// Records = split: faces and flags of all edges; vertices of boundaries, or of all others.
std::vector<std::uint8_t> face_records(std::span<const spec::geometric::Edge> edges);
std::vector<std::uint8_t> pair_records(std::span<const spec::geometric::Edge> edges,
                                       bool boundaries);
std::uint64_t boundaries_of(std::span<const spec::geometric::Edge> edges);
// Bytes of so many records of such an array, whole lines.
std::uint64_t split_bytes(std::uint64_t records);
std::vector<std::uint8_t> vertex_records(std::span<const spec::geometric::Vertex> vertices);
std::vector<std::uint8_t> facing_bits(const std::vector<bool>& faces);

// Where the pixels of a frame lie from the base of colours, depths or the copy on.
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

// A buffer of a whole frame. Values row by row; what lies between the rows and tiles is 0.
std::vector<std::uint8_t> depth_buffer(const PixelLayout& layout,
                                       std::span<const std::uint32_t> depths);
// The coarse depth of a frame, 16 bits a tile of 8 x 8 pixels (coarse_lines).
std::vector<std::uint8_t> coarse_depth(int width, int height,
                                       std::span<const std::uint32_t> depths);
// Its bytes, whole lines.
std::uint64_t coarse_bytes(int width, int height);
std::vector<std::uint8_t> colour_buffer(const PixelLayout& layout,
                                        std::span<const spec::geometric::Rgba8> colours);
// Back again.
std::vector<spec::geometric::Rgba8> colours_of(const PixelLayout& layout,
                                               std::span<const std::uint8_t> buffer);

}  // namespace deburr::platform
