// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/runs/endpoint_predictor.h"

#include <algorithm>

namespace deburr::rtl::morphological {
namespace {

// Bits of a corner code: edges along the axis before and after the corner, edges across it on the
// first and on the second side.
constexpr std::uint8_t kBefore = 1, kAfter = 2;
constexpr int kCrossing = 2;  // of a crossing code

constexpr std::uint8_t kFirstSide = 1;  // crossing code of a single edge on the first side

}  // namespace

EndpointPredictor::EndpointPredictor(const sc_core::sc_module_name& name, ClockDomain& clock,
                                     const spec::morphological::Parameters& p,
                                     const ParameterStore& store, EdgeWindow& window,
                                     spec::morphological::Axis axis)
    : Unit(name, clock),
      records_in("records_in", store.lanes()),
      sums_out("sums_out", store.lanes()),
      store_(store),
      lanes_(static_cast<std::size_t>(store.lanes())),
      window_(window),
      vertical_(axis == spec::morphological::Axis::kVertical),
      reach_(vertical_ ? store.reach_rows() : p.reach_columns),
      units_(static_cast<std::size_t>(p.predictor_units)),
      predictors_(units_ * lanes_),
      turn_(lanes_) {}

Activity EndpointPredictor::work(Cycle cycle) {
  bool did = false, blocked = false;
  for (std::size_t lane = 0; lane < lanes_; ++lane) {
    In<RunToken>& in = records_in[lane];
    const bool arrives = in.can_pop(cycle);
    if (held_ == 0 && !arrives) continue;
    Predictor* const group = &predictors_[lane * units_];

    // The result registers take turns.
    Out<SumsToken>& out = sums_out[lane];
    std::size_t& turn = turn_[lane];
    for (std::size_t i = 0, k = turn; i < units_; ++i, k = k + 1 == units_ ? 0 : k + 1) {
      if (!group[k].done) continue;
      if (out.can_push(cycle)) {
        out.push(cycle, group[k].result);
        group[k].done = false;
        --held_;
        turn = k + 1 == units_ ? 0 : k + 1;
        did = true;
      } else {
        blocked = true;
      }
      break;
    }

    bool taken = !arrives;
    for (std::size_t k = 0; k < units_; ++k) {
      Predictor& p = group[k];
      if (!p.busy) {
        if (taken) continue;
        taken = true;
        take(p, in.front(cycle));
        in.pop(cycle);
        ++held_;
      } else if (p.step < 0) {
        // The last trial has been made; the result register was full.
        ++occupancy;
        if (p.done) continue;
        finish(p);
        did = true;
        continue;
      }
      ++occupancy;
      did = true;
      if (iterate(p, cycle)) continue;
      if (p.done) {
        p.step = -1;
        blocked = true;
      } else {
        finish(p);
      }
    }
  }
  if (did) return kBusy;
  return blocked ? kStalledDownstream : kIdle;
}

void EndpointPredictor::take(Predictor& p, const RunToken& token) {
  const spec::morphological::RunRecord& run = token.run;
  p.busy = true;
  p.run = token;
  p.length = run.length;
  p.start = run.start;
  p.line = run.line;
  p.step = 0;
  p.other = 0;
  const FrameRules& rules = store_.rules();
  const bool extends = run.part == spec::morphological::RunPart::kWhole &&
                       spec::morphological::kRunShapes[run.shape].clean_z && rules.steps > 0;
  p.left.open = p.right.open = extends;
  p.left.keep = p.right.keep = kAll;
  p.left.other = p.right.other = 0;
  p.left.reached[kAll] = {0, 0, 0, 0};
  p.right.reached[kAll] = {0, p.length, 0, 0};
  if (!extends) return;
  // No step yet: nothing to give back, and the half of none is none.
  for (End* const end : {&p.left, &p.right})
    end->reached[kBeforeLast] = end->reached[kFirstHalf] = end->reached[kAll];
  p.drift = token.end_code == kFirstSide ? -1 : 1;
  p.start_corner = static_cast<std::uint8_t>(kAfter | token.start_code << kCrossing);
  p.end_corner = static_cast<std::uint8_t>(kBefore | token.end_code << kCrossing);
  p.corner[spec::morphological::kMaxSteps] = 0;
  p.corner[spec::morphological::kMaxSteps + 1] = p.length;
  p.bounds = {{p.length - 1, 1}, {p.length + 1, 1}};
}

bool EndpointPredictor::iterate(Predictor& p, Cycle cycle) {
  if (!p.left.open && !p.right.open) return false;
  ++iterations;
  const bool more = store_.rules().safe ? iterate_together(p, cycle) : iterate_apart(p, cycle);
  ++p.step;
  return more && p.step < store_.rules().steps;
}

// Each end by itself, with an L' of its own.
bool EndpointPredictor::iterate_apart(Predictor& p, Cycle cycle) {
  for (const bool to_the_right : {true, false}) {
    End& end = to_the_right ? p.right : p.left;
    if (!end.open) continue;
    const std::int32_t step = trial(cycle, p, end, to_the_right, end.other);
    if (step == 0) {
      lose(p, end, to_the_right, end.other);
      continue;
    }
    if (step != p.length) end.other = step;
    accept(p, end, to_the_right, step);
  }
  return p.left.open || p.right.open;
}

// Both ends share L' and every corner must lie on one line with all the others.
bool EndpointPredictor::iterate_together(Predictor& p, Cycle cycle) {
  std::int32_t right = p.right.open ? trial(cycle, p, p.right, true, p.other) : 0;
  std::int32_t left = p.left.open ? trial(cycle, p, p.left, false, p.other) : 0;
  if (p.right.open && right == 0) lose(p, p.right, true, p.other);
  if (p.left.open && left == 0) lose(p, p.left, false, p.other);
  const auto stop = [&] {
    close(p.right, kFirstHalf);
    close(p.left, kFirstHalf);
    return false;
  };
  if (right != 0 && left != 0 && right != p.length && left != p.length && right != left)
    return stop();
  const std::int32_t right_index = p.step + 2, left_index = -p.step - 1;
  const std::int32_t right_x = p.right.reached[kAll].position + right;
  const std::int32_t left_x = p.left.reached[kAll].position - left;
  Bounds bounds = p.bounds;
  if (right != 0) {
    const Bounds extended = with(p, p.bounds, right_index, right_x);
    if (extended.consistent()) {
      bounds = extended;
    } else {
      close(p.right, kFirstHalf);
      right = 0;
    }
  }
  if (left != 0) {
    const Bounds extended = with(p, p.bounds, left_index, left_x);
    if (!extended.consistent()) {
      close(p.left, kFirstHalf);
      left = 0;
    } else if (right == 0) {
      bounds = extended;
    } else {
      // Both: the new corners against each other as well.
      p.corner[static_cast<std::size_t>(right_index + spec::morphological::kMaxSteps)] = right_x;
      ++p.right.reached[kAll].steps;
      bounds = with(p, bounds, left_index, left_x);
      --p.right.reached[kAll].steps;
      if (!bounds.consistent()) return stop();
    }
  }
  p.bounds = bounds;
  for (const bool to_the_right : {true, false}) {
    const std::int32_t step = to_the_right ? right : left;
    if (step == 0) continue;
    if (step != p.length) p.other = step;
    accept(p, to_the_right ? p.right : p.left, to_the_right, step);
  }
  return p.left.open || p.right.open;
}

// The first candidate that hits, or 0. All are tested in the same clock.
std::int32_t EndpointPredictor::trial(Cycle cycle, const Predictor& p, const End& end,
                                      bool to_the_right, std::int32_t other) {
  const std::int32_t lines = (p.step + 1) * p.drift;
  const std::int32_t line = to_the_right ? p.line + lines : p.line - lines;
  const std::int32_t last_line = vertical_ ? store_.rules().width : store_.rules().height;
  const std::int32_t length = p.length;
  const bool known = other != 0;
  probes += known || length == 1 ? 2 : 3;
  if (line < 0 || line > last_line) return 0;
  const std::int32_t from = p.start + end.reached[kAll].position;
  // The corners of L - 1, L and L + 1, each between two columns; vertical: all on one line.
  const EdgeWindow::Columns corners =
      vertical_ ? window_.read(cycle, line - 1, 2)
                : window_.read(cycle, (to_the_right ? from + length : from - length) - 2, 4);
  if (store_.rules().contiguous) {
    // The step must begin at a corner like the one at the other end of the run.
    const EdgeWindow::Columns origin = vertical_ ? corners : window_.read(cycle, from - 1, 2);
    if (!vertical_) window_.read_row(cycle);
    const std::uint8_t wanted = to_the_right ? p.start_corner : p.end_corner;
    if (corner(origin, from, line) != wanted) return 0;
  }
  const auto hits = [&](std::int32_t step) {
    return candidate(p, end, to_the_right, corners, line, step);
  };
  if (hits(length)) return length;
  if (known) return hits(other) ? other : 0;
  if (length > 1 && hits(length - 1)) return length - 1;
  return hits(length + 1) ? length + 1 : 0;
}

bool EndpointPredictor::candidate(const Predictor& p, const End& end, bool to_the_right,
                                  const EdgeWindow::Columns& corners, std::int32_t line,
                                  std::int32_t step) const {
  const std::int32_t from = end.reached[kAll].position;
  const std::int32_t x = to_the_right ? from + step : from - step;
  if (to_the_right ? x > reach_ : x < p.length - reach_) return false;
  if (corner(corners, p.start + x, line) != (to_the_right ? p.end_corner : p.start_corner))
    return false;
  if (!store_.rules().contiguous) return true;
  const std::int32_t along = p.start + (to_the_right ? from : x);
  if (!vertical_) return window_.unbroken(along, line, step);
  // The column has been read; above the frame there is no edge.
  for (std::int32_t y = along; y < along + step; ++y)
    if (!corners.left(line, y)) return false;
  return true;
}

// The bounds when corner i at x joins those that the predictor has.
EndpointPredictor::Bounds EndpointPredictor::with(const Predictor& p, Bounds bounds, std::int32_t i,
                                                  std::int32_t x) const {
  const std::int32_t last = p.right.reached[kAll].steps + 1;
  for (std::int32_t j = -p.left.reached[kAll].steps; j <= last; ++j) {
    const std::int32_t x_j = p.corner[static_cast<std::size_t>(j + spec::morphological::kMaxSteps)];
    const std::int32_t under = i > j ? i - j : j - i;
    const std::int32_t apart = i > j ? x - x_j : x_j - x;
    if (std::int64_t{apart - 1} * bounds.low.under > std::int64_t{bounds.low.over} * under)
      bounds.low = {apart - 1, under};
    if (std::int64_t{apart + 1} * bounds.high.under < std::int64_t{bounds.high.over} * under)
      bounds.high = {apart + 1, under};
  }
  return bounds;
}

void EndpointPredictor::accept(Predictor& p, End& end, bool to_the_right, std::int32_t step) {
  const auto add = [&](Stretch& stretch, std::int32_t index, std::int32_t x) {
    ++stretch.steps;
    stretch.position = x;
    stretch.sum += x;
    stretch.indexed_sum += index * x;
  };
  const auto index_of = [&](std::int32_t step_number) {
    return to_the_right ? step_number + 1 : -step_number;
  };
  Stretch& all = end.reached[kAll];
  end.reached[kBeforeLast] = all;
  const std::int32_t index = index_of(all.steps + 1);
  const std::int32_t x = to_the_right ? all.position + step : all.position - step;
  p.corner[static_cast<std::size_t>(index + spec::morphological::kMaxSteps)] = x;
  add(all, index, x);
  if (all.steps % 2 != 0) return;
  Stretch& half = end.reached[kFirstHalf];
  const std::int32_t next = index_of(half.steps + 1);
  add(half, next, p.corner[static_cast<std::size_t>(next + spec::morphological::kMaxSteps)]);
}

// The line is lost, unless a candidate that lies beyond the reach might have gone on with it.
void EndpointPredictor::lose(const Predictor& p, End& end, bool to_the_right, std::int32_t other) {
  const std::int32_t x = end.reached[kAll].position;
  const std::int32_t used = to_the_right ? x : p.length - x;  // of the reach
  const std::int32_t largest = other == 0 ? p.length + 1 : std::max(p.length, other);
  close(end, used + largest > reach_ ? kAll : kBeforeLast);
}

void EndpointPredictor::close(End& end, Keep keep) {
  end.open = false;
  end.keep = store_.rules().trim ? keep : kAll;
}

// The sums go to the result register; the predictor is free in the next clock.
void EndpointPredictor::finish(Predictor& p) {
  const Stretch& left = p.left.reached[p.left.keep];
  const Stretch& right = p.right.reached[p.right.keep];
  const std::int32_t kept = left.steps + right.steps;
  steps += static_cast<std::uint64_t>(kept);
  if (kept != 0) ++extended_runs;
  p.result = {p.run,
              static_cast<std::uint8_t>(left.steps),
              static_cast<std::uint8_t>(right.steps),
              static_cast<std::int16_t>(left.position),
              static_cast<std::int16_t>(right.position),
              left.sum + p.length + right.sum,  // X_0 = 0, X_1 = L
              left.indexed_sum + p.length + right.indexed_sum};
  p.busy = false;
  p.done = true;
}

std::uint8_t EndpointPredictor::corner(const EdgeWindow::Columns& read, std::int32_t along,
                                       std::int32_t across) const {
  const FrameRules& rules = store_.rules();
  const std::int32_t x = vertical_ ? across : along, y = vertical_ ? along : across;
  if (x < 0 || y < 0 || x > rules.width || y > rules.height) return 0;
  const unsigned row = read.top_pair(x, y);
  const unsigned column = unsigned{read.left(x, y - 1)} | unsigned{read.left(x, y)} << 1;
  return static_cast<std::uint8_t>(vertical_ ? column | row << kCrossing
                                             : row | column << kCrossing);
}

void EndpointPredictor::reset() {
  for (Predictor& p : predictors_) p.busy = p.done = false;
  std::fill(turn_.begin(), turn_.end(), 0);
  held_ = 0;
}

}  // namespace deburr::rtl::morphological
