// SPDX-License-Identifier: MIT
// A bus for any number of initiators and targets, loosely and approximately timed. It keeps one
// request at a time per target and one response at a time per initiator, in order of arrival.
#pragma once

#include <tlm_utils/multi_passthrough_initiator_socket.h>
#include <tlm_utils/multi_passthrough_target_socket.h>
#include <tlm_utils/peq_with_cb_and_phase.h>

#include <cstdint>
#include <deque>
#include <map>
#include <systemc>
#include <tlm>
#include <vector>

namespace platform {

class Router final : public sc_core::sc_module {
 public:
  tlm_utils::multi_passthrough_target_socket<Router> initiators{"initiators"};
  tlm_utils::multi_passthrough_initiator_socket<Router> targets{"targets"};

  explicit Router(const sc_core::sc_module_name& name);
  // The address range of the next target that is bound. The target sees addresses from 0.
  void map(std::uint64_t base, std::uint64_t bytes) { map_.push_back({base, bytes}); }

 private:
  using Payload = tlm::tlm_generic_payload;
  struct Range {
    std::uint64_t base, bytes;
  };
  struct Route {
    int initiator, target;
    bool completed = false;  // by the target, which expects no END_RESP
  };
  struct Port {
    Payload* busy =
        nullptr;  // a target's request without END_REQ, an initiator's response without END_RESP
    std::deque<Payload*> waiting;
  };

  int target_of(const Payload& payload) const;  // -1: none
  tlm::tlm_sync_enum forward(int initiator, Payload& payload, tlm::tlm_phase& phase,
                             sc_core::sc_time& delay);
  tlm::tlm_sync_enum backward(int target, Payload& payload, tlm::tlm_phase& phase,
                              sc_core::sc_time& delay);
  void b_transport(int initiator, Payload& payload, sc_core::sc_time& delay);
  unsigned transport_dbg(int initiator, Payload& payload);
  bool get_direct_mem_ptr(int initiator, Payload& payload, tlm::tlm_dmi& dmi);
  void invalidate(int target, sc_dt::uint64 from, sc_dt::uint64 to);

  void due(Payload& payload, const tlm::tlm_phase& phase);
  void send_requests(int target);
  void send_responses(int initiator);

  std::vector<Range> map_;
  std::map<const Payload*, Route> routes_;
  std::map<int, Port> target_ports_, initiator_ports_;
  tlm_utils::peq_with_cb_and_phase<Router> queue_{this, &Router::due};
};

}  // namespace platform
