// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/runs/endpoint_predictor.h"

#include <algorithm>
#include <array>

namespace deburr::rtl::morphological {

EndpointPredictor::EndpointPredictor(const sc_core::sc_module_name& name, ClockDomain& clock,
                                     const spec::morphological::Parameters& p, EdgeMemory& edges,
                                     std::int32_t search_range, bool vertical)
    : Unit(name, clock),
      descriptors_in("descriptors_in", built_lanes(p)),
      sums_out("sums_out", built_lanes(p)),
      schedule_(p),
      lanes_(static_cast<std::size_t>(built_lanes(p))),
      units_(static_cast<std::size_t>(p.predictor_units)),
      turn_(lanes_) {
  const Predictor::Counters counters{extended_runs, steps, probes, iterations};
  // The predictors of a lane are not adjacent in the schedule: they start in different cycles, so
  // one FIFO that delivers a descriptor per cycle serves all of them without waiting.
  const int lanes = built_lanes(p);
  for (int lane = 0; lane < lanes; ++lane)
    for (int unit = 0; unit < p.predictor_units; ++unit) {
      const int number = unit * lanes + lane;
      places_.push_back({Predictor(schedule_, number, EdgePort(edges, schedule_.port(number, 0)),
                                   EdgePort(edges, schedule_.port(number, 1)), search_range,
                                   vertical, counters)});
    }
}

EndpointPredictor::EndpointPredictor(const sc_core::sc_module_name& name, ClockDomain& clock,
                                     const spec::morphological::Parameters& p, EdgeRows& rows)
    : EndpointPredictor(name, clock, p, rows, p.search_columns, false) {}

EndpointPredictor::EndpointPredictor(const sc_core::sc_module_name& name, ClockDomain& clock,
                                     const spec::morphological::Parameters& p, EdgeWindow& window)
    : EndpointPredictor(name, clock, p, window, search_range_rows_of(p), true) {}

Activity EndpointPredictor::work(Cycle cycle) {
  bool did = false, blocked = false;
  for (std::size_t lane = 0; lane < lanes_; ++lane) {
    In<RunToken>& in = descriptors_in[lane];
    const bool arrives = in.can_pop(cycle);
    if (held_ == 0 && !arrives) continue;
    Place* const group = &places_[lane * units_];

    // The result registers are sent in rotation.
    Out<SumsToken>& out = sums_out[lane];
    std::size_t& turn = turn_[lane];
    for (std::size_t i = 0, k = turn; full_ != 0 && i < units_;
         ++i, k = k + 1 == units_ ? 0 : k + 1) {
      if (!group[k].full) continue;
      if (out.can_push(cycle)) {
        out.push(cycle, group[k].result);
        group[k].full = false;
        --full_;
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
      Place& place = group[k];
      Predictor& predictor = place.predictor;
      // A predictor that joins is free for a new descriptor in the same cycle, which may also join
      // at once.
      const auto join = [&] {
        if (!predictor.joins(cycle)) return;
        if (place.full) {
          blocked = true;
          return;
        }
        place.result = predictor.join();
        place.full = true;
        ++full_;
        did = true;
      };
      const bool held = !predictor.free();
      if (held) {
        predictor.tick(cycle);
        did |= !predictor.joins(cycle);
        join();
      }
      const bool takes = predictor.free() && !taken;
      if (takes) {
        taken = did = true;
        predictor.take(cycle, configuration_in.read(cycle), clock().cycles_since_reset(),
                       in.take(cycle));
        ++held_;
        join();
      }
      if (held || takes) ++occupancy;
    }
  }
  if (did) return kBusy;
  return blocked ? kStalledDownstream : kIdle;
}

void EndpointPredictor::reset() {
  for (Place& place : places_) {
    place.predictor.reset();
    place.full = false;
  }
  std::fill(turn_.begin(), turn_.end(), 0);
  held_ = full_ = 0;
}

namespace {

constexpr std::uint32_t kAxes = 2;

// Read ports of both axes, with the select circuits of their words: planes of the edges along the
// row, and of those across on both sides. They are in groups of 32 columns or rows.
struct Ports {
  explicit Ports(const spec::morphological::Parameters& p)
      : ports(static_cast<std::uint32_t>(PortSchedule(p).ports())),
        predictors(lane_copies(p) * static_cast<std::uint32_t>(p.predictor_units)),
        readers((2 * predictors + ports - 1) / ports),
        groups{2 * EdgeRows::words_per_read(p),
               static_cast<std::uint32_t>(p.window_rows + 32) / 32} {}
  const std::uint32_t ports;       // per axis
  const std::uint32_t predictors;  // per axis
  const std::uint32_t readers;     // sides that share a port
  const std::array<std::uint32_t, kAxes> groups;
  // Operators of a port, by its groups.
  template <class Of>
  std::vector<Operator> each(Of&& of) const {
    std::vector<Operator> operators;
    for (const std::uint32_t axis_groups : groups)
      for (const Operator& one : of(axis_groups)) operators.push_back(ports * one);
    return operators;
  }
};

std::vector<Operator> operator+(std::vector<Operator> a, const std::vector<Operator>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

Datasheet EndpointPredictor::datasheet(const spec::morphological::Parameters& p) {
  const auto units = static_cast<std::uint32_t>(p.predictor_units);
  const std::uint32_t run = Payload::of<RunToken>(descriptor_shape(p, "", "run.")).bits(),
                      sums = Payload::of<SumsToken>(sums_shape(p)).bits();
  return {.unit = "EndpointPredictor",
          .variant = "not extended",
          .does = "Extends clean Z runs on both sides and sums their corners.",
          .latency = {2},
          .stages = {{.clock = "1",
                      .work = "descriptor to the first free predictor; its sums",
                      .operators = {op::priority(units), units * op::mux(run, 2)},
                      .registers = units * (run + sums + 1)},
                     {.clock = "2",
                      .work = "one result per lane and cycle",
                      .operators = {op::priority(units), op::mux(sums, units)},
                      .longest = {op::priority(units), op::mux(sums, units)},
                      .registers = 4}},
          .copies = kAxes * lane_copies(p),
          .per = "axis and lane"};
}

Datasheet EndpointPredictor::trial_datasheet(const spec::morphological::Parameters& p) {
  const auto trial = static_cast<std::uint64_t>(p.trial_cycles);
  const std::uint64_t over = trial >= 3 ? trial : trial == 2 ? 4 : 3;
  constexpr std::uint32_t kSides = 2, kPlane = 36, kPlanes = 3, kPrefix = 5 + 13 + 18 + 24;
  // Of a trial, needed until the comparison: places, codes, candidates within the range.
  constexpr std::uint32_t kAsked = 13 + 13 + 8 + 3 + 1 + 4 + 4;
  const bool from = p.contiguous || p.area == spec::morphological::AreaSource::kLearned;
  const Ports at(p);
  const auto port = [&](std::uint32_t groups) -> std::vector<Operator> {
    return {op::mux(kAsked + 16, at.readers),
            (1 + from) * op::mux(kPlanes * kPlane, groups),
            op::mux(10, 32),
            from * op::mux(4, 32),
            4 * op::equal(4),
            op::logic(30),
            p.contiguous * op::logic(5 * 32 * groups)};
  };
  // Addresses: a word and the base of a row; the age of a row.
  const std::uint32_t sides = kSides * at.predictors;
  const std::vector<Operator> addresses = {2 * sides * op::add(14), sides * op::add(16),
                                           sides * op::mux(16, 2), sides * op::subtract(9)};
  const std::uint32_t words = trial >= 3 ? (1u + from) * kPlanes * kPlane + kAsked : 0;
  // With fewer cycles per trial, stages share cycles.
  const std::uint32_t most = std::max(at.groups[0], at.groups[1]);
  const std::vector<Operator> group = {op::mux(1, most)}, bits = {op::mux(1, 32), op::equal(4)},
                              fits = {op::add(7), 2 * op::compare(7), op::mux(7, 3)},
                              turns = {op::multiply(6, 6), op::add(12)},
                              address = {op::logic(20), op::mux(13, 3), op::add(14), op::add(5)};
  return {
      .unit = "EndpointPredictor",
      .variant = "extended",
      .does = datasheet(p).does,
      .latency = {trial + 5,
                  "T x trials + 5, plus up to T - 1 of waiting for the first trial (T = "
                  "`trial_cycles`)"},
      .interval =
          {trial + over,
           "T x (trials + 1) per predictor, predictor_units of them (T = 2: T x trials + 4, "
           "T = 1: trials + 3)"},
      .stages =
          {{.clock = "0",
            .work = "address of the right side's columns (of the left side's here or in cycle 1)",
            .operators = {kSides * op::mux(13, 3), 2 * kSides * op::add(14),
                          kSides * op::subtract(13), 2 * kSides * op::compare(13), 2 * op::add(12)},
            .longest = address,
            .registers = kSides * (14 + 14),
            .on = "iterations"},
           {.clock = "1",
            .work = "the words arrive; select groups of bits",
            .path = "SRAM read",
            .longest = trial >= 4 ? group : group + bits},
           {.clock = "2",
            .work = "select bits; compare corner codes; test that all edges between them are set; "
                    "the left side's words arrive",
            .longest = bits},
           {.clock = "3",
            .work = "the same for the left side if it reads one cycle later",
            .longest = bits},
           // L' and the chosen candidates; LineBounds.
           {.clock = "4 = 0'",
            .work = "bounds: steps accepted or rejected; in parallel the next address, from the "
                    "hits only. A read for a side that the bounds end is discarded",
            .operators = {op::logic(80), 5 * op::compare(12), 8 * op::add(7), 4 * op::compare(7),
                          4 * op::equal(7), 4 * op::subtract(6), op::mux(96, 3),
                          2 * op::multiply(6, 6), op::add(12)},
            .longest = trial >= 4   ? fits
                       : trial >= 2 ? fits + turns
                                    : bits + fits + turns + fits + turns + address,
            .registers = 8 * 12 + 4 * 6 + kSides * (12 + 16 + 3 + 3) + 11,
            .on = "iterations"},
           // Per side all steps, without the last, and the first half.
           {.clock = "5",
            .work = "sums of the new corners",
            .operators = {kSides * op::multiply(13, 5), kSides * op::multiply(13, 4),
                          2 * kSides * op::add(13), 2 * kSides * op::add(18),
                          2 * kSides * op::add(24), 2 * kSides * op::add(5),
                          kSides * op::mux(13, 2)},
            .longest = {op::multiply(13, 5), op::add(24)},
            .registers = kSides * 3 * kPrefix,
            .on = "iterations"},
           {.clock = "6",
            .work = "after the last trial: join the sums of both sides",
            .operators = {kSides * op::mux(kPrefix, 3), 2 * op::add(18), 2 * op::add(24)},
            .longest = {op::mux(kPrefix, 3), 2 * op::add(24)},
            .on = "extended_runs"}},
      .formats = "positions S13 from the start of the run, sums per side S18 and S24.",
      .copies = kAxes * at.predictors,
      .per = "predictor",
      .shared = at.each(port) + addresses,
      .shared_registers = kAxes * at.ports * (kAsked + words + 4)};
}

Datasheet EndpointPredictor::class_datasheet(const spec::morphological::Parameters& p) {
  const auto trial = static_cast<std::uint64_t>(p.trial_cycles);
  constexpr std::uint32_t kEdges = kMostLooks;
  const Ports at(p);
  const auto port = [](std::uint32_t groups) -> std::vector<Operator> {
    return {op::mux(kEdges, groups), op::mux(kEdges, 32), op::leading_one(kEdges), op::logic(40)};
  };
  return {
      .unit = "EndpointPredictor",
      .variant = "classes only",
      .does = datasheet(p).does,
      .latency = {trial + 2, "T + 2, plus up to T - 1 of waiting for the reads"},
      .interval = {trial, "T per predictor, predictor_units of them"},
      .stages = {{.clock = "0-3", .work = "as in the first trial of an extended descriptor"},
                 {.clock = "4",
                  .work = "class of each crossing: the corner's code, the first gap of ten edges",
                  .operators = {op::subtract(12), op::maximum(4)},
                  .longest = {op::leading_one(kEdges), op::logic(40)},
                  .registers = 2 * 4}},
      .copies = kAxes * at.predictors,
      .per = "predictor",
      .shared = at.each(port),
      .shared_registers = kAxes * at.ports * kEdges};
}

}  // namespace deburr::rtl::morphological
