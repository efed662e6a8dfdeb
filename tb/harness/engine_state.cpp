// SPDX-License-Identifier: MIT
#include "tb/harness/engine_state.h"

#include <fmt/format.h>

#include <algorithm>

#include "rtl_model/fabric/wire.h"

namespace deburr::tb {
namespace {

// The object's name without the engine's name.
std::string inner_name(const rtl::Engine& engine, const sc_core::sc_object& object) {
  return std::string(object.name()).substr(std::string(engine.name()).size() + 1);
}

}  // namespace

std::vector<std::string> engine_state(rtl::Engine& engine, platform::RegisterHost& host,
                                      const std::vector<std::uint32_t>& more_registers) {
  std::vector<std::string> state;
  const auto add = [&](const std::string& name, std::uint64_t value) {
    state.push_back(fmt::format("{} = {:#x}", name, value));
  };
  for (const spec::RegisterInfo& info : engine.control.registers.table())
    add(fmt::format("register {}", info.name), host.read(info.offset));
  for (const std::uint32_t offset : more_registers)
    add(fmt::format("register {:#x}", offset), host.read(offset));
  for (const rtl::Counter* counter : engine.counters())
    add(inner_name(engine, *counter), counter->value());
  for (const rtl::Histogram* histogram : engine.histograms()) {
    const std::string name = inner_name(engine, *histogram);
    add(name + ".count", histogram->count());
    add(name + ".sum", histogram->sum());
    add(name + ".min", histogram->min());
    add(name + ".max", histogram->max());
    for (const rtl::Histogram::Bin& bin : histogram->bins())
      add(fmt::format("{} of {}", name, bin.low), bin.count);
  }
  for (const rtl::Unit* unit : engine.units()) {
    const std::string name = inner_name(engine, *unit);
    add(name + ".busy", unit->busy_cycles());
    add(name + ".idle", unit->idle_cycles());
    for (const rtl::Unit::StallCause& cause : unit->stalls())
      add(name + "." + cause.name, cause.cycles);
  }
  for (const rtl::LinkBase* link : engine.links()) {
    add(inner_name(engine, *link) + ".pushes", link->pushes());
    add(inner_name(engine, *link) + ".pops", link->pops());
  }
  rtl::for_each<rtl::WireBase>(engine, [&](const rtl::WireBase& wire) {
    add(inner_name(engine, wire) + ".changes", wire.changes());
    add(inner_name(engine, wire) + ".high",
        wire.high_cycles(engine.units().front()->clock().cycle()));
  });
  for (const rtl::MemoryBase* memory : engine.memories())
    if (const auto high_water = memory->high_water())
      add(inner_name(engine, *memory) + ".high_water", *high_water);
  return state;
}

std::string state_difference(const std::vector<std::string>& was,
                             const std::vector<std::string>& is) {
  std::string text;
  for (std::size_t i = 0; i < std::max(was.size(), is.size()); ++i) {
    const std::string a = i < was.size() ? was[i] : "nothing",
                      b = i < is.size() ? is[i] : "nothing";
    if (a != b) text += fmt::format("was {}, is {}\n", a, b);
  }
  return text;
}

}  // namespace deburr::tb
