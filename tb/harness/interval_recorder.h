// SPDX-License-Identifier: MIT
// Cuts a run into windows of equal length and keeps what was counted in each: every activity of
// every unit, every counter, beats and occupancy of links, transactions in flight. From the
// counters that are there anyway, by their difference from one window's end to the next; only
// occupancy is looked at in every clock.
//
//   IntervalRecorder recorder(clock, {.cycles = 1000});   // after the design
//   environment.show_parts(recorder);
//   ... run ...
//   recorder.finish();
//
// Memory is bounded: with `most` windows, neighbours become one and windows are twice as long from
// then on. A reset of the clock domain forgets all windows, as it forgets all counters.
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
  std::size_t most = 1024;          // windows; even
  std::optional<std::size_t> lose;  // a fault: forgets what this window counted
};

class IntervalRecorder final : public rtl::Clocked, public Observer {
 public:
  // What was counted in each window under a key, "units.tag_stage.stalls.fifo_full".
  struct Series {
    std::string key, unit;
    bool largest = false;  // the largest value in the window, else a sum
    std::vector<std::uint64_t> values;
  };
  // Of a link: cycles by the number of beats inside at their end, from 0 to its depth.
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
  // The run is over: the last window is as long as it is. Once.
  void finish();

  rtl::Cycle interval_cycles() const { return interval_; }
  const std::vector<rtl::Cycle>& from() const { return from_; }
  const std::vector<rtl::Cycle>& cycles() const { return cycles_; }
  // Without counters that are no sums: a largest value, or one that begins anew within the run.
  std::vector<Series> series() const;
  std::vector<Occupancy> occupancy() const;
  // The file intervals.json (docs/reference/statistics.md).
  nlohmann::ordered_json json() const;

 private:
  struct Counted {
    Series series;
    std::function<std::uint64_t()> total;  // since reset
    std::uint64_t before = 0;              // the total at the end of the last window
    const rtl::Counter* counter = nullptr;
    bool restarts = false;
  };
  struct WatchedLink {
    const rtl::LinkBase* link;
    std::string name;
    std::uint64_t occupied = 0;  // beats x cycles
    std::uint64_t most = 0;      // in this window
    std::vector<std::uint64_t> cycles;
  };
  struct WatchedPort {
    const rtl::MemoryPort* port;
    std::uint64_t outstanding = 0;  // transactions x cycles
    std::uint64_t most = 0;         // in this window
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
  rtl::Cycle interval_, begin_ = 0, end_ = 0;  // of the window that is being counted
  bool begun_ = false;
  std::vector<Counted> counted_;
  std::vector<Largest> largest_;
  // Places are kept: what is counted refers to them.
  std::vector<std::unique_ptr<WatchedLink>> links_;
  std::vector<std::unique_ptr<WatchedPort>> ports_;
  std::vector<ThroughputSeries> throughput_;
  std::vector<rtl::Cycle> from_, cycles_;
};

}  // namespace deburr::tb
