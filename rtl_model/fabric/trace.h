// SPDX-License-Identifier: MIT
// VCD waves of links, wires, units and counters of a clock domain, chosen by scope and cycle
// window.
//
// One scope holds all: the clock, the number of its cycle, and the hierarchy. Of each link, in a
// scope of its own: occupancy, push, pop, and every field of the beat at its head (pixel.0.r is
// pixel_0_r; x while the link is empty). Of each wire: what its readers see in that cycle (x: not
// driven), by field if it has several. Of each unit: its activity (as a string). Of each counter
// and register: its value. Sampled at the end of every cycle of the clock domain and written with
// the time of the edge. While a trace is attached, the domain goes cycle by cycle, so
// that signals that other SystemC code traces by itself are right as well. Off by default; costs
// nothing when off.
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
  bool payloads = true;                  // the fields at the head of links, not only the hand-shake
  std::string top = "deburr";            // the scope around all
};

class Trace final : public Clocked {
 public:
  // Attaches to the domain; write nothing before the first cycle in the window.
  Trace(ClockDomain& clock, const TraceOptions& options);
  // A file that could not be written whole is removed.
  ~Trace() override;

  // Something else, sampled each cycle in the window; name is hierarchical. Before the first cycle.
  void add(const std::string& name, int bits, std::function<std::uint64_t()> sample);

  // FileError with the reason once something could not be written.
  Activity tick(Cycle cycle) override;
  // What was sampled so far is in the file, or this is a FileError.
  void flush();
  void reset() override {}
  std::size_t signals() const { return signals_.size(); }
  // Everything of the domain that a scope can choose.
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
