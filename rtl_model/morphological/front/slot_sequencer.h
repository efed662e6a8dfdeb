// SPDX-License-Identifier: MIT
// Counts the slots of a frame: takes a beat a clock in the rows that have input, then flushes.
//
// Where: first block of the engine, in front of the LumaUnit and the PixelStore. The first slot
// latches the rules; the next frame begins after the last beat of this one has been pushed. Stalls:
// `upstream` (no beat in an input slot), `downstream` (the pipe is full: further on something waits
// for records, memory or room). A beat whose marks disagree with SIZE sets the framing bit and is
// taken as SIZE says.
#pragma once

#include <cstdint>
#include <optional>
#include <systemc>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/latency_probe.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/morphological/common/parameter_store.h"
#include "rtl_model/morphological/common/tokens.h"

namespace deburr::rtl::morphological {

class SlotSequencer final : public Unit {
 public:
  In<spec::morphological::PixelBeat> pixels_in{"pixels_in"};
  In<FrameDoneToken> frames_done_in{"frames_done_in"};
  Out<SlotToken> slots_out{"slots_out"};
  Out<BeatToken> beats_out{"beats_out"};
  std::optional<Out<GuardSlotToken>> guard_slots_out;  // for the TextGuard, if it is built

  SlotSequencer(const sc_core::sc_module_name& name, ClockDomain& clock, ParameterStore& store,
                LatencyProbe& probe);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter frames{"frames", "frames", "frames delivered"};
  Counter beats{"beats", "beats", "beats taken"};
  Counter framing_errors{"framing_errors", "beats", "beats whose marks are not as SIZE says"};
  Counter frame_cycles{"frame_cycles", "clk",
                       "from first beat in to last beat out of the last frame, both counted"};

  static Datasheet datasheet();

 private:
  // Of the frame inside: none are left, some are, or each goes to the TextGuard, too.
  enum class Slots : std::uint8_t { kNone, kSome, kGuarded };

  void take_beat(Cycle cycle);
  bool send_to_guard(Cycle cycle);

  ParameterStore& store_;
  LatencyProbe& probe_;
  Activity upstream_;
  Slots slots_ = Slots::kNone;
  Slot next_{};
  Cycle first_cycle_ = 0;
};

}  // namespace deburr::rtl::morphological
