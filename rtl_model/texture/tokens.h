// SPDX-License-Identifier: MIT
// The wires between the blocks of the texture unit: one struct a link. A comment gives the width in
// hardware; formats as in docs/number_formats.md. Texels stand in the order 00, 10, 01, 11.
#pragma once

#include <array>
#include <cstdint>

#include "spec/texture/descriptor.h"

namespace deburr::rtl::texture {

// Goes with a fragment from the first block to the last: 32 + 2 + 1 + 1 + 4 bits.
struct Ticket {
  std::uint32_t tag;     // of the quad
  std::uint8_t lane;     // U2
  bool last;             // last covered lane of its quad
  bool valid;            // the descriptor is valid; otherwise the colour is zero
  std::uint8_t texture;  // U4, descriptor handle
};

// DerivativeUnit -> FootprintUnit.
struct DerivativeToken {
  Ticket ticket;
  std::int32_t s, t;                                     // S7.24
  std::int64_t s_x, t_x, s_y, t_y;                       // S8.24, differences along row and column
  std::uint32_t size_s_x, size_t_x, size_s_y, size_t_y;  // U15.16, their sizes in texels of level 0
};

// FootprintUnit -> Log2Unit. From here on only the difference along the major axis is of interest.
struct FootprintToken {
  Ticket ticket;
  std::int32_t s, t;            // S7.24
  std::int64_t axis_s, axis_t;  // S8.24
  std::uint32_t d_max, d_min;   // U16.16
};

// Log2Unit -> LevelUnit.
struct Log2Token {
  Ticket ticket;
  std::int32_t s, t;            // S7.24
  std::int64_t axis_s, axis_t;  // S8.24
  std::int32_t lb_max, lb_min;  // S5.12
};

// LevelUnit -> SampleWalker.
struct LevelToken {
  Ticket ticket;
  std::int32_t s, t;            // S7.24
  std::int64_t axis_s, axis_t;  // S8.24
  std::uint8_t count_log2;      // U3, lb N
  std::uint8_t level;           // U4, the finer of the levels used
  std::uint8_t fraction;        // U0.8; not 0: level + 1 is used as well
  bool linear;                  // filter within a level: nearest or linear
};

// What the FilterPipeline does with a bilinear request: 8 + 8 + 9 + 5 + 3 + 3 + 2 bits.
struct FilterControl {
  std::uint8_t fraction_u, fraction_v;  // U0.8
  std::uint16_t level_weight;           // U1.8, 1..256
  std::uint8_t kernel_weight;           // U5, 0 for a fragment with an invalid descriptor
  std::uint8_t sum_log2;                // U3, lb of the sum of kernel weights
  std::uint8_t format;                  // U3, spec::texture::Format
  bool last_of_sample;                  // completes a sample (second level, or the only one)
  bool last_of_fragment;                // completes a fragment
};

// SampleWalker -> TexelAddresser: one bilinear request.
struct SampleToken {
  Ticket ticket;
  std::int64_t s, t;  // S9.24
  std::uint16_t level_weight;
  std::uint8_t kernel_weight, sum_log2;
  std::uint8_t level;  // U4
  bool linear;
  bool last_of_sample, last_of_fragment;
};

// TexelAddresser -> TagStage.
struct TexelToken {
  Ticket ticket;
  FilterControl control;
  std::array<std::uint32_t, 4> address;  // U32, bytes
  std::array<std::uint8_t, 4> bank;      // U2, {y & 1, x & 1}
  bool column_conflict;                  // x0 and x1 are distinct columns of equal parity
  bool row_conflict;                     // y0 and y1 are distinct rows of equal parity
};

// TagStage -> MissQueue: the lines that one request misses, in the order of their fills.
struct MissToken {
  std::array<std::uint32_t, 4> line;  // U27, line number
  std::uint8_t count;                 // 1..4
};

// TagStage -> LatencyFifo -> DataStage.
struct CacheToken {
  Ticket ticket;
  FilterControl control;
  std::array<std::uint32_t, 4> place;   // U20, byte in the data store (hit) or in the line (miss)
  std::array<std::uint8_t, 4> source;   // U3, 0: data store; 1 + k: fill number k of this request
  std::array<std::uint8_t, 4> bank;     // U2
  std::array<std::uint16_t, 4> victim;  // U15, line slot that fill number k is written to
  std::uint8_t fills;                   // U3, number of fills, 0..4
  bool column_conflict, row_conflict;
};

// DataStage -> FilterPipeline.
struct TexelQuadToken {
  Ticket ticket;
  FilterControl control;
  std::array<std::uint32_t, 4> texel;  // U32, as stored, in the low bits
};

}  // namespace deburr::rtl::texture
