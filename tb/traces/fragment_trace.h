// SPDX-License-Identifier: MIT
// Content of a fragment trace (docs/reference/traces.md): quads of the texture unit, each with the
// data needed to draw it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>

#include "spec/texture/packets.h"

namespace deburr::tb::traces {

struct TracedQuad {
  spec::texture::Quad quad;    // tag: its index in the trace
  std::uint8_t visible = 0xF;  // bit i: the colour of lane i is visible
  bool placed = false;         // x and y are picture coordinates

  int x(int lane) const { return quad.x + (lane & 1); }
  int y(int lane) const { return quad.y + (lane >> 1); }
  // Whether the colour of this lane is drawn to a pixel.
  bool shows(int lane) const { return placed && (visible >> lane & 1) != 0; }
};

// Returns the next quad; false at the end.
using QuadSource = std::function<bool(TracedQuad&)>;

inline constexpr std::uint32_t kFragmentTraceVersion = 1;
inline constexpr std::string_view kFragmentTraceMagic = "DEBURRFT";
inline constexpr std::string_view kFragmentTraceTitle = "deburr-fragments";
inline constexpr std::size_t kFragmentHeaderBytes = 64, kFragmentRecordBytes = 80;
inline constexpr int kMostPictureSide = 8192;  // pixels

// Record types: four lanes, or one lane with its derivatives.
enum class FragmentRecord : std::uint8_t { kQuad = 0, kFragment = 1 };

}  // namespace deburr::tb::traces
