// SPDX-License-Identifier: MIT
// Register access for software: 32 bits at a time, without simulated time.
#pragma once

#include <tlm_utils/simple_initiator_socket.h>

#include <cstdint>
#include <systemc>

#include "rtl_model/platform/host.h"

namespace deburr::platform {

class RegisterHost final : public sc_core::sc_module, public RegisterBus {
 public:
  tlm_utils::simple_initiator_socket<RegisterHost> bus{"bus"};

  explicit RegisterHost(const sc_core::sc_module_name& name) : sc_module(name) {}

  std::uint32_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint32_t value) override;
  // Returns the response, also an error.
  tlm::tlm_response_status try_write(std::uint32_t offset, std::uint32_t value);
  // Debug write; true if accepted.
  bool debug_write(std::uint32_t offset, std::uint32_t value);
};

}  // namespace deburr::platform
