// SPDX-License-Identifier: MIT
// Results collected from units, memories, latencies and parameters: each number by hand.
#include "tb/env/collect.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "rtl_model/fabric/unit.h"
#include "spec/error.h"
#include "tb/env/memory_parameters.h"

namespace deburr::tb::collect_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Bins = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

Latency latency(const std::vector<std::uint64_t>& values) {
  rtl::Histogram histogram("histogram", "clk", "of the test");
  for (const std::uint64_t value : values) histogram.record(value);
  return latency_of(histogram);
}
Bins bins(const Latency& latency) {
  Bins all;
  for (const LatencyBin& bin : latency.histogram) all.emplace_back(bin.from, bin.count);
  return all;
}

TEST(Latency, EmptySampleHasNoBins) {
  const Latency none = latency({});
  EXPECT_TRUE(none.histogram.empty());
  EXPECT_EQ(none.min + none.p50 + none.p95 + none.p99 + none.max, 0u);
}

TEST(Latency, ListsPercentiles) {
  std::vector<std::uint64_t> values;
  for (std::uint64_t i = 1; i <= 200; ++i) values.push_back(201 - i + 10);  // 11..210
  const Latency l = latency(values);
  EXPECT_EQ(l.min, 11u);
  EXPECT_EQ(l.p50, 110u);
  EXPECT_EQ(l.p95, 200u);
  EXPECT_EQ(l.p99, 208u);
  EXPECT_EQ(l.max, 210u);
}

// At most 48 bins of equal width, a power of two, including empty ones, starting at a multiple of
// the width.
TEST(Latency, BinsHaveEqualWidth) {
  EXPECT_EQ(bins(latency({7, 9, 9, 8})), (Bins{{7, 1}, {8, 1}, {9, 2}}));
  EXPECT_EQ(bins(latency({3, 5})), (Bins{{3, 1}, {4, 0}, {5, 1}}));
  EXPECT_EQ(latency({10, 57}).histogram.size(), 48u) << "one cycle each";
  const Latency wide = latency({10, 11, 12, 58});
  EXPECT_EQ(wide.histogram.size(), 25u);
  EXPECT_EQ(wide.histogram[0].from, 10u);
  EXPECT_EQ(wide.histogram[0].count, 2u);
  EXPECT_EQ(wide.histogram[1].from, 12u);
  EXPECT_EQ(wide.histogram[1].count, 1u);
  EXPECT_EQ(wide.histogram[24].from, 58u);
  EXPECT_EQ(wide.histogram[24].count, 1u);
  const Latency odd = latency({11, 59, 106});  // widths of 4: 8, 12, ... 104
  EXPECT_EQ(odd.histogram.front().from, 8u);
  EXPECT_EQ(odd.histogram.back().from, 104u);
  EXPECT_EQ(odd.histogram.front().count, 1u);
  EXPECT_EQ(odd.histogram.back().count, 1u);
  EXPECT_EQ(odd.histogram.size(), 25u);
  EXPECT_EQ(odd.histogram[12].from, 56u);
  EXPECT_EQ(odd.histogram[12].count, 1u);
}

TEST(Sentence, BeginsWithCapitalAndEndsWithFullStop) {
  EXPECT_EQ(sentence(""), "");
  EXPECT_EQ(sentence("x"), "X.");
  EXPECT_EQ(sentence("lines that were read"), "Lines that were read.");
  EXPECT_EQ(sentence("Whole."), "Whole.");
}

// Returns the scripted activity of each cycle.
class Told final : public rtl::Unit {
 public:
  Told(const sc_core::sc_module_name& name, rtl::ClockDomain& clock)
      : Unit(name, clock),
        causes{declare_stall("full", "the queue is full"),
               declare_stall("wait_memory", "answers are on their way"),
               declare_stall("memory", "no line has come")} {}
  rtl::Activity tick(rtl::Cycle) override {
    return next++ < acts.size() ? acts[next - 1] : rtl::kIdle;
  }
  void reset() override {}
  const std::array<rtl::Activity, 3> causes;
  std::vector<rtl::Activity> acts;
  std::size_t next = 0;
};

// Waiting for memory with nothing else to do is idle; only a port counts `memory`.
TEST(UnitCycles, CountsEachCycleOnce) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  Told unit("unit", clock);
  const auto add = [&](int times, rtl::Activity activity) {
    for (int i = 0; i < times; ++i) unit.acts.push_back(activity);
  };
  add(2, rtl::kBusy);
  add(3, rtl::kStalledDownstream);
  add(5, unit.causes[0]);
  add(7, unit.causes[1]);
  add(11, unit.causes[2]);
  clock.run(30);  // two more, idle
  const UnitCycles cycles = unit_cycles("called", unit);
  EXPECT_EQ(cycles.name, "called");
  EXPECT_EQ(cycles.busy, 2u);
  EXPECT_EQ(cycles.idle, 2u + 7u);
  std::vector<std::pair<std::string, std::uint64_t>> stalls;
  for (const StallCycles& stall : cycles.stalls) stalls.emplace_back(stall.cause, stall.cycles);
  EXPECT_THAT(stalls, ElementsAre(std::pair("downstream", 3u), std::pair("full", 5u),
                                  std::pair("memory", 11u)));
  EXPECT_EQ(cycles.stalls[1].meaning, "The queue is full.");
  EXPECT_THAT(activity_keys(unit), ElementsAre("idle", "busy", "stalls.downstream", "stalls.full",
                                               "idle", "stalls.memory"));
}

