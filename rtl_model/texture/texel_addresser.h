// SPDX-License-Identifier: MIT
// From a sample position to the byte addresses of its four texels and its bilinear fractions.
//
// Where: tail of the AddressUnit. Five stages: 1 choice of the descriptor; 2 choice of the level in
// it, and wrapping of both coordinates; 3 their products with the level's width and height; 4 half
// a texel less, rounded, split into texel and fraction, both texels of each axis brought into
// range; 5 two column parts, two row parts, four sums. The model does all in stage 1, then delays.
// Latency 5, initiation interval 1; stalled by `downstream`, and then holds still as a whole. Made
// for 250 MHz; longest path: 34 x 13 bit multiply; in stage 5, `linear`: 12 x 9 bit multiply, then
// a 32-bit addition of three operands. Formats: position S9.24, texel position rounded to 8
// fraction bits, address U32 (sums wrap). An address is base + column part + row part, so that four
// texels need two column parts, two row parts and four three-input adders. Cost: a choice of 1 in
// 16 descriptors and 1 in 13 levels, two 34 x 13 bit multipliers, two 12 x 9 ones for `linear`
// pitch; `tiled` is wires and multiplexers; registers of four requests, the first with 13 level
// bases. Source: paper 2.2 (3) and (4); layouts are ours.
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/descriptors.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/descriptor.h"

namespace deburr::rtl::texture {

class TexelAddresser final : public Unit {
 public:
  In<SampleToken> samples_in{"samples_in"};
  Out<TexelToken> texels_out{"texels_out"};

  TexelAddresser(const sc_core::sc_module_name& name, ClockDomain& clock,
                 const Descriptors::Reader& descriptors);
  Activity tick(Cycle cycle) override;
  void reset() override { pipe_.reset(); }

  Counter bilinears{"bilinears", "requests", "bilinear requests sent to the cache"};

 private:
  static constexpr int kStages = 5;
  // Two neighbouring texels along one axis.
  struct Axis {
    std::uint64_t texels;   // U12 each, in range; the first one in the low half
    std::uint8_t fraction;  // U0.8
  };
  void request(Cycle cycle, const SampleToken& sample, TexelToken& texels);
  static Axis scale(std::int64_t position, std::int32_t size, spec::texture::Wrap wrap,
                    bool linear);
  static void address(const TextureState& texture, const LevelGeometry& level, std::uint64_t x,
                      std::uint64_t y, TexelToken& texels);

  Descriptors::Reader descriptors_;
  Pipe<TexelToken, kStages> pipe_;
};

}  // namespace deburr::rtl::texture
