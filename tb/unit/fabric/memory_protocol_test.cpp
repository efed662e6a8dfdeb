// SPDX-License-Identifier: MIT
// The memory port with targets that cover every behaviour that the TLM-2.0 base protocol allows,
// and some violations. The targets check the port (tb/harness/protocol_target.h; their checks are
// tested in tb/unit/harness/protocol_target_test.cpp).
#include <gtest/gtest.h>
#include <tlm_utils/peq_with_cb_and_phase.h>
#include <tlm_utils/simple_target_socket.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "tb/harness/protocol_target.h"
#include "tb/unit/fabric/memory_bench.h"

namespace deburr::tb::memory_protocol_test {
namespace {

using rtl::MemoryRequest;
using rtl::MemoryResponse;
using rtl::ResponseEnd;
using sc_core::sc_time;
using sc_core::SC_ZERO_TIME;

constexpr std::array kAnswers = {Answer::kFourPhases, Answer::kEndRequest,    Answer::kNoEndRequest,
                                 Answer::kAnnotated,  Answer::kBeginResponse, Answer::kComplete};
constexpr std::array<std::string_view, 6> kAnswerNames = {
    "FourPhases", "EndRequest", "NoEndRequest", "Annotated", "BeginResponse", "Complete"};
constexpr std::array kEnds = {ResponseEnd::kUpdated, ResponseEnd::kCompleted, ResponseEnd::kCall};
constexpr std::array<std::string_view, 3> kEndNames = {"Updated", "Completed", "Call"};

AcceptedEnds only(ResponseEnd end) {
  return {end == ResponseEnd::kUpdated, end == ResponseEnd::kCompleted, end == ResponseEnd::kCall};
}

struct ProtocolSystem : Side {
  platform::MemoryModel memory;
  ProtocolTarget target;
  ProtocolSystem(const ProtocolTargetParameters& parameters, ResponseEnd end,
                 std::uint32_t latency_max = 5)
      : Side({.max_burst_lines = 4, .max_write_lines = 2}, 150),
        memory("memory", kPeriod, with_latency(5, latency_max)),
        target("target", parameters) {
    port.response_end = end;
    port.memory.bind(target.socket);
    target.memory.bind(memory.ports);
    fill(memory, platform::MemoryModelParameters{}.bytes);
  }

