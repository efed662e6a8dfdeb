// SPDX-License-Identifier: MIT
// Function  32-bit registers with a TLM-2.0 target socket, built from a table of descriptions that
//           also generates the tables of the docs and the C header for software.
// Cost      32 flip-flops per writable register.
//
// Access: one aligned 32-bit word per transaction, without byte enables. A write changes only the
// fields that software may write, as the access of each says. Commands and bits without a field
// read as 0. A write at the time of a clock edge takes effect at that edge.
//   ADDRESS_ERROR       unknown or unaligned address
//   BURST_ERROR         another length or streaming width
//   BYTE_ENABLE_ERROR   byte enables
//   COMMAND_ERROR       write to a register without a writable field, or read of one without a
//                       readable field
// transport_dbg reads and writes any span of whole registers, without side effects except those of
// on_debug_write(), and stops at the first hole.
//
// With temporal decoupling, a thread ahead of simulated time waits until that time: it sees the
// registers at its own time, whatever its quantum. A process that cannot wait is served at once and
// its delay is unchanged.
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

  // Access from the hardware side by position in the table (an enum): bypasses the bus and its
  // access checks.
  std::uint32_t get(std::size_t index) const { return values_[index]; }
  void set(std::size_t index, std::uint32_t value) { values_[index] = value; }
  // Called with the written value after a bus write (for instance of a command register).
  void on_write(std::size_t index, std::function<void(std::uint32_t)> action);
  // The same after transport_dbg, for a register whose writes have an effect.
  void on_debug_write(std::size_t index, std::function<void(std::uint32_t)> action);
  // Sets the function that gives a read's value instead of the stored one (a status that follows
  // the hardware).
  void on_read(std::size_t index, std::function<std::uint32_t()> value);
  // Makes a read-only register show the low (shift 0) or high (shift 32) word of a counter.
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
