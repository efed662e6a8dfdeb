// SPDX-License-Identifier: MIT
#include "tb/env/meter.h"

#include <fmt/format.h>

#include <utility>

#include "tb/env/collect.h"

namespace deburr::tb {

std::string Meter::figure(std::string_view name) const {
  return name_.empty() ? std::string(name) : fmt::format("{}_{}", name_, name);
}

void Meter::add(Result& result, std::string_view name, WorkValue value, std::string unit,
                std::string meaning) const {
  result.work.push_back({figure(name), value, std::move(unit), std::move(meaning)});
}

void Meter::add(Result& result, std::string_view name, const rtl::Counter& counter) const {
  add(result, name, counter.value(), counter.unit(), sentence(counter.meaning()));
}

void Meter::add(Result& result, std::string_view name, const rtl::Unit& unit) const {
  result.units.push_back(unit_cycles(figure(name), unit));
}

void Meter::add(Result& result, std::string_view name, const rtl::MemoryBase& memory,
                int width) const {
  MemoryFigures& added = result.memories.emplace_back(memory_figures(figure(name), memory, width));
  added.owner = figure(added.owner.empty() ? name : added.owner);
}

namespace {

// A link inside a FIFO is shown under the FIFO's name, which its memory has.
const sc_core::sc_object& fifo_or_link(const rtl::Engine& engine, const rtl::LinkBase& link) {
  for (const rtl::MemoryBase* memory : engine.memories())
    if (memory->high_water() && link.name() == std::string(memory->name()) + "_entries")
      return *memory;
  return link;
}

}  // namespace

void Meter::add_parts(Result& result, const rtl::Engine& engine, int width) const {
  for (const rtl::Unit* unit : engine.units()) add(result, name_within(engine, *unit), *unit);
  for (const rtl::MemoryBase* memory : engine.memories())
    add(result, name_within(engine, *memory), *memory, width);
  for (const rtl::LinkBase* link : engine.links()) {
    if (&fifo_or_link(engine, *link) != link) continue;
    ++result.link_bits.links;
    result.link_bits.bits += std::uint64_t{link->depth()} * link->payload_bits();
    const std::string& consumer = link->consumer();
    result.link_shapes.push_back({figure(name_within(engine, *link)),
                                  figure(consumer.substr(consumer.rfind('.') + 1)),
                                  link->payload_bits(), link->depth()});
  }
  for (rtl::Datasheet& sheet : engine.datasheets())
    result.sheets.push_back({figure(instance_name(sheet)), std::move(sheet)});
}

void Meter::add_counters(Result& result, const rtl::Engine& engine) const {
  for (const rtl::Counter* counter : engine.counters())
    add(result, name_within(engine, *counter), *counter);
}

void Meter::show(Observer& observer, const rtl::Engine& engine) const {
  const auto name = [&](const sc_core::sc_object& object) {
    return figure(name_within(engine, object));
  };
  for (const rtl::Unit* unit : engine.units()) {
    observer.see(name(*unit), *unit, activity_keys(*unit));
    if (const auto* port = dynamic_cast<const rtl::MemoryPort*>(unit))
      observer.see(name(*port), *port);
  }
  for (const rtl::Counter* counter : engine.counters()) observer.see(name(*counter), *counter);
  for (const rtl::LinkBase* link : engine.links())
    observer.see(name(fifo_or_link(engine, *link)), *link);
}

std::vector<PictureMap> Meter::named(std::vector<PictureMap> maps) const {
  for (PictureMap& map : maps) map.name = figure(map.name);
  return maps;
}

void Meter::add(Result& result, const platform::MemoryModel& memory) {
  result.bytes_read += memory.bytes_read();
  result.bytes_written += memory.bytes_written();
}

}  // namespace deburr::tb
