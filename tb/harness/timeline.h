// SPDX-License-Identifier: MIT
// Records some cycles of a run in the Trace Event format (JSON) for trace viewers such as Perfetto
// and chrome://tracing. Each unit has a track with a slice for each busy or stalled period; a
// stalled slice has the name of the stall cause. Each memory transaction is an asynchronous event,
// from the cycle in which the request is accepted to the last response. Counter tracks show, at the
// end of each cycle, the occupancy of FIFOs and the transactions in flight at each port. One
// microsecond in the viewer is one cycle; idle cycles have no slice.
//
//   Timeline timeline(clock, {.from = 1000, .to = 3000});   // after the design
//   environment.show_parts(timeline);
//   ... run ...
//   timeline.finish();
//   write(timeline.json());
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/link.h"
#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/fabric/unit.h"
#include "tb/harness/observer.h"

namespace deburr::tb {

struct TimelineOptions {
  rtl::Cycle from = 0, to = 2000;  // cycles [from, to)
};

class Timeline final : public rtl::Clocked, public Observer {
 public:
  Timeline(rtl::ClockDomain& clock, const TimelineOptions& options);

  using Observer::see;
  void see(const std::string& name, const rtl::Unit& unit,
           const std::vector<std::string>& activities) override;
  // Shows only FIFOs: links that are deeper than a throughput of one beat per cycle requires.
  void see(const std::string& name, const rtl::LinkBase& link) override;
  void see(const std::string& name, const rtl::MemoryPort& port) override;

  rtl::Activity tick(rtl::Cycle cycle) override;
  void reset() override;
  // Ends the run and closes open slices. Call once.
  void finish();

  std::string json() const;

 private:
  struct Slice {
    std::size_t track;
    std::string name, category;  // "fifo_full", "stall"
    rtl::Cycle from, to;
  };
  struct Transaction {
    std::size_t port;
    std::uint64_t id;
    rtl::MemoryRequest request;
    rtl::Cycle from, to;
    bool answered;
  };
  struct Track {
    std::string name;
    const rtl::Unit* unit;
    std::vector<std::string> activities;
    std::array<std::uint64_t, rtl::kActivities> before{};
    std::string open;  // activity of the open slice; empty: idle
    rtl::Cycle since = 0;
  };
  struct Port {
    std::string name;
    const rtl::MemoryPort* port;
    std::vector<Transaction> in_flight{};
    std::uint32_t beats_left = 0;  // of the write burst in progress
  };
  struct Level {
    std::string name, category, unit;  // "beats"
    std::function<std::uint32_t()> now;
    std::optional<std::uint32_t> last{};
  };
  struct Sample {
    std::size_t level;
    rtl::Cycle at;
    std::uint32_t value;
  };
  void look_at(Level& level, std::size_t number, rtl::Cycle cycle);
  void look_at(Track& track, std::size_t number, rtl::Cycle cycle);
  void end_slice(Track& track, std::size_t number, rtl::Cycle cycle);
  void look_at(Port& port, std::size_t number, rtl::Cycle cycle);
  void keep(Transaction transaction);

  const rtl::ClockDomain& clock_;
  TimelineOptions options_;
  rtl::Cycle end_ = 0;
  std::uint64_t transactions_ = 0;
  std::vector<Track> tracks_;
  std::vector<Port> ports_;
  std::vector<Level> levels_;
  std::vector<Slice> slices_;
  std::vector<Transaction> kept_;
  std::vector<Sample> samples_;  // one per change of level
};

}  // namespace deburr::tb
