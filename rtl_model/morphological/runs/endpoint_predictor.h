// SPDX-License-Identifier: MIT
// Extends clean Z runs to both sides, a step of both sides a clock, and sums up the corners.
//
// Where: between the record FIFOs and the LineUnit, one of these an axis. For each lane a FIFO
// feeds predictor_units predictors; one takes a record a clock and holds it for max(1, iterations)
// clocks, the first of them the clock of the pop. Then the sums go to a result register of the
// predictor and from there, one a lane and clock, to the LineUnit: latency max(1, iterations) + 1,
// initiation interval max(1, iterations) a predictor. A trial reads the three candidates L, L - 1,
// L + 1 of a side at once. Stalls: `downstream` (the result register is still full).
//
// Trim takes no clock of its own: beside the sums of all its steps a side keeps those without its
// last step and those of the first half of its steps. The former are what the sums were before;
// the latter take in one corner at every second step, which the corner file has held for as many
// steps as the half is long. The trial that ends a side sets two bits, and the join of the sums in
// the last clock selects by them.
//
// Formats: positions S13 from the start of the run, sums of a side S18 and S24. Cost a predictor:
// 2 x 3 comparators of four bits, two masks and comparators of (reach + 1) / 2 bits (contiguous;
// the edges along a horizontal step come from EdgeRows), 34 corners in registers, 2 x 34 cross
// products of 13 x 6 bits and their maximum and minimum (safe); a side three adders and a
// multiplier of 13 x 5 bits for its sums, four adders to join them. Trim: a side 2 x 60 flip-flops,
// two adders and a multiplier of 13 x 4 bits (the half), an adder and a comparator of 13 bits (the
// reach), and a selector 3 : 1 of 60 bits.
// Source: paper 000, sections 3 and 4; `safe`, `trim` and the sums are ours.
#pragma once

#include <array>
#include <cstdint>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/unit.h"
#include "rtl_model/morphological/parameter_store.h"
#include "rtl_model/morphological/runs/edge_window.h"
#include "rtl_model/morphological/tokens.h"

namespace deburr::rtl::morphological {

class EndpointPredictor final : public Unit {
 public:
  LanePorts<In<RunToken>> records_in;
  LanePorts<Out<SumsToken>> sums_out;

  EndpointPredictor(const sc_core::sc_module_name& name, ClockDomain& clock,
                    const spec::morphological::Parameters& parameters, const ParameterStore& store,
                    EdgeWindow& window, spec::morphological::Axis axis);
  Activity tick(Cycle cycle) override {
    return held_ == 0 && !records_in.any_arrives(cycle, lanes_) ? kIdle : work(cycle);
  }
  void reset() override;

  Counter extended_runs{"extended_runs", "runs", "runs that keep at least one step"};
  Counter steps{"steps", "steps", "extensions kept"};
  Counter probes{"probes", "corners", "corners tested"};
  Counter iterations{"iterations", "clk", "clocks in which a predictor made a trial"};
  Counter occupancy{"occupancy", "clk", "clocks in which a predictor held a record, summed"};

 private:
  // Bounds of the slope (pixels a step) of a line that has all corners: low < slope < high.
  struct Fraction {
    std::int32_t over;   // S14
    std::int32_t under;  // U6, > 0
  };
  struct Bounds {
    Fraction low, high;
    bool consistent() const {
      return std::int64_t{low.over} * high.under < std::int64_t{high.over} * low.under;
    }
  };
  // The first steps of a side: their number, the X that they reach, the sums of their corners.
  struct Stretch {
    std::int32_t steps;             // U5
    std::int32_t position;          // S13
    std::int32_t sum, indexed_sum;  // S18, S24: sum of X_i, of i X_i
  };
  // Which of its steps a side passes on.
  enum Keep : std::uint8_t { kAll, kBeforeLast, kFirstHalf, kKeeps };
  // One end that grows.
  struct End {
    bool open;
    Keep keep;
    std::int32_t other;  // L' if not safe, 0 while unknown
    std::array<Stretch, kKeeps> reached;
  };
  struct Predictor {
    bool busy = false, done = false;  // holds a record; has a result
    RunToken run;
    std::int32_t length, start, line;
    std::int32_t drift;  // lattice lines a step to the right: -1 or +1
    std::uint8_t start_corner, end_corner;
    std::int32_t step;   // k
    std::int32_t other;  // L' of both ends if safe, 0 while unknown
    End left, right;
    Bounds bounds;
    std::array<std::int32_t, spec::morphological::kMaxCorners> corner;  // X_i at [i + kMaxSteps]
    SumsToken result;
  };

  Activity work(Cycle cycle);
  void take(Predictor& p, const RunToken& run);
  bool iterate(Predictor& p, Cycle cycle);  // false after the last trial
  bool iterate_apart(Predictor& p, Cycle cycle);
  bool iterate_together(Predictor& p, Cycle cycle);
  std::int32_t trial(Cycle cycle, const Predictor& p, const End& end, bool to_the_right,
                     std::int32_t other);
  bool candidate(const Predictor& p, const End& end, bool to_the_right,
                 const EdgeWindow::Columns& corners, std::int32_t line, std::int32_t step) const;
  Bounds with(const Predictor& p, Bounds bounds, std::int32_t i, std::int32_t x) const;
  void accept(Predictor& p, End& end, bool to_the_right, std::int32_t step);
  // A side ends for good: as a trial without a hit says, or with the given share of its steps.
  void lose(const Predictor& p, End& end, bool to_the_right, std::int32_t other);
  void close(End& end, Keep keep);
  void finish(Predictor& p);

  // The four edges at a lattice corner; `across` numbers the lattice lines along the axis.
  std::uint8_t corner(const EdgeWindow::Columns& read, std::int32_t along,
                      std::int32_t across) const;

  const ParameterStore& store_;
  const std::size_t lanes_;
  EdgeWindow& window_;
  const bool vertical_;
  const std::int32_t reach_;
  const std::size_t units_;  // predictors a lane
  std::vector<Predictor> predictors_;
  std::vector<std::size_t> turn_;  // of each lane: the predictor whose result is sent next
  std::uint32_t held_ = 0;         // records and results inside
};

}  // namespace deburr::rtl::morphological
