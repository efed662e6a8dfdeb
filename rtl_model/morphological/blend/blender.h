// SPDX-License-Identifier: MIT
// Decides the axis of each pixel and blends it with its two neighbours on that axis.
//
// Where: last block. Stage 1 chooses the axis and linearises, stage 2 multiplies, rounds and
// encodes: latency 2 to the output link, initiation interval 1. Stalls: `downstream`. Rule: the
// axis that has shares at all; else the longer line; else the larger sum, ties to up and down.
// Formats: shares U0.8, linear light U0.12, result rounded by magnitude. Cost a lane: three 256 x
// 12 bit ROMs a channel (behind the choice of the axis), two multipliers 8 x 13 and one 4096 x 8
// bit ROM a channel, six comparators. Source: paper 000, section 2 (D sums); the tie rule is ours.
#pragma once

#include <array>
#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/histogram.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/morphological/latency_probe.h"
#include "rtl_model/morphological/parameter_store.h"
#include "rtl_model/morphological/tokens.h"

namespace deburr::rtl::morphological {

class Blender final : public Unit {
 public:
  In<ShareToken> shares_in{"shares_in"};
  In<PixelToken> pixels_in{"pixels_in"};
  Out<spec::morphological::BlendedBeat> pixels_out{"pixels_out"};
  Out<FrameDoneToken> frames_done_out{"frames_done_out"};

  Blender(const sc_core::sc_module_name& name, ClockDomain& clock, const ParameterStore& store,
          LatencyProbe& probe);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter pixels{"pixels", "pixels", "pixels delivered"};
  Counter blended_pixels{"blended_pixels", "pixels", "pixels that took a share of a neighbour"};
  Histogram beat_latency{"beat_latency", "clk", "from a beat being popped to it being pushed"};

 private:
  // Registers between the stages. Operands in the light that is blended in, U0.12.
  struct Operands {
    std::array<std::int32_t, 3> centre, first, second;
  };
  struct Stage {
    bool full = false;
    bool last = false;  // beat of the frame
    Slot slot;
    LanePixels centre;
    std::array<spec::morphological::BlendTap, spec::morphological::kMaxLanes> tap;
    std::array<Operands, spec::morphological::kMaxLanes> operands;  // of lanes with a share
  };

  void choose(const ShareToken& shares, const PixelToken& around);
  void deliver(Cycle cycle);
  spec::morphological::Rgba8 blend(const Operands& operands,
                                   const spec::morphological::BlendTap& tap,
                                   std::uint8_t alpha) const;

  const ParameterStore& store_;
  LatencyProbe& probe_;
  Stage stage_;
};

}  // namespace deburr::rtl::morphological
