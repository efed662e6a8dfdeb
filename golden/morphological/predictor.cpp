// SPDX-License-Identifier: MIT
#include "golden/morphological/predictor.h"

#include <algorithm>
#include <string>
#include <utility>

#include "golden/morphological/configuration.h"
#include "spec/error.h"

namespace deburr::golden::morphological {
namespace {

// Candidate steps of a trial, best first.
struct Candidates {
  std::array<int, 3> step{};
  int count = 0;
  const int* begin() const { return step.data(); }
  const int* end() const { return step.data() + count; }
  int largest() const { return *std::max_element(begin(), end()); }
};

Candidates candidates(int length, int other) {
  if (other != 0) return {{length, other}, 2};
  if (length == 1) return {{1, 2}, 2};  // a step of 0 is not a candidate
  return {{length, length - 1, length + 1}, 3};
}

// The run being extended: its location and the code that a continuation must have.
class Trials {
 public:
  Trials(const spec::morphological::Parameters& parameters, const AxisEdges& edges,
         const spec::morphological::RunDescriptor& run)
      : edges_(edges),
        contiguous_(parameters.contiguous),
        search_range_(search_range(parameters, edges.axis)),
        line_(run.line),
        origin_(run.start),
        length_(run.length),
        start_code_(edges.corner(run.start, run.line)),
        end_code_(edges.corner(run.start + run.length, run.line)),
        direction_((end_code_ & 1) != 0 ? -1 : 1) {}

  // Step k from the right corner at x; 0 if no candidate hits.
  int right(int k, int x, const Candidates& steps) const {
    const int row = line_ + direction_ * (k + 1);
    for (const int s : steps) {
      if (x + s <= search_range_ && code(x + s, row) == end_code_ &&
          (!contiguous_ || (code(x, row) == start_code_ && unbroken(x, x + s, row)))) {
        return s;
      }
    }
    return 0;
  }
  // Mirrored: from the left corner at x.
  int left(int k, int x, const Candidates& steps) const {
    const int row = line_ - direction_ * (k + 1);
    for (const int s : steps) {
      if (x - s >= length_ - search_range_ && code(x - s, row) == start_code_ &&
          (!contiguous_ || (code(x, row) == end_code_ && unbroken(x - s, x, row)))) {
        return s;
      }
    }
    return 0;
  }

  // Whether the largest candidate of the next step exceeds the search range. If a trial then finds
  // nothing, the search range ended, not the line.
  bool out_of_search_range_right(int x, int largest) const { return x + largest > search_range_; }
  bool out_of_search_range_left(int x, int largest) const {
    return x - largest < length_ - search_range_;
  }

 private:
  int code(int x, int row) const { return edges_.corner(origin_ + x, row); }
  bool unbroken(int from, int to, int row) const {
    for (int x = from; x < to; ++x) {
      if (!edges_.along.at(origin_ + x, row)) return false;
    }
    return true;
  }

  const AxisEdges& edges_;
  bool contiguous_;
  int search_range_, line_, origin_, length_, start_code_, end_code_, direction_;
};

// One side of the run during its extension.
struct Growth {
  Extension& side;
  int length;
  bool open = true;

