// SPDX-License-Identifier: MIT
// The host of a unit: reads and writes its registers, 32 bits at a time, taking no simulated time.
#pragma once

#include <tlm_utils/simple_initiator_socket.h>

#include <cstdint>
#include <systemc>

namespace deburr::tb {

class RegisterHost final : public sc_core::sc_module {
 public:
  tlm_utils::simple_initiator_socket<RegisterHost> bus{"bus"};

  explicit RegisterHost(const sc_core::sc_module_name& name) : sc_module(name) {}

  // SimulationError, with the offset and the response, where the access is refused.
  std::uint32_t read(std::uint32_t offset) { return access(offset, 0, false); }
  void write(std::uint32_t offset, std::uint32_t value) { access(offset, value, true); }

 private:
  std::uint32_t access(std::uint32_t offset, std::uint32_t value, bool write);
};

}  // namespace deburr::tb
