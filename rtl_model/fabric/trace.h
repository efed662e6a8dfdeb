// SPDX-License-Identifier: MIT
// VCD traces of links, wires, units and counters of a clock domain, selected by scope and cycle
// range.
//
// One top scope holds the clock, the cycle number and the hierarchy.
//   link     in its own scope: occupancy, push, pop, and every field of the beat at its head
//            (pixel.0.r becomes pixel_0_r; x while the link is empty)
//   wire     the value that its readers see in the cycle (x: not driven), per field if several
//   unit     its activity, as a string
//   counter, register   its value
// Values are sampled at the end of every cycle of the domain and written with the time of the edge.
// While a trace is attached, the domain runs cycle by cycle, so that signals traced by other
// SystemC code are correct as well. Off by default, without cost when off.
#pragma once

#include <array>
#include <cstdint>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"

namespace deburr::rtl {

struct TraceOptions {
  std::string file;                      // *.vcd
  std::vector<std::string> scopes{"*"};  // globs (* and ?) on full hierarchical names
  Cycle from = 0, to = kNever;           // cycles [from, to)
  bool payloads = true;                  // the fields at the head of links, not only the handshake
  std::string top = "deburr";            // the top scope
};

class Trace final : public Clocked {
 public:
  // Attaches to the domain; the file is written from the first sampled cycle on.
  Trace(ClockDomain& clock, const TraceOptions& options);
  // A file that could not be written completely is removed.
  ~Trace() override;

  // Adds a value that is sampled in each traced cycle; `name` is hierarchical. Call before the
  // first cycle.
  void add(const std::string& name, int bits, std::function<std::uint64_t()> sample);

  // Throws FileError with the reason if writing failed.
  Activity tick(Cycle cycle) override;
  // Writes all samples so far to the file; throws FileError if that fails.
  void flush();
  void reset() override {}
  std::size_t signals() const { return signals_.size(); }
  // All names of the domain that a scope can select.
  static std::vector<std::string> names(const ClockDomain& clock);

 private:
  struct Signal {
    std::string name;
    int bits;  // 0: a string
    std::function<std::string(Cycle)> sample;
    std::string id, last;
  };
  bool wanted(const std::string& name) const;
  void collect(Cycle cycle);
  void write_header();
  void write(const std::string& value, int bits, const std::string& id);
  void check_file() const;

  ClockDomain& clock_;
  TraceOptions options_;
  std::ofstream file_;
  std::vector<Signal> signals_;
  std::string clock_id_, cycle_id_;
  std::map<const Unit*, std::array<std::uint64_t, kActivities>> initial_;  // when it was attached
  bool started_ = false;
};

}  // namespace deburr::rtl
