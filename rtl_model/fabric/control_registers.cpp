// SPDX-License-Identifier: MIT
#include "rtl_model/fabric/control_registers.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "spec/error.h"

namespace deburr::rtl {

ControlLayout control_layout(std::span<const spec::RegisterInfo> table, bool busy_ignores_writes) {
  const auto row = [&](std::string_view name) -> const spec::RegisterInfo& {
    const spec::RegisterInfo* const found = spec::register_named(table, name);
    DEBURR_CHECK(found, fmt::format("the register table has no register {}", name));
    return *found;
  };
  const auto bit = [&](const spec::RegisterInfo& of, std::string_view name, spec::Access access) {
    const std::uint32_t bits = spec::bits_named(of, name);
    DEBURR_CHECK(bits != 0, fmt::format("{} has no field {}", of.name, name));
    DEBURR_CHECK(
        (bits & of.bits(access)) == bits,
        fmt::format("{}.{} has an access that the hardware does not implement", of.name, name));
    return bits;
  };
  using spec::Access;
  const spec::RegisterInfo &control = row("CONTROL"), &status = row("STATUS");
  return {.control = control.offset,
          .status = status.offset,
          .enable = bit(control, "enable", Access::kReadWrite),
          .clear_counters = bit(control, "clear_counters", Access::kCommand),
          .idle = bit(status, "idle", Access::kReadOnly),
          .written_while_busy = bit(status, "written_while_busy", Access::kWriteOneToClear),
          .busy_ignores_writes = busy_ignores_writes};
}

ControlRegisters::ControlRegisters(const char* name, std::span<const spec::RegisterInfo> table,
                                   const ControlLayout& layout)
    : registers(name, table), layout_(layout), kept_(table.size()), taken_(table.size()) {
  for (std::size_t i = 0; i < registers.table().size(); ++i) {
    const spec::RegisterInfo& info = registers.table()[i];
    resets_.push_back(info.reset());
    kept_[i] = resets_[i];
    masks_.push_back(info.mask() & ~info.bits(spec::Access::kCommand));
    if (info.written() != 0 || info.offset == layout.control)
      registers.on_write(i, [this, i](std::uint32_t value) { written(i, value); });
  }
  const std::size_t status = index(layout.status);
  registers.on_write(
      status, [this, sticky = registers.table()[status].bits(spec::Access::kWriteOneToClear)](
                  std::uint32_t value) { keep(sticky_ & ~(value & sticky)); });
  registers.on_read(index(layout.status),
                    [this] { return sticky_ | (busy_() ? 0 : layout_.idle); });
  enabled_ = value(layout.control) & layout.enable;
}

std::size_t ControlRegisters::index(std::uint32_t offset) const {
  const auto found = std::find_if(registers.table().begin(), registers.table().end(),
                                  [&](const spec::RegisterInfo& r) { return r.offset == offset; });
  DEBURR_CHECK(found != registers.table().end(),
               fmt::format("{} has no register at {:#x}", registers.name(), offset));
  return static_cast<std::size_t>(found - registers.table().begin());
}

void ControlRegisters::on_command(std::uint32_t control_bit, std::function<void()> action) {
  const spec::RegisterInfo& control = registers.table()[index(layout_.control)];
  DEBURR_CHECK((control.bits(spec::Access::kCommand) & control_bit) == control_bit,
               fmt::format("{}.{}: bit {:#x} is not a command", registers.name(), control.name,
                           control_bit));
  commands_.push_back({control_bit, std::move(action)});
}

void ControlRegisters::set_resets(std::span<const spec::LoadedRegister> loaded) {
  for (const auto& [offset, value] : loaded) {
    const std::size_t i = index(offset);
    resets_[i] = kept_[i] = value;
    registers.set(i, value);
  }
}

void ControlRegisters::show_sum(std::uint32_t offset,
                                std::initializer_list<const Counter*> counters) {
  registers.on_read(index(offset), [all = std::vector<const Counter*>(counters)] {
    std::uint64_t sum = 0;
    for (const Counter* counter : all) sum += counter->value();
    return static_cast<std::uint32_t>(sum);
  });
}

void ControlRegisters::written(std::size_t i, std::uint32_t value) {
  const std::uint32_t offset = registers.table()[i].offset;
  if (offset == layout_.control) return write_control(value);
  if (busy_()) {
    set_sticky(layout_.written_while_busy);
    if (layout_.busy_ignores_writes) return registers.set(i, kept_[i]);
  }
  const std::uint32_t bits = registers.table()[i].written() & masks_[i];
  kept_[i] = (kept_[i] & ~bits) | (value & bits);
  registers.set(i, kept_[i]);
  if (taken_[i]) taken_[i](kept_[i]);
  changed_(offset);
}

void ControlRegisters::on_taken(std::uint32_t offset, std::function<void(std::uint32_t)> action) {
  taken_[index(offset)] = action;
  registers.on_debug_write(index(offset), std::move(action));
}

void ControlRegisters::set(std::uint32_t offset, std::uint32_t value) {
  kept_[index(offset)] = value;
  registers.set(index(offset), value);
}

void ControlRegisters::write_control(std::uint32_t value) {
  enabled_ = value & layout_.enable;
  for (const Command& command : commands_) {
    if (!(value & command.bit)) continue;
    if (busy_())
      set_sticky(layout_.written_while_busy);
    else
      command.action();
  }
  if (value & layout_.clear_counters) clear_counters_();
  const std::size_t control = index(layout_.control);
  registers.set(control, value & registers.table()[control].bits(spec::Access::kReadWrite));
}

void ControlRegisters::mask_values() {
  for (std::size_t i = 0; i < registers.table().size(); ++i) {
    kept_[i] = registers.get(i) & masks_[i];
    registers.set(i, kept_[i]);
  }
}

void ControlRegisters::reset() {
  for (std::size_t i = 0; i < registers.table().size(); ++i) {
    kept_[i] = resets_[i];
    registers.set(i, resets_[i]);
  }
  enabled_ = value(layout_.control) & layout_.enable;
  keep(0);
  for (const spec::RegisterInfo& r : registers.table())
    if (r.written() != 0 && r.offset != layout_.control) changed_(r.offset);
}

}  // namespace deburr::rtl
