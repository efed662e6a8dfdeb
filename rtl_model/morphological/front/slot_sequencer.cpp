// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/front/slot_sequencer.h"

namespace deburr::rtl::morphological {

SlotSequencer::SlotSequencer(const sc_core::sc_module_name& name, ClockDomain& clock,
                             const spec::morphological::Parameters& p, LatencyProbe& probe)
    : Unit(name, clock),
      lanes_(built_lanes(p)),
      probe_(probe),
      upstream_(declare_stall("upstream", "waits for an input beat inside a frame")) {
  if (p.text_guard) guard_slots_out.emplace("guard_slots_out");
}

[[gnu::always_inline]] inline void SlotSequencer::take_beat(
    Cycle cycle, const FrameConfiguration& configuration) {
  const spec::morphological::PixelBeat& beat = pixels_in.take(cycle);
  const bool end = next_.beat + 1u == configuration.beats;
  const int count = end ? configuration.last_count : lanes_;
  if (beat.count != count || beat.end_of_row != end || beat.start_of_frame != (next_.number == 0))
      [[unlikely]] {
    ++framing_errors;
    framing_out.raise(cycle);
  }
  SlotToken& slot = slots_out.emplace(cycle);
  BeatToken& stored = beats_out.emplace(cycle);
  slot.slot = stored.slot = next_;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    slot.pixel[i] = stored.pixel[i] = beat.pixel[i];
    slot.depth[i] = beat.depth[i] & 0xFFFFFF;
  }
  ++beats;
  probe_.enters(cycle);
}

// Returns false if the TextGuard's link is full. A slot that waits for something else is not sent
// yet.
bool SlotSequencer::send_to_guard(Cycle cycle, std::int32_t height) {
  const bool input = next_.row < height;
  if (next_.row >= height + kGuardRows || !slots_out.can_push(cycle)) return true;
  if (input && (!pixels_in.can_pop(cycle) || !beats_out.can_push(cycle))) return true;
  if (!guard_slots_out->can_push(cycle)) return false;
  GuardSlotToken& guarded = guard_slots_out->emplace(cycle);
  guarded.row = next_.row;
  guarded.beat = next_.beat;
  if (!input) return true;
  const spec::morphological::PixelBeat& beat = pixels_in.front(cycle);
  for (std::size_t i = 0; i < guarded.pixel.size(); ++i)
    guarded.pixel[i] = {beat.pixel[i][0], beat.pixel[i][1], beat.pixel[i][2]};
  return true;
}

Activity SlotSequencer::tick(Cycle cycle) {
  const FrameConfiguration* configuration = &configuration_in.read(cycle);
  if (slots_ != Slots::kSome) [[unlikely]] {
    if (slots_ == Slots::kSent) {
      if (!frames_done_in.can_pop(cycle)) return kIdle;  // the frame is still in the pipeline
      frames_done_in.pop(cycle);
      slots_ = Slots::kNone;
      frame_done_out.raise(cycle);
      ++frames;
      // The token was pushed with the last beat; its wait in the link does not count.
      frame_cycles.reset();
      frame_cycles += frames_done_in.link().last_push() + 1 - first_cycle_;
    }
    if (slots_ == Slots::kNone) {
      if (!pixels_in.can_pop(cycle)) return kIdle;
      first_beat_out.raise(cycle);
      if (!enabled_in.read(cycle)) return kIdle;
      // The frame is inside from the cycle that takes its first beat.
      if (!slots_out.can_push(cycle) || !beats_out.can_push(cycle)) return kStalledDownstream;
      if (guard_slots_out && !guard_slots_out->can_push(cycle)) return kStalledDownstream;
      latch_out.raise(cycle);
      const Decoded& latched = latched_in.read(cycle);
      if (!latched.valid) return kIdle;
      configuration = &latched.configuration;
      slots_ = configuration->text_guard ? Slots::kGuarded : Slots::kSome;
      next_ = {};
      first_cycle_ = cycle;
    }
    if (slots_ == Slots::kGuarded && !send_to_guard(cycle, configuration->height))
      return kStalledDownstream;
  }
  const bool input = next_.row < configuration->height;
  if (input && !pixels_in.can_pop(cycle)) return upstream_;
  if (!slots_out.can_push(cycle) || (input && !beats_out.can_push(cycle)))
    return kStalledDownstream;
  if (input) {
    take_beat(cycle, *configuration);
  } else {
    slots_out.emplace(cycle).slot = next_;
  }
  ++next_.number;
  if (++next_.beat == configuration->beats) {
    next_.beat = 0;
    if (++next_.row == configuration->rows) slots_ = Slots::kSent;
  }
  return kBusy;
}

void SlotSequencer::reset() {
  probe_.reset();
  slots_ = Slots::kNone;
  next_ = {};
}

Datasheet SlotSequencer::datasheet(const spec::morphological::Parameters& p) {
  return {.unit = "SlotSequencer",
          .does = "Counts the slots of a frame and takes a beat in each input slot.",
          .latency = {1},
          // Number, beat and row; ends of row and frame; the beat's marks. In the cycle of `latch`
          // the configuration comes from the registers.
          .stages = {{.clock = "1",
                      .work = "counts, takes a beat, checks it against SIZE",
                      .operators = {op::add(27), op::add(14), op::add(13), 2 * op::equal(14),
                                    op::compare(14), op::equal(3), op::mux(45, 2), op::logic(20),
                                    p.text_guard * op::add(14), p.text_guard * op::compare(14)},
                      .longest = {op::mux(14, 2), op::compare(14), op::logic(20)},
                      .registers = kPayloadBits<Slot> + 2}},
          .megahertz = 300};
}

}  // namespace deburr::rtl::morphological
