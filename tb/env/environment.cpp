// SPDX-License-Identifier: MIT
#include "tb/env/environment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "spec/error.h"
#include "tb/env/collect.h"

namespace deburr::tb {

void Environment::check() const {
  if (!golden()) return;
  for (const Boards& boards : {outputs(), traffic(), counters()})
    for (const ScoreboardBase* board : boards) board->check();
}

void Environment::drain_memory() const {
  constexpr rtl::Cycle kStep = 100;
  do simulation().clock().run(kStep);
  while (!memory_at_rest());
}

// ---- faults -------------------------------------------------------------------------------------

std::vector<PlantedFault> Environment::memory_faults(const std::string& needs) {
  return {{"lost-response", "Memory never answers request 20.", "", needs},
          {"memory-error", "Memory answers request 20 with an error.", "", needs}};
}

void Environment::plant_in(MemoryModel& memory, const MemoryParameters& parameters) const {
  if (planted("lost-response")) memory.lose_request(kFaultyRequest);
  if (planted("memory-error")) memory.fail_request(kFaultyRequest);
  if (const auto range = error_range(parameters)) memory.fail_range(range->from, range->to);
}

void Environment::let_blind(std::initializer_list<ScoreboardBase*> boards) {
  std::vector<PlantedFault> faults;
  for (ScoreboardBase* board : boards) {
    std::string name = "blind-" + board->name();
    std::replace(name.begin(), name.end(), ' ', '-');
    if (planted(name)) board->look_away();
    faults.push_back({std::move(name), fmt::format("Compares nothing of: {}.", board->name())});
  }
  know(std::move(faults));
}

void Environment::let_miscount(RegisterScoreboard& board, std::span<const std::uint32_t> offsets) {
  std::vector<PlantedFault> faults;
  for (const std::uint32_t offset : offsets) {
    std::string name = fmt::format("miscount-{}", board.name_of(offset));
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) {
      return c == '_' ? '-' : static_cast<char>(std::tolower(c));
    });
    if (planted(name)) board.misread(offset);
    faults.push_back({std::move(name), fmt::format("{} is wrong by one.", board.name_of(offset))});
  }
  know(std::move(faults));
}

void Environment::refuse_untouched(const MemoryModel& memory, const MemoryParameters& parameters) {
  const auto range = error_range(parameters);
  if (range && memory.errors() == 0)
    throw spec::ConfigError(fmt::format(
        "{0}.error_address = {1}: the run asked {0} for nothing from {1:#x} to {2:#x}, so no "
        "access failed: name an address that it asks for, or more {0}.error_bytes",
        memory.name(), range->from, range->to - 1));
}

// ---- registers ----------------------------------------------------------------------------------

void Environment::require_id(RegisterHost& host, std::uint32_t offset, std::uint32_t expected) {
  if (const std::uint32_t id = host.read(offset); id != expected)
    throw spec::SimulationError(
        fmt::format("the ID register reads {:#x}, expected {:#x}", id, expected));
}

RegisterScoreboard::RegisterScoreboard(std::span<const spec::RegisterInfo> table)
    : table_(table), board_("status registers", 1, [this](const Status& s) {
        return fmt::format("{} = {}", name_of(s.offset), s.value);
      }) {}

std::string_view RegisterScoreboard::name_of(std::uint32_t offset) const {
  for (const spec::RegisterInfo& info : table_)
    if (info.offset == offset) return info.name;
  return "?";
}

void RegisterScoreboard::judge(RegisterHost& host,
                               std::span<const std::pair<std::uint32_t, std::uint64_t>> expected) {
  board_.require(expected.size());
  for (const auto& [offset, value] : expected) {
    board_.expect({offset, static_cast<std::uint32_t>(value)});
    const std::uint32_t wrong = offset == misread_ ? 1 : 0;
    board_.got({offset, host.read(offset) ^ wrong}, std::string(name_of(offset)));
  }
}

// ---- figures ------------------------------------------------------------------------------------

std::string Environment::figure(std::string_view name) const {
  return name_.empty() ? std::string(name) : fmt::format("{}_{}", name_, name);
}

void Environment::add(Result& result, std::string_view name, WorkValue value, std::string unit,
                      std::string meaning) const {
  result.work.push_back({figure(name), value, std::move(unit), std::move(meaning)});
}

void Environment::add(Result& result, std::string_view name, const rtl::Counter& counter) const {
  add(result, name, counter.value(), counter.unit(), sentence(counter.meaning()));
}

void Environment::add(Result& result, std::string_view name, const rtl::Unit& unit) const {
  result.units.push_back(unit_cycles(figure(name), unit));
}

void Environment::add(Result& result, std::string_view name, const rtl::MemoryBase& memory,
                      int width) const {
  result.memories.push_back(memory_figures(figure(name), memory, width));
}

namespace {

// What is inside a FIFO is shown under the FIFO's name, which its memory has.
const sc_core::sc_object& fifo_or_link(const rtl::Engine& engine, const rtl::LinkBase& link) {
  for (const rtl::MemoryBase* memory : engine.memories())
    if (memory->high_water() && link.name() == std::string(memory->name()) + "_entries")
      return *memory;
  return link;
}

}  // namespace

void Environment::show(Observer& observer, const rtl::Engine& engine) const {
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

std::vector<PictureMap> Environment::named(std::vector<PictureMap> maps) const {
  for (PictureMap& map : maps) map.name = figure(map.name);
  return maps;
}

void Environment::add(Result& result, const MemoryModel& memory) {
  result.bytes_read += memory.bytes_read();
  result.bytes_written += memory.bytes_written();
}

}  // namespace deburr::tb
