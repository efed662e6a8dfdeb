// SPDX-License-Identifier: MIT
// Memory front end for tests: a TLM-2.0 target that answers in a chosen legal style of the base
// protocol and checks that the initiator follows the protocol.
//
//   engine ─► ProtocolTarget ─► MemoryModel (b_transport: data, status and latency)
//
// Everything that it sends is legal: a response begins only when the previous one has ended. A
// target must accept every way of ending a response that the protocol allows, but many do not.
// `AcceptedEnds` models a target that ignores some of them: the response then stays open, and no
// other response begins.
#pragma once

#include <tlm_utils/peq_with_cb_and_phase.h>
#include <tlm_utils/simple_initiator_socket.h>
#include <tlm_utils/simple_target_socket.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <systemc>
#include <tlm>
#include <vector>

namespace deburr::tb {

enum class Answer : std::uint8_t {
  kFourPhases,     // END_REQ and BEGIN_RESP by calls
  kEndRequest,     // END_REQ as return from BEGIN_REQ, BEGIN_RESP by a call
  kNoEndRequest,   // BEGIN_RESP by a call, which also ends the request
  kAnnotated,      // as kNoEndRequest, but called early with an annotated delay
  kBeginResponse,  // BEGIN_RESP as return from BEGIN_REQ; END_RESP must be a call
  kComplete        // TLM_COMPLETED from BEGIN_REQ
};

// Accepted ways to end a response that was begun by a call.
struct AcceptedEnds {
  bool updated = true;    // TLM_UPDATED with END_RESP
  bool completed = true;  // TLM_COMPLETED
  bool call = true;       // TLM_ACCEPTED, and END_RESP by a call
};

struct ProtocolTargetParameters {
  Answer answer = Answer::kFourPhases;
  AcceptedEnds accepts{};
  sc_core::sc_time request_time{};  // from BEGIN_REQ to END_REQ, if END_REQ is sent
};

class ProtocolTarget final : public sc_core::sc_module {
 public:
  tlm_utils::simple_target_socket<ProtocolTarget> socket{"socket"};
  tlm_utils::simple_initiator_socket<ProtocolTarget> memory{"memory"};

  ProtocolTarget(const sc_core::sc_module_name& name, const ProtocolTargetParameters& parameters);

  std::uint64_t begun() const { return begun_times_.size(); }
  std::uint64_t ended() const { return ended_; }
  const std::vector<sc_core::sc_time>& begun_times() const { return begun_times_; }
  // Protocol violations by the initiator, one sentence each.
  const std::vector<std::string>& violations() const { return violations_; }
  // Number of payloads to which someone still holds a reference. The initiator must still own all
  // of them.
  std::size_t referenced() const;

 private:
  SC_HAS_PROCESS(ProtocolTarget);
  struct Attributes {
    tlm::tlm_command command;
    std::uint64_t address;
    const unsigned char *data, *enables;
    unsigned length, width, enables_length;
    friend bool operator==(const Attributes&, const Attributes&) = default;
  };
  struct Transaction {
    Attributes attributes;
    sc_core::sc_time latency;
    bool responding = false;
  };
  using Payload = tlm::tlm_generic_payload;

  static Attributes attributes_of(const Payload& payload);
  tlm::tlm_sync_enum forward(Payload& payload, tlm::tlm_phase& phase, sc_core::sc_time& delay);
  tlm::tlm_sync_enum begin(Payload& payload, tlm::tlm_phase& phase, sc_core::sc_time& delay);
  bool check_payload(const Payload& payload);
  void check_unchanged(const Payload& payload, const Transaction& transaction);
  void due(Payload& payload, const tlm::tlm_phase& phase);
  void respond();
  void begin_response(Payload& payload);
  void end_response(Payload& payload, const sc_core::sc_time& when);
  void forget(Payload& payload);
  void complain(const Payload& payload, const std::string& what);

  ProtocolTargetParameters parameters_;
  tlm_utils::peq_with_cb_and_phase<ProtocolTarget> queue_{this, &ProtocolTarget::due};
  // From BEGIN_REQ to the end of the transaction.
  std::map<const Payload*, Transaction> transactions_;
  std::set<const Payload*> seen_;
  const Payload* requesting_ = nullptr;  // BEGIN_REQ without END_REQ
  Payload* responding_ = nullptr;        // BEGIN_RESP without END_RESP
  std::deque<Payload*> ready_;           // waiting for their response phase
  sc_core::sc_time request_free_, response_free_, response_begun_;
  sc_core::sc_event response_may_begin_;
  std::vector<sc_core::sc_time> begun_times_;
  std::uint64_t ended_ = 0;
  std::vector<std::string> violations_;
};

}  // namespace deburr::tb
