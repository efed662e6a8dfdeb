// SPDX-License-Identifier: MIT
// A memory port between a driver and a sink, with the repository's memory model.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/platform/memory_model.h"
#include "tb/unit/fabric/support.h"

namespace deburr::tb {

inline const sc_core::sc_time kPeriod(10, sc_core::SC_NS);

inline std::uint8_t pattern(std::uint64_t address) {
  return static_cast<std::uint8_t>(address * 7 + (address >> 8) * 13 + 1);
}

inline rtl::MemoryRequest read_of(std::uint32_t line) {
  rtl::MemoryRequest request;
  request.address = std::uint64_t{line} * rtl::kLineBytes;
  request.tag = line;
  return request;
}

inline bool right(const rtl::MemoryResponse& response) {
  if (response.status != rtl::MemoryStatus::kOk) return false;
  for (std::uint32_t i = 0; i < rtl::kLineBytes; ++i)
    if (response.data[i] != pattern(response.address + i)) return false;
  return true;
}

// driver -> port -> sink
struct Side {
  rtl::ClockDomain clock{"clock", kPeriod};
  Driver<rtl::MemoryRequest> driver{"driver", clock};
  rtl::MemoryPort port;
  Sink<rtl::MemoryResponse> sink;
  rtl::Link<rtl::MemoryRequest> requests;
  rtl::Link<rtl::MemoryResponse> responses;
  explicit Side(const rtl::MemoryPortParameters& parameters = {}, std::uint32_t sink_stalls = 0)
      : port("port", clock, parameters),
        sink("sink", clock, {sink_stalls, 1}),
        requests("requests", 2, rtl::request_shape(parameters, 64, 32)),
        responses("responses", 2, rtl::response_shape(parameters, 64, 32)) {
    driver.beats_out(requests);
    port.requests_in(requests);
    port.responses_out(responses);
    sink.beats_in(responses);
  }
  std::string fingerprint() const {
    std::string text;
    for (std::size_t i = 0; i < sink.beats().size(); ++i)
      text += fmt::format("{}:{}.{}{} ", sink.cycles()[i], sink.beats()[i].tag,
                          sink.beats()[i].line, right(sink.beats()[i]) ? "" : "!");
    return text + statistics(clock).dump();
  }
};

// Fills every byte of memory with its pattern().
inline void fill(platform::MemoryModel& memory, std::uint64_t bytes) {
  std::vector<std::uint8_t> contents(bytes);
  for (std::size_t i = 0; i < contents.size(); ++i) contents[i] = pattern(i);
  memory.preload(0, contents);
}

struct System : Side {
  platform::MemoryModel memory;
  System(const rtl::MemoryPortParameters& port_parameters,
         const platform::MemoryModelParameters& parameters, std::uint32_t sink_stalls = 0)
      : Side(port_parameters, sink_stalls), memory("memory", kPeriod, parameters) {
    port.memory.bind(memory.ports);
    fill(memory, parameters.bytes);
  }
};

inline platform::MemoryModelParameters with_latency(std::uint32_t min, std::uint32_t max = 0) {
  platform::MemoryModelParameters parameters;
  parameters.latency_min = min;
  parameters.latency_max = max ? max : min;
  return parameters;
}

}  // namespace deburr::tb
