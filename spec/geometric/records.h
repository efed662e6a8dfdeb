// SPDX-License-Identifier: MIT
// What the geometric engine finds in memory: vertices, edges, facing bits, buffers of pixels and of
// weights. Little-endian 32-bit words. Meaning and addresses: docs/reference/geometric/memory.md.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace deburr::spec::geometric {

inline constexpr int kLineBytes = 64;  // of memory; every base address is a multiple of it

// ---- vertices: 16 bytes, four a line
inline constexpr int kVertexBytes = 16;
inline constexpr int kVerticesInLine = 4;
struct Vertex {
  std::int32_t x = 0, y = 0;  // words 0, 1: S.8 pixels, snapped
  std::uint32_t depth = 0;    // word 2, bits 23..0
  bool usable = false;        // word 3, bit 0
  friend bool operator==(const Vertex&, const Vertex&) = default;
};

// ---- edges: 16 bytes, four a line
inline constexpr int kEdgeBytes = 16;
inline constexpr int kEdgesInLine = 4;
inline constexpr std::uint32_t kIndexMask = 0xFFFFFF;  // of vertices and faces
inline constexpr int kFlagShift = 24;                  // in word 2
namespace flag {
inline constexpr std::uint8_t kBoundary = 1u << 0;      // one face, or no two that agree
inline constexpr std::uint8_t kAngle = 1u << 1;         // eq (4): N1 . N2 <= 0.99
inline constexpr std::uint8_t kSplitNormals = 1u << 2;  // shaded with different normals
inline constexpr std::uint8_t kSeam = 1u << 3;          // another material or texture coordinate
}  // namespace flag
struct Edge {
  std::uint32_t v0 = 0, v1 = 0;  // words 0, 1: vertices, bits 23..0
  std::uint32_t f0 = 0, f1 = 0;  // words 2, 3: faces, bits 23..0; f1 is ignored at a boundary
  std::uint8_t flags = 0;        // word 2, bits 31..24
  friend bool operator==(const Edge&, const Edge&) = default;
};

// ---- the same in two arrays (records = split): 6 bytes each, ten a line, whose last four bytes
// are ignored. Bit i of a record is bit i of its bytes, the lowest first.
inline constexpr int kSplitBytes = 6;
inline constexpr int kSplitInLine = 10;
// Faces and flags, of all edges.
inline constexpr int kSplitFaceBits = 21;  // f0 from bit 0 on, then f1
inline constexpr std::uint32_t kSplitFaceMask = (1u << kSplitFaceBits) - 1;
inline constexpr int kSplitFlagShift = 2 * kSplitFaceBits;  // bits 45..42
// Vertices, of boundaries and of other edges apart: v0 from bit 0 on, then v1.
inline constexpr int kSplitVertexBits = 24;

// ---- coarse depth: a lower bound of the depths of a tile of 8 x 8 pixels, 16 bits each
inline constexpr int kCoarseBytes = 2;
inline constexpr int kCoarseShift = 8;   // of a depth
inline constexpr int kCoarseAcross = 8;  // tiles of a line
inline constexpr int kCoarseDown = 4;

// ---- facing bits: face f is bit f & 7 of byte f >> 3; 1: turned to the eye
inline constexpr int kFacesInLine = 512;

// ---- pixels: 4 bytes each
inline constexpr int kPixelBytes = 4;
inline constexpr int kPixelsInLine = 16;
// Byte of the weights word of a pixel.
enum class Direction : std::uint8_t { kUp, kDown, kLeft, kRight };
inline constexpr std::array<std::string_view, 4> kDirectionNames = {"up", "down", "left", "right"};

// ---- what became of an edge
enum class EdgeClass : std::uint8_t {
  kInvalid,  // an index is out of range: dropped
  kBoundary,
  kSilhouette,
  kBack,  // both faces turned away, cull = back: dropped
  kCrease,
  kFlat,         // dropped
  kUnclassified  // select = all, and no boundary
};
inline constexpr std::array<std::string_view, 7> kEdgeClassNames = {
    "invalid", "boundary", "silhouette", "back", "crease", "flat", "unclassified"};

}  // namespace deburr::spec::geometric
