// SPDX-License-Identifier: MIT
// Function  Control and status registers of an engine: a register block built from its table in
//           spec/, with the CONTROL and STATUS registers that every engine has.
// Position  Next to the pipeline, owned by the engine.
// Latency   A write takes effect at the next clock edge.
// Cost      32 flip-flops per writable register.
//
// The rows of the table give the access of each field: stored, command, sticky.
//   CONTROL  enable; clear the counters (command); further commands, which are rejected while the
//            engine is busy.
//   STATUS   idle; sticky bits, which writing a one clears. One of them reports a register write
//            while the engine was busy; the layout says whether such a write is taken or ignored.
// The interrupt is high while a sticky bit is set. Bits without a field read as 0. The engine
// decodes the values in on_change().
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
  bool busy_ignores_writes;                // false: takes them; the sticky bit is set anyway
};

// The offsets and bits of CONTROL and STATUS, by the names of their fields. CheckFailed if the
// table lacks one of them.
ControlLayout control_layout(std::span<const spec::RegisterInfo> table, bool busy_ignores_writes);

// Decodes a field's code as an enumeration. An unknown code counts as code 0.
template <class Choice>
Choice choice_of(const spec::Field& field, std::uint32_t word) {
  const std::uint32_t code = field.of(word);
  return static_cast<Choice>(code < field.codes.size() ? code : 0);
}

class ControlRegisters {
 public:
  RegisterBlock registers;

  // The table and its texts must outlive this object.
  ControlRegisters(const char* name, std::span<const spec::RegisterInfo> table,
                   const ControlLayout& layout);

  // --- Wires to the blocks ---
  bool enabled() const { return enabled_; }
  void set_sticky(std::uint32_t status_bits) { keep(sticky_ | status_bits); }
  bool interrupt() const { return sticky_ != 0; }
  std::uint32_t value(std::uint32_t offset) const { return registers.get(index(offset)); }
  // Debug writes bypass the masks: restores the values that the hardware would hold.
  void mask_values();

  // --- Wiring, while the engine is built ---
  void on_busy(std::function<bool()> busy) { busy_ = std::move(busy); }
  void on_clear_counters(std::function<void()> clear) { clear_counters_ = std::move(clear); }
  // Called when the interrupt has changed: in a cycle, or by a write to STATUS.
  void on_interrupt(std::function<void()> changed) { interrupt_changed_ = std::move(changed); }
  // Adds a command to CONTROL.
  void on_command(std::uint32_t control_bit, std::function<void()> action);
  // Called after every accepted write, and after a reset for each writable register except CONTROL.
  void on_change(std::function<void(std::uint32_t offset)> changed) {
    changed_ = std::move(changed);
  }
  // Called after an accepted write to a register, and after a debug write, which is never rejected.
  void on_taken(std::uint32_t offset, std::function<void(std::uint32_t)> action);
  // Sets the function that gives a read's value instead of the stored one.
  void on_read(std::uint32_t offset, std::function<std::uint32_t()> value) {
    registers.on_read(index(offset), std::move(value));
  }
  // Sets a value from the hardware side.
  void set(std::uint32_t offset, std::uint32_t value);
  // The bits of a register that exist in builds with fewer than its fields; the others read as 0.
  void set_mask(std::uint32_t offset, std::uint32_t mask) { masks_[index(offset)] = mask; }
  // Sets the reset values that parameters define.
  void set_resets(std::span<const spec::LoadedRegister> loaded);
  void show(std::uint32_t offset, const Counter& counter) {
    registers.show(index(offset), counter);
  }
  // Shows the sum of counters of several blocks.
  void show_sum(std::uint32_t offset, std::initializer_list<const Counter*> counters);

  // Acts as a bus write, without simulated time.
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
  std::vector<std::uint32_t> masks_, resets_, kept_;  // kept: value before a write
  std::vector<Command> commands_;
  std::function<bool()> busy_ = [] { return false; };
  std::function<void()> clear_counters_ = [] {}, interrupt_changed_ = [] {};
  std::function<void(std::uint32_t)> changed_ = [](std::uint32_t) {};
  std::vector<std::function<void(std::uint32_t)>> taken_;  // by register
  bool enabled_ = true;
  std::uint32_t sticky_ = 0;
};

}  // namespace deburr::rtl
