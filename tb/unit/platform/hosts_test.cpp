// SPDX-License-Identifier: MIT
// Software's two ways to memory: bypassing the bus, and through it by b_transport.
#include "rtl_model/platform/memory_host.h"
#include "rtl_model/platform/memory_model.h"
#include "tb/unit/platform/fakes.h"

namespace deburr::tb::hosts_test {
namespace {

using testing::HasSubstr;

struct Bed {
  Bed() {
    host.bus.bind(memory.ports);
    sc_core::sc_start(sc_core::SC_ZERO_TIME);
  }
  platform::MemoryModel memory{
      "memory", sc_core::sc_time(10, sc_core::SC_NS), {.bytes = 1000, .record_writes = true}};
  platform::MemoryHost host{"host", 1000};
};

std::vector<std::uint8_t> counted(std::size_t bytes) {
  std::vector<std::uint8_t> data(bytes);
  for (std::size_t i = 0; i < bytes; ++i) data[i] = static_cast<std::uint8_t>(i + 1);
  return data;
}

TEST(MemoryHost, WritesAndReadsLineByLine) {
  Bed b;
  const std::vector<std::uint8_t> data = counted(150);
  b.host.write(60, data);
  EXPECT_EQ(b.memory.dump(60, 150), data);
  EXPECT_EQ(b.memory.dump(59, 1), std::vector<std::uint8_t>{0});
  EXPECT_EQ(b.memory.dump(210, 1), std::vector<std::uint8_t>{0});
  EXPECT_EQ(b.memory.writes(), 4u) << "60..63, two whole lines, 192..209";
  EXPECT_EQ(b.memory.bytes_written(), 150u);
  EXPECT_EQ(b.host.read(60, 150), data);
  EXPECT_EQ(b.memory.reads(), 4u);
  EXPECT_EQ(b.memory.bytes_read(), 150u);
  EXPECT_EQ(b.host.size(), 1000u);
  b.host.write(5, {});
  EXPECT_EQ(b.memory.writes(), 4u);
}

TEST(MemoryHost, RejectedAccessIsAnError) {
  Bed b;
  EXPECT_EQ(error_of<spec::SimulationError>([&] { b.host.write(990, counted(20)); }),
            "host: write of 20 bytes at 0x3de was rejected: TLM_ADDRESS_ERROR_RESPONSE");
  EXPECT_THAT(error_of<spec::SimulationError>([&] { b.host.read(2000, 1); }),
              HasSubstr("read of 1 bytes at 0x7d0"));
}

TEST(MemoryModel, DriverAccessUsesNoTimeAndNoCounters) {
  Bed b;
  platform::HostMemory& memory = b.memory;
  memory.write(10, counted(3));
  EXPECT_EQ(memory.read(9, 5), (std::vector<std::uint8_t>{0, 1, 2, 3, 0}));
  EXPECT_EQ(memory.size(), 1000u);
  EXPECT_EQ(b.memory.reads() + b.memory.writes(), 0u);
  EXPECT_THAT(error_of<spec::ConfigError>([&] { memory.write(999, counted(2)); }),
              HasSubstr("do not fit into 1000 bytes"));
}

}  // namespace
}  // namespace deburr::tb::hosts_test
