// SPDX-License-Identifier: MIT
// What a meter takes of an engine's parts.
#include "tb/env/meter.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

#include "rtl_model/fabric/fifo.h"
#include "rtl_model/fabric/link.h"
#include "spec/registers.h"

namespace deburr::tb::meter_test {
namespace {

using spec::Access;

constexpr std::uint32_t kControl = 0x04, kStatus = 0x08;
constexpr std::array<spec::RegisterInfo, 3> kTable = {
    {{0x00, "ID", Access::kReadOnly, 0xDEB000FF, "Which."},
     {kControl, "CONTROL", Access::kReadWrite, 1, "Bit 0 enable, 1 clear."},
     {kStatus, "STATUS", Access::kWriteOneToClear, 1, "Bit 0 idle."}}};

struct Linked final : rtl::Engine {
  rtl::Link<std::uint16_t> pair{"pair"};
  rtl::Link<bool> deep{"deep", 9};
  rtl::Link<std::uint32_t> single{"single", 1};
  rtl::Fifo<std::uint16_t> queue{"queue", 8};

  Linked(const sc_core::sc_module_name& name, rtl::ClockDomain& clock)
      : Engine(name, clock, kTable,
               {.control = kControl,
                .status = kStatus,
                .enable = 1,
                .clear_counters = 2,
                .idle = 1,
                .written_while_busy = 4,
                .busy_ignores_writes = false}) {}
  bool idle() const override { return true; }
};

struct Parts final : Meter {
  using Meter::add_parts;
  using Meter::Meter;
};

TEST(Meter, BitsOfLinksArePlacesTimesBits) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  const Linked engine("engine", clock);
  Result result;
  Parts("").add_parts(result, engine, 0);
  EXPECT_EQ(result.link_bits.links, 3u) << "a FIFO is a memory";
  EXPECT_EQ(result.link_bits.bits, 2u * 16 + 9 * 1 + 1 * 32);
}

}  // namespace
}  // namespace deburr::tb::meter_test
