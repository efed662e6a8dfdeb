// SPDX-License-Identifier: MIT
// Helpers of the tests of the texture unit's RTL model: a queue of tokens at each end of a block, a
// memory that records its requests, and the whole unit with both.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <systemc>
#include <tlm>
#include <utility>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/counters.h"
#include "rtl_model/fabric/link.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/platform/memory_model.h"
#include "rtl_model/platform/register_host.h"
#include "rtl_model/platform/texture_memory.h"
#include "rtl_model/texture/texture_unit.h"
#include "spec/error.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/packets.h"
#include "spec/texture/parameters.h"
#include "spec/texture/registers.h"
#include "tb/harness/unit_bench.h"
#include "tb/stimuli/texture_quads.h"

namespace deburr::tb::texture_rtl {

using rtl::Activity;
using rtl::ClockDomain;
using rtl::Cycle;
using rtl::In;
using rtl::kBusy;
using rtl::kIdle;
using rtl::Link;
using rtl::Out;
using rtl::Unit;

using unit_bench::read_one_cycle_early, unit_bench::period, unit_bench::rejection;

// Sends a second token in the same cycle, for a unit that has forgotten the first.
template <class T>
std::string of_a_second_token(Unit& unit, Link<T>& link, const T& token, const ClockDomain& clock) {
  const Cycle cycle = clock.cycle() - 1;
  unit.reset();
  link.reset();
  link.push(cycle - 1, token);
  return rejection([&] { unit.tick(cycle); });
}
// Matches the rejection by this memory with this reason.
MATCHER_P2(Rejects, memory, reason, "") {
  return arg.find(memory) != std::string::npos && arg.find(reason) != std::string::npos;
}
inline constexpr const char* kEarly = "is used";
inline constexpr const char* kTooMany = "second access";

// Adds an undeclared port to the only memory of this word type below `root`.
template <class Port, class Word>
std::string of_one_port_more(sc_core::sc_object& root, const std::string& name) {
  rtl::Memory<Word>* found = nullptr;
  rtl::for_each<rtl::Memory<Word>>(root, [&](rtl::Memory<Word>& memory) {
    if (name == memory.basename()) found = &memory;
  });
  if (!found) return "no such memory";
  return rejection([&] { Port(*found, "somebody"); });
}

using unit_bench::cycles_of, unit_bench::Ends, unit_bench::Sink, unit_bench::Source,
    unit_bench::stalls;

// The first cycle in which the consumer of `link` can take its oldest token; kNever if that does
// not happen within `limit` cycles. Proves "not ready at n - 1, ready at n".
template <class T>
Cycle ready_at(ClockDomain& clock, const Link<T>& link, Cycle limit = 1000) {
  const Cycle end = clock.cycle() + limit;
  while (!link.can_pop(clock.cycle())) {
    if (clock.cycle() == end) return rtl::kNever;
    clock.run(1);
  }
  return clock.cycle();
}

// Writes a descriptor, valid or not; TextureDriver rejects invalid ones.
inline void write_descriptor(platform::RegisterHost& bus, std::uint32_t handle,
                             const spec::texture::Descriptor& d) {
  for (const auto& [offset, value] : platform::descriptor_registers(static_cast<int>(handle), d))
    bus.write(offset, value);
}

inline constexpr std::uint32_t kMemoryLatency = 10;

// With `scatter`, responses arrive up to that many cycles later, at random, and may be reordered.
inline platform::MemoryModelParameters memory_parameters(std::uint32_t latency,
                                                         std::uint32_t scatter) {
  platform::MemoryModelParameters p;
  p.latency_min = latency;
  p.latency_max = latency + scatter;
  p.outstanding = 1024;
  return p;
}

// The ticket of a fragment with a valid descriptor.
inline rtl::texture::Ticket ticket(std::uint32_t tag = 0, std::uint8_t texture = 0) {
  return {tag, 0, true, true, texture};
}

// Registers and descriptors with their bus, for the blocks that read them.
struct Store {
  explicit Store(ClockDomain& clock, const std::string& name = "",
                 const spec::texture::Build& build = {})
      : control((name + "registers").c_str(), rtl::texture::register_table(),
                rtl::texture::control_layout()),
        descriptors((name + "descriptors").c_str(), control, build),
        bus((name + "bus").c_str()) {
    bus.bus.bind(control.registers.bus);
    clock.on_reset([this] { control.reset(); });
  }
  rtl::ControlRegisters control;
  rtl::texture::Descriptors descriptors;
  platform::RegisterHost bus;
};

// The whole unit between source and sink, with the preset `paper` by default.
struct UnitBench {
  explicit UnitBench(const spec::texture::Parameters& parameters = stimuli::paper_configuration(),
                     std::uint32_t latency = kMemoryLatency, std::uint32_t scatter = 0,
                     const sc_core::sc_time& clock_period = period())
      : clock("clock", clock_period),
        colours("colours", 2, rtl::texture::colours_shape(parameters)),
        unit("unit", clock, parameters, {static_cast<std::int32_t>(latency + scatter), 1}),
        memory("memory", clock_period, memory_parameters(latency, scatter)) {
    unit.quads_in(quads);
    unit.colours_out(colours);
    unit.memory()->bind(memory.ports);
    bus.bus.bind(unit.registers);
    source.out(quads);
    sink.in(colours);
  }
  // Runs until every added quad has been answered.
  bool finish(Cycle limit = 1'000'000) {
    return clock.run_until([&] { return source.done() && unit.idle() && colours.empty(); }, limit);
  }
  void reset(Cycle cycles = 3) {
    clock.set_reset_n(false);
    clock.run(cycles);
    clock.set_reset_n(true);
  }

  ClockDomain clock;
  Link<spec::texture::Quad> quads{"quads"};
  Link<spec::texture::ColourGroup> colours;
  Source<spec::texture::Quad> source{"source", clock};
  rtl::texture::TextureUnit unit;
  Sink<spec::texture::ColourGroup> sink{"sink", clock};
  platform::MemoryModel memory;
  platform::RegisterHost bus{"bus"};
};

// A power-of-two RGBA8 texture in row-major order at address 0, levels one after the other. Texel
// (x, y) of level k is (x, y, k, 255).
inline spec::texture::Descriptor linear_texture(platform::MemoryModel& memory, int size) {
  std::vector<std::vector<platform::Texel>> texels;
  std::vector<platform::TextureLevel> levels;
  for (int side = size; side > 0; side /= 2) {
    std::vector<platform::Texel>& level = texels.emplace_back();
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        level.push_back({static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                         static_cast<std::uint8_t>(levels.size()), 255});
    levels.push_back({side, side, level});
  }
  spec::texture::Descriptor sampler;
  sampler.layout = spec::texture::Layout::kLinear;
  platform::TextureMemory textures;
  textures.add(levels, sampler);
  memory.preload(0, textures.bytes());
  return textures.descriptors().front();
}

// A quad whose lanes are dx and dy apart: along s in the row, along t in the column.
inline spec::texture::Quad quad_at(std::int32_t s, std::int32_t t, std::int32_t dx, std::int32_t dy,
                                   std::uint32_t tag = 0) {
  spec::texture::Quad q;
  q.tag = tag;
  q.s = {s, s + dx, s, s + dx};
  q.t = {t, t, t + dy, t + dy};
  return q;
}

}  // namespace deburr::tb::texture_rtl
