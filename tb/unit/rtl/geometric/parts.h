// SPDX-License-Identifier: MIT
// Shared by the tests of single units: registers, a frame that stays in its edge or resolve phase,
// memory, and a queue of tokens at each end of the unit.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "rtl_model/fabric/histogram.h"
#include "rtl_model/geometric/common/edge_latency.h"
#include "rtl_model/geometric/common/memory_arbiter.h"
#include "rtl_model/geometric/common/parameter_store.h"
#include "rtl_model/geometric/frame_sequencer.h"
#include "tb/harness/in_child.h"
#include "tb/harness/unit_bench.h"
#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/geometric/support.h"

namespace deburr::tb::geometric_rtl {

// `measured` is a latency returned by a forked simulation.
inline void expect_latency_of(const rtl::Datasheet& sheet, const std::string& measured) {
  EXPECT_EQ(measured, std::to_string(sheet.latency.cycles))
      << "by the datasheet of " << title(sheet);
}

// "1 x 3, 4 x 1": each value of a histogram and its count.
inline std::string text_of(const rtl::Histogram& histogram) {
  std::string text;
  for (const rtl::Histogram::Bin& bin : histogram.bins())
    text +=
        (text.empty() ? "" : ", ") + std::to_string(bin.low) + " x " + std::to_string(bin.count);
  return text;
}

using unit_bench::Ends, unit_bench::Source, unit_bench::spread, unit_bench::stalls;

// The environment of a unit.
struct Frame {
  explicit Frame(const Parameters& parameters, std::uint32_t cycles = 20)
      : control("registers", spec::geometric::kRegisters, rtl::geometric::control_layout()),
        store("parameter_store", clock, control, parameters),
        sequencer("sequencer", clock),
        port_parameters{.outstanding = static_cast<std::uint32_t>(parameters.memory_outstanding)},
        arbiter("arbiter", clock, port_parameters, parameters),
        port("port", clock, port_parameters),
        memory("memory", period(), EngineBench::memory_parameters({.latency = cycles})),
        requests("requests"),
        responses("responses") {
    bus.bus.bind(control.registers.bus);
    arbiter.requests_out(requests);
    port.requests_in(requests);
    port.responses_out(responses);
    arbiter.responses_in(responses);
    port.memory.bind(memory.ports);
    sequencer.phase_out(phase);
    store.configuration_out(configuration);
    store.start_out(start);
    sequencer.start_in(start);
    sequencer.latch_out(latch);
    store.latch_in(latch);
    store.rejection_out(rejection);
    sequencer.rejection_in(rejection);
    sequencer.frame_done_out(frame_done);
    store.frame_done_in(frame_done);
    arbiter.memory_error_out(memory_error);
    store.memory_error_in(memory_error);
    store.invalid_edge_in(invalid_edge);
    if (store.invalid_pair_in) (*store.invalid_pair_in)(invalid_pair);
  }
  // A new wire for an output of the unit; the sequencer may wait for it.
  rtl::Wire<bool>& wire(rtl::WireOut<bool>& from, rtl::WireIn<bool>* to = nullptr) {
    rtl::Wire<bool>& joined = wires_.emplace_back(sc_core::sc_gen_unique_name("wire"), false);
    from(joined);
    if (to) (*to)(joined);
    return joined;
  }
  // Ties inputs that no unit of the test drives: done at once in the begin phase, and never
  // afterwards.
  void tie() {
    for (rtl::WireIn<bool>* const in : {&sequencer.facing_loaded_in, &sequencer.vertices_cleared_in,
                                        &sequencer.depth_cleared_in, &sequencer.weights_cleared_in})
      if (!in->bound()) (*in)(high);
    for (rtl::WireIn<bool>* const in :
         {&sequencer.drawn_in, &sequencer.copied_in, &sequencer.resolved_in})
      if (!in->bound()) (*in)(low);
  }
  // Starts a frame of this size, up to its edge phase.
  void begin(int width, int height) {
    tie();
    bus.write(reg::kSize, spec::geometric::size_word(static_cast<std::uint32_t>(width),
                                                     static_cast<std::uint32_t>(height)));
    bus.write(reg::kControl, reg::kControlEnable | reg::kControlStart);
    clock.run_until([this] { return phase.read(clock.cycle()) == rtl::geometric::Phase::kEdges; },
                    100'000);
    clock.run(1);
  }
  // Cycles from the one in which the unit takes this token to the first one in which the next unit
  // can take the result.
  template <class From, class To>
  std::string latency(Ends<From, To>& ends, const From& token) {
    const Cycle pushed = clock.cycle();
    ends.in.push(pushed, token);
    const std::size_t before = ends.sink.taken.size();
    clock.run_until([&] { return ends.sink.taken.size() != before; }, 1000);
    return std::to_string(ends.sink.taken.back().cycle - pushed - 1);
  }

  ClockDomain clock{"clock", period()};
  rtl::ControlRegisters control;
  rtl::geometric::ParameterStore store;
  rtl::geometric::FrameSequencer sequencer;
  rtl::MemoryPortParameters port_parameters;
  rtl::geometric::MemoryArbiter arbiter;
  rtl::MemoryPort port;
  platform::MemoryModel memory;
  platform::RegisterHost bus{"bus"};
  rtl::Link<rtl::MemoryRequest> requests;
  rtl::Link<rtl::MemoryResponse> responses;
  rtl::Wire<rtl::geometric::Phase> phase{"phase", rtl::geometric::Phase::kIdle,
                                         rtl::geometric::phase_shape()};
  rtl::Wire<rtl::geometric::FrameConfiguration> configuration{"configuration",
                                                              rtl::geometric::FrameConfiguration{}};
  rtl::CombinationalWire<spec::geometric::Rejection> rejection{"rejection",
                                                               rtl::geometric::rejection_shape()};
  rtl::Pulse start{"start"}, latch{"latch"}, frame_done{"frame_done"}, memory_error{"memory_error"},
      invalid_edge{"invalid_edge"}, invalid_pair{"invalid_pair"};
  rtl::Wire<bool> high{"high", true}, low{"low", false};
  rtl::geometric::EdgeLatency edge_latency;

 private:
  std::deque<rtl::Wire<bool>> wires_;
};

// Runs until this number of tokens has come out.
template <class From, class To>
void finish(Frame& frame, const Ends<From, To>& ends, std::size_t tokens) {
  ASSERT_TRUE(frame.clock.run_until([&] { return ends.sink.taken.size() == tokens; }, 100'000));
}

}  // namespace deburr::tb::geometric_rtl
