// SPDX-License-Identifier: MIT
// Counts the slots of a frame: takes a beat a clock in the rows that have input, then flushes.
//
// Where: first block of the engine, in front of the LumaUnit and the PixelStore. The first slot has
// the ParameterStore latch the rules, and goes by those that it gets in the same clock; the next
// frame begins after the last beat of this one has been pushed. Stalls: `upstream` (no beat in an
// input slot), `downstream` (the pipe is full: further on something waits for records, memory or
// room). A beat whose marks disagree with SIZE sets the framing bit and is taken as SIZE says.
#pragma once

#include <cstdint>
#include <optional>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/latency_probe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/morphological/common/frame_configuration.h"
#include "rtl_model/morphological/common/tokens.h"

namespace deburr::rtl::morphological {

class SlotSequencer final : public Unit {
 public:
  In<spec::morphological::PixelBeat> pixels_in{"pixels_in"};
  In<FrameDoneToken> frames_done_in{"frames_done_in"};
  Out<SlotToken> slots_out{"slots_out"};
  Out<BeatToken> beats_out{"beats_out"};
  std::optional<Out<GuardSlotToken>> guard_slots_out;  // for the TextGuard, if it is built
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  // The first beat of a frame waits; whether it may be taken, in the same clock.
  PulseOut first_beat_out{"first_beat_out"};
  WireIn<bool, WireKind::kCombinational> enabled_in{"enabled_in"};
  // The registers become the rules; what they are, in the same clock.
  PulseOut latch_out{"latch_out"};
  WireIn<Decoded, WireKind::kCombinational> latched_in{"latched_in"};
  PulseOut frame_done_out{"frame_done_out"}, framing_out{"framing_out"};

  SlotSequencer(const sc_core::sc_module_name& name, ClockDomain& clock,
                const spec::morphological::Parameters& parameters, LatencyProbe& probe);
  Activity tick(Cycle cycle) override;
  void reset() override;

  // No frame is inside. Between edges.
  bool idle() const { return slots_ == Slots::kNone; }

  Counter frames{"frames", "frames", "frames delivered"};
  Counter beats{"beats", "beats", "beats taken"};
  Counter framing_errors{"framing_errors", "beats", "beats whose frame marks contradict SIZE"};
  Counter frame_cycles{
      "frame_cycles", "clk",
      "cycles of the last frame, from its first input beat to its last output beat, both included"};

  static Datasheet datasheet();

 private:
  // No frame is inside; of the one that is, all are sent, some are left, or each goes to the
  // TextGuard, too.
  enum class Slots : std::uint8_t { kNone, kSent, kSome, kGuarded };

  void take_beat(Cycle cycle, const FrameConfiguration& configuration);
  bool send_to_guard(Cycle cycle, std::int32_t height);

  const std::int32_t lanes_;
  LatencyProbe& probe_;
  Activity upstream_;
  Slots slots_ = Slots::kNone;
  Slot next_{};
  Cycle first_cycle_ = 0;
};

}  // namespace deburr::rtl::morphological
