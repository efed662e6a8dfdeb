// SPDX-License-Identifier: MIT
#include "tb/env/environment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <memory>

#include "spec/error.h"
#include "tb/env/collect.h"

namespace deburr::tb {
namespace {

std::string fault_name(std::string_view kind, std::string_view what) {
  std::string name = fmt::format("{}-{}", kind, what);
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) {
    return std::isalnum(c) ? static_cast<char>(std::tolower(c)) : '-';
  });
  return name;
}

std::uint32_t misdecoded(const spec::Field& field, std::uint32_t word) {
  const std::uint32_t value = field.of(word);
  std::uint32_t wrong = value == 0 ? ~std::uint32_t{0} : value / 2;
  if (!field.codes.empty()) wrong = (value + 1) % static_cast<std::uint32_t>(field.codes.size());
  return (word & ~field.mask()) | field.in(wrong);
}

}  // namespace

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

void Environment::inject_in(platform::MemoryModel& memory,
                            const MemoryParameters& parameters) const {
  if (injected("lost-response")) memory.lose_request(kFaultyRequest);
  if (injected("memory-error")) memory.fail_request(kFaultyRequest);
  if (const auto range = error_range(parameters)) memory.fail_range(range->from, range->to);
}

void Environment::let_blind(std::initializer_list<ScoreboardBase*> boards) {
  std::vector<InjectedFault> faults;
  for (ScoreboardBase* board : boards) {
    std::string name = fault_name("blind", board->name());
    if (injected(name)) board->look_away();
    faults.push_back(
        {std::move(name), fmt::format("Skips every comparison of: {}.", board->name())});
  }
  know(std::move(faults));
}

void Environment::let_miscount(RegisterScoreboard& board, std::span<const std::uint32_t> offsets) {
  std::vector<InjectedFault> faults;
  for (const std::uint32_t offset : offsets) {
    std::string name = fault_name("miscount", board.name_of(offset));
    if (injected(name)) board.misread(offset);
    faults.push_back({std::move(name), fmt::format("{} is wrong by one.", board.name_of(offset))});
  }
  know(std::move(faults));
}

void Environment::let_miscount(FigureScoreboard& board) {
  if (injected("wrong-figures")) board.miscount();
  know({{"wrong-figures", "Adds one to every counter that is checked against a second source."}});
}

void Environment::let_misdecode(rtl::ControlRegisters& control,
                                std::span<const std::uint32_t> offsets, const std::string& needs) {
  std::vector<InjectedFault> faults;
  for (const spec::RegisterInfo& info : control.registers.table()) {
    if (std::find(offsets.begin(), offsets.end(), info.offset) == offsets.end()) continue;
    for (const spec::Field& field : info.fields) {
      std::string name = fault_name("misdecode", fmt::format("{}-{}", info.name, field.name));
      if (injected(name)) {
        const auto written = std::make_shared<std::uint32_t>(control.value(info.offset));
        control.on_read(info.offset, [written] { return *written; });
        control.on_taken(info.offset,
                         [&control, offset = info.offset, field, written](std::uint32_t word) {
                           *written = word;
                           control.set(offset, misdecoded(field, word));
                         });
      }
      faults.push_back({std::move(name),
                        fmt::format("{} of {} is decoded as a different value than software wrote.",
                                    field.name, info.name),
                        "", needs});
    }
  }
  know(std::move(faults));
}

void Environment::reject_untouched(const platform::MemoryModel& memory,
                                   const MemoryParameters& parameters) {
  const auto range = error_range(parameters);
  if (range && memory.errors() == 0)
    throw spec::ConfigError(fmt::format(
        "{0}.error_address = {1}: the run did not access {0} from {1:#x} to {2:#x}, so no access "
        "failed: give an address that the run accesses, or a larger {0}.error_bytes",
        memory.name(), range->from, range->to - 1));
}

// ---- figures ------------------------------------------------------------------------------------

void FigureScoreboard::check(const std::string& name, std::uint64_t counted,
                             std::uint64_t expected) {
  board_.require(++checked_);
  board_.expect({name, expected});
  board_.got({name, counted + too_many_}, name);
}

void FigureScoreboard::check(const rtl::Engine& engine, const rtl::Counter& counter,
                             std::uint64_t expected) {
  const std::vector<const rtl::Counter*> counted = engine.counters();
  if (std::find(counted.begin(), counted.end(), &counter) != counted.end())
    check(name_within(engine, counter), counter.value(), expected);
}

void FigureScoreboard::check(const rtl::Engine& engine, const rtl::MemoryPort& port,
                             const platform::MemoryModel& memory) {
  check(engine, port.reads, memory.reads());
  check(engine, port.writes, memory.writes());
  check(engine, port.bytes_read, memory.bytes_read());
  if (memory.errors() > 0) return;  // failed writes leave memory unchanged
  check(engine, port.bytes_written, memory.bytes_written());
}

// ---- registers ----------------------------------------------------------------------------------

RegisterScoreboard::RegisterScoreboard(std::span<const spec::RegisterInfo> table)
    : table_(table), board_("status registers", 1, [this](const Status& s) {
        return fmt::format("{} = {}", name_of(s.offset), s.value);
      }) {}

std::string_view RegisterScoreboard::name_of(std::uint32_t offset) const {
  for (const spec::RegisterInfo& info : table_)
    if (info.offset == offset) return info.name;
  return "?";
}

void RegisterScoreboard::check(platform::RegisterBus& registers,
                               std::span<const std::pair<std::uint32_t, std::uint64_t>> expected) {
  board_.require(expected.size());
  for (const auto& [offset, value] : expected) {
    board_.expect({offset, static_cast<std::uint32_t>(value)});
    const std::uint32_t wrong = offset == misread_ ? 1 : 0;
    board_.got({offset, registers.read(offset) ^ wrong}, std::string(name_of(offset)));
  }
}

}  // namespace deburr::tb
