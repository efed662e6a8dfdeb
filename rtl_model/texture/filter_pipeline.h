// SPDX-License-Identifier: MIT
// Filters four texels a clock to the colour of a fragment, in seven stages:
// 1 unpack, 2 horizontal products, 3 horizontal sums, 4 vertical lerp, 5 level lerp, 6 accumulate,
// 7 divide, round, pack.
//
// Where: after the TextureCache. Latency 7, initiation interval 1 a bilinear request; stages 5 and
// 6 wait for the requests that belong together, so a colour leaves after the last request of its
// fragment. When a colour cannot leave (`downstream`), the whole pipeline holds still.
// Formats: U8.4 after stage 1, U8.12 after 3, 4 and 5, U15.12 in 6, U8.0 out; rounded in 4, 5
// and 7. Cost, four channels: 16 + 8 + 4 + 4 multipliers (12 x 9, 20 x 9, 20 x 9, 20 x 5 bits), 24
// adders, three 256 x 12 bit tables for sRGB a texel. Source: paper 2.3.
#pragma once

#include <array>
#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/histogram.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/fragment_probe.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/packets.h"

namespace deburr::rtl::texture {

class FilterPipeline final : public Unit {
 public:
  static constexpr int kStages = 7;

  In<TexelQuadToken> texels_in{"texels_in"};
  Out<spec::texture::Colour> colours_out{"colours_out"};

  FilterPipeline(const sc_core::sc_module_name& name, ClockDomain& clock, FragmentProbe& probe);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter fragments{"fragments", "fragments", "colours delivered"};
  Histogram fragment_latency{"fragment_latency", "clk",
                             "from a quad being taken to a colour of it being delivered"};
  // Clocks in which a stage had a token to work on.
  std::array<Counter, kStages> occupancy;

 private:
  using Channels = std::array<std::uint32_t, 4>;  // R, G, B, A
  // The registers after each stage; stage 7 writes the output link.
  struct Unpacked {
    FilterControl control;
    Ticket ticket;
    std::array<std::array<std::uint16_t, 4>, 4> texel;  // U8.4
  };
  struct Products {
    FilterControl control;
    Ticket ticket;
    std::array<Channels, 4> texel;  // U8.12
  };
  struct Sums {
    FilterControl control;
    Ticket ticket;
    Channels upper, lower;  // U8.12
  };
  struct Lerped {
    FilterControl control;
    Ticket ticket;
    Channels value;  // U8.12
  };
  struct Total {
    Ticket ticket;
    std::uint8_t sum_log2;
    Channels value;  // U15.12
  };

  void unpack(const TexelQuadToken& token);
  void multiply();
  void add();
  void lerp_rows();
  bool lerp_levels();
  bool accumulate();
  void deliver(Cycle cycle);

  FragmentProbe& probe_;
  unsigned occupied_ = 0;  // bit k: the registers after stage k + 1 hold a token
  Unpacked unpacked_{};
  Products products_{};
  Sums sums_{};
  Lerped row_{};
  Channels level_sum_{};  // U8.20, of the levels of the sample in hand
  Lerped sample_{};
  Channels kernel_sum_{};  // U15.12, of the samples of the fragment in hand
  Total total_{};
};

}  // namespace deburr::rtl::texture
