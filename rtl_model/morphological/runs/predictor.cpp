// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/runs/predictor.h"

#include <algorithm>

namespace deburr::rtl::morphological {
namespace {

constexpr int kCrossing = 2;  // crossing bits of a corner code start here

// Crossing codes with a single edge.
constexpr int kFirstSide = 1, kSecondSide = 2;

// Cycles from the last trial's bounds to the join of the sums.
constexpr Cycle kJoinAfter = 2;

}  // namespace

Predictor::Predictor(const PortSchedule& schedule, int number, EdgePort right, EdgePort left,
                     std::int32_t search_range, bool vertical, Counters counters)
    : schedule_(schedule),
      phase_(schedule.phase(number, 0)),
      cycles_(static_cast<Cycle>(schedule.cycles())),
      left_after_(static_cast<Cycle>(schedule.phase(number, 1) - schedule.phase(number, 0))),
      search_range_(search_range),
      vertical_(vertical),
      counters_(counters),
      right_{right, true},
      left_{left, false} {}

void Predictor::take(Cycle cycle, const FrameConfiguration& configuration, Cycle since_reset,
                     const RunToken& token) {
  configuration_ = &configuration;
  const spec::morphological::RunDescriptor& run = token.run;
  run_ = token;
  length_ = run.length;
  const bool whole_z = run.part == spec::morphological::RunPart::kWhole &&
                       spec::morphological::kRunShapes[run.shape].clean_z;
  const bool extends = whole_z && configuration_->steps > 0;
  long_z_ = whole_z && length_ >= spec::morphological::kLongZ;
  right_.keep = left_.keep = kAll;
  right_.reached[kAll] = {0, length_, 0, 0};
  left_.reached[kAll] = {0, 0, 0, 0};
  state_ = State::kJoins;
  join_at_ = cycle;
  step_ = 0;
  const int start_code = run.shape & 3, end_code = run.shape >> 2;
  for (End* const side : {&right_, &left_}) {
    side->trial.classes = false;
    side->trial.looks = 0;
  }
  if (configuration_->learned && !long_z_) {
    look_at(right_, end_code);
    look_at(left_, start_code);
    if (right_.trial.classes || left_.trial.classes) state_ = State::kLooks;
  }
  if (extends) state_ = State::kTrials;
  if (state_ == State::kJoins) return;
  trial_at_ = cycle + 1 + schedule_.wait(since_reset + 1, phase_);
  if (!extends) {
    right_.open = left_.open = false;
    return;
  }
  drift_ = end_code == kFirstSide ? -1 : 1;
  const auto start = static_cast<std::uint8_t>(kAfterBit | (token.beyond & 1 ? kBeforeBit : 0) |
                                               start_code << kCrossing);
  const auto end = static_cast<std::uint8_t>(kBeforeBit | (token.beyond & 2 ? kAfterBit : 0) |
                                             end_code << kCrossing);
  for (End* const side : {&right_, &left_}) {
    side->open = true;
    side->other = 0;
    side->letters = 0;
    // No step yet: all prefixes are empty.
    side->reached[kBeforeLast] = side->reached[kFirstHalf] = side->reached[kAll];
    side->trial.length = length_;
    side->trial.to_the_right = side->to_the_right;
    side->trial.origin = side->to_the_right ? start : end;
    side->trial.corner = side->to_the_right ? end : start;
  }
  bounds_.begin();
}

// Sets up the class of an end's crossing if it has exactly one.
void Predictor::look_at(End& end, int code) {
  const spec::morphological::RunDescriptor& run = run_.run;
  end.crossing_class = 0;
  if (code != kFirstSide && code != kSecondSide) return;
  const bool whole = run.part == spec::morphological::RunPart::kWhole;
  end.trial.to_the_right = end.to_the_right;
  end.trial.line = run.line + (code == kFirstSide ? -1 : 1);
  end.trial.crossing = code == kFirstSide ? kFirstBit : kSecondBit;
  end.trial.classes = true;
  end.trial.looks = whole ? std::min(kMostLooks, search_range_ - length_) : 0;
}

// Reads for the classes of a descriptor that is not extended.
void Predictor::look(Cycle cycle) {
  const Cycle clock = cycle - trial_at_;
  if (clock == 1) see(cycle, right_);
  if (clock == left_after_ + 1) see(cycle, left_);
  if (clock == 0) read(cycle, right_);
  if (clock == left_after_) read(cycle, left_);
  if (clock < std::max(cycles_ - 1, left_after_ + 1)) return;
  state_ = State::kJoins;
  join_at_ = cycle;
}

// Order matters: see data that were read, decide, then issue the next read.
void Predictor::run_trial(Cycle cycle) {
  Cycle clock = cycle - trial_at_;
  if (clock == 1) see(cycle, right_);
  if (clock == left_after_ + 1) see(cycle, left_);
  if (clock == cycles_) {
    if (!decide()) {
      state_ = State::kJoins;
      join_at_ = cycle + kJoinAfter;
      return;
    }
    trial_at_ = cycle;
    clock = 0;
  }
  if (clock == 0) read(cycle, right_);
  if (clock == left_after_) read(cycle, left_);
}

// Longest step within the search range.
std::int32_t Predictor::room(const End& end) const {
  const std::int32_t x = end.reached[kAll].position;
  return search_range_ - (end.to_the_right ? x : length_ - x);
}

void Predictor::read(Cycle cycle, End& end) {
  const FrameConfiguration& configuration = *configuration_;
  Trial& trial = end.trial;
  if (end.open) {
    const std::int32_t lines = (step_ + 1) * drift_;
    trial.line = run_.run.line + (end.to_the_right ? lines : -lines);
  }
  trial.from = run_.run.start + end.reached[kAll].position;
  trial.room = room(end);
  trial.tries = end.open && trial.line >= 0 &&
                trial.line <= (vertical_ ? configuration.width : configuration.height) &&
                trial.room >= std::max(1, length_ - 1);
  if (step_ != 0 && trial.classes) {
    trial.classes = false;
    trial.looks = 0;
  }
  end.reads = trial.tries || trial.classes;
  if (end.reads) end.port.read(cycle, configuration, trial);
}

[[gnu::always_inline]] inline void Predictor::see(Cycle cycle, End& end) {
  end.hits = 0;
  if (!end.reads) return;
  if (end.trial.tries) end.hits = end.port.hits(cycle, *configuration_, end.trial);
  if (end.trial.classes)
    end.crossing_class = end.port.crossing_class(cycle, *configuration_, end.trial);
}

bool Predictor::decide() {
  ++counters_.trials;
  for (const End* const end : {&right_, &left_})
    if (end->open) counters_.probes += end->other != 0 || length_ == 1 ? 2 : 3;
  if (configuration_->safe)
    decide_together();
  else
    decide_apart();
  ++step_;
  return (right_.open || left_.open) && step_ < configuration_->steps;
}

// First candidate that hits, or 0.
std::int32_t Predictor::chosen(const End& end) const {
  if (!end.open) return 0;
  if (end.hits & kEqual) return length_;
  if (end.hits & kShorter && end.other <= length_) return length_ - 1;
  return end.hits & kLonger && (end.other == 0 || end.other > length_) ? length_ + 1 : 0;
}

// Each end has its own L'.
void Predictor::decide_apart() {
  for (End* const end : {&right_, &left_}) {
    if (!end->open) continue;
    const std::int32_t step = chosen(*end);
    if (step == 0) {
      lose(*end);
      continue;
    }
    if (step != length_) end->other = step;
    accept(*end, step);
  }
}

// Both ends share L', and all corners must lie on one line.
void Predictor::decide_together() {
  using Fit = LineBounds::Fit;
  std::int32_t right = chosen(right_), left = chosen(left_);
  if (right_.open && right == 0) lose(right_);
  if (left_.open && left == 0) lose(left_);
  const bool right_other = right != length_, left_other = left != length_;
  const auto stop = [&] {
    close(right_, kFirstHalf);
    close(left_, kFirstHalf);
  };
  if (right != 0 && left != 0 && right_other && left_other && right != left) return stop();
  const Fit right_fit = bounds_.right(right_other), left_fit = bounds_.left(left_other);
  if (right != 0 && right_fit == Fit::kNone) {
    close(right_, kFirstHalf);
    right = 0;
  }
  if (left != 0 && left_fit == Fit::kNone) {
    close(left_, kFirstHalf);
    left = 0;
  }
  if (right != 0 && left != 0 && !LineBounds::together(right_fit, left_fit)) return stop();
  if (right != 0) bounds_.add_right(right_other);
  if (left != 0) bounds_.add_left(left_other);
  for (const std::int32_t step : {right, left})
    if (step != 0 && step != length_) right_.other = left_.other = step;
  if (right != 0) accept(right_, right);
  if (left != 0) accept(left_, left);
}

void Predictor::accept(End& end, std::int32_t step) {
  const auto add = [&](Stretch& stretch, std::int32_t size) {
    ++stretch.steps;
    stretch.position += end.to_the_right ? size : -size;
    const std::int32_t index = end.to_the_right ? stretch.steps + 1 : -stretch.steps;
    stretch.sum += stretch.position;
    stretch.indexed_sum += index * stretch.position;
  };
  Stretch& all = end.reached[kAll];
  end.reached[kBeforeLast] = all;
  if (step != length_) end.letters |= 1u << all.steps;
  add(all, step);
  if (all.steps % 2 != 0) return;
  Stretch& half = end.reached[kFirstHalf];
  add(half, end.letters >> half.steps & 1 ? end.other : length_);
}

// The last step is lost too, unless a candidate beyond the search range might have continued the
// line.
void Predictor::lose(End& end) {
  const std::int32_t largest = end.other == 0 ? length_ + 1 : std::max(length_, end.other);
  close(end, largest > room(end) ? kAll : kBeforeLast);
}

void Predictor::close(End& end, Keep keep) {
  end.open = false;
  end.keep = configuration_->trim ? keep : kAll;
}

SumsToken Predictor::join() {
  const Stretch& left = left_.reached[left_.keep];
  const Stretch& right = right_.reached[right_.keep];
  const std::int32_t kept = left.steps + right.steps;
  counters_.steps += static_cast<std::uint64_t>(kept);
  if (kept != 0) ++counters_.extended_runs;
  state_ = State::kFree;
  const bool learned = configuration_->learned && kept == 0 && !long_z_;
  return {run_,
          learned,
          learned ? left_.crossing_class : std::uint8_t{0},
          learned ? right_.crossing_class : std::uint8_t{0},
          static_cast<std::uint8_t>(left.steps),
          static_cast<std::uint8_t>(right.steps),
          static_cast<std::int16_t>(left.position),
          static_cast<std::int16_t>(right.position),
          left.sum + length_ + right.sum,  // X_0 = 0, X_1 = L
          left.indexed_sum + length_ + right.indexed_sum};
}

}  // namespace deburr::rtl::morphological