  void close(SideEnd why) {
    open = false;
    side.why = why;
  }
  // Moves the outermost corner by `move`, away from the run.
  void take(int step, int move) {
    side.end += move;
    side.corner[static_cast<std::size_t>(side.steps++)] = static_cast<std::int16_t>(side.end);
    if (step < length) side.outcome = Outcome::kEarly;
    if (step > length) side.outcome = Outcome::kLate;
    if (step == length && side.outcome == Outcome::kNone) side.outcome = Outcome::kExact;
  }
};

// The paper's extension, corrected: each side independently.
void extend_alone(const Trials& trials, int n, int length, Prediction& p) {
  const auto extend = [&](Extension& side, auto&& trial, auto&& out_of_search_range, int sign) {
    Growth growth{side, length};
    int other = 0;
    for (int k = 0; k < n; ++k) {
      const Candidates steps = candidates(length, other);
      p.probes += steps.count;
      p.iterations = std::max(p.iterations, k + 1);
      const int s = trial(k, side.end, steps);
      if (s == 0) {
        return growth.close(out_of_search_range(side.end, steps.largest()) ? SideEnd::kReach
                                                                           : SideEnd::kNoHit);
      }
      growth.take(s, sign * s);
      if (s != length) other = s;
    }
    growth.close(SideEnd::kSteps);
  };
  extend(
      p.right, [&](int k, int x, const Candidates& c) { return trials.right(k, x, c); },
      [&](int x, int largest) { return trials.out_of_search_range_right(x, largest); }, 1);
  extend(
      p.left, [&](int k, int x, const Candidates& c) { return trials.left(k, x, c); },
      [&](int x, int largest) { return trials.out_of_search_range_left(x, largest); }, -1);
}

// This project's extension: both sides in lockstep with one L', while one line explains every
// corner. Numbers are the steps of the page.
void extend_together(const Trials& trials, int n, int length, Prediction& p) {
  ConsistentSet corners(length);
  Growth right{p.right, length}, left{p.left, length};
  const auto close_both = [&](SideEnd why) {
    if (right.open) right.close(why);
    if (left.open) left.close(why);
  };
  int other = 0;
  for (int k = 0; k < n && (right.open || left.open); ++k) {
    p.iterations = k + 1;
    const Candidates steps = candidates(length, other);
    p.probes += steps.count * ((right.open ? 1 : 0) + (left.open ? 1 : 0));
    int s_r = right.open ? trials.right(k, p.right.end, steps) : 0;  // 1
    int s_l = left.open ? trials.left(k, p.left.end, steps) : 0;
    if (s_r != 0 && s_l != 0 && s_r != length && s_l != length && s_r != s_l) {  // 2
      return close_both(SideEnd::kCurve);
    }
    const ConsistentSet::Corner r{k + 2, p.right.end + s_r}, l{-k - 1, p.left.end - s_l};
    if (s_r != 0 && !corners.consistent_with(r)) {  // 3
      s_r = 0;
      right.close(SideEnd::kInconsistent);
    }
    if (s_l != 0 && !corners.consistent_with(l)) {
      s_l = 0;
      left.close(SideEnd::kInconsistent);
    }
    if (s_r != 0 && s_l != 0 && !corners.consistent_with(r, l)) {  // 4
      return close_both(SideEnd::kInconsistent);
    }
    if (s_r != 0) corners.add(r);  // 5
    if (s_l != 0) corners.add(l);
    const auto settle = [&](Growth& growth, int s, int sign, bool out_of_search_range) {
      if (!growth.open) return;
      if (s == 0) return growth.close(out_of_search_range ? SideEnd::kReach : SideEnd::kNoHit);
      growth.take(s, sign * s);
      if (s != length) other = s;
    };
    settle(right, s_r, 1, trials.out_of_search_range_right(p.right.end, steps.largest()));
    settle(left, s_l, -1, trials.out_of_search_range_left(p.left.end, steps.largest()));
  }
  close_both(SideEnd::kSteps);
}

// Drops the steps that the end of a side makes doubtful; `inner` is its corner of the run.
void trim(Extension& side, int inner) {
  switch (side.why) {
    case SideEnd::kNoHit:
      side.steps = std::max(0, side.steps - 1);
      break;
    case SideEnd::kInconsistent:
    case SideEnd::kCurve:
      side.steps /= 2;
      break;
    case SideEnd::kUntried:
    case SideEnd::kSteps:
    case SideEnd::kReach:
      return;
  }
  side.end = side.steps > 0 ? side.corners().back() : inner;
}

}  // namespace

void ConsistentSet::Bounds::tighten(Corner a, Corner b) {
  if (b.index < a.index) std::swap(a, b);
  const std::int32_t pixels = b.position - a.position, steps = b.index - a.index;
  const Ratio over{pixels - 1, steps}, under{pixels + 1, steps};
  if (low < over) low = over;
  if (under < high) high = under;
}

ConsistentSet::ConsistentSet(int length) : bounds_{{length - 1, 1}, {length + 1, 1}} {
  corners_[count_++] = {0, 0};
  corners_[count_++] = {1, length};
}

ConsistentSet::Bounds ConsistentSet::bounds_with(Corner corner) const {
  Bounds bounds = bounds_;
  for (std::size_t i = 0; i < count_; ++i) bounds.tighten(corners_[i], corner);
  return bounds;
}

void ConsistentSet::add(Corner corner) {
  DEBURR_CHECK(count_ < corners_.size(), "more corners than two sides of kMaxSteps steps have");
  bounds_ = bounds_with(corner);
  corners_[count_++] = corner;
}

bool ConsistentSet::consistent_with(Corner corner) const {
  const Bounds bounds = bounds_with(corner);
  return bounds.low < bounds.high;
}

bool ConsistentSet::consistent_with(Corner a, Corner b) const {
  ConsistentSet extended = *this;
  extended.add(a);
  return extended.consistent_with(b);
}

Prediction predict(const spec::morphological::Parameters& parameters, const AxisEdges& edges,
                   const spec::morphological::RunDescriptor& run) {
  Prediction p;
  p.right.end = run.length;
  if (parameters.predictor == spec::morphological::Predictor::kNone || parameters.steps == 0 ||
      run.part != spec::morphological::RunPart::kWhole ||
      !spec::morphological::kRunShapes[run.shape].clean_z) {
    return p;
  }
  p.left.outcome = p.right.outcome = Outcome::kNone;
  const Trials trials(parameters, edges, run);
  if (parameters.safe) {
    extend_together(trials, parameters.steps, run.length, p);
  } else {
    extend_alone(trials, parameters.steps, run.length, p);
  }
  if (parameters.trim) {
    trim(p.left, 0);
    trim(p.right, run.length);
  }
  return p;
}

}  // namespace deburr::golden::morphological
