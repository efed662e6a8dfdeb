// SPDX-License-Identifier: MIT
// Breaks one rule of the base protocol, once, between an initiator and its checker (or a checker
// and its target), so that the checker can be seen to notice.
#pragma once

#include <tlm_utils/simple_initiator_socket.h>
#include <tlm_utils/simple_target_socket.h>

#include <set>
#include <span>
#include <string>
#include <systemc>
#include <tlm>

namespace platform {

enum class Violation {
  kNone,
  // By the initiator.
  kTwoRequests,     // BEGIN_REQ before END_REQ
  kSameRequest,     // BEGIN_REQ of a transaction that is under way
  kWrongPhase,      // END_REQ from an initiator
  kNoManager,       // a payload without memory manager
  kStatusSet,       // a request with a response status
  kNoData,          // no data
  kEarlyEnd,        // END_RESP before BEGIN_RESP
  kBlockingStatus,  // the same by b_transport
  // By the target.
  kBackwardRequest,  // BEGIN_REQ from a target
  kTwoResponses,     // BEGIN_RESP before END_RESP
  kSameResponse,     // BEGIN_RESP of a transaction that is over
  kIncomplete,       // a response without status
  kChangedLength,    // an attribute that is the initiator's
  kAcceptedUpdate,   // TLM_ACCEPTED with another phase
  kWrongReturn,      // BEGIN_REQ answered with END_RESP
  kPast,             // a phase before the one before it
  kBlockingIncomplete,
  kBlockingPast,
  kDebugTooMuch,
  kDirectElsewhere  // direct memory without the address
};

struct ViolationInfo {
  Violation violation;
  const char* name;
  const char* rule;  // by which the checker names it
  bool by_target;
  bool by_software;  // a call of software's, else of an engine's
};
std::span<const ViolationInfo> violations();

class Violator final : public sc_core::sc_module {
 public:
  tlm_utils::simple_target_socket<Violator> from_initiator{"from_initiator"};
  tlm_utils::simple_initiator_socket<Violator> to_target{"to_target"};

  Violator(const sc_core::sc_module_name& name, Violation violation);

 private:
  using Payload = tlm::tlm_generic_payload;
  struct Manager : tlm::tlm_mm_interface {
    void free(Payload*) override {}
  };
  tlm::tlm_sync_enum forward(Payload& payload, tlm::tlm_phase& phase, sc_core::sc_time& delay);
  tlm::tlm_sync_enum backward(Payload& payload, tlm::tlm_phase& phase, sc_core::sc_time& delay);
  void b_transport(Payload& payload, sc_core::sc_time& delay);
  unsigned transport_dbg(Payload& payload);
  bool get_direct_mem_ptr(Payload& payload, tlm::tlm_dmi& dmi);
  // Of those that wait for their response.
  Payload* another(const Payload& payload) const;
  void send(Payload& payload, const tlm::tlm_phase& phase, const sc_core::sc_time& delay);
  // Whether it is the turn of this violation, which then is over.
  bool now(Violation violation);

  Violation violation_;
  int seen_ = 0;  // chances to break the rule
  std::set<Payload*> in_flight_;
  Manager manager_;
  unsigned char data_[64] = {};
  Payload own_{&manager_}, own_without_manager_;
};

}  // namespace platform
