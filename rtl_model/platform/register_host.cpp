// SPDX-License-Identifier: MIT
#include "rtl_model/platform/register_host.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>

#include "spec/error.h"

namespace deburr::platform {
namespace {

// One 32-bit access; a TLM payload points to its data.
struct Access {
  Access(tlm::tlm_command command, std::uint32_t offset, std::uint32_t value) {
    for (std::size_t i = 0; i < data.size(); ++i)
      data[i] = static_cast<unsigned char>(value >> (8 * i));
    payload.set_command(command);
    payload.set_address(offset);
    payload.set_data_ptr(data.data());
    payload.set_data_length(static_cast<unsigned>(data.size()));
    payload.set_streaming_width(static_cast<unsigned>(data.size()));
    payload.set_response_status(tlm::TLM_INCOMPLETE_RESPONSE);
  }
  std::uint32_t value() const {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < data.size(); ++i) word |= std::uint32_t{data[i]} << (8 * i);
    return word;
  }
  std::array<unsigned char, 4> data{};
  tlm::tlm_generic_payload payload;
};

// Sends an access over `bus` and returns the response.
tlm::tlm_response_status send(tlm_utils::simple_initiator_socket<RegisterHost>& bus,
                              Access& access) {
  sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
  bus->b_transport(access.payload, delay);
  return access.payload.get_response_status();
}

// The same, with SimulationError if the access is rejected.
void require(tlm_utils::simple_initiator_socket<RegisterHost>& bus, Access& access,
             const char* host) {
  send(bus, access);
  if (access.payload.is_response_error())
    throw spec::SimulationError(fmt::format("{}: {} of register {:#x} was rejected: {}", host,
                                            access.payload.is_write() ? "write" : "read",
                                            access.payload.get_address(),
                                            access.payload.get_response_string()));
}

}  // namespace

std::uint32_t RegisterHost::read(std::uint32_t offset) {
  Access access(tlm::TLM_READ_COMMAND, offset, 0);
  require(bus, access, name());
  return access.value();
}

void RegisterHost::write(std::uint32_t offset, std::uint32_t value) {
  Access access(tlm::TLM_WRITE_COMMAND, offset, value);
  require(bus, access, name());
}

tlm::tlm_response_status RegisterHost::try_write(std::uint32_t offset, std::uint32_t value) {
  Access access(tlm::TLM_WRITE_COMMAND, offset, value);
  return send(bus, access);
}

bool RegisterHost::debug_write(std::uint32_t offset, std::uint32_t value) {
  Access access(tlm::TLM_WRITE_COMMAND, offset, value);
  return bus->transport_dbg(access.payload) == access.data.size();
}

}  // namespace deburr::platform
