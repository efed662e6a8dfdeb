// SPDX-License-Identifier: MIT
#include "router.h"

namespace platform {

using sc_core::sc_time;
using tlm::tlm_phase;

Router::Router(const sc_core::sc_module_name& name) : sc_module(name) {
  initiators.register_nb_transport_fw(this, &Router::forward);
  initiators.register_b_transport(this, &Router::b_transport);
  initiators.register_transport_dbg(this, &Router::transport_dbg);
  initiators.register_get_direct_mem_ptr(this, &Router::get_direct_mem_ptr);
  targets.register_nb_transport_bw(this, &Router::backward);
  targets.register_invalidate_direct_mem_ptr(this, &Router::invalidate);
}

int Router::target_of(const Payload& payload) const {
  const std::uint64_t address = payload.get_address();
  for (std::size_t i = 0; i < map_.size(); ++i)
    if (address >= map_[i].base && address - map_[i].base < map_[i].bytes)
      return static_cast<int>(i);
  return -1;
}

// ---- loosely timed, debug, direct memory: forwarded to the target with its local address ----

void Router::b_transport(int, Payload& payload, sc_time& delay) {
  const int target = target_of(payload);
  if (target < 0) return payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
  const std::uint64_t address = payload.get_address();
  payload.set_address(address - map_[target].base);
  targets[target]->b_transport(payload, delay);
  payload.set_address(address);
}

unsigned Router::transport_dbg(int, Payload& payload) {
  const int target = target_of(payload);
  if (target < 0) return 0;
  const std::uint64_t address = payload.get_address();
  payload.set_address(address - map_[target].base);
  const unsigned done = targets[target]->transport_dbg(payload);
  payload.set_address(address);
  return done;
}

bool Router::get_direct_mem_ptr(int, Payload& payload, tlm::tlm_dmi& dmi) {
  const int target = target_of(payload);
  if (target < 0) return false;
  const std::uint64_t address = payload.get_address(), base = map_[target].base;
  payload.set_address(address - base);
  const bool given = targets[target]->get_direct_mem_ptr(payload, dmi);
  payload.set_address(address);
  dmi.set_start_address(dmi.get_start_address() + base);
  dmi.set_end_address(dmi.get_end_address() + base);
  return given;
}

void Router::invalidate(int target, sc_dt::uint64 from, sc_dt::uint64 to) {
  for (unsigned i = 0; i < initiators.size(); ++i)
    initiators[i]->invalidate_direct_mem_ptr(from + map_[target].base, to + map_[target].base);
}

// ---- approximately timed: every phase goes through one queue in time ----

tlm::tlm_sync_enum Router::forward(int initiator, Payload& payload, tlm_phase& phase,
                                   sc_time& delay) {
  if (phase == tlm::BEGIN_REQ) {
    const int target = target_of(payload);
    if (target < 0) {
      payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
      return tlm::TLM_COMPLETED;
    }
    payload.acquire();
    payload.set_address(payload.get_address() - map_[target].base);
    routes_[&payload] = {initiator, target};
  }
  queue_.notify(payload, phase, delay);
  return tlm::TLM_ACCEPTED;
}

tlm::tlm_sync_enum Router::backward(int, Payload& payload, tlm_phase& phase, sc_time& delay) {
  queue_.notify(payload, phase, delay);
  return tlm::TLM_ACCEPTED;
}

void Router::due(Payload& payload, const tlm_phase& phase) {
  const Route route = routes_.at(&payload);
  Port& target = target_ports_[route.target];
  Port& initiator = initiator_ports_[route.initiator];
  if (phase == tlm::BEGIN_REQ) {
    target.waiting.push_back(&payload);
    send_requests(route.target);
  } else if (phase == tlm::END_REQ) {
    target.busy = nullptr;
    tlm_phase end = tlm::END_REQ;
    sc_time now;
    initiators[route.initiator]->nb_transport_bw(payload, end, now);
    send_requests(route.target);
  } else if (phase == tlm::BEGIN_RESP) {
    initiator.waiting.push_back(&payload);
    send_responses(route.initiator);
    if (target.busy == &payload) {  // a response ends its request
      target.busy = nullptr;
      send_requests(route.target);
    }
  } else {  // END_RESP
    initiator.busy = nullptr;
    routes_.erase(&payload);
    if (!route.completed) {
      tlm_phase end = tlm::END_RESP;
      sc_time now;
      targets[route.target]->nb_transport_fw(payload, end, now);
    }
    payload.release();
    send_responses(route.initiator);
  }
}

void Router::send_requests(int number) {
  Port& target = target_ports_[number];
  while (!target.busy && !target.waiting.empty()) {
    Payload& payload = *(target.busy = target.waiting.front());
    target.waiting.pop_front();
    tlm_phase phase = tlm::BEGIN_REQ;
    sc_time delay;
    const tlm::tlm_sync_enum status = targets[number]->nb_transport_fw(payload, phase, delay);
    if (status == tlm::TLM_COMPLETED) {
      routes_.at(&payload).completed = true;
      phase = tlm::BEGIN_RESP;
    }
    if (status != tlm::TLM_ACCEPTED) queue_.notify(payload, phase, delay);
  }
}

void Router::send_responses(int number) {
  Port& initiator = initiator_ports_[number];
  while (!initiator.busy && !initiator.waiting.empty()) {
    Payload& payload = *(initiator.busy = initiator.waiting.front());
    initiator.waiting.pop_front();
    tlm_phase phase = tlm::BEGIN_RESP;
    sc_time delay;
    const tlm::tlm_sync_enum status = initiators[number]->nb_transport_bw(payload, phase, delay);
    if (status != tlm::TLM_ACCEPTED) queue_.notify(payload, tlm::END_RESP, delay);
  }
}

}  // namespace platform
