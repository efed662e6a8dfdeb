// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/runs/line_unit.h"

#include "spec/morphological/packets.h"
#include "spec/morphological/parameters.h"
#include "spec/morphological/shapes.h"
#include "spec/morphological/tables.h"

namespace deburr::rtl::morphological {
namespace {

// The tables are U1.26, the inverse is U12.12.
constexpr int kInverseDrop = 26 - spec::morphological::kInverseFractionBits;

std::uint32_t inverse(std::int32_t pixels, std::uint32_t table) {
  const auto product = static_cast<std::uint64_t>(pixels) * table;
  return static_cast<std::uint32_t>((product + (std::uint64_t{1} << (kInverseDrop - 1))) >>
                                    kInverseDrop);
}

// Quotient of the divider, U0.24, rounded to nearest.
std::uint32_t divide(std::int64_t over, std::int64_t under) {
  const std::int64_t numerator = (over << (spec::morphological::kRecipFractionBits + 1)) + under;
  return static_cast<std::uint32_t>(numerator / (2 * under));
}

}  // namespace

LineUnit::LineUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
                   const spec::morphological::Parameters& p, const ParameterStore& store,
                   spec::morphological::Axis axis)
    : Unit(name, clock),
      sums_in("sums_in", store.lanes()),
      lines_out("lines_out", store.lanes()),
      store_(store),
      lanes_(static_cast<std::size_t>(store.lanes())),
      reach_(axis == spec::morphological::Axis::kVertical ? store.reach_rows() : p.reach_columns),
      latency_(static_cast<Cycle>(p.divider_latency)),
      interval_(static_cast<Cycle>(p.divider_interval)),
      interval_stall_(declare_stall("interval", "the divider cannot start again yet")),
      dividers_(lanes_) {
  // As many as are under way when nothing waits: the next one starts when the oldest has gone.
  for (Divider& divider : dividers_) divider.flight.resize((latency_ + interval_ - 1) / interval_);
}

Activity LineUnit::work(Cycle cycle) {
  bool did = false, blocked = false, waits = false;
  for (std::size_t lane = 0; lane < lanes_; ++lane) {
    Divider& divider = dividers_[lane];
    In<SumsToken>& in = sums_in[lane];
    if (divider.count != 0) {
      const Division& oldest = divider.flight[divider.oldest];
      if (oldest.ready <= cycle) {
        if (lines_out[lane].can_push(cycle)) {
          lines_out[lane].push(cycle, oldest.result);
          divider.oldest = divider.oldest + 1 == divider.flight.size() ? 0 : divider.oldest + 1;
          --divider.count;
          --in_flight_;
          did = true;
        } else {
          blocked = true;
        }
      } else {
        did = true;  // dividing
      }
    }
    if (!in.can_pop(cycle)) continue;
    if (divider.count == divider.flight.size()) continue;  // blocked
    if (divider.start_from > cycle) {
      waits = true;
      continue;
    }
    std::size_t place = divider.oldest + divider.count++;
    if (place >= divider.flight.size()) place -= divider.flight.size();
    divider.flight[place] = {line_of(in.front(cycle)), cycle + latency_};
    divider.start_from = cycle + interval_;
    in.pop(cycle);
    ++divides;
    ++in_flight_;
    occupancy += interval_;
    did = true;
  }
  if (did) return kBusy;
  return blocked ? kStalledDownstream : waits ? interval_stall_ : kIdle;
}

LineToken LineUnit::line_of(const SumsToken& sums) const {
  const spec::morphological::RunRecord& run = sums.run.run;
  const spec::morphological::RunShape& shape = spec::morphological::kRunShapes[run.shape];
  LineToken token{};
  token.slot = sums.run.slot;
  spec::morphological::LineRecord& line = token.line;
  line.run = run;
  line.before = shape.before;
  line.after = shape.after;
  if (run.part != spec::morphological::RunPart::kWhole) {
    // One end of a run of `reach` pixels.
    line.scale = 2;
    line.offset =
        run.part == spec::morphological::RunPart::kHead ? reach_ : 2 * run.length - reach_;
    line.slope = divide(1, 2 * reach_);
    line.inverse = static_cast<std::uint32_t>(reach_) << spec::morphological::kInverseFractionBits;
    line.span = static_cast<std::uint16_t>(reach_ + 1);
    return token;
  }
  const std::int32_t left = sums.left, right = sums.right, corners = left + right + 2;
  const std::int32_t span = sums.last - sums.first;
  line.left_steps = sums.left;
  line.right_steps = sums.right;
  line.shift = right - left;
  line.span = static_cast<std::uint16_t>(span);
  if (store_.rules().predictor == spec::morphological::Predictor::kChord) {
    const std::int32_t steps = corners - 1;
    line.scale = 2;
    line.offset = sums.first + sums.last;
    line.slope = divide(steps, 2 * span);
    line.inverse =
        inverse(span, spec::morphological::kChordInverseSlope[static_cast<std::size_t>(steps)]);
  } else {
    // P = sum of J_i X_i with J_i = 2 i - (r + 1 - l).
    const std::int32_t p = 2 * sums.indexed_sum - (right + 1 - left) * sums.sum;
    line.scale = corners;
    line.offset = sums.sum;
    line.slope = divide(corners * corners - 1, std::int64_t{6} * p);
    line.inverse =
        inverse(p, spec::morphological::kFitInverseSlope[static_cast<std::size_t>(corners)]);
  }
  return token;
}

void LineUnit::reset() {
  for (Divider& divider : dividers_) {
    divider.oldest = divider.count = 0;
    divider.start_from = 0;
  }
  in_flight_ = 0;
}

}  // namespace deburr::rtl::morphological
