// SPDX-License-Identifier: MIT
// The frames of the vectors in docs/reference/geometric/vectors.md: random edges, and special
// cases.
#pragma once

#include <algorithm>
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

// Bits of records and depth words that memory.md ignores. In the frame of special cases they are 1.
inline constexpr std::array<std::uint32_t, 4> kIgnoredOfEdge = {0xFF000000, 0xFF000000, 0xF0000000,
                                                                0xFF000000};
inline constexpr std::uint32_t kIgnoredOfDepth = 0xFF000000;

// Ignored bits are 1 where a packet holds them; for the others, in indices and `usable`, the writer
// of the records must set them.
inline VectorFrame special_frame() {
  stimuli::Sequence sequence;
  const auto r = [&sequence] { return sequence.next(); };
  // Multiples of a quarter of a pixel.
  const auto quarters = [&r](std::uint32_t count) {
    return static_cast<std::int32_t>((r() >> 16) % count) * 64 - 512;
  };
  VectorFrame frame;
  const int pixels = frame.width * frame.height;
  for (int i = 0; i < pixels; ++i) {
    const std::uint32_t v = r();
    frame.colours.push_back({static_cast<std::uint8_t>(v >> 24), static_cast<std::uint8_t>(v >> 16),
                             static_cast<std::uint8_t>(v >> 8), static_cast<std::uint8_t>(v)});
  }
  // 8000000 is 8015655 and 16000000 minus their fractions by a depth_bias of 9 and 1; 12000000 is
  // 12800000 and 16000000 minus theirs by a crease_depth of 4 and 2.
  constexpr std::array<std::uint32_t, 8> kDepths = {0,        4000000,  8000000,  8015655,
                                                    12000000, 12800000, 16000000, 16777215};
  for (int i = 0; i < pixels; ++i) frame.depths.push_back(kDepths[r() >> 29] | kIgnoredOfDepth);
  constexpr std::int32_t kBand = spec::geometric::kGuardBand;
  for (int i = 0; i < 100; ++i) {
    spec::geometric::Vertex a, b;
    for (spec::geometric::Vertex* v : {&a, &b}) {
      v->x = quarters(264);
      v->y = quarters(200);
      v->depth = kDepths[r() >> 29] | kIgnoredOfDepth;
      v->usable = true;
    }
    if (i % 2 == 0) b.depth = a.depth;
    const auto beside = [&](std::int32_t major, std::int32_t minor) {
      b.x = a.x + (i % 4 < 2 ? major : minor);
      b.y = a.y + (i % 4 < 2 ? minor : major);
    };
    if (i >= 30 && i < 50) {  // along a border of the frame
      if (i < 40)
        a.y = b.y = i % 2 == 0 ? 0 : 256 * frame.height;
      else
        a.x = b.x = i % 2 == 0 ? 0 : 256 * frame.width;
    } else if (i >= 50 && i < 65) {  // horizontal, through centres
      a.y = b.y = (a.y & ~255) + 128;
    } else if (i >= 65 && i < 80) {  // diagonal
      beside(b.y - a.y, b.y - a.y);
    } else if (i >= 80 && i < 90) {  // of slope 1/2
      beside(2 * (b.y - a.y), b.y - a.y);
    } else if (i >= 90 && i < 95) {  // from one end of the guard band to the other
      (i % 2 == 0 ? a.x : a.y) = -kBand;
      (i % 2 == 0 ? b.x : b.y) = kBand - 1;
    } else if (i >= 95) {  // of slope slightly above 1/2
      a.x &= ~127;
      a.y &= ~127;
      beside(1 << 21, (1 << 20) + 1);
    }
    frame.vertices.push_back(a);
    frame.vertices.push_back(b);
  }
  for (int i = 0; i < 50; ++i) frame.facing.push_back(r() >> 31 != 0);
  for (std::uint32_t i = 0; i < 400; ++i) {
    spec::geometric::Edge e;
    e.v0 = (r() >> 16) % 200;
    e.v1 = (r() >> 16) % 200;
    if (i < 100) {
      e.v0 = 2 * i + (e.v0 & 1);
      e.v1 = e.v0 ^ 1;
    }
    e.f0 = (r() >> 16) % 50;
    e.f1 = (r() >> 16) % 50;
    e.flags = static_cast<std::uint8_t>((r() >> 16) % 16 | kIgnoredOfEdge[2] >> 24);
    if (e.flags & spec::geometric::flag::kBoundary) e.f1 = spec::geometric::kIndexMask;
    frame.edges.push_back(e);
  }
  return frame;
}

// Nearly equal depths for the pixels of a tile.
inline VectorFrame tiles_frame() {
  VectorFrame frame = vector_frame();
  const std::vector<std::uint32_t> depths = frame.depths;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const auto at = [&frame](int column, int row) {
        return static_cast<std::size_t>(row * frame.width + column);
      };
      frame.depths[at(x, y)] =
          std::min(0xFFFFFFu, depths[at(x & ~7, y & ~7)] + (depths[at(x, y)] >> 6));
    }
  return frame;
}

inline VectorFrame vector_frame(spec::geometric::DrawnFrame frame) {
  switch (frame) {
    case spec::geometric::DrawnFrame::kSpecial:
      return special_frame();
    case spec::geometric::DrawnFrame::kTiles:
      return tiles_frame();
    default:
      return vector_frame();
  }
}

// The vectors of both frames.
inline std::vector<spec::geometric::FrameVector> all_frame_vectors() {
  std::vector<spec::geometric::FrameVector> all(spec::geometric::kFrameVectors.begin(),
                                                spec::geometric::kFrameVectors.end());
  all.insert(all.end(), spec::geometric::kSpecialFrameVectors.begin(),
             spec::geometric::kSpecialFrameVectors.end());
  return all;
}

// A vector by its name.
inline spec::geometric::FrameVector frame_vector(char name) {
  for (const spec::geometric::FrameVector& v : all_frame_vectors())
    if (v.name == name) return v;
  for (const spec::geometric::FrameVector& v : spec::geometric::kTrafficFrameVectors)
    if (v.name == name) return v;
  throw std::out_of_range(std::string("no test vector ") + name);
}

}  // namespace deburr::tb::geometric
