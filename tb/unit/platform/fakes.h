// SPDX-License-Identifier: MIT
// Engine registers that record writes in order, and memory in an array.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "rtl_model/platform/host.h"
#include "spec/error.h"

namespace deburr::tb {

class FakeRegisters final : public platform::RegisterBus {
 public:
  std::uint32_t read(std::uint32_t offset) override { return values[offset]; }
  void write(std::uint32_t offset, std::uint32_t value) override {
    values[offset] = value;
    written.emplace_back(offset, value);
  }
  std::map<std::uint32_t, std::uint32_t> values;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> written;
};

class FakeMemory final : public platform::HostMemory {
 public:
  explicit FakeMemory(std::size_t bytes) : contents(bytes, 0xEE) {}
  void write(std::uint64_t address, std::span<const std::uint8_t> data) override {
    std::copy(data.begin(), data.end(), contents.begin() + static_cast<std::ptrdiff_t>(address));
  }
  std::vector<std::uint8_t> read(std::uint64_t address, std::uint64_t bytes) override {
    const auto from = contents.begin() + static_cast<std::ptrdiff_t>(address);
    return {from, from + static_cast<std::ptrdiff_t>(bytes)};
  }
  std::uint64_t size() const override { return contents.size(); }
  std::vector<std::uint8_t> contents;
};

// The text of the error; empty if there was none.
template <class Error, class Action>
std::string error_of(Action&& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace deburr::tb
