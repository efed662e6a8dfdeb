// SPDX-License-Identifier: MIT
// Breaks one rule of the base protocol once, between an initiator and its checker (or a checker and
// its target), to show that the checker detects it.
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
  kSameRequest,     // BEGIN_REQ of a transaction in progress
  kWrongPhase,      // END_REQ from an initiator
  kNoManager,       // a payload without memory manager
  kStatusSet,       // a request with a response status
  kNoData,          // no data
  kEarlyEnd,        // END_RESP before BEGIN_RESP
  kBlockingStatus,  // the same by b_transport
  // By the target.
  kBackwardRequest,  // BEGIN_REQ from a target
  kTwoResponses,     // BEGIN_RESP before END_RESP
  kSameResponse,     // BEGIN_RESP of a finished transaction
  kIncomplete,       // a response without status
  kChangedLength,    // an attribute that only the initiator may set
  kAcceptedUpdate,   // TLM_ACCEPTED with another phase
  kWrongReturn,      // BEGIN_REQ answered with END_RESP
  kPast,             // a phase earlier than the previous one
  kBlockingIncomplete,
  kBlockingPast,
  kDebugTooMuch,
  kDirectElsewhere  // direct memory without the address
};

struct ViolationInfo {
  Violation violation;
  const char* name;
  const char* rule;  // name in the checker's messages
  bool by_target;
  bool by_software;  // in a call of the software, else of an engine
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
  // Transactions that wait for their response.
  Payload* another(const Payload& payload) const;
  void send(Payload& payload, const tlm::tlm_phase& phase, const sc_core::sc_time& delay);
  // True if this violation is due now; it is then done.
  bool now(Violation violation);

  Violation violation_;
  int seen_ = 0;  // opportunities to break the rule
  std::set<Payload*> in_flight_;
  Manager manager_;
  unsigned char data_[64] = {};
  Payload own_{&manager_}, own_without_manager_;
};

}  // namespace platform
