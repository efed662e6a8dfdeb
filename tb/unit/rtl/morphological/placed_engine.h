// SPDX-License-Identifier: MIT
// One engine of several on a clock, between a driver and a sink, with its registers, and a memory
// if it has a port for one.
#pragma once

#include <memory>
#include <string>

#include "tb/unit/rtl/morphological/support.h"

namespace deburr::tb::morphological_rtl {

struct PlacedEngine {
  PlacedEngine(const std::string& prefix, ClockDomain& clock, const Parameters& p)
      : driver((prefix + "_driver").c_str(), clock),
        engine((prefix + "_engine").c_str(), clock, p),
        sink((prefix + "_sink").c_str(), clock),
        bus((prefix + "_bus").c_str()),
        software(bus, p),
        in((prefix + "_in").c_str()),
        out((prefix + "_out").c_str()) {
    driver.beats_out(in);
    engine.pixels_in(in);
    engine.pixels_out(out);
    sink.beats_in(out);
    bus.bus.bind(engine.registers);
    if (engine.memory() != nullptr) {
      platform::MemoryModelParameters m;
      m.latency_max = 50;
      memory = std::make_unique<platform::MemoryModel>((prefix + "_memory").c_str(), period(), m);
      engine.memory()->bind(memory->ports);
    }
  }
  Driver<spec::morphological::PixelBeat> driver;
  rtl::morphological::MorphologicalEngine engine;
  Sink<spec::morphological::BlendedBeat> sink;
  platform::RegisterHost bus;
  platform::MorphologicalDriver software;
  Link<spec::morphological::PixelBeat> in;
  Link<spec::morphological::BlendedBeat> out;
  std::unique_ptr<platform::MemoryModel> memory;
};

}  // namespace deburr::tb::morphological_rtl
