// SPDX-License-Identifier: MIT
// Chooses the axis of each pixel and blends it with its two neighbours on that axis.
//
// Position  Last unit of the engine.
// Stalls    downstream
// Options   longest     The axis that has weights; if both do, the one with the longer line, then
//                       the larger sum; ties go to up/down.
//           strongest   The axis of the largest weight, ties to up/down. Each weight w of the pair
//                       becomes w^2 / (w1 + w2).
//           bypass      A marked pixel (bit 0 of alpha is 0), or one next to it, takes no weight;
//                       or it takes half of a marked neighbour's weight. The EdgeDetector
//                       implements masked. The mark is removed here.
//           text_guard  A guarded pixel takes no weight; its guard bit is ready before its weights
//                       are.
// Note      Results are rounded by magnitude.
// Source    Paper 000, section 2 (D sums); SMAA 1x (strongest). The tie rules are ours.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/histogram.h"
#include "rtl_model/fabric/latency_probe.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/pipe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/morphological/common/frame_configuration.h"
#include "rtl_model/morphological/common/tokens.h"

namespace deburr::rtl::morphological {

class Blender final : public Unit {
 public:
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  In<WeightToken> weights_in{"weights_in"};
  In<PixelToken> pixels_in{"pixels_in"};
  std::optional<In<GuardToken>> guards_in;  // only with text_guard
  Out<spec::morphological::BlendedBeat> pixels_out{"pixels_out"};
  Out<FrameDoneToken> frames_done_out{"frames_done_out"};

  Blender(const sc_core::sc_module_name& name, ClockDomain& clock,
          const spec::morphological::Parameters& parameters, LatencyProbe& probe);
  Activity tick(Cycle cycle) override;
  void reset() override {
    pipe_.reset();
    blending_ = 0;
  }

  Counter pixels{"pixels", "pixels", "pixels delivered"};
  Counter blended_pixels{"blended_pixels", "pixels", "pixels blended with a neighbour"};
  Counter bypassed_pixels{"bypassed_pixels", "pixels", "pixels with a weight that were bypassed"};
  Histogram beat_latency{"beat_latency", "clk", "cycles from popping a beat to pushing it"};

  static Datasheet datasheet(const spec::morphological::Parameters& parameters = {});

 private:
  static constexpr std::size_t kLanes = spec::morphological::kMaxLanes;
  // A pixel being blended.
  struct Operands {
    std::array<spec::morphological::Rgba8, 3> code;     // centre, first, second
    std::array<std::int32_t, 3> centre, first, second;  // differences to centre; S13
    std::array<std::uint16_t, 2> weight;                // U0.12, first, second
    std::array<std::int32_t, 3> sum;                    // S25
    std::array<std::uint16_t, 3> value;                 // U0.12
  };
  struct Beat {
    std::uint32_t slot;  // slot number
    bool last;           // last beat of the frame
    std::uint8_t blend;  // bit k: lane k is blended
    std::uint8_t left;   // bit k: lane k had a weight and was bypassed
    spec::morphological::BlendedBeat result;
    std::array<Operands, kLanes> operands;
  };

  // Each is called once per cycle from one place, hence inline.
  inline void choose(Cycle cycle, const FrameConfiguration& configuration,
                     const WeightToken& weights, const PixelToken& around, Beat& beat);
  inline void deliver(Cycle cycle, const FrameConfiguration& configuration, const Beat& beat);
  bool is_bypassed(const FrameConfiguration& configuration, const Slot& slot,
                   const PixelToken& around, std::size_t lane, std::size_t count) const;
  void choose_axes(Cycle cycle, const WeightToken& weights, const PixelToken& around,
                   std::uint32_t guarded, Beat& beat);
  void blend(Cycle cycle);
  void mix(Cycle cycle, Beat& beat);
  void address_light(Cycle cycle, const Beat& beat);
  void subtract(Cycle cycle, Beat& beat);
  void multiply(Beat& beat);
  void round(Cycle cycle, Beat& beat);
  void encode(Cycle cycle, const Beat& beat, spec::morphological::BlendedBeat& out);
  static std::size_t light_port(std::size_t lane, std::size_t channel, std::size_t operand) {
    return (lane * 3 + channel) * 3 + operand;
  }

  const std::int32_t lanes_, first_row_;  // first_row_: first slot row that blends
  LatencyProbe& probe_;
  Memory<std::uint32_t> mix_rom_;
  std::vector<ReadPort<std::uint32_t>> mix_;  // lane
  Memory<std::uint16_t> linear_rom_;
  std::vector<ReadPort<std::uint16_t>> light_;  // lane, channel, operand
  Memory<std::uint8_t> encode_rom_;
  std::vector<ReadPort<std::uint8_t>> codes_;  // lane, channel
  Pipe<Beat, spec::morphological::kBlenderLatency + 1> pipe_;
  std::uint32_t blending_ = 0;  // beats up to stage 5 with a lane to blend
};

}  // namespace deburr::rtl::morphological
