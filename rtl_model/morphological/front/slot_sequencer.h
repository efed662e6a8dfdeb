// SPDX-License-Identifier: MIT
// Counts the slots of a frame: takes one beat per cycle in input rows, then flushes.
//
// Position  First unit of the engine, before LumaUnit and PixelStore. The first slot latches the
//           configuration in the ParameterStore and uses it in the same cycle. The next frame
//           starts after the last beat of this frame has been pushed.
// Stalls    upstream    No beat in an input slot.
//           downstream  The pipeline is full: a later unit waits for descriptors, memory or the
//                       output.
// Errors    A beat whose marks disagree with SIZE sets the framing bit; SIZE wins.
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
  std::optional<Out<GuardSlotToken>> guard_slots_out;  // only with text_guard
  WireIn<FrameConfiguration> configuration_in{"configuration_in"};
  // The first beat of a frame waits; the answer comes in the same cycle.
  PulseOut first_beat_out{"first_beat_out"};
  WireIn<bool, WireKind::kCombinational> enabled_in{"enabled_in"};
  // Latches the registers; the configuration comes back in the same cycle.
  PulseOut latch_out{"latch_out"};
  WireIn<Decoded, WireKind::kCombinational> latched_in{"latched_in"};
  PulseOut frame_done_out{"frame_done_out"}, framing_out{"framing_out"};

  SlotSequencer(const sc_core::sc_module_name& name, ClockDomain& clock,
                const spec::morphological::Parameters& parameters, LatencyProbe& probe);
  Activity tick(Cycle cycle) override;
  void reset() override;

  // True if no frame is inside. Call between clock edges.
  bool idle() const { return slots_ == Slots::kNone; }

  Counter frames{"frames", "frames", "frames delivered"};
  Counter beats{"beats", "beats", "beats taken"};
  Counter framing_errors{"framing_errors", "beats", "beats whose marks disagree with SIZE"};
  Counter frame_cycles{"frame_cycles", "clk",
                       "cycles of the last frame, from first beat in to last beat out inclusive"};

  static Datasheet datasheet(const spec::morphological::Parameters& parameters = {});

 private:
  // kNone: no frame inside. kSent: all slots of the frame were sent. kSome: slots remain. kGuarded:
  // slots remain and also go to the TextGuard.
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
