// SPDX-License-Identifier: MIT
// The registers of an engine: a block built from its table in spec/, with the CONTROL and STATUS
// that every engine has.
//
// Where: beside the pipe, owned by the engine. Timing: a write counts from the next clock edge on.
// The rows of the table say what each field is: kept as written, a command, sticky. CONTROL:
// enable; clear the counters (command); further commands, which wait for nobody: while the engine
// is busy they are rejected. STATUS: idle, and sticky bits that a one clears; one of them says that
// a register was written while the engine was busy. Such a write is taken or ignored, as the layout
// says. The interrupt is high while one of the sticky bits is set. Bits that no field has read as
// 0. What the values mean is the engine's business: it decodes them in on_change(). Cost: 32
// flip-flops a writable register.
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <span>
#include <vector>

#include "rtl_model/fabric/counters.h"
#include "rtl_model/fabric/register_block.h"
#include "spec/registers.h"

namespace deburr::rtl {

struct ControlLayout {
  std::uint32_t control, status;           // offsets
  std::uint32_t enable, clear_counters;    // bits of CONTROL
  std::uint32_t idle, written_while_busy;  // bits of STATUS
  bool busy_ignores_writes;                // or takes them, and only says so
};

// As the rows of CONTROL and STATUS have it, by the names of their fields. CheckFailed for a table
// without one of these.
ControlLayout control_layout(std::span<const spec::RegisterInfo> table, bool busy_ignores_writes);

// A choice by the code in its field. A code that no choice has counts as code 0.
template <class Choice>
Choice choice_of(const spec::Field& field, std::uint32_t word) {
  const std::uint32_t code = field.of(word);
  return static_cast<Choice>(code < field.codes.size() ? code : 0);
}

class ControlRegisters {
 public:
  RegisterBlock registers;

  // The table, and the texts in it, must outlive this.
  ControlRegisters(const char* name, std::span<const spec::RegisterInfo> table,
                   const ControlLayout& layout);

  // --- Wires to the blocks ---
  bool enabled() const { return enabled_; }
  void set_sticky(std::uint32_t status_bits) { keep(sticky_ | status_bits); }
  bool interrupt() const { return sticky_ != 0; }
  std::uint32_t value(std::uint32_t offset) const { return registers.get(index(offset)); }
  // Debug writes go past the masks: the values as the hardware would hold them.
  void mask_values();

  // --- Wiring, while the engine is built ---
  void on_busy(std::function<bool()> busy) { busy_ = std::move(busy); }
  void on_clear_counters(std::function<void()> clear) { clear_counters_ = std::move(clear); }
  // After the interrupt has changed: in a clock, or by a write to STATUS.
  void on_interrupt(std::function<void()> changed) { interrupt_changed_ = std::move(changed); }
  // A further command of CONTROL.
  void on_command(std::uint32_t control_bit, std::function<void()> action);
  // After every write that was taken, and after a reset: the values have changed.
  void on_change(std::function<void(std::uint32_t offset)> changed) {
    changed_ = std::move(changed);
  }
  // After a write to a register that was taken; after a debug write, which nothing rejects, too.
  void on_taken(std::uint32_t offset, std::function<void(std::uint32_t)> action);
  // What a read of a register gives instead of its value.
  void on_read(std::uint32_t offset, std::function<std::uint32_t()> value) {
    registers.on_read(index(offset), std::move(value));
  }
  // A value that the hardware changes.
  void set(std::uint32_t offset, std::uint32_t value);
  // The bits of a register that exist where a build has fewer than its fields; the others read as
  // 0.
  void set_mask(std::uint32_t offset, std::uint32_t mask) { masks_[index(offset)] = mask; }
  // Reset values that parameters give.
  void set_resets(std::span<const spec::LoadedRegister> loaded);
  void show(std::uint32_t offset, const Counter& counter) {
    registers.show(index(offset), counter);
  }
  // What several blocks count for themselves.
  void show_sum(std::uint32_t offset, std::initializer_list<const Counter*> counters);

  // As a bus write, from outside of time.
  void write(std::uint32_t offset, std::uint32_t value) { written(index(offset), value); }
  void reset();

 private:
  struct Command {
    std::uint32_t bit;
    std::function<void()> action;
  };
  std::size_t index(std::uint32_t offset) const;
  void written(std::size_t index, std::uint32_t value);
  void write_control(std::uint32_t value);
  void keep(std::uint32_t sticky) {
    const bool before = interrupt();
    sticky_ = sticky;
    if (interrupt() != before) interrupt_changed_();
  }

  ControlLayout layout_;
  std::vector<std::uint32_t> masks_, resets_, kept_;  // kept: before a write
  std::vector<Command> commands_;
  std::function<bool()> busy_ = [] { return false; };
  std::function<void()> clear_counters_ = [] {}, interrupt_changed_ = [] {};
  std::function<void(std::uint32_t)> changed_ = [](std::uint32_t) {};
  std::vector<std::function<void(std::uint32_t)>> taken_;  // by register
  bool enabled_ = true;
  std::uint32_t sticky_ = 0;
};

}  // namespace deburr::rtl
