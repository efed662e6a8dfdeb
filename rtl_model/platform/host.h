// SPDX-License-Identifier: MIT
// What a driver stands on: how software reaches the registers of an engine, and memory.
// RegisterHost and MemoryHost are both over TLM-2.0 sockets; a platform with a bus of its own gives
// its own.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace deburr::platform {

// The registers of one engine, by offset.
class RegisterBus {
 public:
  virtual ~RegisterBus() = default;
  // SimulationError, with the offset and the response, where the access is rejected.
  virtual std::uint32_t read(std::uint32_t offset) = 0;
  virtual void write(std::uint32_t offset, std::uint32_t value) = 0;
};

// The memory that an engine's socket is bound to, by address, from 0 on.
class HostMemory {
 public:
  virtual ~HostMemory() = default;
  virtual void write(std::uint64_t address, std::span<const std::uint8_t> data) = 0;
  virtual std::vector<std::uint8_t> read(std::uint64_t address, std::uint64_t bytes) = 0;
  virtual std::uint64_t size() const = 0;  // bytes
};

}  // namespace deburr::platform
