// SPDX-License-Identifier: MIT
// Extends one clean Z run to both sides, a step of both sides a trial, and sums up its corners;
// with learned weights, finds the classes of a record's crossings.
//
// Where: predictor_units of these a lane in an EndpointPredictor, whose datasheet has the cycles of
// a trial. Holds a record at a time. A trial every trial_cycles cycles T, from the clock on that
// the schedule of the ports gives it. In clock T = 0' of a trial its bounds are decided beside the
// next one's address, which knows the hits but not the rejection: a read too many is dropped.
//
// With T = 4 (the default) each stage has its clock. 5 and more leave cycles to slower memories or
// longer paths. 3: the left side's words are chosen and compared in the clock in which they come,
// if it reads a clock later (an odd number of ports). 2: so are both sides'. 1: besides, bounds and
// the next address follow in the same clock. LineBounds needs four cycles a trial too: with 3, two
// of its steps weight a clock, with 1 all of them. So 3 and below are for slow cycles.
//
// Classes (docs/reference/morphological/learned_weights.md) ask for the corner at which the first
// trial begins and for ten edges behind it, so that trial's reads give them. Any other record with
// a crossing makes these two reads alone: it leaves in clock T - 1, with the words of both sides
// chosen (T below 3: when they have come), and their classes are known as its result is sent. So it
// takes T cycles (T = 2: 4 if the left side reads a clock later; T = 1: 2), and the wait for its
// phase if the predictor was idle. A long clean Z keeps its line and has none. Any other record
// leaves in the clock that takes it. One that is extended, takes from its pop to the clock that may
// take the next one 1 clock, the wait for its phase, T cycles a trial, and 1 clock.
//
// Trim takes no clock of its own: beside the sums of all its steps a side keeps those without its
// last step and those of the first half of its steps. The former are what the sums were before; the
// latter take in one corner at every second step, which is a step L or L' on, as the side's letters
// say. The trial that ends a side sets two bits, and the join selects by them. Source: paper 000,
// sections 3 and 4; `safe`, `trim` and the sums are ours.
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
  // What all predictors of an axis count together.
  struct Counters {
    Counter &extended_runs, &steps, &probes, &trials;
  };

  // `number`: of the axis, for the schedule. `last_line`: of the frame, across the axis.
  Predictor(const PortSchedule& schedule, int number, EdgePort right, EdgePort left,
            std::int32_t search_range, bool vertical, Counters counters);

  // Holds no record.
  bool free() const { return state_ == State::kFree; }
  // Takes a record in this clock; `since_reset`: from the first one after the reset, where the
  // schedule begins.
  void take(Cycle cycle, const FrameConfiguration& configuration, Cycle since_reset,
            const RunToken& run);
  // The cycles of the record's trials.
  void tick(Cycle cycle) {
    if (state_ == State::kTrials && cycle >= trial_at_) run_trial(cycle);
    if (state_ == State::kLooks && cycle >= trial_at_) look(cycle);
  }
  // Its sums may be passed on in this clock, and the next record taken.
  bool joins(Cycle cycle) const { return state_ == State::kJoins && cycle >= join_at_; }
  SumsToken join();
  void reset() { state_ = State::kFree; }

 private:
  enum class State : std::uint8_t { kFree, kTrials, kLooks, kJoins };
  // The first steps of a side: their number, the X that they reach, the sums of their corners.
  struct Stretch {
    std::int32_t steps;             // U5
    std::int32_t position;          // S13
    std::int32_t sum, indexed_sum;  // S18, S24: sum of X_i, of i X_i
  };
  // Which of its steps a side passes on.
  enum Keep : std::uint8_t { kAll, kBeforeLast, kFirstHalf, kKeeps };
  // One end that grows.
  struct End {
    EdgePort port;
    bool to_the_right;
    bool open = false;
    bool reads = false;  // in this trial
    std::uint8_t hits = 0;
    std::uint8_t crossing_class = 0;
    Keep keep = kAll;
    std::int32_t other = 0;     // L', 0 while unknown; the same at both ends if safe
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
  // A side ends for good: as a trial without a hit says, or with the given weight of its steps.
  void lose(End& end);
  void close(End& end, Keep keep);
  std::int32_t room(const End& end) const;

  const PortSchedule& schedule_;
  const int phase_;
  const Cycle cycles_, left_after_;  // T; cycles from the right side's read to the left one's
  const std::int32_t search_range_;
  const bool vertical_;
  Counters counters_;

  const FrameConfiguration* configuration_ = nullptr;  // which stand still while it holds a record
  State state_ = State::kFree;
  Cycle trial_at_ = 0, join_at_ = 0;  // clock of the trial's first read; of the join
  RunToken run_{};
  std::int32_t length_ = 0;
  bool long_z_ = false;     // keeps its line without a step too
  std::int32_t drift_ = 0;  // lattice lines a step to the right: -1 or +1
  std::int32_t step_ = 0;   // k
  End right_, left_;
  LineBounds bounds_;
};

}  // namespace deburr::rtl::morphological
