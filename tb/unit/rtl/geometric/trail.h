// SPDX-License-Identifier: MIT
// All that a frame of the geometric engine leaves behind, to compare two of them; and scenes that
// are small enough to be drawn a thousand times.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tb/harness/statistics.h"
#include "tb/unit/rtl/geometric/support.h"

namespace deburr::tb::geometric_rtl {

// The contract's scene with its first edges, cut to a small frame, all of it moved to the right by
// so many pixels.
inline Scene small_scene(int width, int height, std::size_t edges, int right = 0) {
  const Scene whole = contract_scene();
  Scene scene = whole;
  scene.width = width;
  scene.height = height;
  scene.edges.resize(edges);
  for (spec::geometric::Vertex& vertex : scene.vertices) vertex.x += 256 * right;
  scene.colours.clear();
  scene.depths.clear();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto at = static_cast<std::size_t>(y * whole.width + x % whole.width);
      scene.colours.push_back(whole.colours[at]);
      scene.depths.push_back(whole.depths[at]);
    }
  return scene;
}

inline std::string registers_of(EngineBench& b) {
  std::string text;
  for (const spec::RegisterInfo& info : spec::geometric::kRegisters)
    text += std::string(info.name) + "=" + std::to_string(b.bus.read(info.offset)) + " ";
  return text;
}

struct Trail {
  // What the frame is; accesses by region, reads and writes each in order.
  std::vector<spec::geometric::LineRecord> lines;
  std::vector<spec::geometric::Candidate> candidates;
  std::vector<spec::geometric::BlockRecord> blocks;
  std::vector<std::vector<std::uint64_t>> traffic;
  std::uint64_t pixels = 0;
  // How regions interleave, in how many clocks, and whatever was counted since the last reset.
  std::vector<std::uint64_t> reads, writes;
  std::string statistics, registers;
};
// Of the last run.
inline Trail trail_of(EngineBench& b) {
  Trail trail = {b.lines,
                 b.candidates,
                 b.blocks,
                 {},
                 b.pixel_hash(),
                 b.memory.lines_read(),
                 b.memory.lines_written(),
                 statistics(b.clock).dump(),
                 registers_of(b)};
  for (const std::uint32_t base :
       {b.bases.faces, b.bases.edges, b.bases.vertices, b.bases.depth, b.bases.weights,
        b.bases.colour, b.bases.copy, b.bases.pairs, b.bases.coarse}) {
    trail.traffic.push_back(b.reads(base));
    trail.traffic.push_back(b.writes(base));
  }
  return trail;
}
// The first kind of thing that differs; empty if nothing does.
inline std::string frame_difference(const Trail& a, const Trail& b) {
  if (a.lines != b.lines) return "lines";
  if (a.candidates != b.candidates) return "candidates";
  if (a.blocks != b.blocks) return "blocks";
  if (a.traffic != b.traffic) return "accesses of a region";
  if (a.pixels != b.pixels) return "pixels";
  return "";
}
inline std::string trail_difference(const Trail& a, const Trail& b) {
  if (std::string frame = frame_difference(a, b); !frame.empty()) return frame;
  if (a.reads != b.reads || a.writes != b.writes) return "order of accesses";
  if (a.registers != b.registers) return "registers: " + a.registers + "; " + b.registers;
  if (a.statistics != b.statistics) return "statistics: " + a.statistics + "; " + b.statistics;
  return "";
}

}  // namespace deburr::tb::geometric_rtl
