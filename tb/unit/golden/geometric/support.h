// SPDX-License-Identifier: MIT
// The contract's frame of random edges (docs/geometric.md, "Vectors"), and hashes of what came of
// it.
#pragma once

#include <cstdint>
#include <vector>

#include "golden/geometric/geometric_golden.h"

namespace deburr::tb::geometric {

class Fnv {
 public:
  void byte(unsigned value) { hash_ = (hash_ ^ value) * 1099511628211u; }
  void word(std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8) byte(value >> shift & 255);
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 1469598103934665603u;
};

// A frame and what it is drawn from; owns what the golden only looks at.
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

inline constexpr golden::geometric::Bases kVectorBases{.edges = 0x10000,
                                                       .vertices = 0x20000,
                                                       .facing = 0x30000,
                                                       .depth = 0x40000,
                                                       .colour = 0x50000,
                                                       .weights = 0x60000,
                                                       .copy = 0x70000};

inline Drawing vector_drawing() {
  std::uint32_t state = 1;
  const auto r = [&state] { return state = 1664525u * state + 1013904223u; };
  Drawing d(61, 45);
  for (auto& pixel : d.colours) {
    const std::uint32_t v = r();
    pixel = {static_cast<std::uint8_t>(v >> 24), static_cast<std::uint8_t>(v >> 16),
             static_cast<std::uint8_t>(v >> 8), 255};
  }
  constexpr std::uint32_t kDepths[] = {0,       3000000, 3005000, 6000000,
                                       6011000, 9000000, 9017000, 16777215};
  for (std::uint32_t& depth : d.depths) depth = kDepths[r() >> 29];
  for (int i = 0; i < 200; ++i) {
    spec::geometric::Vertex v;
    v.x = static_cast<std::int32_t>((r() >> 16) % 20480) - 2304;
    v.y = static_cast<std::int32_t>((r() >> 16) % 16384) - 2304;
    v.depth = r() >> 8;
    v.usable = i != 7;
    if (i < 10) {
      v.x &= ~127;
      v.y &= ~127;
    }
    if (i == 11) v.x = 1 << 22;
    d.vertices.push_back(v);
  }
  for (std::uint32_t face = 0; face < 49; ++face) d.set_facing(face, r() >> 31 != 0);
  for (int i = 0; i < 300; ++i) {
    spec::geometric::Edge e;
    e.v0 = (r() >> 16) % 201;
    e.v1 = (r() >> 16) % 200;
    e.f0 = (r() >> 16) % 50;
    e.f1 = (r() >> 16) % 50;
    e.flags = static_cast<std::uint8_t>((r() >> 16) % 16);
    d.edges.push_back(e);
  }
  return d;
}

inline std::uint64_t hash_of(const std::vector<std::array<std::uint8_t, 4>>& pixels) {
  Fnv hash;
  for (const auto& pixel : pixels)
    for (const std::uint8_t value : pixel) hash.byte(value);
  return hash.value();
}

// Of the reads of faces, edges, vertices, depth and weights, the writes of weights, the reads of
// colours by the resolve, the writes of colours, and the reads and writes of the copying.
inline std::uint64_t hash_of(const golden::geometric::Traffic& traffic, bool frame_copy) {
  using spec::geometric::Region;
  Fnv hash;
  const auto add = [&](const std::vector<std::uint32_t>& list) {
    for (const std::uint32_t address : list) hash.word(address);
  };
  for (const Region region :
       {Region::kFaces, Region::kEdges, Region::kVertices, Region::kDepth, Region::kWeights})
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
