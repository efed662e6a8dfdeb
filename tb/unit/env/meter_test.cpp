// SPDX-License-Identifier: MIT
// Figures that a meter derives from an engine's parts.
#include "tb/env/meter.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <variant>

#include "rtl_model/fabric/fifo.h"
#include "rtl_model/fabric/link.h"
#include "rtl_model/fabric/memory.h"
#include "spec/registers.h"

namespace deburr::tb::meter_test {
namespace {

using spec::Access;

constexpr std::uint32_t kControl = 0x04, kStatus = 0x08;
constexpr std::array kId = spec::number(Access::kConstant, 0xDEB000FF);
constexpr std::array<spec::RegisterInfo, 3> kTable = {
    {{0x00, "ID", "Which.", kId},
     {kControl, "CONTROL", "Bit 0 enable, 1 clear.", spec::kNumber},
     {kStatus, "STATUS", "Bit 0 idle.", spec::kCounter}}};

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

TEST(Meter, LinkBitsAreEntriesTimesWidth) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  const Linked engine("engine", clock);
  Result result;
  Parts("").add_parts(result, engine, 0);
  EXPECT_EQ(result.link_bits.links, 3u) << "a FIFO is a memory";
  EXPECT_EQ(result.link_bits.bits, 2u * 16 + 9 * 1 + 1 * 32);
}

// Within a composition every name of an engine is prefixed with the environment's name.
TEST(Meter, NamesFiguresAfterItsEnvironment) {
  struct All final : Meter {
    using Meter::add;
    using Meter::key;
    using Meter::Meter;
  };
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  rtl::Memory<std::uint32_t> lines("lines", {.words = 10,
                                             .word_bits = 24,
                                             .read_ports = 2,
                                             .latency = 2,
                                             .content = "lines of the picture"});
  rtl::Counter hits("hits", "line", "lines that were there");
  hits += 7;
  Result alone, within;
  All("").add(alone, "hits", hits);
  All("texture").add(within, "hits", hits);
  All("texture").add(within, "rate", 0.5, "line/clk", "A rate.");
  ASSERT_EQ(within.work.size(), 2u);
  EXPECT_EQ(alone.work[0].name, "hits");
  EXPECT_EQ(within.work[0].name, "texture_hits");
  EXPECT_EQ(std::get<std::uint64_t>(within.work[0].value), 7u);
  EXPECT_EQ(within.work[0].unit, "line");
  EXPECT_EQ(within.work[0].meaning, "Lines that were there.");
  EXPECT_EQ(within.work[1].name, "texture_rate");
  EXPECT_EQ(std::get<double>(within.work[1].value), 0.5);
  EXPECT_EQ(All("texture").key("hits"), "work.texture_hits");
  EXPECT_EQ(All("").key("hits"), "work.hits");
  EXPECT_EQ(Meter("texture").named({PictureMap("level", "", "", "", 1, 1)})[0].name,
            "texture_level");
  All("texture").add(within, "lines", lines, 0);
  ASSERT_EQ(within.memories.size(), 1u);
  const MemoryFigures& m = within.memories[0];
  EXPECT_EQ(m.name, "texture_lines");
  EXPECT_EQ(m.content, "Lines of the picture.");
  EXPECT_EQ(m.kind, "sram");
  EXPECT_EQ(m.words, 10u);
  EXPECT_EQ(m.word_bits, 24u);
  EXPECT_EQ(m.ports, "2R1W");
  EXPECT_EQ(m.read_latency, 2u);
  EXPECT_EQ(m.copies, 2u);
  EXPECT_EQ(m.banks, 1u);
  EXPECT_EQ(m.logical_bits, 240u);
  EXPECT_EQ(m.logical_bits_at_frame_width, 240u);
  EXPECT_EQ(m.physical_bits, 480u);
}

}  // namespace
}  // namespace deburr::tb::meter_test
