// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/runs/endpoint_predictor.h"

#include <algorithm>

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

Datasheet EndpointPredictor::datasheet() {
  return {.unit = "EndpointPredictor",
          .variant = "not extended",
          .does = "Extends clean Z runs on both sides and sums their corners.",
          .latency = {2},
          .stages = {{"1", "descriptor to the first free predictor; its sums"},
                     {"2", "one result per lane and cycle", "16 : 1 mux of predictors"}}};
}

Datasheet EndpointPredictor::trial_datasheet(const spec::morphological::Parameters& p) {
  const auto trial = static_cast<std::uint64_t>(p.trial_cycles);
  const std::uint64_t over = trial >= 3 ? trial : trial == 2 ? 4 : 3;
  return {
      .unit = "EndpointPredictor",
      .variant = "extended",
      .does = datasheet().does,
      .latency = {trial + 5,
                  "T x trials + 5, plus up to T - 1 of waiting for the first trial (T = "
                  "`trial_cycles`)"},
      .interval =
          {trial + over,
           "T x (trials + 1) per predictor, predictor_units of them (T = 2: T x trials + 4, "
           "T = 1: trials + 3)"},
      .stages =
          {{"0", "address of the right side's columns (of the left side's here or in cycle 1)",
            "13-bit add, 5-bit add"},
           {"1", "the words arrive; select groups of bits", "SRAM read, 8 : 1 mux"},
           {"2",
            "select bits; compare corner codes; test that all edges between them are set; the "
            "left side's words arrive",
            "32 : 1 mux, 4-bit comparison"},
           {"3", "the same for the left side if it reads one cycle later",
            "32 : 1 mux, 4-bit comparison"},
           {"4 = 0'",
            "bounds: steps accepted or rejected; in parallel the next address, from the hits "
            "only. A read for a side that the bounds end is discarded",
            "7-bit add, two comparisons, mux"},
           {"5", "sums of the new corners", "13 x 5 multiply, 24-bit add"},
           {"6", "after the last trial: join the sums of both sides", "mux, two 24-bit adds"}},
      .formats = "positions S13 from the start of the run, sums per side S18 and S24.",
      .cost =
          "per predictor: LineBounds (safe); per side 16 flip-flops of letters, 3 x 60 of sums "
          "(trim; else 60), five 4-bit comparators, three adders and a 13 x 5 multiplier for the "
          "sums; trim adds a 13 x 4 multiplier, two adders and a 3 : 1 mux of 60 bits; classes "
          "add the first gap of ten edges per side. Per lane: predictor_units of these, with "
          "registers for a SumsToken and a mux."};
}

Datasheet EndpointPredictor::class_datasheet(const spec::morphological::Parameters& p) {
  const auto trial = static_cast<std::uint64_t>(p.trial_cycles);
  return {
      .unit = "EndpointPredictor",
      .variant = "classes only",
      .does = datasheet().does,
      .latency = {trial + 2, "T + 2, plus up to T - 1 of waiting for the reads"},
      .interval = {trial, "T per predictor, predictor_units of them"},
      .stages = {{"0-3", "as in the first trial of an extended descriptor"},
                 {"4", "class of each crossing: the corner's code, the first gap of ten edges"}}};
}

}  // namespace deburr::rtl::morphological
