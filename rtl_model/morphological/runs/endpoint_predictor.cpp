// SPDX-License-Identifier: MIT
#include "rtl_model/morphological/runs/endpoint_predictor.h"

#include <algorithm>

namespace deburr::rtl::morphological {

template <class Edges>
EndpointPredictor::EndpointPredictor(const sc_core::sc_module_name& name, ClockDomain& clock,
                                     const spec::morphological::Parameters& p,
                                     const ParameterStore& store, Edges& edges, std::int32_t reach,
                                     bool vertical)
    : Unit(name, clock),
      records_in("records_in", store.lanes()),
      sums_out("sums_out", store.lanes()),
      schedule_(p),
      lanes_(static_cast<std::size_t>(store.lanes())),
      units_(static_cast<std::size_t>(p.predictor_units)),
      turn_(lanes_) {
  const Predictor::Counters counters{extended_runs, steps, probes, iterations};
  // Those of a lane do not follow each other in the schedule: they begin in different clocks, so
  // that a FIFO that gives a record a clock serves all of them in time.
  for (int lane = 0; lane < store.lanes(); ++lane)
    for (int unit = 0; unit < p.predictor_units; ++unit) {
      const int number = unit * store.lanes() + lane;
      places_.push_back(
          {Predictor(store, schedule_, number, EdgePort(edges, schedule_.port(number, 0)),
                     EdgePort(edges, schedule_.port(number, 1)), reach, vertical, counters)});
    }
}

EndpointPredictor::EndpointPredictor(const sc_core::sc_module_name& name, ClockDomain& clock,
                                     const spec::morphological::Parameters& p,
                                     const ParameterStore& store, EdgeRows& rows)
    : EndpointPredictor(name, clock, p, store, rows, p.reach_columns, false) {}

EndpointPredictor::EndpointPredictor(const sc_core::sc_module_name& name, ClockDomain& clock,
                                     const spec::morphological::Parameters& p,
                                     const ParameterStore& store, EdgeWindow& window)
    : EndpointPredictor(name, clock, p, store, window, store.reach_rows(), true) {}

Activity EndpointPredictor::work(Cycle cycle) {
  bool did = false, blocked = false;
  for (std::size_t lane = 0; lane < lanes_; ++lane) {
    In<RunToken>& in = records_in[lane];
    const bool arrives = in.can_pop(cycle);
    if (held_ == 0 && !arrives) continue;
    Place* const group = &places_[lane * units_];

    // The result registers take turns.
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
      // What is joined leaves room for a record in the same clock, and that may leave at once.
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
        predictor.take(cycle, reset_, in.take(cycle));
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
  reset_ = kNever;
}

}  // namespace deburr::rtl::morphological
