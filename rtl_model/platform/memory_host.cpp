// SPDX-License-Identifier: MIT
#include "rtl_model/platform/memory_host.h"

#include <fmt/format.h>

#include <algorithm>

#include "spec/error.h"

namespace deburr::platform {
namespace {

constexpr std::uint64_t kBusLine = 64;

// Calls access(offset, length) for each part of [address, address + bytes) that is within one line.
template <class Access>
void by_line(std::uint64_t address, std::uint64_t bytes, Access&& access) {
  for (std::uint64_t done = 0; done < bytes;) {
    const std::uint64_t length = std::min(bytes - done, kBusLine - (address + done) % kBusLine);
    access(done, length);
    done += length;
  }
}

}  // namespace

void MemoryHost::transport(tlm::tlm_command command, std::uint64_t address, std::uint8_t* data,
                           std::size_t length) {
  tlm::tlm_generic_payload payload;
  payload.set_command(command);
  payload.set_address(address);
  payload.set_data_ptr(data);
  payload.set_data_length(static_cast<unsigned>(length));
  payload.set_streaming_width(static_cast<unsigned>(length));
  payload.set_response_status(tlm::TLM_INCOMPLETE_RESPONSE);
  sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
  bus->b_transport(payload, delay);
  if (payload.is_response_error())
    throw spec::SimulationError(fmt::format("{}: {} of {} bytes at {:#x} was rejected: {}", name(),
                                            payload.is_write() ? "write" : "read", length, address,
                                            payload.get_response_string()));
}

void MemoryHost::write(std::uint64_t address, std::span<const std::uint8_t> data) {
  std::vector<std::uint8_t> bytes(data.begin(), data.end());  // the data of a payload are not const
  by_line(address, bytes.size(), [&](std::uint64_t at, std::uint64_t length) {
    transport(tlm::TLM_WRITE_COMMAND, address + at, bytes.data() + at, length);
  });
}

std::vector<std::uint8_t> MemoryHost::read(std::uint64_t address, std::uint64_t bytes) {
  std::vector<std::uint8_t> data(bytes);
  by_line(address, bytes, [&](std::uint64_t at, std::uint64_t length) {
    transport(tlm::TLM_READ_COMMAND, address + at, data.data() + at, length);
  });
  return data;
}

}  // namespace deburr::platform
