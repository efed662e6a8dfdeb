// SPDX-License-Identifier: MIT
// The memory port and the repository's memory model.
#include <gtest/gtest.h>
#include <tlm_utils/simple_initiator_socket.h>
#include <tlm_utils/simple_target_socket.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "rtl_model/fabric/clock_input.h"
#include "rtl_model/platform/memory_host.h"
#include "tb/harness/link_checker.h"
#include "tb/unit/fabric/memory_bench.h"

namespace deburr::tb::memory_test {
namespace {

using rtl::Cycle;
using rtl::kLineBytes;
using rtl::MemoryPortParameters;
using rtl::MemoryRequest;
using rtl::MemoryResponse;
using rtl::MemoryStatus;

// Pushed in 0, sent in 1, arrives at 1 + L, pushed in 2 + L, in the sink in exactly 3 + L; for
// reads and writes.
TEST(MemoryPort, LatencyIsExact) {
  for (const bool write : {false, true})
    for (const std::uint32_t latency : {0U, 1U, 2U, 20U, 100U}) {
      const std::string text = in_child([&] {
        System s({}, with_latency(latency));
        MemoryRequest request = read_of(5);
        request.write = write;
        request.byte_mask = ~std::uint64_t{0};
        s.driver.send(request);
        s.clock.run(latency + 3);
        if (s.sink.received() != 0) return std::string("too early");
        s.clock.run(1);
        if (s.sink.received() != 1) return std::string("too late");
        const MemoryResponse& response = s.sink.beats()[0];
        if (write ? !response.write || response.status != MemoryStatus::kOk : !right(response))
          return std::string("another answer");
        return fmt::format("{} {}x{}", s.sink.cycles()[0], s.port.latency.count(),
                           s.port.latency.max());
      });
      // The request is pushed in cycle 0 and popped in cycle 1.
      EXPECT_EQ(text,
                fmt::format("{} 1x{}", 1 + rtl::MemoryPort::datasheet().latency.cycles + latency,
                            latency + 1))
          << write;
    }
}

// At a clock of the platform with the memory's period, latency is that of a domain with its own
// clock, wherever the rises are. While the clock stands still, a response waits for the next rise.
TEST(MemoryPort, LatencyFollowsTheClock) {
  for (const std::uint32_t latency : {0U, 1U, 20U})
    for (const std::uint32_t shift : {0U, 3U}) {
      const auto received = [&](std::uint32_t stop) {
        return in_child([&] {
          System s({}, with_latency(latency));
          rtl::ClockInput input("input", s.clock);
          const std::uint64_t period = s.clock.period().value();
          sc_core::sc_signal<bool> clock("clock_signal"), reset_n("reset_n_signal");
          reset_n.write(true);
          input.clock(clock);
          input.reset_n(reset_n);
          s.driver.send(read_of(5));
          const auto run = [](std::uint64_t time) {
            sc_core::sc_start(sc_core::sc_time::from_value(time));
          };
          run(shift * period / 10 + 1);
          std::uint32_t edges = 0;
          for (; s.sink.received() == 0 && edges < 50; ++edges) {
            clock.write(true);
            run(period / 2);
            clock.write(false);
            run(period - period / 2 + (edges == 1 ? stop * period : 0));
          }
          return fmt::format("{} {}", edges, s.sink.received() != 0 && right(s.sink.beats()[0]));
        });
      };
      EXPECT_EQ(received(0), fmt::format("{} true", latency + 4)) << latency << ' ' << shift;
      // It has arrived when the clock rises again: as without latency.
      EXPECT_EQ(received(latency + 1), "4 true") << latency << ' ' << shift;
    }
}

// All latencies of the range are drawn, including both bounds.
TEST(MemoryPort, RandomLatenciesCoverTheWholeRange) {
  MemoryPortParameters parameters;
  parameters.outstanding = 1;  // no request waits for another
  System s(parameters, with_latency(5, 8));
  for (std::uint32_t i = 0; i < 200; ++i) s.driver.send(read_of(i));
  ASSERT_TRUE(s.clock.run_until([&] { return s.sink.received() == 200; }, 10'000));
  EXPECT_EQ(s.port.latency.min(), 6U);
  EXPECT_EQ(s.port.latency.max(), 9U);
  EXPECT_GT(s.port.latency.percentile(60), s.port.latency.percentile(40));
}

// Request n has latency n of the list, which begins again at its end. A later response that is
// faster overtakes; of two that are ready in one cycle the first one requested gets the bus.
TEST(MemoryPort, ListedLatenciesAreExactAndRepeat) {
  platform::MemoryModelParameters parameters;
  parameters.latencies = {20, 3, 9, 8};
  System s({}, parameters);
  for (std::uint32_t i = 0; i < 6; ++i) s.driver.send(read_of(i));
  s.clock.run(60);
  std::string arrived;  // in the sink 3 + latency cycles after the push
  for (std::size_t i = 0; i < s.sink.received(); ++i)
    arrived += fmt::format("{}@{}{} ", s.sink.beats()[i].tag, s.sink.cycles()[i],
                           right(s.sink.beats()[i]) ? "" : "!");
  EXPECT_EQ(arrived, "1@7 5@11 2@14 3@15 0@23 4@27 ");
}

TEST(MemoryPort, AcceptsOneRequestPerCycle) {
  MemoryPortParameters parameters;
  parameters.outstanding = 32;
  System s(parameters, with_latency(20));
  for (std::uint32_t i = 0; i < 500; ++i) s.driver.send(read_of(i));
  s.clock.run(500 + 23);
  ASSERT_EQ(s.sink.received(), 500U);
  for (std::uint32_t i = 0; i < 500; ++i) {
    EXPECT_EQ(s.sink.cycles()[i], 23U + i);
    EXPECT_TRUE(right(s.sink.beats()[i]));
  }
  EXPECT_EQ(s.port.max_outstanding.value(), 21U);
  EXPECT_EQ(s.port.bytes_read.value(), 500U * 64);
  EXPECT_EQ(s.memory.bytes_read(), 500U * 64);
}

// With n outstanding, n requests leave every latency + 1 cycles: a beat that leaves is not counted
// any longer.
TEST(MemoryPort, OutstandingRequestsLimitTheRate) {
  MemoryPortParameters parameters;
  parameters.outstanding = 4;
  System s(parameters, with_latency(19));
  for (std::uint32_t i = 0; i < 400; ++i) s.driver.send(read_of(i));
  ASSERT_TRUE(s.clock.run_until([&] { return s.sink.received() == 400; }, 10'000));
  EXPECT_EQ(s.port.max_outstanding.value(), 4U);
  EXPECT_NEAR(static_cast<double>(s.sink.cycles()[399] - s.sink.cycles()[199]), 200.0 * 20 / 4, 3);
  EXPECT_GT(s.port.stalls()[1].cycles, 1000U);
  EXPECT_EQ(s.port.stalls()[1].name, "outstanding");
}

TEST(MemoryPort, MemoryBandwidthLimitsTheRate) {
  platform::MemoryModelParameters parameters = with_latency(10);
  parameters.bytes_per_cycle = 16;
  System s({}, parameters);
  for (std::uint32_t i = 0; i < 100; ++i) s.driver.send(read_of(i));
  ASSERT_TRUE(s.clock.run_until([&] { return s.sink.received() == 100; }, 10'000));
  EXPECT_EQ(s.sink.cycles()[0], 13U + 3);
  EXPECT_EQ(s.sink.cycles()[99], 13U + 3 + 99 * 4);
}

TEST(MemoryPort, BusyBanksLimitTheRate) {
  for (const std::uint32_t banks : {1U, 4U, 8U}) {
    const std::string text = in_child([&] {
      platform::MemoryModelParameters parameters = with_latency(10);
      parameters.banks = banks;
      parameters.bank_busy = 8;
      MemoryPortParameters port;
      port.outstanding = 128;
      System s(port, parameters);
      for (std::uint32_t i = 0; i < 128; ++i) s.driver.send(read_of(i));
      s.clock.run_until([&] { return s.sink.received() == 128; }, 10'000);
      return fmt::format("{}", s.sink.cycles()[127] - s.sink.cycles()[127 - banks]);
    });
    EXPECT_EQ(text, "8");
  }
}

TEST(MemoryPort, RandomLatencyReordersUnlessInOrder) {
  for (const bool in_order : {false, true}) {
    const std::string text = in_child([&] {
      MemoryPortParameters parameters;
      parameters.in_order = in_order;
      System s(parameters, with_latency(5, 60), 300);
      for (std::uint32_t i = 0; i < 1000; ++i) s.driver.send(read_of(i));
      if (!s.clock.run_until([&] { return s.sink.received() == 1000; }, 100'000))
        return std::string("not done");
      std::set<std::uint32_t> tags;
      bool sorted = true;
      std::uint32_t last = 0;
      for (const MemoryResponse& response : s.sink.beats()) {
        if (!right(response) || response.address != response.tag * 64ULL)
          return fmt::format("wrong data for {}", response.tag);
        tags.insert(response.tag);
        sorted = sorted && response.tag >= last;
        last = response.tag;
      }
      return fmt::format("{} {}", tags.size(), sorted ? "sorted" : "overtaken");
    });
    EXPECT_EQ(text, in_order ? "1000 sorted" : "1000 overtaken");
  }
}

TEST(MemoryPort, HandlesReadAndWriteBursts) {
  MemoryPortParameters parameters;
  parameters.max_burst_lines = 8;
  parameters.max_write_lines = 4;
  System s(parameters, with_latency(12));
  MemoryRequest burst = read_of(16);
  burst.lines = 8;
  s.driver.send(burst);
  for (std::uint32_t beat = 0; beat < 4; ++beat) {
    MemoryRequest write = read_of(100);
    write.write = true;
    write.lines = 4;
    write.byte_mask = ~std::uint64_t{0};
    write.data.fill(static_cast<std::uint8_t>(0xA0 + beat));
    s.driver.send(write);
  }
  MemoryRequest masked = read_of(200);
  masked.write = true;
  masked.byte_mask = 0x5;
  masked.data.fill(0xEE);
  s.driver.send(masked);
  ASSERT_TRUE(s.clock.run_until([&] { return s.sink.received() == 10; }, 1000));
  for (std::uint16_t i = 0; i < 8; ++i) {
    const MemoryResponse& response = s.sink.beats()[i];
    EXPECT_TRUE(right(response));
    EXPECT_EQ(response.address, (16U + i) * 64);
    EXPECT_EQ(response.line, i);
    EXPECT_EQ(response.last, i == 7);
  }
  EXPECT_TRUE(s.sink.beats()[8].write && s.sink.beats()[8].last);
  EXPECT_EQ(s.sink.beats()[8].tag, 100U);
  const auto written = s.memory.dump(100 * 64, 256);
  for (std::size_t i = 0; i < 256; ++i) EXPECT_EQ(written[i], 0xA0 + i / 64);
  const auto partly = s.memory.dump(200 * 64, 4);
  EXPECT_EQ(partly[0], 0xEE);
  EXPECT_EQ(partly[1], pattern(200 * 64 + 1));
  EXPECT_EQ(partly[2], 0xEE);
  EXPECT_EQ(s.port.bytes_written.value(), 258U);
  EXPECT_EQ(s.memory.bytes_written(), 258U);
  EXPECT_EQ(s.memory.lines_read().size(), 8U);
  EXPECT_EQ(s.port.response_buffer.writes(), 8U) << "a write response has no line";
  EXPECT_EQ(s.port.response_buffer.reads(), 8U);
  EXPECT_EQ(s.port.gather_buffer->writes(), 5U);
}

// A request that a full memory withholds during a reset of the engine arrives later and does not
// count among the requests made after the reset.
TEST(MemoryModel, IgnoresRequestWithheldBeforeReset) {
  platform::MemoryModelParameters parameters = with_latency(50);
  parameters.outstanding = 1;
  System s({}, parameters);
  s.driver.send(read_of(3));
  s.driver.send(read_of(4));
  s.clock.run(20);  // 3 is in flight, 4 is withheld
  ASSERT_EQ(s.memory.lines_read(), (std::vector<std::uint64_t>{3 * 64}));
  s.memory.clear_statistics();
  s.driver.send(read_of(5));
  ASSERT_TRUE(s.clock.run_until([&] { return s.sink.received() == 3; }, 1000));
  EXPECT_EQ(s.memory.lines_read(), (std::vector<std::uint64_t>{5 * 64}));
  EXPECT_EQ(s.memory.reads(), 1U);
  EXPECT_EQ(s.memory.bytes_read(), 64U);
}

// The last data on a narrow bus are written long after the latency.
TEST(MemoryModel, IdleAfterLastWrite) {
  platform::MemoryModelParameters parameters = with_latency(10);
  parameters.write_at_response = true;
  parameters.bytes_per_cycle = 1;
  parameters.outstanding = 2;
  System s({}, parameters);
  EXPECT_TRUE(s.memory.at_rest());
  for (std::uint32_t line = 3; line < 6; ++line) {
    MemoryRequest write = read_of(line);
    write.write = true;
    write.byte_mask = ~std::uint64_t{0};
    write.data.fill(0xEE);
    s.driver.send(write);
  }
  const auto written = [&] { return s.memory.dump(5 * 64, 1)[0] == 0xEE; };
  s.clock.run(100);
  ASSERT_FALSE(written());
  while (!s.memory.at_rest() && s.clock.cycle() < 1100) {
    EXPECT_FALSE(written()) << s.clock.cycle();
    s.clock.run(1);
  }
  EXPECT_TRUE(s.memory.at_rest());
  EXPECT_TRUE(written());
  EXPECT_GT(s.clock.cycle(), Cycle{3 * 64});
}

// While a clock domain runs ahead, SystemC time does not advance; a reader of the contents during a
// run still sees the writes whose responses have arrived.
TEST(MemoryModel, AnsweredWriteIsVisibleDuringRun) {
  struct Look final : rtl::Clocked {
    System& system;
    std::optional<int> seen;
    explicit Look(System& of) : system(of) {}
    rtl::Activity tick(Cycle) override {
      if (!seen && system.sink.received() == 1)
        seen = system.memory.dump(std::uint64_t{3} * 64, 1)[0];
      return rtl::kIdle;
    }
    void reset() override {}
  };
  platform::MemoryModelParameters parameters = with_latency(40);
  parameters.write_at_response = true;
  System s({}, parameters);
  Look look(s);
  s.clock.add_after(look);
  MemoryRequest write = read_of(3);
  write.write = true;
  write.byte_mask = ~std::uint64_t{0};
  write.data.fill(0xEE);
  s.driver.send(write);
  s.clock.run(200);
  EXPECT_EQ(look.seen, 0xEE);
}

TEST(MemoryModel, ClearsAllCounters) {
  System s({}, with_latency(5));
  s.memory.fail_range(9 * 64, 10 * 64);
  const auto counted = [&] {
    return std::array<std::uint64_t, 8>{s.memory.reads(),
                                        s.memory.writes(),
                                        s.memory.bytes_read(),
                                        s.memory.bytes_written(),
                                        s.memory.errors(),
                                        s.memory.max_outstanding(),
                                        s.memory.lines_read().size(),
                                        s.memory.lines_written().size()};
  };
  MemoryRequest write = read_of(3);
  write.write = true;
  write.byte_mask = ~std::uint64_t{0};
  for (const MemoryRequest& request : {read_of(1), read_of(2), write, read_of(9)})
    s.driver.send(request);
  ASSERT_TRUE(s.clock.run_until([&] { return s.sink.received() == 4; }, 1000));
  s.clock.run(10);
  EXPECT_THAT(counted(), ::testing::ElementsAre(3, 1, 192, 64, 1, 4, 3, 0));
  s.memory.clear_statistics();
  EXPECT_THAT(counted(), ::testing::Each(0u));
}

// A response that was sent ahead ends at its time, even without a later request.
TEST(MemoryModel, ResponseSentAheadIsNotOutstandingAtClear) {
  System s({}, with_latency(5));
  for (std::uint64_t number = 1; number <= 2; ++number) {  // the first response is not sent ahead
    s.driver.send(read_of(3));
    ASSERT_TRUE(s.clock.run_until([&] { return s.sink.received() == number; }, 1000));
  }
  s.clock.run(10);
  ASSERT_EQ(s.memory.max_outstanding(), 1U);
  s.memory.clear_statistics();
  EXPECT_EQ(s.memory.max_outstanding(), 0U);
}

TEST(MemoryModel, ForgetsLinesAndKeepsCounting) {
  System s({}, with_latency(5));
  s.driver.send(read_of(3));
  ASSERT_TRUE(s.clock.run_until([&] { return s.sink.received() == 1; }, 1000));
  s.memory.forget_lines();
  EXPECT_TRUE(s.memory.lines_read().empty());
  EXPECT_EQ(s.memory.reads(), 1U);
}

// A reader that does not wait for the response to a write gets the old data; one that waits gets
// the new data. A memory that accepts one request at a time would hide the difference.
TEST(MemoryModel, ReadAfterUnansweredWriteIsRace) {
  for (const bool late : {true, false}) {
    const std::string text = in_child([&] {
      platform::MemoryModelParameters parameters = with_latency(10);
      parameters.write_at_response = late;
      System s({}, parameters);
      MemoryRequest write = read_of(3);
      write.write = true;
      write.byte_mask = ~std::uint64_t{0};
      write.data.fill(0xEE);
      s.driver.send({write, read_of(3)});
      s.clock.run(40);
      s.driver.send(read_of(3));
      s.clock.run(40);
      std::string said;
      for (const MemoryResponse& response : s.sink.beats())
        said += response.write             ? "written "
                : right(response)          ? "old "
                : response.data[0] == 0xEE ? "new "
                                           : "? ";
      return said;
    });
    EXPECT_EQ(text, late ? "written old new " : "written new new ");
  }
}

// The first read that sees the write begins at the time of its last byte, whenever the response is
// sent.
TEST(MemoryModel, WriteIsVisibleFromItsLastByte) {
  for (const bool ahead : {true, false}) {
    const std::string text = in_child([&] {
      platform::MemoryModelParameters parameters = with_latency(10);
      parameters.answer_ahead = ahead;
      System s({.outstanding = 32}, parameters);
      s.driver.send(read_of(0));
      s.clock.run(40);
      MemoryRequest write = read_of(3);
      write.write = true;
      write.byte_mask = ~std::uint64_t{0};
      write.data.fill(0xEE);
      s.driver.send(write);
      for (int i = 0; i < 12; ++i) s.driver.send(read_of(3));  // one per cycle
      s.clock.run(60);
      std::string said;
      for (const MemoryResponse& response : s.sink.beats())
        said += response.write ? 'w' : right(response) ? 'o' : response.data[0] == 0xEE ? 'n' : '?';
      return said;
    });
    EXPECT_EQ(text, "owooooooooonnn");
  }
}

// Sending a response ahead is unobservable: with any bus, limits, errors, writes between the reads
// and a reset, every beat, cycle and counter is the same, and so are the contents for every time
// and kind of access.
TEST(MemoryModel, ResponsesSentAheadArriveAtTheirTime) {
  std::array<std::uint64_t, 2> activations{};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const bool free = seed % 2 == 0;  // the memory withholds no request
    const auto run = [&](bool ahead) {
      const std::string text = in_child([&] {
        Random random(seed, "parameters");
        platform::MemoryModelParameters memory = with_latency(random.below(40));
        memory.bytes_per_cycle = std::array{0U, 16U, 64U}[random.below(3)];
        memory.banks = random.chance(500) ? 1 : 4;
        memory.bank_busy = memory.banks == 1 ? random.below(4) : 0;
        memory.outstanding = free ? 64 : 1 + random.below(24);
        memory.record_writes = true;
        memory.answer_ahead = ahead;
        MemoryPortParameters port;
        port.outstanding = 1 + random.below(32);
        port.in_order = random.chance(500);
        System s(port, memory, random.chance(500) ? 300 : 0);
        s.memory.fail_range(7 * 64, 9 * 64);
        for (std::uint32_t i = 0; i < 600; ++i) {
          MemoryRequest request = read_of(random.below(64));
          request.write = random.chance(250);
          request.byte_mask = random.chance(500) ? 0x0FF0 : ~std::uint64_t{0};
          request.data.fill(static_cast<std::uint8_t>(i));
          s.driver.send(request);
        }
        s.clock.run(100 + random.below(100));
        const std::uint64_t bytes_written = s.memory.bytes_written();
        const std::vector<std::uint8_t> halfway = s.memory.dump(0, 64 * 64);
        s.clock.set_reset_n(false);
        s.clock.run(2);
        s.clock.set_reset_n(true);
        const std::vector<std::uint8_t> reset = s.memory.dump(0, 64 * 64);
        s.memory.clear_statistics();
        if (!s.clock.run_until([&] { return s.sink.received() == 600; }, 100'000))
          return std::string("not done");
        s.clock.run(100);
        if (!s.memory.at_rest()) return std::string("not at rest");
        return fmt::format(
            "{}\n{} {} {} {} {} {} {} {} {} {} {} {} {}", s.clock.activations(), bytes_written,
            fmt::join(halfway, ","), fmt::join(reset, ","), s.fingerprint(), s.memory.reads(),
            s.memory.writes(), s.memory.bytes_read(), s.memory.bytes_written(), s.memory.errors(),
            s.memory.max_outstanding(), fmt::join(s.memory.lines_read(), ","),
            fmt::join(s.memory.lines_written(), ","), fmt::join(s.memory.dump(0, 64 * 64), ","));
      });
      const std::size_t line = text.find('\n');
      EXPECT_NE(line, std::string::npos) << text;
      if (free) activations[ahead] += std::stoull(text);
      return text.substr(line);
    };
    const std::string with = run(true), without = run(false);
    const auto at = static_cast<std::size_t>(
        std::mismatch(with.begin(), with.end(), without.begin(), without.end()).first -
        with.begin());
    const std::size_t from = at > 40 ? at - 40 : 0;
    EXPECT_TRUE(with == without) << "seed " << seed << ": ahead ..." << with.substr(from, 80)
                                 << "..., at its time ..." << without.substr(from, 80) << "...";
  }
  EXPECT_LT(activations[true], activations[false] / 10);
}

// An interconnect that maps the initiator's addresses to others.
struct Relocator : sc_core::sc_module {
  static constexpr std::uint64_t kBase = 0x1000;
  tlm_utils::simple_target_socket<Relocator> in{"in"};
  tlm_utils::simple_initiator_socket<Relocator> out{"out"};
  std::set<const tlm::tlm_generic_payload*> payloads;
  explicit Relocator(const sc_core::sc_module_name& name) : sc_module(name) {
    in.register_nb_transport_fw(this, &Relocator::forward);
    out.register_nb_transport_bw(this, &Relocator::backward);
  }
  tlm::tlm_sync_enum forward(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                             sc_core::sc_time& delay) {
    if (phase == tlm::BEGIN_REQ) payload.set_address(payload.get_address() + kBase);
    payloads.insert(&payload);
    return out->nb_transport_fw(payload, phase, delay);
  }
  tlm::tlm_sync_enum backward(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                              sc_core::sc_time& delay) {
    if (phase == tlm::BEGIN_RESP) payload.set_address(payload.get_address() - kBase);
    return in->nb_transport_bw(payload, phase, delay);
  }
};

MemoryRequest write_of(std::uint32_t line) {
  MemoryRequest write = read_of(line);
  write.write = true;
  write.byte_mask = ~std::uint64_t{0};
  write.data.fill(0xEE);
  return write;
}

TEST(MemoryModel, WriteAnsweredAheadUsesMappedAddress) {
  Side side;
  Relocator between("between");
  platform::MemoryModel memory("memory", kPeriod, with_latency(10));
  side.port.memory.bind(between.in);
  between.out.bind(memory.ports);
  side.driver.send(read_of(0));
  ASSERT_TRUE(side.clock.run_until([&] { return side.sink.received() == 1; }, 1000));
  side.driver.send(write_of(3));
  ASSERT_TRUE(side.clock.run_until([&] { return side.sink.received() == 2; }, 1000));
  EXPECT_EQ(memory.dump(3 * 64, 1)[0], 0);
  EXPECT_EQ(memory.dump(Relocator::kBase + 3 * 64, 1)[0], 0xEE);
  // Payloads are returned: one after the other, the writes need one or two.
  for (std::uint32_t i = 0; i < 9; ++i) {
    side.driver.send(write_of(i));
    ASSERT_TRUE(side.clock.run_until([&] { return side.sink.received() == 3 + i; }, 1000));
    side.clock.run(10);
  }
  EXPECT_LE(between.payloads.size(), 2u);
}

// After its time, a write that was answered ahead is visible to every kind of access.
TEST(MemoryModel, WriteAnsweredAheadIsVisibleToEveryAccess) {
  using Look = std::function<std::uint8_t(System&, platform::MemoryHost&)>;
  constexpr std::uint64_t kAt = 3 * 64;
  const std::vector<Look> looks = {
      [](System& s, platform::MemoryHost&) { return s.memory.dump(kAt, 1)[0]; },
      [](System&, platform::MemoryHost& host) { return host.read(kAt, 1)[0]; },
      [](System& s, platform::MemoryHost&) {
        std::uint8_t byte = 0;
        s.port.debug_read(kAt, &byte, 1);
        return byte;
      },
      [](System& s, platform::MemoryHost&) {
        s.memory.preload(kAt, std::vector<std::uint8_t>{0x11});
        return static_cast<std::uint8_t>(
            s.memory.dump(kAt, 1)[0] == 0x11 ? s.memory.dump(kAt + 1, 1)[0] : 0);
      }};
  for (std::size_t look = 0; look < looks.size(); ++look)
    EXPECT_EQ(in_child([&] {
                System s({}, with_latency(10));
                platform::MemoryHost host("host", s.memory.size());
                host.bus.bind(s.memory.ports);
                s.driver.send(read_of(0));
                s.clock.run(20);
                s.driver.send(write_of(3));
                s.clock.run(20);
                return fmt::format("{:x}", looks[look](s, host));
              }),
              "ee")
        << look;
}

// A b_transport access sees it from the time of its last byte on, not earlier.
TEST(MemoryModel, WriteAnsweredAheadIsVisibleAtItsTime) {
  constexpr std::uint64_t kAt = 3 * 64;
  System s({}, with_latency(10));
  platform::MemoryHost host("host", s.memory.size());
  host.bus.bind(s.memory.ports);
  s.driver.send(read_of(0));
  s.clock.run(20);
  s.driver.send(write_of(3));
  ASSERT_TRUE(s.clock.run_until([&] { return s.memory.writes() == 1; }, 20));
  s.clock.run(8);  // the next edge is the ninth after that of the request
  EXPECT_EQ(host.read(kAt, 1)[0], pattern(kAt));
  s.clock.run(1);
  EXPECT_EQ(host.read(kAt, 1)[0], 0xEE);
}

// Writes a byte and ends each response at once.
struct Writer final : sc_core::sc_module, tlm::tlm_mm_interface {
  tlm_utils::simple_initiator_socket<Writer> out{"out"};
  explicit Writer(const sc_core::sc_module_name& name) : sc_module(name) {
    out.register_nb_transport_bw(this, &Writer::backward);
  }
  tlm::tlm_sync_enum backward(tlm::tlm_generic_payload&, tlm::tlm_phase& phase, sc_core::sc_time&) {
    return phase == tlm::BEGIN_RESP ? tlm::TLM_COMPLETED : tlm::TLM_ACCEPTED;
  }
  void free(tlm::tlm_generic_payload*) override {}
  void write(tlm::tlm_generic_payload& payload, std::uint64_t address, sc_core::sc_time delay) {
    payload.set_mm(this);
    payload.acquire();
    payload.set_command(tlm::TLM_WRITE_COMMAND);
    payload.set_address(address);
    payload.set_data_ptr(&byte);
    payload.set_data_length(1);
    payload.set_streaming_width(1);
    tlm::tlm_phase phase = tlm::BEGIN_REQ;
    out->nb_transport_fw(payload, phase, delay);
  }
  std::uint8_t byte = 0xEE;
};

// The last bytes of two writes are a picosecond apart and the first has been answered: the second
// is not yet visible.
TEST(MemoryModel, WriteIsNotVisibleBeforeItsResponse) {
  platform::MemoryModelParameters parameters = with_latency(10);
  parameters.bytes_per_cycle = 0;
  platform::MemoryModel memory("memory", kPeriod, parameters);
  Writer writer("writer");
  writer.out.bind(memory.ports);
  sc_core::sc_start(sc_core::SC_ZERO_TIME);
  tlm::tlm_generic_payload before, first, second;
  writer.write(before, 9, sc_core::SC_ZERO_TIME);
  sc_core::sc_start(20 * kPeriod);
  writer.write(first, 1, sc_core::SC_ZERO_TIME);
  writer.write(second, 2, sc_core::sc_time::from_value(1));
  EXPECT_EQ(memory.dump(1, 2), (std::vector<std::uint8_t>{0, 0}));
  first.release();
  EXPECT_EQ(memory.dump(1, 2), (std::vector<std::uint8_t>{0xEE, 0}));
  EXPECT_EQ(first.get_ref_count(), 0) << "the memory keeps the written bytes";
  second.release();
  EXPECT_EQ(memory.dump(1, 2), (std::vector<std::uint8_t>{0xEE, 0xEE}));
  EXPECT_EQ(second.get_ref_count(), 0) << "the memory keeps the written bytes";
}

// A request arrives with the last byte of one write, a picosecond before that of the next.
TEST(MemoryModel, RequestSeesWritesUpToItsTime) {
  platform::MemoryModelParameters parameters = with_latency(10);
  parameters.bytes_per_cycle = 0;
  platform::MemoryModel memory("memory", kPeriod, parameters);
  Writer writer("writer");
  writer.out.bind(memory.ports);
  sc_core::sc_start(sc_core::SC_ZERO_TIME);
  tlm::tlm_generic_payload before, first, second, third;
  writer.write(before, 9, sc_core::SC_ZERO_TIME);
  sc_core::sc_start(20 * kPeriod);
  writer.write(first, 1, sc_core::SC_ZERO_TIME);
  writer.write(second, 2, sc_core::sc_time::from_value(1));
  writer.write(third, 3, 10 * kPeriod);
  EXPECT_EQ(memory.dump(1, 3), (std::vector<std::uint8_t>{0xEE, 0, 0}));
}

// Every beat of a read fits links built for narrow lines; a mask that does not fit is rejected.
TEST(MemoryPort, NarrowLinesHaveNarrowBeats) {
  MemoryPortParameters parameters;
  parameters.line_bytes = 32;
  System s(parameters, with_latency(5));
  const LinkChecker checker(s.clock, "*", true);
  for (std::uint32_t line = 0; line < 20; ++line) {
    MemoryRequest read;
    read.address = line * 32;
    read.tag = line;
    s.driver.send(read);
  }
  ASSERT_TRUE(s.clock.run_until([&] { return s.sink.received() == 20; }, 1000));
  for (const MemoryResponse& response : s.sink.beats()) {
    for (std::uint32_t i = 0; i < 32; ++i)
      ASSERT_EQ(response.data[i], pattern(response.address + i)) << response.address;
    for (std::uint32_t i = 32; i < kLineBytes; ++i) ASSERT_EQ(response.data[i], 0);
  }
  EXPECT_EQ(checker.beats(), 40U);
  MemoryRequest write;
  write.write = true;
  write.byte_mask = std::uint64_t{1} << 32;
  s.driver.send(write);
  EXPECT_THROW(s.clock.run(10), spec::SimulationError);
}

TEST(MemoryPort, RejectsWriteLongerThanItsBuffer) {
  MemoryPortParameters parameters;
  parameters.max_burst_lines = 4;
  parameters.max_write_lines = 2;
  System s(parameters, with_latency(5));
  MemoryRequest request = read_of(0);
  request.lines = 4;
  s.driver.send(request);
  s.clock.run(20);
  EXPECT_EQ(s.sink.received(), 4U);
  request.write = true;
  s.driver.send(request);
  EXPECT_THROW(s.clock.run(20), spec::CheckFailed);
}

TEST(MemoryPort, RejectsMisalignedRequest) {
  System s({}, with_latency(1));
  MemoryRequest request = read_of(1);
  request.address += 4;
  s.driver.send(request);
  EXPECT_THROW(s.clock.run(10), spec::CheckFailed);
}

TEST(MemoryPort, RejectsBurstOfInvalidLength) {
  for (const std::uint16_t lines : {std::uint16_t{0}, std::uint16_t{2}}) {
    EXPECT_EQ(in_child([&] {
                System s({}, with_latency(1));
                MemoryRequest request = read_of(1);
                request.lines = lines;
                s.driver.send(request);
                try {
                  s.clock.run(10);
                } catch (const spec::CheckFailed&) {
                  return std::string("rejected");
                }
                return std::string("taken");
              }),
              "rejected")
        << lines;
  }
}

TEST(MemoryPort, AllowsOneToOneThousandOutstanding) {
  rtl::ClockDomain clock("clock", kPeriod);
  for (const std::uint32_t outstanding : {1u, 1024u})
    EXPECT_NO_THROW(rtl::MemoryPort("port", clock, {.outstanding = outstanding}));
  for (const std::uint32_t outstanding : {0u, 1025u})
    EXPECT_THROW(rtl::MemoryPort("port", clock, {.outstanding = outstanding}), spec::CheckFailed);
}

TEST(MemoryPort, BurstsHaveUpTo64Lines) {
  rtl::ClockDomain clock("clock", kPeriod);
  for (const std::uint32_t lines : {1u, 64u}) {
    EXPECT_NO_THROW(rtl::MemoryPort("port", clock, {.max_burst_lines = lines}));
    EXPECT_NO_THROW(
        rtl::MemoryPort("port", clock, {.max_burst_lines = lines, .max_write_lines = lines}));
    EXPECT_THROW(
        rtl::MemoryPort("port", clock, {.max_burst_lines = lines, .max_write_lines = lines + 1}),
        spec::CheckFailed);
  }
  for (const std::uint32_t lines : {0u, 65u})
    EXPECT_THROW(rtl::MemoryPort("port", clock, {.max_burst_lines = lines}), spec::CheckFailed);
}

struct Initiator : sc_core::sc_module {
  tlm_utils::simple_initiator_socket<Initiator> out{"out"};
  explicit Initiator(const sc_core::sc_module_name& name) : sc_module(name) {}
};

// Byte enables repeat over the data; the last repetition may be partial.
TEST(MemoryModel, ByteEnablesRepeatOverData) {
  platform::MemoryModel memory("memory", kPeriod, with_latency(5));
  Initiator initiator("initiator");
  initiator.out.bind(memory.ports);
  sc_core::sc_start(sc_core::SC_ZERO_TIME);
  fill(memory, 64);
  // Only the first four are used.
  std::array<std::uint8_t, 12> enables{};
  enables.fill(TLM_BYTE_ENABLED);
  enables[1] = enables[2] = TLM_BYTE_DISABLED;
  std::array<std::uint8_t, 10> data{};
  const auto access = [&](tlm::tlm_command command, unsigned length) {
    tlm::tlm_generic_payload payload;
    payload.set_command(command);
    payload.set_address(4);
    payload.set_data_ptr(data.data());
    payload.set_data_length(10);
    payload.set_streaming_width(10);
    payload.set_byte_enable_ptr(enables.data());
    payload.set_byte_enable_length(length);
    sc_core::sc_time delay;
    initiator.out->b_transport(payload, delay);
    return payload.get_response_status();
  };
  // Marks each byte as the initiator's or the memory's.
  const auto owners = [](const auto& bytes) {
    std::string text;
    for (std::size_t i = 0; i < 10; ++i)
      text += bytes[i] == 0xEE ? 'i' : bytes[i] == pattern(4 + i) ? 'm' : '?';
    return text;
  };
  data.fill(0xEE);
  EXPECT_EQ(access(tlm::TLM_READ_COMMAND, 4), tlm::TLM_OK_RESPONSE);
  EXPECT_EQ(owners(data), "miimmiimmi");
  data.fill(0xDD);
  ASSERT_EQ(access(tlm::TLM_READ_COMMAND, 1), tlm::TLM_OK_RESPONSE);
  EXPECT_EQ(owners(data), "mmmmmmmmmm");
  data.fill(0xEE);
  EXPECT_EQ(access(tlm::TLM_WRITE_COMMAND, 4), tlm::TLM_OK_RESPONSE);
  EXPECT_EQ(owners(memory.dump(4, 10)), "immiimmiim");
  EXPECT_EQ(memory.dump(14, 1)[0], pattern(14));
  EXPECT_EQ(memory.bytes_written(), 5u);
  EXPECT_EQ(access(tlm::TLM_WRITE_COMMAND, 0), tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE);
  EXPECT_EQ(memory.bytes_written(), 5u);
}

// The mask applies to the first line of a burst: a byte that it excludes keeps its value, and the
// first byte of the next line is written.
TEST(MemoryPort, DisabledByteKeepsItsValue) {
  for (const std::uint32_t line_bytes : {32u, kLineBytes})
    EXPECT_EQ(in_child([line_bytes] {
                MemoryPortParameters parameters;
                parameters.line_bytes = line_bytes;
                parameters.max_burst_lines = parameters.max_write_lines = 2;
                System s(parameters, with_latency(5));
                MemoryRequest write;
                write.write = true;
                write.lines = 2;
                write.byte_mask = (~std::uint64_t{0} >> (64 - line_bytes)) & ~std::uint64_t{0b101};
                write.data.fill(0xEE);
                s.driver.send(write);
                s.driver.send(write);
                if (!s.clock.run_until([&] { return s.sink.received() == 1; }, 1000))
                  return std::string("not done");
                std::vector<std::uint8_t> bytes(2 * line_bytes);
                s.port.debug_read(0, bytes.data(), 2 * line_bytes);
                std::string kept;
                for (std::uint32_t i = 0; i < bytes.size(); ++i) {
                  if (bytes[i] == 0xEE) continue;
                  kept += fmt::format("{}{} ", i, bytes[i] == pattern(i) ? "" : "!");
                }
                return kept + fmt::format("of {}", s.port.bytes_written.value());
              }),
              fmt::format("0 2 of {}", 2 * line_bytes - 2));
}

// Even if the failed transaction carried data before.
TEST(MemoryPort, ErrorResponseCarriesNoData) {
  System s({}, with_latency(7));
  s.memory.fail_range(64 * 10, 64 * 12);
  for (const std::uint32_t line : {1U, 2U, 10U, 3U, 11U}) {
    s.driver.send(read_of(line));
    s.clock.run(30);
  }
  ASSERT_EQ(s.sink.received(), 5U);
  for (const MemoryResponse& response : s.sink.beats()) {
    if (response.status == MemoryStatus::kOk)
      EXPECT_TRUE(right(response)) << response.tag;
    else
      EXPECT_EQ(response.data, rtl::Line{}) << response.tag;
  }
  EXPECT_EQ(s.port.errors.value(), 2U);
}

TEST(MemoryPort, LineSizeIsFourBytesToOneBeat) {
  rtl::ClockDomain clock("clock", kPeriod);
  for (const std::uint32_t bytes : {4u, kLineBytes})
    EXPECT_NO_THROW(rtl::MemoryPort("port", clock, {.line_bytes = bytes}));
  for (const std::uint32_t bytes : {3u, kLineBytes + 1})
    EXPECT_THROW(rtl::MemoryPort("port", clock, {.line_bytes = bytes}), spec::CheckFailed);
}

TEST(MemoryPort, ErrorResponsesReturnTheirTag) {
  System s({}, with_latency(7));
  s.memory.fail_range(64 * 10, 64 * 12);
  s.memory.fail_request(3);
  for (const std::uint32_t line : {1U, 10U, 11U, 4U, 12U, 1U << 20}) s.driver.send(read_of(line));
  ASSERT_TRUE(s.clock.run_until([&] { return s.sink.received() == 6; }, 1000));
  std::vector<MemoryStatus> status;
  for (const MemoryResponse& response : s.sink.beats()) {
    status.push_back(response.status);
    EXPECT_TRUE(response.status == MemoryStatus::kOk || response.data == rtl::Line{});
  }
  EXPECT_EQ(status, (std::vector<MemoryStatus>{MemoryStatus::kOk, MemoryStatus::kAddressError,
                                               MemoryStatus::kAddressError, MemoryStatus::kError,
                                               MemoryStatus::kOk, MemoryStatus::kAddressError}));
  EXPECT_EQ(s.port.errors.value(), 4U);
  EXPECT_EQ(s.memory.errors(), 4U);
}

TEST(MemoryPort, WritesFailLikeReads) {
  System s({}, with_latency(7));
  s.memory.fail_range(64 * 10, 64 * 12);
  const auto write_of = [](std::uint32_t line) {
    MemoryRequest request = read_of(line);
    request.write = true;
    request.byte_mask = ~std::uint64_t{0};
    return request;
  };
  for (const MemoryRequest& request : {write_of(9), write_of(10), read_of(11), write_of(11)})
    s.driver.send(request);
  ASSERT_TRUE(s.clock.run_until([&] { return s.sink.received() == 4; }, 1000));
  std::vector<MemoryStatus> status;
  for (const MemoryResponse& response : s.sink.beats()) status.push_back(response.status);
  EXPECT_EQ(status,
            (std::vector<MemoryStatus>{MemoryStatus::kOk, MemoryStatus::kAddressError,
                                       MemoryStatus::kAddressError, MemoryStatus::kAddressError}));
  EXPECT_EQ(s.port.errors.value(), 3U);
  EXPECT_EQ(s.port.writes.value(), 3U);
  EXPECT_EQ(s.port.reads.value(), 1U);
}

TEST(MemoryPort, HoldsRequestsBeyondMemoryLimit) {
  platform::MemoryModelParameters parameters = with_latency(20);
  parameters.outstanding = 3;
  System s({}, parameters);
  for (std::uint32_t i = 0; i < 60; ++i) s.driver.send(read_of(i));
  ASSERT_TRUE(s.clock.run_until([&] { return s.sink.received() == 60; }, 10'000));
  EXPECT_EQ(s.memory.max_outstanding(), 3U);
  for (const MemoryResponse& response : s.sink.beats()) EXPECT_TRUE(right(response));
  EXPECT_EQ(s.port.stalls()[2].name, "request_channel");
  EXPECT_GT(s.port.stalls()[2].cycles, 100U);
}

TEST(MemoryPort, RunningAheadIsUnobservable) {
  for (const std::uint32_t limit : {3U, 64U})
    for (const std::uint32_t latency_max : {20U, 90U}) {
      const auto run = [&](bool fast, std::optional<std::uint64_t> shuffle) {
        return in_child([&] {
          platform::MemoryModelParameters parameters = with_latency(20, latency_max);
          parameters.outstanding = limit;
          parameters.bytes_per_cycle = 48;
          System s({}, parameters, 200);
          s.clock.set_fast_path(fast);
          s.clock.shuffle(shuffle);
          for (std::uint32_t i = 0; i < 500; ++i) s.driver.send(read_of(i * 37 % 1000));
          s.clock.run(20'000);
          if (s.sink.received() != 500) return std::string("not done");
          return s.fingerprint();
        });
      };
      const std::string slow = run(false, std::nullopt);
      EXPECT_GT(slow.size(), 1000U);
      EXPECT_EQ(slow.find('!'), std::string::npos) << "wrong data";
      EXPECT_EQ(run(true, std::nullopt), slow);
      EXPECT_EQ(run(true, 5), slow);
    }
}

TEST(MemoryPort, ResetDropsTransactionsInFlight) {
  System s({}, with_latency(30));
  for (std::uint32_t i = 0; i < 100; ++i) s.driver.send(read_of(i));
  s.clock.run(25);  // many requested, none answered
  EXPECT_EQ(s.sink.received(), 0U);
  EXPECT_GT(s.port.in_flight(), 10U);
  EXPECT_EQ(s.port.reads.value(), s.port.in_flight());
  s.clock.set_reset_n(false);
  s.clock.run(2);
  s.clock.set_reset_n(true);
  EXPECT_EQ(s.port.in_flight(), 0U);
  EXPECT_EQ(s.port.reads.value(), 0U);
  ASSERT_TRUE(s.clock.run_until([&] { return s.sink.received() == 100; }, 10'000));
  s.clock.run(100);
  EXPECT_EQ(s.sink.received(), 100U);  // late responses from before the reset are dropped
  for (std::uint32_t i = 0; i < 100; ++i) {
    EXPECT_EQ(s.sink.beats()[i].tag, i);
    EXPECT_TRUE(right(s.sink.beats()[i]));
  }
  EXPECT_EQ(s.port.latency.count(), 100U);
  s.clock.set_reset_n(false);
  s.clock.run(1);
  EXPECT_EQ(s.port.latency.count(), 0U);
}

// Responses that overtook each other are partly delivered when the reset occurs.
TEST(MemoryPort, ResetDropsReorderedResponses) {
  MemoryPortParameters parameters;
  parameters.in_order = true;
  System s(parameters, with_latency(5, 60), 300);
  for (std::uint32_t i = 0; i < 200; ++i) s.driver.send(read_of(i));
  for (Cycle round = 0; round < 30; ++round) {
    s.clock.run(20 + 3 * round);
    s.clock.set_reset_n(false);
    s.clock.run(1);
    s.clock.set_reset_n(true);
  }
  ASSERT_TRUE(s.clock.run_until([&] { return s.sink.received() == 200; }, 20'000));
  s.clock.run(100);
  ASSERT_EQ(s.sink.received(), 200U);
  EXPECT_EQ(s.port.in_flight(), 0U);
  for (std::uint32_t i = 0; i < 200; ++i) {
    EXPECT_TRUE(right(s.sink.beats()[i])) << i;
    EXPECT_EQ(s.sink.beats()[i].tag, i);
  }
}

// Once its response has arrived, sent ahead or not.
TEST(MemoryPort, TransactionFromBeforeResetIsReused) {
  for (const bool ahead : {true, false})
    EXPECT_EQ(in_child([ahead] {
                platform::MemoryModelParameters parameters = with_latency(30);
                parameters.answer_ahead = ahead;
                System s({}, parameters);
                std::set<const tlm::tlm_generic_payload*> payloads;
                s.port.observer = [&](Cycle, const tlm::tlm_generic_payload& payload) {
                  payloads.insert(&payload);
                };
                s.driver.send({read_of(1), read_of(2), read_of(3)});  // again after each reset
                for (int round = 0; round < 10; ++round) {
                  s.clock.run(10);  // sent, not answered
                  s.clock.set_reset_n(false);
                  s.clock.run(40);
                  s.clock.set_reset_n(true);
                }
                return fmt::format("{} for {}", payloads.size(), s.memory.reads());
              }),
              "3 for 30")
        << ahead;
}

// One read: one cycle to send it and one to push its response after the memory's latency.
TEST(MemoryPort, AccountsForEveryCycleOfRead) {
  System s({}, with_latency(10));
  s.driver.send(read_of(3));
  s.clock.run(50);
  EXPECT_EQ(s.port.busy_cycles(), 2U);
  std::uint64_t memory = 0;
  for (const auto& cause : s.port.stalls())
    if (cause.name == "memory") memory = cause.cycles;
  EXPECT_EQ(memory, 10U);
  EXPECT_EQ(s.port.stalled_cycles(), 10U);
  EXPECT_EQ(s.port.idle_cycles(), 38U);
}

// No unit takes the responses: two are in the link, the third waits for room.
TEST(MemoryPort, StallsWhileResponsesAreNotTaken) {
  rtl::ClockDomain clock("clock", kPeriod);
  Driver<MemoryRequest> driver("driver", clock);
  rtl::MemoryPort port("port", clock);
  rtl::Link<MemoryRequest> requests("requests");
  rtl::Link<MemoryResponse> responses("responses");
  platform::MemoryModel memory("memory", kPeriod, with_latency(10));
  driver.beats_out(requests);
  port.requests_in(requests);
  port.responses_out(responses);
  port.memory.bind(memory.ports);
  for (std::uint32_t i = 0; i < 5; ++i) driver.send(read_of(i));
  clock.run(40);  // sent in 1 to 5, the first responses pushed in 12 and 13
  EXPECT_EQ(responses.occupancy(), 2U);
  EXPECT_EQ(port.in_flight(), 3U);
  EXPECT_EQ(port.idle_cycles(), 1U);
  EXPECT_EQ(port.busy_cycles(), 5U + 2);
  EXPECT_EQ(port.cycles_of(rtl::kStalledDownstream), 26U);
  EXPECT_EQ(port.stalled_cycles(), 26U + 6);  // six cycles waiting for memory
}

// Responses that overtook the oldest one wait for memory with it: there is room.
TEST(MemoryPort, OrderedPortWaitsForOldestResponse) {
  MemoryPortParameters parameters;
  parameters.in_order = true;
  System s(parameters, with_latency(5, 60));
  for (std::uint32_t i = 0; i < 200; ++i) s.driver.send(read_of(i));
  s.clock.run(5000);
  EXPECT_EQ(s.sink.received(), 200U);
  EXPECT_EQ(s.port.cycles_of(rtl::kStalledDownstream), 0U);
  EXPECT_GT(s.port.stalled_cycles(), 200U);
}

// Responds on command.
struct ToldTarget : sc_core::sc_module, tlm::tlm_fw_transport_if<> {
  tlm::tlm_target_socket<> socket{"socket"};
  std::vector<tlm::tlm_generic_payload*> asked;
  explicit ToldTarget(const sc_core::sc_module_name& name) : sc_module(name) { socket.bind(*this); }
  void answer(std::size_t which) {
    asked.at(which)->set_response_status(tlm::TLM_OK_RESPONSE);
    tlm::tlm_phase phase = tlm::BEGIN_RESP;
    sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
    socket->nb_transport_bw(*asked.at(which), phase, delay);
  }
  tlm::tlm_sync_enum nb_transport_fw(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                                     sc_core::sc_time&) override {
    asked.push_back(&payload);
    phase = tlm::END_REQ;
    return tlm::TLM_UPDATED;
  }
  void b_transport(tlm::tlm_generic_payload&, sc_core::sc_time&) override {}
  bool get_direct_mem_ptr(tlm::tlm_generic_payload&, tlm::tlm_dmi&) override { return false; }
  unsigned transport_dbg(tlm::tlm_generic_payload&) override { return 0; }
};

// The buffer takes one line per edge of the responses that arrive before the same edge, in order of
// arrival: a response waits for the lines before it; write responses carry none. In order of
// arrival, every beat leaves as if all had been taken at once.
TEST(MemoryPort, BufferTakesOneLinePerClockEdge) {
  const auto beats = [](bool in_order, bool write, std::vector<std::size_t> answers) {
    return in_child([&] {
      MemoryPortParameters parameters;
      parameters.max_burst_lines = 4;
      parameters.in_order = in_order;
      Side s(parameters);
      ToldTarget target("target");
      s.port.memory.bind(target.socket);
      MemoryRequest burst = read_of(8);
      burst.write = write;
      burst.lines = write ? 1 : 4;
      s.driver.send(read_of(1));
      s.driver.send(burst);
      s.clock.run(20);
      for (const std::size_t which : answers) target.answer(which);
      s.clock.run(20);
      std::string text;
      for (std::size_t i = 0; i < s.sink.beats().size(); ++i)
        text += fmt::format("{}.{}@{} ", s.sink.beats()[i].tag, s.sink.beats()[i].line,
                            s.sink.cycles()[i] - 20);
      return text;
    });
  };
  EXPECT_EQ(beats(true, false, {0, 1}), "1.0@2 8.0@3 8.1@4 8.2@5 8.3@6 ");
  EXPECT_EQ(beats(true, false, {1, 0}), "1.0@6 8.0@7 8.1@8 8.2@9 8.3@10 ");
  EXPECT_EQ(beats(true, true, {1, 0}), "1.0@2 8.0@3 ");
  EXPECT_EQ(beats(false, false, {1, 0}), "8.0@2 8.1@3 8.2@4 8.3@5 1.0@6 ");
}

TEST(MemoryPort, ReadOnlyPortRejectsWrite) {
  EXPECT_THAT(in_child([] {
                MemoryPortParameters parameters;
                parameters.read_only = true;
                System s(parameters, with_latency(10));
                MemoryRequest request = read_of(3);
                request.write = true;
                s.driver.send(request);
                s.clock.run(20);
                return std::string("written");
              }),
              testing::HasSubstr("write to 0xc0 through a read-only port"));
}

// The first beat of a two-line write burst is taken and waits inside for the second.
struct HalfABurst : System {
  HalfABurst() : System(of_two_lines(), with_latency(10)) {
    MemoryRequest request = read_of(0);
    request.write = true;
    request.lines = 2;
    request.byte_mask = ~std::uint64_t{0};
    driver.send(request);
  }
  static MemoryPortParameters of_two_lines() {
    MemoryPortParameters parameters;
    parameters.max_burst_lines = parameters.max_write_lines = 2;
    return parameters;
  }
};

TEST(MemoryPort, WaitsForRemainingBeatsOfBurst) {
  HalfABurst s;
  s.clock.run(21);
  EXPECT_EQ(s.port.in_flight(), 1U);
  EXPECT_EQ(s.port.busy_cycles(), 1U);
  EXPECT_EQ(s.port.idle_cycles(), 1U);
  EXPECT_EQ(s.port.stalled_cycles(), 19U);
}

TEST(MemoryPort, ResetDiscardsPartialBurst) {
  HalfABurst s;
  s.clock.run(20);
  EXPECT_EQ(s.port.in_flight(), 1U);
  s.clock.set_reset_n(false);
  s.clock.run(1);
  EXPECT_EQ(s.port.in_flight(), 0U);
  s.clock.set_reset_n(true);
  s.clock.run(20);  // the first beat again, not taken as a second one
  EXPECT_EQ(s.memory.writes(), 0U);
}

TEST(MemoryPort, DebugAccessTakesNoTime) {
  System s({}, with_latency(30));
  s.clock.run(1);  // sockets are connected at elaboration
  std::uint8_t bytes[100];
  EXPECT_EQ(s.port.debug_read(1000, bytes, 100), 100U);
  for (std::uint64_t i = 0; i < 100; ++i) EXPECT_EQ(bytes[i], pattern(1000 + i));
  std::fill(std::begin(bytes), std::end(bytes), std::uint8_t{9});
  EXPECT_EQ(s.port.debug_write(2000, bytes, 100), 100U);
  EXPECT_EQ(s.memory.dump(2099, 1)[0], 9);
  EXPECT_EQ(s.port.debug_read(s.memory.dump(0, 1 << 20).size() - 10, bytes, 100), 10U);
  EXPECT_EQ(s.memory.reads(), 0U);
}

}  // namespace
}  // namespace deburr::tb::memory_test
