// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/edges/edge_classifier.h"

#include <bit>
#include <string>

#include "rtl_model/geometric/common/hardware_lists.h"
#include "spec/geometric/records.h"

namespace deburr::rtl::geometric {

namespace flag = spec::geometric::flag;
using spec::geometric::Crease;
using spec::geometric::EdgeClass;
using spec::geometric::Select;

EdgeClassifier::EdgeClassifier(const sc_core::sc_module_name& name, ClockDomain& clock,
                               const spec::geometric::Parameters& p, Memory<std::uint32_t>& facing,
                               EdgeLatency& latency)
    : Unit(name, clock),
      latency_(latency),
      split_(p.records == spec::geometric::RecordsLayout::kSplit) {
  if (split_)
    numbers_out.emplace("numbers_out");
  else
    edges_out.emplace("edges_out");
  for (int lane = 0; lane < spec::geometric::kLaneCount[static_cast<std::size_t>(p.edge_lanes)];
       ++lane)
    for (const char* const face : {" f0", " f1"})
      ports_.emplace_back(facing, "lane " + std::to_string(lane) + face);
}

// Numbers every edge that is read within the array that holds its vertex pair.
void EdgeClassifier::give_number(const FrameConfiguration& configuration, Beat& beat,
                                 std::size_t lane) {
  const bool other = !(beat.edges.edge[lane].flags & flag::kBoundary);
  NextPair& next = next_[other];
  const std::uint32_t there = other ? configuration.edge_count - configuration.boundary_count
                                    : configuration.boundary_count;
  beat.number[lane] = {next.line, next.place, other, false, false, false};
  beat.unpaired |= static_cast<std::uint8_t>((next.count >= there) << lane);
  ++next.count;
  if (++next.place < spec::geometric::kSplitInLine) return;
  next.place = 0;
  ++next.line;
}

// Stage 1.
void EdgeClassifier::look(Cycle cycle, Beat& beat) {
  const FrameConfiguration& configuration = configuration_in.read(cycle);
  const bool selects = configuration.select == Select::kEdges;
  beat.valid = beat.looked = beat.unpaired = 0;
  if (split_ && beat.edges.end) next_ = {};
  for (std::size_t lane = 0; lane < beat.edges.count; ++lane) {
    const EdgeFields& edge = beat.edges.edge[lane];
    const bool boundary = edge.flags & flag::kBoundary;
    if (split_) give_number(configuration, beat, lane);
    const bool vertices =
        split_ || (edge.v0 < configuration.vertex_count && edge.v1 < configuration.vertex_count);
    const bool faces =
        edge.f0 < configuration.face_count && (boundary || edge.f1 < configuration.face_count);
    if (!vertices || (selects && !faces)) continue;
    const auto bit = static_cast<std::uint8_t>(1u << lane);
    beat.valid |= bit;
    if (boundary || !selects) continue;
    beat.looked |= bit;
    ports_[2 * lane].read(cycle, edge.f0 >> 5);
    ports_[2 * lane + 1].read(cycle, edge.f1 >> 5);
  }
}

// Stage 2.
void EdgeClassifier::choose_bits(Cycle cycle, Beat& beat) {
  beat.facing0 = beat.facing1 = 0;
  for (std::uint32_t left = beat.looked; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(left));
    const EdgeFields& edge = beat.edges.edge[lane];
    const auto facing = [&](std::size_t port, std::uint32_t face) {
      return ports_[port].at(cycle, face >> 5) >> (face & 31) & 1;
    };
    beat.facing0 |= static_cast<std::uint8_t>(facing(2 * lane, edge.f0) << lane);
    beat.facing1 |= static_cast<std::uint8_t>(facing(2 * lane + 1, edge.f1) << lane);
  }
}

// Stage 3, of one lane.
EdgeClass EdgeClassifier::class_of(const FrameConfiguration& configuration, const EdgeFields& edge,
                                   bool valid, bool facing0, bool facing1) {
  if (!valid) return EdgeClass::kInvalid;
  if (edge.flags & flag::kBoundary) return EdgeClass::kBoundary;
  if (configuration.select == Select::kAll) return EdgeClass::kUnclassified;
  if (configuration.select == Select::kEdges) {
    if (facing0 != facing1) return EdgeClass::kSilhouette;
    if (!facing0 && configuration.cull == spec::geometric::Cull::kBack) return EdgeClass::kBack;
  }
  const bool angle = edge.flags & flag::kAngle, split = edge.flags & flag::kSplitNormals,
             seam = edge.flags & flag::kSeam;
  const bool crease = (configuration.crease == Crease::kPaper && angle) ||
                      (configuration.crease == Crease::kShading && ((angle && split) || seam));
  return crease ? EdgeClass::kCrease : EdgeClass::kFlat;
}

// nullptr: counted only in the total.
Counter* EdgeClassifier::counter_of(EdgeClass c) {
  switch (c) {
    case EdgeClass::kInvalid:
      return &invalid_edges;
    case EdgeClass::kBoundary:
      return &boundary_edges;
    case EdgeClass::kSilhouette:
      return &silhouette_edges;
    case EdgeClass::kBack:
      return &back_edges;
    case EdgeClass::kCrease:
      return &crease_edges;
    case EdgeClass::kFlat:
      return &flat_edges;
    default:
      return nullptr;
  }
}

