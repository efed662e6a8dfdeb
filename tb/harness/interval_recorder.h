// SPDX-License-Identifier: MIT
// Divides a run into sampling intervals of equal length and records counts for each interval:
// activities of units, counters, beats and occupancy of links, and memory transactions in flight.
// Counts are differences of existing counters between the ends of intervals; only occupancy is
// sampled in every cycle.
//
//   IntervalRecorder recorder(clock, {.cycles = 1000});   // after the design
//   environment.show_parts(recorder);
//   ... run ...
//   recorder.finish();
//
// Memory is bounded: when there are `most` intervals, pairs of neighbours are merged, and later
// intervals are twice as long. A reset of the clock domain clears all intervals, as it clears all
// counters.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "tb/harness/observer.h"

namespace deburr::tb {

struct IntervalOptions {
  rtl::Cycle cycles = 1000;
  std::size_t most = 1024;          // largest number of intervals; even
  std::optional<std::size_t> lose;  // fault: discards the counts of this interval
};

class IntervalRecorder final : public rtl::Clocked, public Observer {
 public:
  // Counts of each interval under one key, such as "units.tag_stage.stalls.fifo_full".
  struct Series {
    std::string key, unit;
    bool largest = false;  // maximum over the interval instead of a sum
    std::vector<std::uint64_t> values;
  };
  // For a link: number of cycles by occupancy at the end of the cycle, from 0 to its depth.
  struct Occupancy {
    std::string name, full_name;
    std::uint64_t beats = 0;  // pushed
    std::vector<std::uint64_t> cycles;
  };

  IntervalRecorder(rtl::ClockDomain& clock, const IntervalOptions& options);

  void see(const std::string& name, const rtl::Unit& unit,
           const std::vector<std::string>& activities) override;
  void see(const std::string& name, const rtl::Counter& counter) override;
  void see(const std::string& name, const rtl::LinkBase& link) override;
  void see(const std::string& name, const rtl::MemoryPort& port) override;
  void see(const ThroughputSeries& series) override { throughput_.push_back(series); }

  rtl::Activity tick(rtl::Cycle cycle) override;
  void reset() override;
  // Ends the run and closes the last, possibly shorter interval. Call once.
  void finish();

  rtl::Cycle interval_cycles() const { return interval_; }
  const std::vector<rtl::Cycle>& from() const { return from_; }
  const std::vector<rtl::Cycle>& cycles() const { return cycles_; }
  // Excludes counters that are not sums: maxima and counters that restart within a run.
  std::vector<Series> series() const;
  std::vector<Occupancy> occupancy() const;
  // Content of intervals.json (docs/reference/statistics.md).
  nlohmann::ordered_json json() const;

 private:
  struct Counted {
    Series series;
    std::function<std::uint64_t()> total;  // since reset
    std::uint64_t before = 0;              // total at the end of the previous interval
    const rtl::Counter* counter = nullptr;
    bool restarts = false;
  };
  struct WatchedLink {
    const rtl::LinkBase* link;
    std::string name;
    std::uint64_t occupied = 0;  // beats x cycles
    std::uint64_t most = 0;      // in this interval
    std::vector<std::uint64_t> cycles;
  };
  struct WatchedPort {
    const rtl::MemoryPort* port;
    std::uint64_t outstanding = 0;  // transactions x cycles
    std::uint64_t most = 0;         // in this interval
  };
  struct Largest {
    Series series;
    std::uint64_t* most;
  };
  void add(std::string key, std::string unit, std::function<std::uint64_t()> total);
  void add_largest(std::string key, std::string unit, std::uint64_t& most);
  void close();
  void merge();

  const rtl::ClockDomain& clock_;
  IntervalOptions options_;
  rtl::Cycle interval_, begin_ = 0, end_ = 0;  // of the current interval
  bool begun_ = false;
  std::vector<Counted> counted_;
  std::vector<Largest> largest_;
  // Pointers, because observers keep references to the elements.
  std::vector<std::unique_ptr<WatchedLink>> links_;
  std::vector<std::unique_ptr<WatchedPort>> ports_;
  std::vector<ThroughputSeries> throughput_;
  std::vector<rtl::Cycle> from_, cycles_;
};

}  // namespace deburr::tb
