// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/blend/area_unit.h"

namespace deburr::rtl::morphological {

AreaUnit::AreaUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
                   const spec::morphological::Parameters& p)
    : Unit(name, clock),
      lines_h_in("lines_h_in", built_lanes(p)),
      lines_v_in("lines_v_in", built_lanes(p)),
      lanes_(static_cast<std::size_t>(built_lanes(p))),
      lag_(search_range_rows_of(p) + spec::morphological::kRowLag),
      columns_((static_cast<std::size_t>(p.line_pixels) + 2 * lanes_ - 1) / (2 * lanes_) * 2 *
               lanes_),
      smaa_(p.ends == spec::morphological::Ends::kCrossings || p.round_corners || p.diagonals ||
            has_table(p)),
      descriptor_store_("descriptor_store", p, columns_, {descriptors, bank_conflicts}),
      descriptor_walk_("descriptor_walk", p, descriptor_store_, {horizontal_edges, vertical_edges}),
      table_(has_table(p) ? std::make_unique<TableWeights>("table", p) : nullptr),
      learned_(p.area == spec::morphological::AreaSource::kLearned
                   ? std::make_unique<LearnedWeights>("learned", built_lanes(p))
                   : nullptr),
      weight_rows_("weight_rows", p, columns_) {
  if (!p.diagonals) return;
  diagonals_in.emplace("diagonals_in");
  diagonals_ = declare_stall("diagonals", "waits for the diagonals of a beat");
}

// Stage 1.
template <bool kSmaa>
void AreaUnit::enter(Cycle cycle, const FrameConfiguration& configuration,
                     const AreaSlotToken& token, Beat& beat) {
  beat.slot = token.slot;
  beat.left = token.left;
  beat.top = token.top;
  beat.next_left = token.next_left;
  beat.next_top = token.next_top;
  beat.weights = {};
  descriptor_walk_.address<kSmaa>(cycle, configuration, token.slot, beat.walk);
  beat.takes_diagonals = kSmaa && beat.walk.evaluates && configuration.diagonal_steps != 0;
}

// Stage 3: edges of the beat go to the units that compute their weights.
template <bool kSmaa, bool kLearned>
void AreaUnit::ask(Cycle cycle, const FrameConfiguration& configuration, Beat& beat) {
  descriptor_walk_.visit_edges(cycle, beat.walk,
                               [&](std::size_t number, const StoredDescriptor& descriptor,
                                   const DescriptorWalk::Edge& edge) {
                                 ask_edge<kSmaa, kLearned>(configuration, beat, number, descriptor,
                                                           edge);
                               });
  if (kLearned && configuration.learned) ask_gaps(beat);
}

template <bool kSmaa, bool kLearned>
void AreaUnit::ask_edge(const FrameConfiguration& configuration, Beat& beat, std::size_t number,
                        const StoredDescriptor& descriptor, const DescriptorWalk::Edge& edge) {
  if (kLearned && descriptor.learned) return learned_->ask(number, descriptor, edge.k, edge.after);
  if constexpr (kSmaa) {
    if (configuration.table) return table_->ask(number, descriptor, edge.k);
    const std::uint8_t near = descriptor.part == spec::morphological::RunPart::kHead ? 0
                              : descriptor.part == spec::morphological::RunPart::kTail
                                  ? 1
                                  : nearer_end(edge.k, edge.after);
    weights_of(beat.weights, number) =
        at_corners(configuration, AnalyticWeights::of(descriptor, edge.k), descriptor.far, near);
  } else {
    weights_of(beat.weights, number) = AnalyticWeights::of(descriptor, edge.k);
  }
}

// Edges not covered by a descriptor.
void AreaUnit::ask_gaps(const Beat& beat) {
  for (std::size_t number = 0; number < std::size_t{2} * beat.walk.count; ++number) {
    const unsigned edges = number % 2 ? beat.next_left : beat.next_top;
    if ((edges >> number / 2 & 1) != 0 && beat.walk.edge(number).from == 0)
      learned_->ask_gap(number);
  }
}

// Stage 8: a diagonal replaces the top edge's weights and clears those of the left edge.
void AreaUnit::take_diagonals(Cycle cycle, Beat& beat) {
  const DiagonalWeightsToken& token = diagonals_in->take(cycle);
  for (std::size_t i = 0; i < lanes_; ++i)
    if (token.taken >> i & 1)
      beat.weights[i] = {{}, {token.first[i], token.second[i], token.span[i]}};
}

// Stage 9: weights of the previous row go to the Blender, those of this row are stored.
[[gnu::always_inline]] inline void AreaUnit::send(Cycle cycle,
                                                  const FrameConfiguration& configuration,
                                                  const Beat& beat) {
  if (!beat.works()) return;
  if (beat.slot.row >= lag_) {
    WeightToken& out = weights_out.emplace(cycle);
    out.slot = beat.slot;
    out.left = beat.left;
    out.top = beat.top;
    weight_rows_.join(cycle, configuration.width, beat.walk.x, beat.walk.count, beat.slot.beat,
                      beat.weights, out);
  }
  weight_rows_.write(cycle, beat.walk.x, beat.slot.beat, beat.weights);
}

