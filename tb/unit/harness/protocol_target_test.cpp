// SPDX-License-Identifier: MIT
// The target that checks the base protocol detects each violation of an initiator and reports
// nothing else. The initiator here makes one violation at a time, with its own memory manager.
#include "tb/harness/protocol_target.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <functional>
#include <string>

#include "rtl_model/platform/memory_model.h"
#include "tb/base/forked.h"

namespace deburr::tb::protocol_target_test {
namespace {

using sc_core::sc_time;

const sc_time kTick(10, sc_core::SC_NS);

struct Script {
  // Changes to the payload before BEGIN_REQ, and while the target has it.
  std::function<void(tlm::tlm_generic_payload&)> spoil{}, disturb{};
  tlm::tlm_sync_enum answer = tlm::TLM_COMPLETED;  // to BEGIN_RESP
  tlm::tlm_phase answer_phase = tlm::BEGIN_RESP;
  tlm::tlm_sync_enum answer_end_request = tlm::TLM_ACCEPTED;
  bool turn_back = false;  // responds at an earlier time
  bool again = false;      // BEGIN_REQ of the same payload at once
  bool second = false;     // another BEGIN_REQ at once
  int end_calls = 0;       // number of END_RESP calls at the end
  bool early_end = false;  // END_RESP before a response exists
  bool past_end = false;   // END_RESP before the annotated time of the response
  bool strange_phase = false;
  sc_time next = 10 * kTick;  // delay of the second request
};

struct Initiator : sc_core::sc_module, tlm::tlm_mm_interface {
  tlm_utils::simple_initiator_socket<Initiator> socket{"socket"};
  Script script;
  std::array<tlm::tlm_generic_payload, 2> payloads;
  std::array<unsigned char, 64> data{};
  int freed = 0;

