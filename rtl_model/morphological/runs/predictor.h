// SPDX-License-Identifier: MIT
// Extends one clean Z run on both sides, one step of both sides per trial, and sums its corners.
// With learned weights it also classifies the descriptor's crossings.
//
// Position  predictor_units of these per lane in an EndpointPredictor, whose datasheet lists the
//           cycles of a trial. Holds one descriptor at a time.
// Interval  A trial every T = trial_cycles cycles, in the cycles that PortSchedule assigns. The
//           bounds of a trial are decided in cycle T = 0', in parallel with the next address, which
//           knows the hits but not the rejection: a superfluous read is discarded.
//           T >= 4      One stage per cycle (default 4); larger T is for slower memories or longer
//                       paths.
//           T = 3       The left side's words are selected and compared in the cycle in which they
//                       arrive, if it reads one cycle later (odd number of ports). Two steps of
//                       LineBounds share a cycle.
//           T = 2       As T = 3, for the words of both sides.
//           T = 1       Bounds, all LineBounds steps and the next address share that cycle as well.
//                       T <= 3 is for slow clocks.
// Classes   docs/reference/morphological/learned_weights.md. They need the corner where the first
//           trial begins and ten edges after it, so the reads of that trial suffice. Any other
//           descriptor with a crossing makes only these two reads and releases the predictor in
//           cycle T - 1; the classes are known when its result is sent. It occupies the predictor
//           for T cycles (T = 2: 4 if the left side reads one cycle later; T = 1: 2) plus the wait
//           for its phase. A long clean Z keeps its line and gets no class.
// Latency   Without trials or reads, a descriptor is released in the cycle that takes it. An
//           extended one occupies the predictor for 1 cycle, the wait for its phase, T cycles per
//           trial, and 1 cycle.
// Trim      Takes no extra cycle. Next to the sums of all steps, a side keeps those without its
//           last step (the previous sums) and those of the first half of its steps (one corner
//           every second step, L or L' by the side's letters). The trial that ends a side sets two
//           bits; the join selects by them.
// Source    Paper 000, sections 3 and 4; `safe`, `trim` and the sums are ours.
#pragma once

#include <array>
#include <cstdint>

#include "rtl_model/fabric/counters.h"
#include "rtl_model/morphological/common/frame_configuration.h"
#include "rtl_model/morphological/common/tokens.h"
#include "rtl_model/morphological/runs/edge_port.h"
#include "rtl_model/morphological/runs/line_bounds.h"
#include "rtl_model/morphological/runs/port_schedule.h"

namespace deburr::rtl::morphological {

class Predictor {
 public:
  // Counters shared by all predictors of an axis.
  struct Counters {
    Counter &extended_runs, &steps, &probes, &trials;
  };

  // `number`: predictor within its axis, for the schedule.
  Predictor(const PortSchedule& schedule, int number, EdgePort right, EdgePort left,
            std::int32_t search_range, bool vertical, Counters counters);

  // True if it holds no descriptor.
  bool free() const { return state_ == State::kFree; }
  // Takes a descriptor in this cycle. `since_reset`: cycles since reset, for the schedule.
  void take(Cycle cycle, const FrameConfiguration& configuration, Cycle since_reset,
            const RunToken& run);
  // Advances the trials of the descriptor.
  void tick(Cycle cycle) {
    if (state_ == State::kTrials && cycle >= trial_at_) run_trial(cycle);
    if (state_ == State::kLooks && cycle >= trial_at_) look(cycle);
  }
  // True if its sums can be sent in this cycle, and the next descriptor taken.
  bool joins(Cycle cycle) const { return state_ == State::kJoins && cycle >= join_at_; }
  SumsToken join();
  void reset() { state_ = State::kFree; }

 private:
  enum class State : std::uint8_t { kFree, kTrials, kLooks, kJoins };
  // A prefix of a side's steps: number of steps, position X reached, sums of the corners.
  struct Stretch {
    std::int32_t steps;             // U5
    std::int32_t position;          // S13
    std::int32_t sum, indexed_sum;  // S18: sum of X_i; S24: sum of i X_i
  };
  // Which prefix of its steps a side outputs.
  enum Keep : std::uint8_t { kAll, kBeforeLast, kFirstHalf, kKeeps };
  // One growing end of the run.
  struct End {
    EdgePort port;
    bool to_the_right;
    bool open = false;
    bool reads = false;  // reads in this trial
    std::uint8_t hits = 0;
    std::uint8_t crossing_class = 0;
    Keep keep = kAll;
    std::int32_t other = 0;     // L', 0 while unknown; equal at both ends if safe
    std::uint32_t letters = 0;  // bit k: step k is L'
    std::array<Stretch, kKeeps> reached{};
    Trial trial{};
  };

  void run_trial(Cycle cycle);
  void look(Cycle cycle);
  void look_at(End& end, int code);
  void read(Cycle cycle, End& end);
  inline void see(Cycle cycle, End& end);
  bool decide();  // false after the last trial
  void decide_apart();
  void decide_together();
  std::int32_t chosen(const End& end) const;
  void accept(End& end, std::int32_t step);
  // Ends a side: lose() after a trial without a hit, close() with the given prefix of steps.
  void lose(End& end);
  void close(End& end, Keep keep);
  std::int32_t room(const End& end) const;

  const PortSchedule& schedule_;
  const int phase_;
  const Cycle cycles_, left_after_;  // T; cycles from the right side's read to the left's
  const std::int32_t search_range_;
  const bool vertical_;
  Counters counters_;

  const FrameConfiguration* configuration_ = nullptr;  // constant while it holds a descriptor
  State state_ = State::kFree;
  Cycle trial_at_ = 0, join_at_ = 0;  // cycle of the trial's first read; of the join
  RunToken run_{};
  std::int32_t length_ = 0;
  bool long_z_ = false;     // keeps its line even without a step
  std::int32_t drift_ = 0;  // lattice lines per step to the right: -1 or +1
  std::int32_t step_ = 0;   // k
  End right_, left_;
  LineBounds bounds_;
};

}  // namespace deburr::rtl::morphological
