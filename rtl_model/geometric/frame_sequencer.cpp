// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/frame_sequencer.h"

#include "rtl_model/geometric/common/frame_configuration.h"

namespace deburr::rtl::geometric {
namespace {

void hold(Counter& counter, Cycle cycles) {
  counter.reset();
  counter += cycles;
}

}  // namespace

void FrameSequencer::enter(Cycle cycle, Phase next) {
  state_ = next;
  phase_out.drive(cycle, next);
}

bool FrameSequencer::begun(Cycle cycle) const {
  return facing_loaded_in.read(cycle) && vertices_cleared_in.read(cycle) &&
         depth_cleared_in.read(cycle) && weights_cleared_in.read(cycle);
}

Activity FrameSequencer::tick(Cycle cycle) {
  switch (state_) {
    case Phase::kIdle:
      if (!start_in.read(cycle)) return kIdle;
      latch_out.raise(cycle);
      if (rejection_in.read(cycle) != spec::geometric::Rejection::kNone) return kBusy;
      begun_ = cycle;
      enter(cycle, Phase::kBegin);
      break;
    case Phase::kBegin:
      if (begun(cycle)) enter(cycle, Phase::kEdges);
      break;
    case Phase::kEdges:
      if (!drawn_in.read(cycle) || !copied_in.read(cycle)) break;
      drawn_ = cycle;
      enter(cycle, Phase::kResolve);
      break;
    case Phase::kResolve:
      if (!resolved_in.read(cycle)) break;
      hold(frame_cycles, cycle - begun_ + 1);
      hold(edge_cycles, drawn_ - begun_ + 1);
      hold(resolve_cycles, cycle - drawn_);
      frame_done_out.raise(cycle);
      enter(cycle, Phase::kIdle);
      break;
  }
  return kBusy;
}

void FrameSequencer::reset() {
  state_ = Phase::kIdle;
  begun_ = drawn_ = 0;
}

Datasheet FrameSequencer::datasheet() {
  // Registers that only some builds have are listed with the units that need them. Bases have 26
  // bits: six are 0.
  constexpr std::uint32_t kBases = 7, kWorkCounters = 19, kCycleRegisters = 4, kFlags = 17;
  const std::uint32_t configuration =
      Payload::of<FrameConfiguration>(configuration_shape({})).bits() - 6 * kBases;
  return {.unit = "FrameSequencer",
          .does = "Sequences the phases of a frame: begin, edges, resolve.",
          .latency = {0, "-"},
          .interval = {1, "-"},
          .stages = {{.clock = "1",
                      .work = "checks START in the cycle after the write: products of SIZE are "
                              "shifts and one multiply over two cycles (ParameterStore)",
                      .operators = {4 * op::add(14), op::add(12), op::mux(11, 2),
                                    op::multiply(5, 12), 3 * op::maximum(5), 3 * op::compare(14),
                                    op::compare(16), op::compare(32), op::logic(120)},
                      .longest = {op::multiply(5, 12), op::compare(16)},
                      .registers = configuration + kFlags},
                     {.clock = "all",
                      .work = "counts of the register map",
                      .operators = {(kWorkCounters + 1) * op::add(32), op::subtract(32)},
                      .registers = 32 * (kWorkCounters + kCycleRegisters)}}};
}

}  // namespace deburr::rtl::geometric
