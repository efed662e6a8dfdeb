// SPDX-License-Identifier: MIT
// Frames of the contract (docs/reference/geometric/vectors.md), and hashes of pixels, weights and
// traffic.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "golden/geometric/geometric_golden.h"
#include "spec/geometric/vectors.h"
#include "tb/stimuli/vector_hash.h"
#include "tb/unit/spec/geometric/vector_frame.h"

namespace deburr::tb::geometric {

// A frame and its mesh. Owns the data that FrameInput refers to.
struct Drawing {
  int width = 0, height = 0;
  std::vector<spec::geometric::Rgba8> colours;
  std::vector<std::uint32_t> depths;
  std::vector<spec::geometric::Vertex> vertices;
  std::vector<std::uint8_t> facing;
  std::uint32_t faces = 0;
  std::vector<spec::geometric::Edge> edges;

  Drawing(int w, int h)
      : width(w),
        height(h),
        colours(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)),
        depths(colours.size()) {}
  void set_facing(std::uint32_t face, bool front) {
    if (face >= faces) faces = face + 1;
    facing.resize((std::size_t{faces} + 7) / 8);
    auto& byte = facing[face >> 3];
    const auto bit = static_cast<std::uint8_t>(1u << (face & 7));
    byte = static_cast<std::uint8_t>(front ? byte | bit : byte & ~bit);
  }
  golden::geometric::FrameInput input(const golden::geometric::Bases& bases = {}) const {
    return {
        {colours, width, height}, {depths, width, height}, edges, vertices, {facing, faces}, bases};
  }
};

constexpr std::uint32_t vector_base(spec::geometric::Region region) {
  return spec::geometric::kVectorBases[static_cast<std::size_t>(region)];
}
inline constexpr golden::geometric::Bases kVectorBases{
    .edges = vector_base(spec::geometric::Region::kEdges),
    .vertices = vector_base(spec::geometric::Region::kVertices),
    .facing = vector_base(spec::geometric::Region::kFaces),
    .depth = vector_base(spec::geometric::Region::kDepth),
    .colour = vector_base(spec::geometric::Region::kColour),
    .weights = vector_base(spec::geometric::Region::kWeights),
    .copy = vector_base(spec::geometric::Region::kCopy),
    .pairs = vector_base(spec::geometric::Region::kPairs),
    .coarse = vector_base(spec::geometric::Region::kCoarse)};

inline Drawing vector_drawing(
    spec::geometric::DrawnFrame which = spec::geometric::DrawnFrame::kRandom) {
  VectorFrame frame = vector_frame(which);
  Drawing d(frame.width, frame.height);
  d.colours = std::move(frame.colours);
  d.depths = std::move(frame.depths);
  d.vertices = std::move(frame.vertices);
  d.edges = std::move(frame.edges);
  for (std::size_t face = 0; face < frame.facing.size(); ++face)
    d.set_facing(static_cast<std::uint32_t>(face), frame.facing[face]);
  return d;
}

inline std::uint64_t hash_of(const std::vector<std::array<std::uint8_t, 4>>& pixels) {
  stimuli::VectorHash hash;
  for (const auto& pixel : pixels)
    for (const std::uint8_t value : pixel) hash.byte(value);
  return hash.value();
}

// Hash of the reads of faces, edges, pairs, vertices, coarse depth, depth and weights, of the
// writes of weights, of the colour reads of the resolve and of the colour writes; with frame_copy
// also of the reads and writes of the copy.
inline std::uint64_t hash_of(const golden::geometric::Traffic& traffic, bool frame_copy) {
  using spec::geometric::Region;
  stimuli::VectorHash hash;
  const auto add = [&](const std::vector<std::uint32_t>& list) {
    for (const std::uint32_t address : list) hash.lowest_first(address, 4);
  };
  for (const Region region : {Region::kFaces, Region::kEdges, Region::kPairs, Region::kVertices,
                              Region::kCoarse, Region::kDepth, Region::kWeights})
    add(traffic.read(region));
  add(traffic.write(Region::kWeights));
  add(traffic.read(frame_copy ? Region::kCopy : Region::kColour));
  add(traffic.write(Region::kColour));
  if (frame_copy) {
    add(traffic.read(Region::kColour));
    add(traffic.write(Region::kCopy));
  }
  return hash.value();
}

}  // namespace deburr::tb::geometric
