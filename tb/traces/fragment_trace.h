// SPDX-License-Identifier: MIT
// What a trace of fragments holds (docs/reference/traces.md): the texture unit's quads, each with
// what a picture of it needs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>

#include "spec/texture/packets.h"

namespace deburr::tb::traces {

struct TracedQuad {
  spec::texture::Quad quad;    // tag: its number in the trace
  std::uint8_t visible = 0xF;  // bit i: the colour of lane i is the one to be seen
  bool placed = false;         // x and y are of a picture

  int x(int lane) const { return quad.x + (lane & 1); }
  int y(int lane) const { return quad.y + (lane >> 1); }
  // The colour of this lane is a pixel's.
  bool shows(int lane) const { return placed && (visible >> lane & 1) != 0; }
};

// Gives the quads one after the other; false: there are no more.
using QuadSource = std::function<bool(TracedQuad&)>;

inline constexpr std::uint32_t kFragmentTraceVersion = 1;
inline constexpr std::string_view kFragmentTraceMagic = "DEBURRFT";
inline constexpr std::string_view kFragmentTraceTitle = "deburr-fragments";
inline constexpr std::size_t kFragmentHeaderBytes = 64, kFragmentRecordBytes = 80;
inline constexpr int kMostPictureSide = 8192;  // pixels

// The two kinds of records: four lanes, or one with its derivatives.
enum class FragmentRecord : std::uint8_t { kQuad = 0, kFragment = 1 };

}  // namespace deburr::tb::traces