// ---- Parameters of a memory --------------------------------------------------------------------

TEST(MemoryParameters, EveryParameterReachesItsModelField) {
  MemoryParameters p;
  p.latency = 11;
  p.latency_max = 17;
  p.bytes_per_cycle = 32;
  p.banks = 8;
  p.interleave_bytes = 128;
  p.bank_busy = 5;
  p.outstanding = 21;
  platform::MemoryModelParameters m = memory_model_parameters(p, 4096, 99);
  EXPECT_EQ(m.bytes, 4096u);
  EXPECT_EQ(m.latency_min, 11u);
  EXPECT_EQ(m.latency_max, 17u);
  EXPECT_EQ(m.bytes_per_cycle, 32u);
  EXPECT_EQ(m.banks, 8u);
  EXPECT_EQ(m.interleave_bytes, 128u);
  EXPECT_EQ(m.bank_busy, 5u);
  EXPECT_EQ(m.outstanding, 21u);
  EXPECT_EQ(m.seed, 99u);
  p.latency_max = 0;  // fixed
  m = memory_model_parameters(p, 63, 1);
  EXPECT_EQ(m.latency_max, 11u);
  EXPECT_EQ(m.bytes, 64u) << "at least one line";
}

TEST(MemoryParameters, LatencyFileGivesLatencyOfEachRequest) {
  MemoryParameters p;
  p.latency_file = testing::TempDir() + "latencies.txt";
  const auto read = [&](std::string_view text) -> std::string {
    std::ofstream(p.latency_file) << text;
    try {
      return fmt::format("{}", fmt::join(memory_model_parameters(p, 64, 1).latencies, " "));
    } catch (const spec::FileError& error) {
      return std::string(error.what()).substr(p.latency_file.size());
    }
  };
  EXPECT_EQ(read("# comment\n1\n100000\r\n 7 "), "1 100000 7");
  for (const std::string row : {"0", "-3", "100001", "4294967297", "1.5", "12 13", "12x", ""})
    EXPECT_EQ(read("7\n" + row + "\n8\n"),
              ":2: '" + row +
                  "' is not a latency: write a whole number of cycles, 1 to 100000, in each line");
  for (const std::string text : {"", "# comment\n"})
    EXPECT_THAT(read(text), HasSubstr("has no latency: write the cycles of one request"));
  std::filesystem::remove(p.latency_file);
  EXPECT_THROW(memory_model_parameters(p, 64, 1), spec::FileError);
  EXPECT_EQ(memory_cycles(p, 64).latency, 100) << "sizes do not depend on the file";
  p.latency_file.clear();
  EXPECT_TRUE(memory_model_parameters(p, 64, 1).latencies.empty());
}

TEST(MemoryParameters, LineTakesLatencyAndItsTransfer) {
  MemoryTiming p;
  const auto cycles = [&](std::int32_t latency, std::int32_t most, std::int32_t bytes_per_cycle,
                          std::int32_t line) {
    p.latency = latency;
    p.latency_max = most;
    p.bytes_per_cycle = bytes_per_cycle;
    const rtl::MemoryCycles c = memory_cycles(p, line);
    return std::pair<int, int>(c.latency, c.transfer);
  };
  EXPECT_EQ(cycles(30, 0, 64, 64), std::pair(30, 1));
  EXPECT_EQ(cycles(30, 40, 16, 64), std::pair(40, 4));
  EXPECT_EQ(cycles(30, 20, 16, 128), std::pair(30, 8));
  EXPECT_EQ(cycles(30, 0, 128, 64), std::pair(30, 1)) << "at least one cycle";
  EXPECT_EQ(cycles(30, 0, 0, 64), std::pair(30, 1)) << "no limit";
}

TEST(ErrorRange, CoversLinesItHasByteOf) {
  MemoryParameters p;
  EXPECT_FALSE(error_range(p).has_value());
  p.error_address = 0;
  p.error_bytes = 1;
  ASSERT_TRUE(error_range(p).has_value());
  EXPECT_TRUE(error_range(p)->touches(0, 64));
  EXPECT_FALSE(error_range(p)->touches(64, 64));
  p.error_address = 100;
  p.error_bytes = 28;  // up to the end of the line at 64
  EXPECT_EQ(error_range(p)->from, 100u);
  EXPECT_EQ(error_range(p)->to, 128u);
  EXPECT_FALSE(error_range(p)->touches(0, 64));
  EXPECT_TRUE(error_range(p)->touches(64, 64));
  EXPECT_FALSE(error_range(p)->touches(128, 64));
  EXPECT_FALSE(error_range(p)->touches(36, 64)) << "its last byte is 99";
  EXPECT_TRUE(error_range(p)->touches(37, 64));
  EXPECT_TRUE(error_range(p)->touches(127, 1));
}

}  // namespace
}  // namespace deburr::tb::collect_test
