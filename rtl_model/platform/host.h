// SPDX-License-Identifier: MIT
// Interfaces that a driver uses: access to an engine's registers and to memory. RegisterHost and
// MemoryHost implement them with TLM-2.0 sockets; a platform with another bus provides its own.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace deburr::platform {

// The registers of one engine, by offset.
class RegisterBus {
 public:
  virtual ~RegisterBus() = default;
  // SimulationError with the offset and the response if the access is rejected.
  virtual std::uint32_t read(std::uint32_t offset) = 0;
  virtual void write(std::uint32_t offset, std::uint32_t value) = 0;
};

// The memory of an engine, by address from 0 on.
class HostMemory {
 public:
  virtual ~HostMemory() = default;
  virtual void write(std::uint64_t address, std::span<const std::uint8_t> data) = 0;
  virtual std::vector<std::uint8_t> read(std::uint64_t address, std::uint64_t bytes) = 0;
  virtual std::uint64_t size() const = 0;  // bytes
};

}  // namespace deburr::platform
