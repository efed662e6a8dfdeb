// SPDX-License-Identifier: MIT
// Software access to memory over a bus: b_transport through a TLM-2.0 initiator socket, one 64-byte
// line per transaction. Waits for the time that the target adds.
#pragma once

#include <tlm_utils/simple_initiator_socket.h>

#include <cstdint>
#include <span>
#include <systemc>
#include <vector>

#include "rtl_model/platform/host.h"

namespace deburr::platform {

class MemoryHost final : public sc_core::sc_module, public HostMemory {
 public:
  tlm_utils::simple_initiator_socket<MemoryHost> bus{"bus"};

  // The target has `bytes` of memory, from address 0 on.
  MemoryHost(const sc_core::sc_module_name& name, std::uint64_t bytes)
      : sc_module(name), bytes_(bytes) {}

  // SimulationError with the address and the response if an access is rejected.
  void write(std::uint64_t address, std::span<const std::uint8_t> data) override;
  std::vector<std::uint8_t> read(std::uint64_t address, std::uint64_t bytes) override;
  std::uint64_t size() const override { return bytes_; }

 private:
  // Transfers at most one line.
  void transport(tlm::tlm_command command, std::uint64_t address, std::uint8_t* data,
                 std::size_t length);
  std::uint64_t bytes_;
};

}  // namespace deburr::platform
