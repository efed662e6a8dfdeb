// SPDX-License-Identifier: MIT
// The frame of random edges that the vectors of docs/reference/geometric/vectors.md are about.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "spec/geometric/packets.h"
#include "spec/geometric/records.h"
#include "spec/geometric/vectors.h"
#include "tb/stimuli/frames.h"

namespace deburr::tb::geometric {

struct VectorFrame {
  int width = 61, height = 45;
  std::vector<spec::geometric::Rgba8> colours;
  std::vector<std::uint32_t> depths;
  std::vector<spec::geometric::Vertex> vertices;
  std::vector<bool> facing;
  std::vector<spec::geometric::Edge> edges;
};

inline VectorFrame vector_frame() {
  stimuli::Sequence sequence;
  const auto r = [&sequence] { return sequence.next(); };
  VectorFrame frame;
  const int pixels = frame.width * frame.height;
  for (int i = 0; i < pixels; ++i) {
    const std::uint32_t v = r();
    frame.colours.push_back({static_cast<std::uint8_t>(v >> 24), static_cast<std::uint8_t>(v >> 16),
                             static_cast<std::uint8_t>(v >> 8), 255});
  }
  constexpr std::array<std::uint32_t, 8> kDepths = {0,       3000000, 3005000, 6000000,
                                                    6011000, 9000000, 9017000, 16777215};
  for (int i = 0; i < pixels; ++i) frame.depths.push_back(kDepths[r() >> 29]);
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
    frame.vertices.push_back(v);
  }
  for (int i = 0; i < 49; ++i) frame.facing.push_back(r() >> 31 != 0);
  for (int i = 0; i < 300; ++i) {
    spec::geometric::Edge e;
    e.v0 = (r() >> 16) % 201;
    e.v1 = (r() >> 16) % 200;
    e.f0 = (r() >> 16) % 50;
    e.f1 = (r() >> 16) % 50;
    e.flags = static_cast<std::uint8_t>((r() >> 16) % 16);
    frame.edges.push_back(e);
  }
  return frame;
}

// A vector by its name.
inline const spec::geometric::FrameVector& frame_vector(char name) {
  for (const spec::geometric::FrameVector& v : spec::geometric::kFrameVectors)
    if (v.name == name) return v;
  throw std::out_of_range(std::string("no test vector ") + name);
}

}  // namespace deburr::tb::geometric
