// SPDX-License-Identifier: MIT
// 32-bit registers behind a TLM-2.0 target socket, from one table of descriptions that also gives
// the tables of the docs and the C header for a user's software.
//
// Access: one aligned 32-bit word a transaction, no byte enables. Errors: unknown or unaligned
// address: ADDRESS_ERROR; other length or streaming width: BURST_ERROR; byte enables:
// BYTE_ENABLE_ERROR; write to a register without a field that software may write, or read of one
// without a field that it may read: COMMAND_ERROR. A write reaches those fields alone, as the
// access of each says. Commands, and bits that no field has, read as 0. transport_dbg reads and
// writes any span of whole registers, without side effects but those of on_debug_write(), and stops
// at the first hole. A write at the time of a clock edge counts for that edge. A thread that is
// ahead of simulated time (temporal decoupling) waits until that has come: the registers are those
// of its own time, whatever its quantum is. Who cannot wait is served at once, with its delay
// unchanged. Cost: 32 flip-flops a writable register.
#pragma once

#include <tlm_utils/simple_target_socket.h>

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <systemc>
#include <tlm>
#include <vector>

#include "rtl_model/fabric/counters.h"
#include "spec/registers.h"

namespace deburr::rtl {

class RegisterBlock final : public sc_core::sc_module {
 public:
  tlm_utils::simple_target_socket<RegisterBlock> bus{"bus"};

  // The table must outlive the block (a constant array).
  RegisterBlock(const sc_core::sc_module_name& name, std::span<const spec::RegisterInfo> table);
  const char* kind() const override { return "deburr_registers"; }

  // From the hardware's side, by position in the table (an enum beside it): no bus, no checks of
  // access.
  std::uint32_t get(std::size_t index) const { return values_[index]; }
  void set(std::size_t index, std::uint32_t value) { values_[index] = value; }
  // Called after a bus write with the value that was written (a command register, for instance).
  void on_write(std::size_t index, std::function<void(std::uint32_t)> action);
  // The same after transport_dbg, for a register whose writes do something.
  void on_debug_write(std::size_t index, std::function<void(std::uint32_t)> action);
  // Gives the value that a read sees, instead of the stored one (a status that follows the
  // hardware).
  void on_read(std::size_t index, std::function<std::uint32_t()> value);
  // A read-only register that shows the low (or, with shift 32, the high) word of a counter.
  void show(std::size_t index, const Counter& counter, int shift = 0);
  void reset();

  std::span<const spec::RegisterInfo> table() const { return table_; }
  std::size_t index_of(const std::string& register_name) const;  // ConfigError if there is none

 private:
  struct Shown {
    const Counter* counter = nullptr;
    int shift = 0;
  };
  void b_transport(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay);
  unsigned transport_dbg(tlm::tlm_generic_payload& payload);
  std::uint32_t read(std::size_t index) const;
  int find(std::uint64_t offset) const;

  std::span<const spec::RegisterInfo> table_;
  std::vector<std::uint32_t> values_;
  std::vector<int> index_by_word_;
  std::vector<std::function<void(std::uint32_t)>> actions_, debug_actions_;
  std::vector<std::function<std::uint32_t()>> values_read_;
  std::vector<Shown> shown_;
};

}  // namespace deburr::rtl