void EdgeClassifier::classify(Cycle cycle, const Beat& beat) {
  const FrameConfiguration& configuration = configuration_in.read(cycle);
  edges += beat.edges.count;
  bool invalid = std::popcount(beat.valid) != beat.edges.count;
  creases_ = 0;
  for (std::size_t lane = 0; lane < beat.edges.count; ++lane) {
    const EdgeClass c = class_of(configuration, beat.edges.edge[lane], beat.valid >> lane & 1,
                                 beat.facing0 >> lane & 1, beat.facing1 >> lane & 1);
    if (Counter* const counter = counter_of(c)) ++*counter;
    const bool kept = c != EdgeClass::kInvalid && c != EdgeClass::kBack && c != EdgeClass::kFlat;
    latency_.decided(kept, split_);
    if (!kept) continue;
    ++kept_edges;
    if (beat.unpaired >> lane & 1) {
      ++invalid_edges;
      ++unpaired_edges;
      invalid = true;
    }
    pending_ |= static_cast<std::uint8_t>(1u << lane);
    creases_ |= static_cast<std::uint8_t>((c == EdgeClass::kCrease) << lane);
  }
  if (invalid) invalid_edge_out.raise(cycle);
  if (beat.edges.end) pending_ = kEnd;
}

void EdgeClassifier::leave(Cycle cycle) {
  const bool end = pending_ == kEnd;
  const auto lane = static_cast<std::size_t>(std::countr_zero(pending_));
  const bool crease = creases_ >> lane & 1;
  if (split_) {
    PairNumber& number = numbers_out->emplace(cycle);
    if (!end) {
      const Beat& beat = *pipe_.at(3);
      number = beat.number[lane];
      number.crease = crease;
      number.invalid = beat.unpaired >> lane & 1;
    }
    number.end = end;
  } else {
    KeptEdge& kept = edges_out->emplace(cycle);
    kept.end = end;
    if (!end) {
      const EdgeFields& edge = pipe_.at(3)->edges.edge[lane];
      kept.v0 = edge.v0;
      kept.v1 = edge.v1;
      kept.crease = crease;
    }
  }
  pending_ &= static_cast<std::uint8_t>(pending_ - 1);
}

Activity EdgeClassifier::tick(Cycle cycle) {
  if (pending_ != 0) {
    if (!can_leave(cycle)) return kStalledDownstream;
    leave(cycle);
    return kBusy;
  }
  const bool arrives = edges_in.can_pop(cycle);
  if (!arrives && pipe_.empty()) return kIdle;
  pipe_.move();
  if (const Beat* beat = pipe_.at(3)) {
    classify(cycle, *beat);
    if (pending_ != 0 && can_leave(cycle)) leave(cycle);
  }
  if (Beat* beat = pipe_.at(2)) choose_bits(cycle, *beat);
  if (arrives) {
    Beat& beat = pipe_.enter();
    beat.edges = edges_in.take(cycle);
    look(cycle, beat);
  }
  return kBusy;
}

void EdgeClassifier::reset() {
  pipe_.reset();
  pending_ = creases_ = 0;
  next_ = {};
}

Datasheet EdgeClassifier::datasheet(const spec::geometric::Parameters& p) {
  const bool split = p.records == spec::geometric::RecordsLayout::kSplit;
  const std::uint32_t lanes = lane_count(p.edge_lanes), more = lanes > 1;
  // Of an edge to be kept: two vertices, or line, record and whether it has a pair.
  const std::uint32_t pair = split ? 21 + 4 + 1 : 2 * 24;
  const std::vector<Operator> ranges =
      split ? built({2 * op::compare(21), op::mux(21, 4), op::mux(28, 2), more * op::add(4),
                     more * op::compare(4), more * op::add(24), op::compare(25),
                     more * op::count_ones(lanes)})
            : std::vector{2 * op::compare(25), 2 * op::compare(24)};
  return {.unit = "EdgeClassifier",
          .variant = split ? "`records = split`" : "`records = joined`",
          .does = "Decides for each edge whether it can be visible as an edge.",
          .latency = {3, "3, plus 1 for each kept edge of the same beat that leaves first"},
          .interval = {1, "kept edges of a beat of edge_lanes edges, at least 1"},
          .stages = {{.clock = "1",
                      .work = std::string("ranges, addresses of the facing bits") +
                              (split ? "; pair numbers" : ""),
                      .operators = built({op::logic(10)}, ranges),
                      .longest = split ? built({more * op::count_ones(lanes), op::mux(28, 2),
                                                more * op::add(24), op::compare(25)})
                                       : std::vector{op::compare(25)},
                      .registers = pair + 4 + 2 * 5 + 2},
                     {.clock = "2",
                      .work = "words of facing bits, selection of one of 32",
                      .path = "SRAM read",
                      .operators = {2 * op::mux(1, 32), op::logic(2)},
                      .longest = {op::mux(32, 16), op::mux(1, 32)},
                      .registers = pair + 4 + 3},
                     {.clock = "3",
                      .work = "class, counters; one kept edge leaves per cycle",
                      .operators = built({op::logic(30), op::mux(pair, 2)}),
                      .longest = built({op::logic(8), more * op::priority(lanes), op::mux(pair, 2),
                                        op::mux(pair + 1, lanes)}),
                      .registers = pair + 2}},
          .copies = lanes,
          .per = "lane",
          .shared =
              split ? built({op::subtract(25), 2 * op::add(24), 2 * op::add(21), 2 * op::add(4),
                             2 * op::compare(4), more * op::priority(lanes),
                             op::mux(pair + 1, lanes), op::logic(20)})
                    : built({more * op::priority(lanes), op::mux(pair + 1, lanes), op::logic(20)}),
          .shared_registers = 2 * 5 + 1 + (split ? 2 * (21 + 4 + 24) : 0U)};
}

}  // namespace deburr::rtl::geometric
