// SPDX-License-Identifier: MIT
// From a sample position to the byte addresses of its four texels and its bilinear fractions.
//
// Where: tail of the AddressUnit. Two stages: 1 wrap and scale, 2 addresses. Latency 2, initiation
// interval 1, stalled by `downstream`. Formats: position S9.24, texel position rounded to 8
// fraction bits, address U32 (sums wrap). An address is base + column part + row part, so that four
// texels need two column parts, two row parts and four three-input adders. Cost: two 34 x 13 bit
// multipliers, two 12 x 15 bit ones for `linear` pitch; `tiled` is wires and multiplexers. Source:
// paper 2.2 (3) and (4); layouts are ours.
#pragma once

#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/parameter_store.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/descriptor.h"

namespace deburr::rtl::texture {

class TexelAddresser final : public Unit {
 public:
  In<SampleToken> samples_in{"samples_in"};
  Out<TexelToken> texels_out{"texels_out"};

  TexelAddresser(const sc_core::sc_module_name& name, ClockDomain& clock,
                 const ParameterStore& store);
  Activity tick(Cycle cycle) override;
  void reset() override { occupied_ = false; }

  Counter bilinears{"bilinears", "requests", "bilinear requests sent to the cache"};

 private:
  // Two neighbouring texels along one axis.
  struct Axis {
    std::int32_t first, second;  // U12, in range
    std::uint8_t fraction;       // U0.8
  };
  // The registers between the two stages.
  struct Scaled {
    Ticket ticket;
    FilterControl control;
    Axis x, y;
    std::uint8_t level;
  };
  static Axis scale(std::int64_t position, std::int32_t size, spec::texture::Wrap wrap,
                    bool linear);
  void wrap_and_scale(const SampleToken& sample);
  void address(TexelToken& texels) const;

  const ParameterStore& store_;
  Scaled scaled_{};
  bool occupied_ = false;
};

}  // namespace deburr::rtl::texture