template <bool kSmaa, bool kLearned>
Activity AreaUnit::work(Cycle cycle) {
  bool did = false, blocked = false, waits = false;
  const FrameConfiguration& configuration = configuration_in.read(cycle);
  const bool arrives = slots_in.can_pop(cycle);
  if (arrives || !pipe_.empty()) {
    if (!weights_out.can_push(cycle) && pipe_.leaves() && pipe_.at(8)->slot.row >= lag_) {
      blocked = true;
    } else if (kSmaa && waits_for_diagonals(cycle)) {
      waits = true;
    } else {
      pipe_.move();
      did = true;
      if (const Beat* beat = pipe_.at(9)) send(cycle, configuration, *beat);
      if (Beat* beat = pipe_.at(8)) {
        if (kSmaa && beat->takes_diagonals) take_diagonals(cycle, *beat);
        if (beat->works()) weight_rows_.read(cycle, beat->walk.x);
      }
      // Stages 4 to 8 are inside the weight units.
      if (kLearned) learned_->move(cycle, weights_in(7));
      if (kSmaa && table_) table_->move(cycle, configuration, weights_in(6));
      if (Beat* beat = pipe_.at(3); beat && beat->walk.any)
        ask<kSmaa, kLearned>(cycle, configuration, *beat);
      if (Beat* beat = pipe_.at(2)) {
        descriptor_walk_.match<kSmaa, kLearned>(cycle, beat->slot, beat->walk);
        if (kLearned && beat->walk.evaluates && configuration.learned)
          beat->walk.any |= (beat->next_left | beat->next_top) != 0;
      }
      if (arrives) enter<kSmaa>(cycle, configuration, slots_in.take(cycle), pipe_.enter());
    }
  }
  did |= descriptor_store_.take_lines(cycle, configuration, lines_h_in, lines_v_in, finished_out);
  if (did) return kBusy;
  return blocked ? kStalledDownstream : waits ? *diagonals_ : kIdle;
}

Activity AreaUnit::tick(Cycle cycle) {
  if (learned_) return smaa_ ? work<true, true>(cycle) : work<false, true>(cycle);
  return smaa_ ? work<true, false>(cycle) : work<false, false>(cycle);
}

void AreaUnit::reset() {
  pipe_.reset();
  descriptor_store_.reset();
  descriptor_walk_.reset();
  if (table_) table_->reset();
  if (learned_) learned_->reset();
}

Datasheet AreaUnit::datasheet(const spec::morphological::Parameters& p) {
  const Datasheet line = has_table(p) ? TableWeights::datasheet(p) : AnalyticWeights::datasheet(p);
  const std::uint32_t lanes = lane_copies(p);
  const std::uint32_t learned = p.area == spec::morphological::AreaSource::kLearned ? 1 : 0;
  constexpr std::uint32_t kEdges = 2, kWeights = 2 * 8, kSpan = 12, kDiagonal = 2 * 8 + 6 + 1;
  const std::uint32_t corner = p.round_corners ? kEdges * (4 + 2) : 0;  // far bits, nearer end
  return {
      .unit = "AreaUnit",
      .does = "Weights of the pixels on both sides of each edge, from its descriptor's line.",
      .latency = {DescriptorWalk::datasheet(p).latency.cycles + line.latency.cycles +
                  WeightRows::datasheet(p).latency.cycles},
      .stages = {{.clock = "1-3", .work = "DescriptorWalk", .registers = kEdges},
                 {.clock = "4-8",
                  .work = "in parallel AnalyticWeights, with a table TableWeights, with learned "
                          "weights LearnedWeights (4-7)",
                  .registers = kEdges + corner},
                 {.clock = "8",
                  .work = "a learned weight replaces the line's; a beat of diagonals; address of "
                          "WeightRows",
                  .operators = {kEdges * learned * op::mux(kWeights + kSpan, 2),
                                kEdges * has_table(p) * op::mux(kWeights, 2)},
                  .registers = kEdges * (kWeights + kSpan) + (p.diagonals ? kDiagonal : 0)},
                 {.clock = "9",
                  .work = "corner factor; a diagonal replaces the weight; WeightRows",
                  .operators = {2 * kEdges * p.round_corners * op::mux(10, 3),
                                2 * kEdges * p.round_corners * op::subtract(10),
                                2 * kEdges * p.round_corners * op::multiply(10, 8),
                                2 * kEdges * p.round_corners * op::add(18),
                                kEdges * p.diagonals * op::mux(kWeights + kSpan, 2)},
                  .longest = p.round_corners ? std::vector{op::mux(10, 3), op::subtract(10),
                                                           op::multiply(10, 8), op::add(18),
                                                           op::mux(kWeights + kSpan, 2)}
                                             : std::vector<Operator>{}}},
      .formats = "weights U0.8, corner factor U1.9.",
      .copies = lanes,
      .per = "lane",
      // The slot, and the edges of the next row up to the query.
      .shared = {op::logic(40)},
      .shared_registers =
          8 * (kPayloadBits<Slot> + 1 + p.diagonals) + learned * 2 * kEdges * lanes};
}

}  // namespace deburr::rtl::morphological
