// SPDX-License-Identifier: MIT
#include "tb/env/collect.h"

#include <cctype>
#include <cstdint>
#include <string_view>
#include <utility>

#include "rtl_model/fabric/memory_port.h"

namespace deburr::tb {
namespace {

// Whether the unit only waits for memory responses. Such cycles count as idle, since this latency
// may be hidden; its cost is the stall of the unit that needs the line.
bool only_waits(const rtl::Unit& unit, std::string_view cause) {
  return cause == "wait_memory" ||
         (cause == "memory" && dynamic_cast<const rtl::MemoryPort*>(&unit) != nullptr);
}

// The unit in which the object lies, or null.
const sc_core::sc_object* unit_around(const sc_core::sc_object* object) {
  while (object != nullptr && dynamic_cast<const rtl::Unit*>(object) == nullptr)
    object = object->get_parent_object();
  return object;
}

// The unit in which the memory lies, or one that holds a port: of a FIFO, the consumer. Empty if an
// engine holds it.
std::string owner_of(const rtl::MemoryBase& memory) {
  const sc_core::sc_object* owner = unit_around(&memory);
  for (const sc_core::sc_object* holder : memory.port_holders())
    if (unit_around(&memory) == nullptr && unit_around(holder) != nullptr)
      owner = unit_around(holder);
  return owner != nullptr ? owner->basename() : "";
}

}  // namespace

std::string sentence(std::string text) {
  if (text.empty()) return text;
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text.back() == '.' ? text : text + ".";
}

std::string name_within(const sc_core::sc_object& engine, const sc_core::sc_object& object) {
  const sc_core::sc_object* const owner = object.get_parent_object();
  std::string name = object.basename();
  if (owner == &engine || dynamic_cast<const rtl::Unit*>(&object) != nullptr) return name;
  return std::string(owner->basename()) + "_" + name;
}

UnitCycles unit_cycles(std::string name, const rtl::Unit& unit) {
  UnitCycles cycles{std::move(name), unit.busy_cycles(), unit.idle_cycles(), {}};
  for (const rtl::Unit::StallCause& cause : unit.stalls()) {
    if (only_waits(unit, cause.name))
      cycles.idle += cause.cycles;
    else
      cycles.stalls.push_back({cause.name, sentence(cause.meaning), cause.cycles});
  }
  return cycles;
}

std::vector<std::string> activity_keys(const rtl::Unit& unit) {
  std::vector<std::string> keys = {"idle", "busy"};
  for (const rtl::Unit::StallCause& cause : unit.stalls())
    keys.push_back(only_waits(unit, cause.name) ? "idle" : "stalls." + cause.name);
  return keys;
}

MemoryFigures memory_figures(std::string name, const rtl::MemoryBase& memory, int width) {
  MemoryFigures f;
  f.name = std::move(name);
  f.content = sentence(memory.content());
  f.kind = rtl::name_of(memory.memory_kind());
  f.words = memory.words();
  f.word_bits = memory.word_bits();
  f.ports = memory.ports();
  f.read_latency = memory.shape().latency;
  f.built_as = memory.built_as();
  f.copies = memory.copies();
  f.banks = memory.banks();
  f.logical_bits = f.logical_bits_at_frame_width = memory.logical_bits();
  if (width > 0) f.logical_bits_at_frame_width = memory.bits_at(static_cast<std::uint64_t>(width));
  f.physical_bits = memory.physical_bits();
  f.register_bits = memory.register_bits();
  f.owner = owner_of(memory);
  f.read_ports = memory.shape().read_ports + memory.shape().shared_ports;
  f.write_ports = memory.shape().write_ports + memory.shape().shared_ports;
  f.reads = memory.reads();
  f.writes = memory.writes();
  f.high_water = memory.high_water();
  f.not_implementable = memory.not_implementable();
  return f;
}

Latency latency_of(const rtl::Histogram& histogram) {
  constexpr std::uint64_t kBins = 48;
  Latency latency{histogram.min(),          histogram.percentile(50), histogram.percentile(95),
                  histogram.percentile(99), histogram.max(),          {}};
  if (histogram.count() == 0) return latency;
  int shift = 0;
  while ((latency.max >> shift) - (latency.min >> shift) >= kBins) ++shift;
  for (std::uint64_t bin = latency.min >> shift; bin <= latency.max >> shift; ++bin)
    latency.histogram.push_back({bin << shift, 0});
  for (const rtl::Histogram::Bin& value : histogram.bins())
    latency.histogram[(value.low >> shift) - (latency.min >> shift)].count += value.count;
  return latency;
}

}  // namespace deburr::tb
