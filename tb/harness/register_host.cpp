// SPDX-License-Identifier: MIT
#include "tb/harness/register_host.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>

#include "spec/error.h"

namespace deburr::tb {

std::uint32_t RegisterHost::access(std::uint32_t offset, std::uint32_t value, bool write) {
  std::array<unsigned char, 4> data{};
  for (std::size_t i = 0; i < data.size(); ++i)
    data[i] = static_cast<unsigned char>(value >> (8 * i));
  tlm::tlm_generic_payload payload;
  payload.set_command(write ? tlm::TLM_WRITE_COMMAND : tlm::TLM_READ_COMMAND);
  payload.set_address(offset);
  payload.set_data_ptr(data.data());
  payload.set_data_length(data.size());
  payload.set_streaming_width(data.size());
  payload.set_response_status(tlm::TLM_INCOMPLETE_RESPONSE);
  sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
  bus->b_transport(payload, delay);
  if (payload.is_response_error())
    throw spec::SimulationError(fmt::format("{}: {} of register {:#x} was refused: {}", name(),
                                            write ? "write" : "read", offset,
                                            payload.get_response_string()));
  value = 0;
  for (std::size_t i = 0; i < data.size(); ++i)
    value |= static_cast<std::uint32_t>(data[i]) << (8 * i);
  return value;
}

}  // namespace deburr::tb