  explicit Initiator(const sc_core::sc_module_name& name) : sc_module(name) {
    socket.register_nb_transport_bw(this, &Initiator::backward);
  }
  void free(tlm::tlm_generic_payload*) override { ++freed; }
  void call(tlm::tlm_generic_payload& payload, tlm::tlm_phase phase, sc_time delay) {
    socket->nb_transport_fw(payload, phase, delay);
  }
  void begin(std::size_t i, sc_time delay) {
    tlm::tlm_generic_payload& payload = payloads[i];
    payload.set_mm(this);
    payload.acquire();
    payload.set_command(tlm::TLM_READ_COMMAND);
    payload.set_address(64 * i);
    payload.set_data_ptr(data.data());
    payload.set_data_length(64);
    payload.set_streaming_width(64);
    payload.set_response_status(tlm::TLM_INCOMPLETE_RESPONSE);
    if (script.spoil) script.spoil(payload);
    call(payload, tlm::BEGIN_REQ, delay);
  }
  tlm::tlm_sync_enum backward(tlm::tlm_generic_payload&, tlm::tlm_phase& phase, sc_time& delay) {
    if (phase == tlm::END_REQ) return script.answer_end_request;
    phase = script.answer_phase;
    if (script.turn_back) delay -= sc_time::from_value(1);
    return script.answer;
  }
};

// The first violation, "" for none, and whether every transaction has ended.
std::string seen(const Script& script, const ProtocolTargetParameters& parameters = {}) {
  return forked_text([&] {
    Initiator initiator("initiator");
    initiator.script = script;
    ProtocolTarget target("target", parameters);
    platform::MemoryModel memory("memory", kTick);
    initiator.socket.bind(target.socket);
    target.memory.bind(memory.ports);
    sc_core::sc_start(kTick);
    initiator.begin(0, sc_core::SC_ZERO_TIME);
    if (script.disturb) script.disturb(initiator.payloads[0]);
    if (script.again) initiator.call(initiator.payloads[0], tlm::BEGIN_REQ, kTick);
    if (script.second) initiator.begin(1, script.next);
    if (script.strange_phase) initiator.call(initiator.payloads[0], tlm::END_REQ, kTick);
    if (script.early_end) initiator.call(initiator.payloads[0], tlm::END_RESP, kTick);
    if (!script.past_end) sc_core::sc_start(100 * kTick);
    for (int i = 0; i < script.end_calls; ++i)
      initiator.call(initiator.payloads[0], tlm::END_RESP, sc_core::SC_ZERO_TIME);
    if (!target.violations().empty()) return target.violations()[0];
    if (target.begun() != target.ended()) return std::string("open");
    initiator.payloads[0].release();
    if (script.second) initiator.payloads[1].release();
    if (target.referenced() != 0 || initiator.freed != (script.second ? 2 : 1))
      return std::string("referenced");
    return std::string("fine");
  });
}

TEST(ProtocolTarget, AcceptsEveryAllowedSequence) {
  for (const Answer answer : {Answer::kFourPhases, Answer::kEndRequest, Answer::kNoEndRequest,
                              Answer::kAnnotated, Answer::kBeginResponse, Answer::kComplete}) {
    const ProtocolTargetParameters parameters{.answer = answer, .request_time = 2 * kTick};
    SCOPED_TRACE(static_cast<int>(answer));
    const bool needs_call = answer == Answer::kBeginResponse;
    if (!needs_call) {
      EXPECT_EQ(seen({}, parameters), "fine");
      EXPECT_EQ(seen({.answer = tlm::TLM_UPDATED, .answer_phase = tlm::END_RESP}, parameters),
                "fine");
    }
    if (answer != Answer::kComplete) {
      EXPECT_EQ(seen({.answer = tlm::TLM_ACCEPTED, .end_calls = 1}, parameters), "fine");
      EXPECT_EQ(seen({.answer = tlm::TLM_ACCEPTED}, parameters), "open");
    }
  }
  EXPECT_EQ(seen({.second = true}, {.answer = Answer::kEndRequest}), "fine");
}

TEST(ProtocolTarget, IgnoresEndsThatItDoesNotAccept) {
  EXPECT_EQ(seen({}, {.accepts = {.completed = false}}), "open");
  EXPECT_EQ(seen({.answer = tlm::TLM_UPDATED, .answer_phase = tlm::END_RESP},
                 {.accepts = {.updated = false}}),
            "open");
  EXPECT_EQ(seen({.answer = tlm::TLM_ACCEPTED, .end_calls = 1}, {.accepts = {.call = false}}),
            "open");
}

TEST(ProtocolTarget, DetectsEachViolation) {
  const auto expect = [](const Script& script, const std::string& what,
                         const ProtocolTargetParameters& parameters = {}) {
    EXPECT_THAT(seen(script, parameters), testing::HasSubstr(what));
  };
  const ProtocolTargetParameters slow{.request_time = 5 * kTick};
  // Requests.
  expect({.second = true, .next = 4 * kTick}, "BEGIN_REQ before the last request has ended", slow);
  expect({.second = true, .next = 4 * kTick}, "BEGIN_REQ before the last request has ended",
         {.answer = Answer::kEndRequest, .request_time = 5 * kTick});
  expect({.second = true, .next = kTick}, "BEGIN_REQ before the last request has ended",
         {.answer = Answer::kNoEndRequest});
  expect({.second = true, .next = 19 * kTick}, "BEGIN_REQ before the last request has ended",
         {.answer = Answer::kComplete});
  expect({.again = true}, "BEGIN_REQ of a transaction that is under way");
  // Payloads.
  using Payload = tlm::tlm_generic_payload;
  expect({.spoil = [](Payload& p) { p.set_command(tlm::TLM_IGNORE_COMMAND); }}, "no command");
  expect({.spoil = [](Payload& p) { p.set_data_ptr(nullptr); }, .end_calls = 0}, "no data");
  expect({.spoil = [](Payload& p) { p.set_streaming_width(0); }}, "streaming width 0");
  expect({.spoil =
              [](Payload& p) {
                p.set_byte_enable_ptr(p.get_data_ptr());
                p.set_byte_enable_length(0);
              }},
         "byte enables of length 0");
  expect({.spoil = [](Payload& p) { p.set_response_status(tlm::TLM_OK_RESPONSE); }},
         "BEGIN_REQ with a response status");
  expect({.spoil = [](Payload& p) { p.set_dmi_allowed(true); }}, "direct memory allowed");
  expect({.spoil = [](Payload& p) { p.set_mm(nullptr); }}, "without memory manager");
  expect({.spoil = [](Payload& p) { p.release(); }}, "the initiator holds no reference");
  expect({.disturb = [](Payload& p) { p.set_address(128); }}, "attributes changed");
  expect({.disturb = [](Payload& p) { p.release(); }}, "released its reference");
  // Ends.
  expect({.answer = tlm::TLM_ACCEPTED, .end_calls = 2}, "END_RESP of a transaction that has ended");
  expect({.answer = tlm::TLM_UPDATED, .answer_phase = tlm::END_RESP, .end_calls = 1},
         "END_RESP of a transaction that has ended");
  expect({.answer = tlm::TLM_COMPLETED, .end_calls = 1},
         "END_RESP of a transaction that has ended");
  expect({.early_end = true}, "END_RESP before BEGIN_RESP");
  expect({.end_calls = 1, .past_end = true}, "END_RESP earlier than BEGIN_RESP",
         {.answer = Answer::kBeginResponse});
  expect({.strange_phase = true}, "phase END_REQ from an initiator");
  // Answers.
  expect({.answer_end_request = tlm::TLM_COMPLETED}, "END_REQ was answered");
  expect({.answer = tlm::TLM_UPDATED}, "TLM_UPDATED without END_RESP");
  expect({.answer = tlm::TLM_ACCEPTED, .answer_phase = tlm::END_RESP}, "with another phase");
  expect({.turn_back = true}, "answered in the past", {.answer = Answer::kAnnotated});
}

}  // namespace
}  // namespace deburr::tb::protocol_target_test
