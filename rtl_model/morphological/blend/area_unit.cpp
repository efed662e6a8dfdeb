// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/area_unit.h"

namespace deburr::rtl::morphological {

AreaUnit::AreaUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
                   const spec::morphological::Parameters& p)
    : Unit(name, clock),
      lines_h_in("lines_h_in", built_lanes(p)),
      lines_v_in("lines_v_in", built_lanes(p)),
      lanes_(static_cast<std::size_t>(built_lanes(p))),
      lag_(reach_rows_of(p) + spec::morphological::kRowLag),
      columns_((static_cast<std::size_t>(p.line_pixels) + 2 * lanes_ - 1) / (2 * lanes_) * 2 *
               lanes_),
      smaa_(p.ends == spec::morphological::Ends::kCrossings || p.round_corners || p.diagonals ||
            has_table(p)),
      record_store_("record_store", p, columns_, {records, bank_conflicts}),
      record_walk_("record_walk", p, record_store_, {horizontal_edges, vertical_edges}),
      table_(has_table(p) ? std::make_unique<TableShares>("table", p) : nullptr),
      learned_(p.area == spec::morphological::AreaSource::kLearned
                   ? std::make_unique<LearnedShares>("learned", built_lanes(p))
                   : nullptr),
      share_rows_("share_rows", p, columns_) {
  if (!p.diagonals) return;
  diagonals_in.emplace("diagonals_in");
  diagonals_ = declare_stall("diagonals", "the diagonals of a beat have not come");
}

// Stage 1.
template <bool kSmaa>
void AreaUnit::enter(Cycle cycle, const FrameRules& rules, const AreaSlotToken& token, Beat& beat) {
  beat.slot = token.slot;
  beat.left = token.left;
  beat.top = token.top;
  beat.next_left = token.next_left;
  beat.next_top = token.next_top;
  beat.shares = {};
  record_walk_.address<kSmaa>(cycle, rules, token.slot, beat.walk);
  beat.takes_diagonals = kSmaa && beat.walk.evaluates && rules.diagonal_steps != 0;
}

// Stage 3: the edges of the beat go to the units of their shares.
template <bool kSmaa, bool kLearned>
void AreaUnit::ask(Cycle cycle, const FrameRules& rules, Beat& beat) {
  record_walk_.visit_edges(
      cycle, beat.walk,
      [&](std::size_t number, const StoredRecord& record, const RecordWalk::Edge& edge) {
        ask_edge<kSmaa, kLearned>(rules, beat, number, record, edge);
      });
  if (kLearned && rules.learned) ask_gaps(beat);
}

template <bool kSmaa, bool kLearned>
void AreaUnit::ask_edge(const FrameRules& rules, Beat& beat, std::size_t number,
                        const StoredRecord& record, const RecordWalk::Edge& edge) {
  if (kLearned && record.learned) return learned_->ask(number, record, edge.k, edge.after);
  if constexpr (kSmaa) {
    if (rules.table) return table_->ask(number, record, edge.k);
    const std::uint8_t near = record.part == spec::morphological::RunPart::kHead ? 0
                              : record.part == spec::morphological::RunPart::kTail
                                  ? 1
                                  : nearer_end(edge.k, edge.after);
    shares_of(beat.shares, number) =
        at_corners(rules, AnalyticShares::of(record, edge.k), record.far, near);
  } else {
    shares_of(beat.shares, number) = AnalyticShares::of(record, edge.k);
  }
}

// The edges that no record covers.
void AreaUnit::ask_gaps(const Beat& beat) {
  for (std::size_t number = 0; number < std::size_t{2} * beat.walk.count; ++number) {
    const unsigned edges = number % 2 ? beat.next_left : beat.next_top;
    if ((edges >> number / 2 & 1) != 0 && beat.walk.edge(number).from == 0)
      learned_->ask_gap(number);
  }
}

// Stage 8: a diagonal gives the top edge its shares and takes those of the left one.
void AreaUnit::take_diagonals(Cycle cycle, Beat& beat) {
  const DiagonalSharesToken& token = diagonals_in->take(cycle);
  for (std::size_t i = 0; i < lanes_; ++i)
    if (token.taken >> i & 1)
      beat.shares[i] = {{}, {token.first[i], token.second[i], token.span[i]}};
}

