// SPDX-License-Identifier: MIT
// Filters four texels a clock to the colour of a fragment, in eight stages:
// 1 fields, 2 unpack, 3 horizontal products, 4 horizontal sums, 5 vertical lerp, 6 level lerp,
// 7 accumulate, 8 divide, round, pack.
//
// Where: after the TextureCache. Latency 8, initiation interval 1 a bilinear request; stages 6 and
// 7 wait for the requests that belong together, so a colour leaves after the last request of its
// fragment. When a colour cannot leave (`downstream`), the whole pipeline holds still. Made for
// 250 MHz; longest path: two 20 x 9 bit multiplies and their sum, 18 rows of partial products where
// a 24 x 24 multiply has 24.
// Formats: U8.4 after stage 2, U8.12 after 4, 5 and 6, U15.12 in 7, U8.0 out; rounded in 5, 6
// and 8. Cost, four channels: 16 + 8 + 4 + 4 multipliers (12 x 9, 20 x 9, 20 x 9, 20 x 5 bits), 24
// adders, the ROM `srgb`, 256 x 12 bits, 12R, one word a coded channel. Source: paper 2.3.
#pragma once

#include <array>
#include <cstdint>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/histogram.h"
#include "rtl_model/fabric/latency_probe.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/packets.h"

namespace deburr::rtl::texture {

class FilterPipeline final : public Unit {
 public:
  static constexpr int kStages = 8;

  In<TexelQuadToken> texels_in{"texels_in"};
  Out<spec::texture::Colour> colours_out{"colours_out"};

  FilterPipeline(const sc_core::sc_module_name& name, ClockDomain& clock, LatencyProbe& probe);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter fragments{"fragments", "fragments", "colours delivered"};
  Histogram fragment_latency{"fragment_latency", "clk",
                             "from a quad being taken to a colour of it being delivered"};
  // Clocks in which a stage had a token to work on.
  std::array<Counter, kStages> occupancy;

 private:
  using Channels = std::array<std::uint32_t, 4>;  // R, G, B, A
  // The registers after each stage; stage 8 writes the output link.
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

  void look_up(Cycle cycle);
  void unpack(Cycle cycle);
  std::array<std::uint16_t, 4> unpack_srgb(Cycle cycle, std::size_t texel) const;
  void multiply();
  void add();
  void lerp_rows();
  bool lerp_levels();
  bool accumulate();
  void deliver(Cycle cycle);

  LatencyProbe& probe_;
  Memory<std::uint16_t> srgb_;
  std::vector<ReadPort<std::uint16_t>> linear_;  // 3 x texel + channel
  unsigned occupied_ = 0;  // bit k: the registers after stage k + 1 hold a token
  TexelQuadToken raw_{};
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