  // Reads, read bursts, and writes of the existing bytes. Returns beats, cycles and counters.
  std::string run() {
    constexpr std::uint32_t kRequests = 200;
    std::uint64_t beats = 0;
    for (std::uint32_t i = 0; i < kRequests; ++i) {
      MemoryRequest request = read_of(4 * i);
      request.write = i % 7 == 3;
      request.lines = request.write ? 1 + i % 2 : i % 5 == 0 ? 4 : 1;
      request.byte_mask = ~std::uint64_t{0};
      beats += request.write ? 1 : request.lines;
      for (std::uint32_t beat = 0; beat < (request.write ? request.lines : 1u); ++beat) {
        for (std::uint32_t k = 0; k < rtl::kLineBytes; ++k)
          request.data[k] = pattern(request.address + beat * rtl::kLineBytes + k);
        driver.send(request);
      }
    }
    const bool done = clock.run_until([&] { return sink.received() == beats; }, 20'000);
    clock.run(1);  // deliver responses due at the time of the last edge
    if (!target.violations().empty()) return "violation: " + target.violations()[0];
    if (!done) return fmt::format("stuck after {}", target.ended());
    if (port.in_flight() != 0 || target.begun() != kRequests || target.ended() != kRequests)
      return fmt::format("leftovers: {} begun, {} ended", target.begun(), target.ended());
    if (target.referenced() != 0) return fmt::format("{} references are left", target.referenced());
    for (const MemoryResponse& response : sink.beats())
      if (response.write ? response.status != rtl::MemoryStatus::kOk : !right(response))
        return fmt::format("wrong response for {:#x}", response.address);
    if (memory.bytes_written() == 0 || memory.dump(0, 1U << 16)[12345] != pattern(12345))
      return "wrong contents";
    return fingerprint();
  }
};

class EveryAnswer : public testing::TestWithParam<Answer> {};

// Neither the way a response ends nor running ahead changes a beat, a cycle or a counter.
TEST_P(EveryAnswer, WorksWithEveryResponseEnd) {
  for (const std::uint32_t latency_max : {5u, 40u})
    for (const sc_time& request_time : {SC_ZERO_TIME, 2 * kPeriod, sc_time(13, sc_core::SC_NS)}) {
      const auto run = [&](ResponseEnd end, bool fast) {
        return in_child([&] {
          ProtocolSystem s({.answer = GetParam(), .request_time = request_time}, end, latency_max);
          s.clock.set_fast_path(fast);
          return s.run();
        });
      };
      const std::string slow = run(ResponseEnd::kUpdated, false);
      EXPECT_GT(slow.size(), 1000U) << slow;
      for (const ResponseEnd end : kEnds) EXPECT_EQ(run(end, true), slow);
    }
}

INSTANTIATE_TEST_SUITE_P(MemoryPort, EveryAnswer, testing::ValuesIn(kAnswers),
                         [](const auto& tested) {
                           return std::string(kAnswerNames[static_cast<std::size_t>(tested.param)]);
                         });

// A target that accepts only one way of ending responses works with it and rejects the first
// response that ends otherwise.
class OneEnd : public testing::TestWithParam<std::tuple<ResponseEnd, Answer>> {};

TEST_P(OneEnd, RejectsEveryOtherEnd) {
  const ResponseEnd accepted = std::get<0>(GetParam());
  const Answer answer = std::get<1>(GetParam());
  for (const ResponseEnd end : kEnds) {
    const std::string text = in_child(
        [&] { return ProtocolSystem({.answer = answer, .accepts = only(accepted)}, end).run(); });
    if (end == accepted)
      EXPECT_GT(text.size(), 1000U) << text;
    else
      EXPECT_EQ(text, "stuck after 0") << kEndNames[static_cast<std::size_t>(end)];
  }
}

INSTANTIATE_TEST_SUITE_P(
    MemoryPort, OneEnd,
    testing::Combine(testing::ValuesIn(kEnds),
                     testing::Values(Answer::kFourPhases, Answer::kEndRequest,
                                     Answer::kNoEndRequest, Answer::kAnnotated)),
    [](const auto& tested) {
      return fmt::format("{}_{}", kEndNames[static_cast<std::size_t>(std::get<0>(tested.param))],
                         kAnswerNames[static_cast<std::size_t>(std::get<1>(tested.param))]);
    });

// A request that ends at the time of an edge makes room for the next one at that edge.
TEST(MemoryPort, SendsNextRequestWhenLastHasEnded) {
  ProtocolSystem s({.answer = Answer::kFourPhases, .request_time = 2 * kPeriod},
                   ResponseEnd::kUpdated);
  for (std::uint32_t i = 0; i < 20; ++i) s.driver.send(read_of(i));
  ASSERT_TRUE(s.clock.run_until([&] { return s.sink.received() == 20; }, 1000));
  for (std::size_t i = 1; i < 20; ++i)
    EXPECT_EQ(s.target.begun_times()[i] - s.target.begun_times()[i - 1], 2 * kPeriod);
}

// Protocol violations of a target.
struct BrokenTarget : sc_core::sc_module {
  enum class Fault { kSecondAnswer, kBackwardRequest, kSecondResponse };
  tlm_utils::simple_target_socket<BrokenTarget> socket{"socket"};
  tlm_utils::peq_with_cb_and_phase<BrokenTarget> queue{this, &BrokenTarget::due};
  Fault fault;
  BrokenTarget(const sc_core::sc_module_name& name, Fault what) : sc_module(name), fault(what) {
    socket.register_nb_transport_fw(this, &BrokenTarget::forward);
  }
  tlm::tlm_sync_enum forward(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                             sc_time& delay) {
    if (phase == tlm::END_RESP) return tlm::TLM_COMPLETED;
    payload.acquire();
    queue.notify(payload, fault == Fault::kBackwardRequest ? tlm::BEGIN_REQ : tlm::BEGIN_RESP,
                 // The responses to the first two requests arrive at the same time.
                 delay + (payload.get_address() == 0 ? 5 : 4) * kPeriod);
    phase = tlm::END_REQ;
    return tlm::TLM_UPDATED;
  }
  void due(tlm::tlm_generic_payload& payload, const tlm::tlm_phase& when) {
    for (int times = fault == Fault::kSecondAnswer ? 2 : 1; times > 0; --times) {
      tlm::tlm_phase phase = when;
      sc_time delay;
      payload.set_response_status(tlm::TLM_OK_RESPONSE);
      socket->nb_transport_bw(payload, phase, delay);
    }
  }
};

std::string rejection_of(BrokenTarget::Fault fault, ResponseEnd end) {
  return in_child([&] {
    Side side;
    BrokenTarget target("target", fault);
    side.port.response_end = end;
    side.port.memory.bind(target.socket);
    side.driver.send({read_of(0), read_of(1)});
    side.clock.run(100);
    return std::string("taken");
  });
}

TEST(MemoryPort, ReportsProtocolViolationsOfTarget) {
  using Fault = BrokenTarget::Fault;
  for (const ResponseEnd end : kEnds) {
    EXPECT_THAT(rejection_of(Fault::kSecondAnswer, end),
                testing::HasSubstr("port: the memory responded twice to the read of 0x0"));
    EXPECT_THAT(rejection_of(Fault::kBackwardRequest, end),
                testing::HasSubstr("port: the memory sent phase BEGIN_REQ backwards"));
  }
  // Only while the first response is still open.
  EXPECT_THAT(rejection_of(Fault::kSecondResponse, ResponseEnd::kCall),
              testing::HasSubstr("port: the memory began the response for 0x"));
  EXPECT_EQ(rejection_of(Fault::kSecondResponse, ResponseEnd::kUpdated), "taken");
}

// A target with b_transport only, through the adapter of simple_target_socket.
struct BlockingTarget : sc_core::sc_module {
  tlm_utils::simple_target_socket<BlockingTarget> socket{"socket"};
  explicit BlockingTarget(const sc_core::sc_module_name& name) : sc_module(name) {
    socket.register_b_transport(this, &BlockingTarget::transport);
  }
  void transport(tlm::tlm_generic_payload& payload, sc_time&) {
    wait(7 * kPeriod);
    for (unsigned i = 0; i < payload.get_data_length(); ++i)
      payload.get_data_ptr()[i] = pattern(payload.get_address() + i);
    payload.set_response_status(tlm::TLM_OK_RESPONSE);
  }
};

TEST(MemoryPort, WorksWithBlockingTarget) {
  const auto run = [](ResponseEnd end, bool fast) {
    return in_child([&] {
      Side side;
      BlockingTarget target("target");
      side.port.response_end = end;
      side.port.memory.bind(target.socket);
      side.clock.set_fast_path(fast);
      for (std::uint32_t i = 0; i < 200; ++i) side.driver.send(read_of(i));
      if (!side.clock.run_until([&] { return side.sink.received() == 200; }, 10'000))
        return std::string("not done");
      return side.fingerprint();
    });
  };
  const std::string slow = run(ResponseEnd::kUpdated, false);
  EXPECT_GT(slow.size(), 1000U) << slow;
  EXPECT_EQ(slow.find('!'), std::string::npos) << "wrong data";
  for (const ResponseEnd end : kEnds) EXPECT_EQ(run(end, true), slow);
}

// Leaves an extension in each payload; it must end with its transaction.
struct MarkingTarget : sc_core::sc_module {
  struct Mark final : tlm::tlm_extension<Mark> {
    tlm::tlm_extension_base* clone() const override { return new Mark; }
    void copy_from(const tlm::tlm_extension_base&) override {}
  };
  tlm_utils::simple_target_socket<MarkingTarget> socket{"socket"};
  std::string marked;
  explicit MarkingTarget(const sc_core::sc_module_name& name) : sc_module(name) {
    socket.register_b_transport(this, &MarkingTarget::transport);
  }
  void transport(tlm::tlm_generic_payload& payload, sc_time&) {
    marked += payload.get_extension<Mark>() ? 'x' : '-';
    payload.set_auto_extension(new Mark);
    payload.set_response_status(tlm::TLM_OK_RESPONSE);
  }
};

TEST(MemoryPort, PayloadArrivesWithoutOldExtensions) {
  Side side({.outstanding = 1});
  MarkingTarget target("target");
  side.port.memory.bind(target.socket);
  for (std::uint32_t i = 0; i < 8; ++i) side.driver.send(read_of(i));
  ASSERT_TRUE(side.clock.run_until([&] { return side.sink.received() == 8; }, 1000));
  EXPECT_EQ(target.marked, "--------");
}

// Changes that interconnects and memories may make to a payload, or values they may fail to set.
struct OddTarget : sc_core::sc_module {
  enum class What { kMovesAddress, kLeavesIncomplete, kRejectsEnables };
  tlm_utils::simple_target_socket<OddTarget> socket{"socket"};
  What what;
  OddTarget(const sc_core::sc_module_name& name, What does) : sc_module(name), what(does) {
    socket.register_b_transport(this, &OddTarget::transport);
  }
  void transport(tlm::tlm_generic_payload& payload, sc_time&) {
    const std::uint64_t address = payload.get_address();
    for (unsigned i = 0; i < payload.get_data_length() && payload.is_read(); ++i)
      payload.get_data_ptr()[i] = pattern(address + i);
    if (what == What::kMovesAddress) payload.set_address(address % (2 * rtl::kLineBytes));
    if (what == What::kRejectsEnables && payload.get_byte_enable_ptr())
      return payload.set_response_status(tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE);
    if (what != What::kLeavesIncomplete) payload.set_response_status(tlm::TLM_OK_RESPONSE);
  }
};

// A read, a burst of two, a full line write, a half line write: `status.line@address` of each
// response, and the counters.
std::string answers_of(OddTarget::What what) {
  return in_child([&] {
    Side side({.outstanding = 1, .max_burst_lines = 2});
    OddTarget target("target", what);
    side.port.memory.bind(target.socket);
    std::vector<MemoryRequest> requests = {read_of(5), read_of(8), read_of(11), read_of(12)};
    requests[1].lines = 2;
    requests[2].write = requests[3].write = true;
    requests[2].byte_mask = ~std::uint64_t{0};
    requests[3].byte_mask = 0xFFFFFFFF;
    for (const MemoryRequest& request : requests) side.driver.send(request);
    if (!side.clock.run_until([&] { return side.sink.received() == 5; }, 1000))
      return std::string("not done");
    std::string text;
    for (const MemoryResponse& response : side.sink.beats()) {
      const bool empty = std::all_of(response.data.begin(), response.data.end(),
                                     [](std::uint8_t byte) { return byte == 0; });
      text += fmt::format("{}.{}@{}{} ", static_cast<int>(response.status), response.line,
                          response.address / rtl::kLineBytes, empty ? "-" : "");
    }
    return text + fmt::format("errors {}", side.port.errors.value());
  });
}

TEST(MemoryPort, ResponseCarriesRequestedAddress) {
  EXPECT_EQ(answers_of(OddTarget::What::kMovesAddress),
            "0.0@5 0.0@8 0.1@9 0.0@11- 0.0@12- errors 0");
}

TEST(MemoryPort, MissingStatusCountsAsError) {
  EXPECT_EQ(answers_of(OddTarget::What::kLeavesIncomplete),
            "2.0@5- 2.0@8- 2.1@9- 2.0@11- 2.0@12- errors 4");
}

TEST(MemoryPort, TargetWithoutByteEnablesFailsPartialLinesOnly) {
  EXPECT_EQ(answers_of(OddTarget::What::kRejectsEnables),
            "0.0@5 0.0@8 0.1@9 0.0@11- 2.0@12- errors 1");
}

}  // namespace
}  // namespace deburr::tb::memory_protocol_test