// Stage 9: shares of the row above go to the Blender, those of this row take their place.
[[gnu::always_inline]] inline void AreaUnit::send(Cycle cycle, const FrameRules& rules,
                                                  const Beat& beat) {
  if (!beat.works()) return;
  if (beat.slot.row >= lag_) {
    ShareToken& out = shares_out.emplace(cycle);
    out.slot = beat.slot;
    out.left = beat.left;
    out.top = beat.top;
    share_rows_.join(cycle, rules.width, beat.walk.x, beat.walk.count, beat.slot.beat, beat.shares,
                     out);
  }
  share_rows_.write(cycle, beat.walk.x, beat.slot.beat, beat.shares);
}

template <bool kSmaa, bool kLearned>
Activity AreaUnit::work(Cycle cycle) {
  bool did = false, blocked = false, waits = false;
  const FrameRules& rules = rules_in.read(cycle);
  const bool arrives = slots_in.can_pop(cycle);
  if (arrives || !pipe_.empty()) {
    if (!shares_out.can_push(cycle) && pipe_.leaves() && pipe_.at(8)->slot.row >= lag_) {
      blocked = true;
    } else if (kSmaa && waits_for_diagonals(cycle)) {
      waits = true;
    } else {
      pipe_.move();
      did = true;
      if (const Beat* beat = pipe_.at(9)) send(cycle, rules, *beat);
      if (Beat* beat = pipe_.at(8)) {
        if (kSmaa && beat->takes_diagonals) take_diagonals(cycle, *beat);
        if (beat->works()) share_rows_.read(cycle, beat->walk.x);
      }
      // Stages 4 to 8 are those of the units of shares.
      if (kLearned) learned_->move(cycle, shares_in(7));
      if (kSmaa && table_) table_->move(cycle, rules, shares_in(6));
      if (Beat* beat = pipe_.at(3); beat && beat->walk.any)
        ask<kSmaa, kLearned>(cycle, rules, *beat);
      if (Beat* beat = pipe_.at(2)) {
        record_walk_.match<kSmaa, kLearned>(cycle, beat->slot, beat->walk);
        if (kLearned && beat->walk.evaluates && rules.learned)
          beat->walk.any |= (beat->next_left | beat->next_top) != 0;
      }
      if (arrives) enter<kSmaa>(cycle, rules, slots_in.take(cycle), pipe_.enter());
    }
  }
  did |= record_store_.take_lines(cycle, rules, lines_h_in, lines_v_in, finished_out);
  if (did) return kBusy;
  return blocked ? kStalledDownstream : waits ? *diagonals_ : kIdle;
}

Activity AreaUnit::tick(Cycle cycle) {
  if (learned_) return smaa_ ? work<true, true>(cycle) : work<false, true>(cycle);
  return smaa_ ? work<true, false>(cycle) : work<false, false>(cycle);
}

void AreaUnit::reset() {
  pipe_.reset();
  record_store_.reset();
  record_walk_.reset();
  if (table_) table_->reset();
  if (learned_) learned_->reset();
}

Datasheet AreaUnit::datasheet(const spec::morphological::Parameters& p) {
  const Datasheet line = has_table(p) ? TableShares::datasheet() : AnalyticShares::datasheet();
  return {.unit = "AreaUnit",
          .does = "Shares of the pixels across each edge, by its record's line.",
          .latency = {RecordWalk::datasheet().latency.clocks + line.latency.clocks +
                      ShareRows::datasheet().latency.clocks},
          .stages = {{"1-3", "RecordWalk"},
                     {"4-8",
                      "side by side AnalyticShares, with a table TableShares, with learned shares "
                      "LearnedShares (4-7)"},
                     {"8",
                      "a learned share in place of the line's; a beat of diagonals; address of "
                      "ShareRows"},
                     {"9", "corner factor; a diagonal in place of the share; ShareRows",
                      "10 x 8 multiply, choice"}},
          .formats = "shares U0.8, corner factor U1.9.",
          .cost = "that of its parts, in an axis and lane with corners two multipliers 10 x 8."};
}

}  // namespace deburr::rtl::morphological
