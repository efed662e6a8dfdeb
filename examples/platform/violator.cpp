// SPDX-License-Identifier: MIT
#include "violator.h"

namespace platform {

using sc_core::sc_time;
using tlm::tlm_phase;
using tlm::tlm_sync_enum;

std::span<const ViolationInfo> violations() {
  using V = Violation;
  static constexpr ViolationInfo kAll[] = {
      {V::kTwoRequests, "two-requests", "request exclusion", false, false},
      {V::kSameRequest, "same-request", "phases", false, false},
      {V::kWrongPhase, "wrong-phase", "phases", false, false},
      {V::kNoManager, "no-manager", "memory manager", false, false},
      {V::kStatusSet, "status-set", "response status", false, false},
      {V::kNoData, "no-data", "attributes", false, false},
      {V::kEarlyEnd, "early-end", "phases", false, false},
      {V::kBlockingStatus, "blocking-status", "response status", false, true},
      {V::kBackwardRequest, "backward-request", "phases", true, false},
      {V::kTwoResponses, "two-responses", "response exclusion", true, false},
      {V::kSameResponse, "same-response", "phases", true, false},
      {V::kIncomplete, "incomplete", "response status", true, false},
      {V::kChangedLength, "changed-length", "attributes", true, false},
      {V::kAcceptedUpdate, "accepted-update", "return", true, false},
      {V::kWrongReturn, "wrong-return", "return", true, false},
      {V::kPast, "past", "timing", true, false},
      {V::kBlockingIncomplete, "blocking-incomplete", "response status", true, true},
      {V::kBlockingPast, "blocking-past", "timing", true, true},
      {V::kDebugTooMuch, "debug-too-much", "debug", true, true},
      {V::kDirectElsewhere, "direct-elsewhere", "direct memory", true, true}};
  return kAll;
}

Violator::Violator(const sc_core::sc_module_name& name, Violation violation)
    : sc_module(name), violation_(violation) {
  from_initiator.register_nb_transport_fw(this, &Violator::forward);
  from_initiator.register_b_transport(this, &Violator::b_transport);
  from_initiator.register_transport_dbg(this, &Violator::transport_dbg);
  from_initiator.register_get_direct_mem_ptr(this, &Violator::get_direct_mem_ptr);
  to_target.register_nb_transport_bw(this, &Violator::backward);
  for (Payload* payload : {&own_, &own_without_manager_}) {
    payload->set_command(tlm::TLM_READ_COMMAND);
    payload->set_data_ptr(data_);
    payload->set_data_length(64);
    payload->set_streaming_width(64);
  }
  own_.acquire();
}

bool Violator::now(Violation violation) {
  // The third opportunity, when transactions are already in progress.
  if (violation != violation_ || ++seen_ != 3) return false;
  violation_ = Violation::kNone;
  return true;
}

Violator::Payload* Violator::another(const Payload& payload) const {
  for (Payload* other : in_flight_)
    if (other != &payload) return other;
  return nullptr;
}

void Violator::send(Payload& payload, const tlm_phase& phase, const sc_time& delay) {
  tlm_phase sent = phase;
  sc_time when = delay;
  to_target->nb_transport_fw(payload, sent, when);
}

tlm_sync_enum Violator::forward(Payload& payload, tlm_phase& phase, sc_time& delay) {
  using V = Violation;
  if (phase != tlm::BEGIN_REQ) return to_target->nb_transport_fw(payload, phase, delay);
  in_flight_.insert(&payload);
  own_.set_address(payload.get_address());
  if (now(V::kNoManager)) send(own_without_manager_, tlm::BEGIN_REQ, delay);
  if (now(V::kStatusSet)) payload.set_response_status(tlm::TLM_OK_RESPONSE);
  if (now(V::kNoData)) payload.set_data_ptr(nullptr);
  if (now(V::kAcceptedUpdate)) {
    phase = tlm::END_REQ;
    return tlm::TLM_ACCEPTED;
  }
  if (now(V::kWrongReturn)) {
    phase = tlm::END_RESP;
    return tlm::TLM_UPDATED;
  }
  const tlm_sync_enum status = to_target->nb_transport_fw(payload, phase, delay);
  if (now(V::kTwoRequests)) send(own_, tlm::BEGIN_REQ, delay);
  if (now(V::kSameRequest)) send(payload, tlm::BEGIN_REQ, delay);
  if (now(V::kWrongPhase)) send(payload, tlm::END_REQ, delay);
  if (now(V::kEarlyEnd)) send(payload, tlm::END_RESP, delay);
  return status;
}

tlm_sync_enum Violator::backward(Payload& payload, tlm_phase& phase, sc_time& delay) {
  using V = Violation;
  Payload* second = nullptr;  // that begins its response right after this one
  if (phase == tlm::BEGIN_RESP) {
    in_flight_.erase(&payload);
    if (now(V::kIncomplete)) payload.set_response_status(tlm::TLM_INCOMPLETE_RESPONSE);
    if (now(V::kChangedLength)) payload.set_data_length(payload.get_data_length() / 2);
    if (now(V::kSameResponse)) second = &payload;
    if (another(payload) && now(V::kTwoResponses)) second = another(payload);
    if (now(V::kBackwardRequest)) phase = tlm::BEGIN_REQ;
  } else if (now(V::kPast)) {
    delay += sc_time(1, sc_core::SC_US);  // END_REQ, before which the response will come
  }
  const tlm_sync_enum status = from_initiator->nb_transport_bw(payload, phase, delay);
  if (second) {
    second->set_response_status(tlm::TLM_OK_RESPONSE);
    tlm_phase begin = tlm::BEGIN_RESP;
    sc_time when;
    from_initiator->nb_transport_bw(*second, begin, when);
  }
  return status;
}

void Violator::b_transport(Payload& payload, sc_time& delay) {
  using V = Violation;
  if (now(V::kBlockingStatus)) payload.set_response_status(tlm::TLM_OK_RESPONSE);
  to_target->b_transport(payload, delay);
  if (now(V::kBlockingIncomplete)) payload.set_response_status(tlm::TLM_INCOMPLETE_RESPONSE);
  if (delay > sc_core::SC_ZERO_TIME && now(V::kBlockingPast)) delay = sc_core::SC_ZERO_TIME;
}

unsigned Violator::transport_dbg(Payload& payload) {
  const unsigned done = to_target->transport_dbg(payload);
  return violation_ == Violation::kDebugTooMuch ? payload.get_data_length() + 1 : done;
}

bool Violator::get_direct_mem_ptr(Payload& payload, tlm::tlm_dmi& dmi) {
  if (violation_ != Violation::kDirectElsewhere) return to_target->get_direct_mem_ptr(payload, dmi);
  dmi.set_dmi_ptr(data_);
  dmi.set_start_address(payload.get_address() + 64);
  dmi.set_end_address(payload.get_address() + 127);
  dmi.allow_read_write();
  return true;
}

}  // namespace platform
