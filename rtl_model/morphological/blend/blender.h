// SPDX-License-Identifier: MIT
// Decides the axis of each pixel and blends it with its two neighbours on that axis.
//
// Where: last block. Stalls: `downstream`. Rule `longest`: the axis that has weights at all; else
// the longer line; else the larger sum, ties to up and down. Rule `strongest`: the axis of the
// largest weight, ties to up and down; each weight w of the pair becomes w^2 / (w1 + w2). Rule
// `leave`: a pixel that is marked (bit 0 of its alpha is 0), or beside one that is, takes no
// weight; or it takes half of a marked one's. A mask is the EdgeDetector's. The mark ends here.
// Rule `text_guard`: a pixel that is guarded takes no weight; its bit is there before its weights
// are. Results are rounded by magnitude. Source: paper 000, section 2 (D sums), SMAA 1x
// (strongest); the tie rules are ours.
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
  std::optional<In<GuardToken>> guards_in;  // from the TextGuard, if it is built
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
  Counter blended_pixels{"blended_pixels", "pixels",
                         "blended pixels: those with a blend weight above 0"};
  Counter bypassed_pixels{"bypassed_pixels", "pixels",
                          "bypassed pixels: those whose blend weights a rule set to 0"};
  Histogram beat_latency{"beat_latency", "clk", "from a beat being popped to it being pushed"};

  static Datasheet datasheet();

 private:
  static constexpr std::size_t kLanes = spec::morphological::kMaxLanes;
  // A pixel that takes a weight.
  struct Operands {
    std::array<spec::morphological::Rgba8, 3> code;     // centre, first, second
    std::array<std::int32_t, 3> centre, first, second;  // differences to centre; S13
    std::array<std::uint16_t, 2> weight;                // U0.12, first, second
    std::array<std::int32_t, 3> sum;                    // S25
    std::array<std::uint16_t, 3> value;                 // U0.12
  };
  struct Beat {
    std::uint32_t slot;  // number
    bool last;           // of the frame
    std::uint8_t blend;  // bit k: lane k takes a weight
    std::uint8_t left;   // bit k: it had one, and the rule took it
    spec::morphological::BlendedBeat result;
    std::array<Operands, kLanes> operands;
  };

  // Once a clock each, from one place: inline.
  inline void choose(Cycle cycle, const FrameConfiguration& configuration,
                     const WeightToken& weights, const PixelToken& around, Beat& beat);
  inline void deliver(Cycle cycle, const FrameConfiguration& configuration, const Beat& beat);
  bool is_left(const FrameConfiguration& configuration, const Slot& slot, const PixelToken& around,
               std::size_t lane, std::size_t count) const;
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

  const std::int32_t lanes_, first_row_;  // first_row: of slots that blend
  LatencyProbe& probe_;
  Memory<std::uint32_t> mix_rom_;
  std::vector<ReadPort<std::uint32_t>> mix_;  // lane
  Memory<std::uint16_t> linear_rom_;
  std::vector<ReadPort<std::uint16_t>> light_;  // lane, channel, operand
  Memory<std::uint8_t> encode_rom_;
  std::vector<ReadPort<std::uint8_t>> codes_;  // lane, channel
  Pipe<Beat, spec::morphological::kBlenderLatency + 1> pipe_;
  std::uint32_t blending_ = 0;  // beats up to stage 5 of which a lane takes a weight
};

}  // namespace deburr::rtl::morphological
