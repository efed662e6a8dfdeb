// SPDX-License-Identifier: MIT
// Some cycles of a run for public trace viewers (Perfetto, chrome://tracing), as JSON of their
// Trace Event format: a track a unit with a slice for each time that it is busy or stalled, named
// by the cause, an asynchronous event a memory transaction, from the port taking the request to its
// last answer, and counters: beats inside a FIFO and transactions in flight of a port, at the end
// of each clock. A microsecond of the viewer is a clock. Idle is where no slice is.
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
  // Links that hold more than it takes to pass a beat a clock: FIFOs.
  void see(const std::string& name, const rtl::LinkBase& link) override;
  void see(const std::string& name, const rtl::MemoryPort& port) override;

  rtl::Activity tick(rtl::Cycle cycle) override;
  void reset() override;
  // The run is over: what is open ends here. Once.
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
    std::string open;  // activity of the slice that goes on; empty: idle
    rtl::Cycle since = 0;
  };
  struct Port {
    std::string name;
    const rtl::MemoryPort* port;
    std::vector<Transaction> in_flight{};
    std::uint32_t beats_left = 0;  // of a burst that is being written
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
  std::vector<Sample> samples_;  // where a level changes
};

}  // namespace deburr::tb
