// SPDX-License-Identifier: MIT
#include "tb/harness/protocol_target.h"

#include <fmt/format.h>

#include <algorithm>

namespace deburr::tb {
namespace {

using sc_core::sc_time;
using sc_core::SC_ZERO_TIME;

sc_time now() { return sc_core::sc_time_stamp(); }

}  // namespace

ProtocolTarget::ProtocolTarget(const sc_core::sc_module_name& name,
                               const ProtocolTargetParameters& parameters)
    : sc_module(name), parameters_(parameters) {
  socket.register_nb_transport_fw(this, &ProtocolTarget::forward);
  SC_METHOD(respond);
  sensitive << response_may_begin_;
  dont_initialize();
}

std::size_t ProtocolTarget::referenced() const {
  return static_cast<std::size_t>(
      std::count_if(seen_.begin(), seen_.end(),
                    [](const Payload* payload) { return payload->get_ref_count() > 0; }));
}

void ProtocolTarget::complain(const Payload& payload, const std::string& what) {
  violations_.push_back(
      fmt::format("{}: address {:#x}: {}", now().to_string(), payload.get_address(), what));
}

ProtocolTarget::Attributes ProtocolTarget::attributes_of(const Payload& payload) {
  return {payload.get_command(),           payload.get_address(),     payload.get_data_ptr(),
          payload.get_byte_enable_ptr(),   payload.get_data_length(), payload.get_streaming_width(),
          payload.get_byte_enable_length()};
}

// ---- initiator to target -------------------------------------------------------------------

tlm::tlm_sync_enum ProtocolTarget::forward(Payload& payload, tlm::tlm_phase& phase,
                                           sc_time& delay) {
  if (phase == tlm::BEGIN_REQ) return begin(payload, phase, delay);
  if (phase != tlm::END_RESP) {
    complain(payload, fmt::format("phase {} from an initiator", phase.get_name()));
    return tlm::TLM_ACCEPTED;
  }
  const auto found = transactions_.find(&payload);
  if (found == transactions_.end()) {
    complain(payload, "END_RESP of a transaction that has ended");
  } else if (!found->second.responding) {
    complain(payload, "END_RESP before BEGIN_RESP");
  } else {
    if (now() + delay < response_begun_) complain(payload, "END_RESP earlier than BEGIN_RESP");
    if (parameters_.accepts.call || parameters_.answer == Answer::kBeginResponse)
      end_response(payload, now() + delay);
  }
  return tlm::TLM_COMPLETED;
}

// Returns false for an invalid request.
bool ProtocolTarget::check_payload(const Payload& payload) {
  const std::size_t before = violations_.size();
  if (!payload.has_mm())
    complain(payload, "a payload without memory manager");
  else if (payload.get_ref_count() < 1)
    complain(payload, "a payload to which the initiator holds no reference");
  if (payload.get_command() == tlm::TLM_IGNORE_COMMAND) complain(payload, "no command");
  if (!payload.get_data_ptr() || payload.get_data_length() == 0) complain(payload, "no data");
  if (payload.get_streaming_width() == 0) complain(payload, "streaming width 0");
  if (payload.get_byte_enable_ptr() && payload.get_byte_enable_length() == 0)
    complain(payload, "byte enables of length 0");
  if (payload.get_response_status() != tlm::TLM_INCOMPLETE_RESPONSE)
    complain(payload, "BEGIN_REQ with a response status");
  if (payload.is_dmi_allowed()) complain(payload, "BEGIN_REQ with direct memory allowed");
  return violations_.size() == before;
}

void ProtocolTarget::check_unchanged(const Payload& payload, const Transaction& transaction) {
  if (attributes_of(payload) != transaction.attributes)
    complain(payload, "attributes changed before the response");
  if (payload.get_ref_count() < 2)  // the target holds one reference itself
    complain(payload, "the initiator released its reference before the response");
}

tlm::tlm_sync_enum ProtocolTarget::begin(Payload& payload, tlm::tlm_phase& phase, sc_time& delay) {
  const sc_time when = now() + delay;
  if (transactions_.count(&payload)) {
    complain(payload, "BEGIN_REQ of a transaction that is under way");
    return tlm::TLM_ACCEPTED;
  }
  if (requesting_ || when < request_free_)
    complain(payload, "BEGIN_REQ before the last request has ended");
  if (!check_payload(payload)) return tlm::TLM_ACCEPTED;
  begun_times_.push_back(when);
  seen_.insert(&payload);
  payload.acquire();
  sc_time latency;
  Transaction& transaction = transactions_[&payload];
  transaction.attributes = attributes_of(payload);
  memory->b_transport(payload, latency);
  transaction.latency = latency;

  switch (parameters_.answer) {
    case Answer::kFourPhases:
      requesting_ = &payload;
      queue_.notify(payload, tlm::END_REQ, delay + parameters_.request_time);
      return tlm::TLM_ACCEPTED;
    case Answer::kEndRequest:
      request_free_ = when + parameters_.request_time;
      queue_.notify(payload, tlm::BEGIN_RESP, delay + std::max(latency, parameters_.request_time));
      phase = tlm::END_REQ;
      delay += parameters_.request_time;
      return tlm::TLM_UPDATED;
    case Answer::kNoEndRequest:
      requesting_ = &payload;
      queue_.notify(payload, tlm::BEGIN_RESP, delay + latency);
      return tlm::TLM_ACCEPTED;
    case Answer::kAnnotated:
      requesting_ = &payload;
      queue_.notify(payload, tlm::BEGIN_RESP, delay);
      return tlm::TLM_ACCEPTED;
    case Answer::kBeginResponse:
      phase = tlm::BEGIN_RESP;
      delay += latency;
      request_free_ = response_begun_ = now() + delay;
      transaction.responding = true;
      responding_ = &payload;
      return tlm::TLM_UPDATED;
    case Answer::kComplete:
      delay += latency;
      request_free_ = now() + delay;
      forget(payload);
      return tlm::TLM_COMPLETED;
  }
  return tlm::TLM_ACCEPTED;
}

// ---- target to initiator ---------------------------------------------------------------------

void ProtocolTarget::due(Payload& payload, const tlm::tlm_phase& when) {
  if (when == tlm::END_REQ) {
    requesting_ = nullptr;
    request_free_ = now();
    const sc_time latency = transactions_.at(&payload).latency;
    queue_.notify(payload, tlm::BEGIN_RESP, latency - std::min(latency, parameters_.request_time));
    tlm::tlm_phase phase = tlm::END_REQ;
    sc_time delay;
    if (socket->nb_transport_bw(payload, phase, delay) != tlm::TLM_ACCEPTED)
      complain(payload, "END_REQ was answered with more than TLM_ACCEPTED");
    return;
  }
  ready_.push_back(&payload);
  respond();
}

void ProtocolTarget::respond() {
  while (!ready_.empty() && !responding_) {
    if (response_free_ > now() && parameters_.answer != Answer::kAnnotated) {
      response_may_begin_.notify(response_free_ - now());
      return;
    }
    Payload& payload = *ready_.front();
    ready_.pop_front();
    begin_response(payload);
  }
}

void ProtocolTarget::begin_response(Payload& payload) {
  Transaction& transaction = transactions_.at(&payload);
  check_unchanged(payload, transaction);
  transaction.responding = true;
  responding_ = &payload;
  sc_time delay;
  if (parameters_.answer == Answer::kAnnotated)
    delay = std::max(transaction.latency, response_free_ - std::min(response_free_, now()));
  response_begun_ = now() + delay;
  if (requesting_ == &payload) {
    requesting_ = nullptr;
    request_free_ = response_begun_;
  }
  tlm::tlm_phase phase = tlm::BEGIN_RESP;
  const tlm::tlm_sync_enum status = socket->nb_transport_bw(payload, phase, delay);
  if (now() + delay < response_begun_) complain(payload, "BEGIN_RESP was answered in the past");
  switch (status) {
    case tlm::TLM_ACCEPTED:
      if (phase != tlm::BEGIN_RESP) complain(payload, "TLM_ACCEPTED with another phase");
      break;
    case tlm::TLM_UPDATED:
      if (phase != tlm::END_RESP)
        complain(payload, "BEGIN_RESP was answered with TLM_UPDATED without END_RESP");
      else if (parameters_.accepts.updated)
        end_response(payload, now() + delay);
      break;
    case tlm::TLM_COMPLETED:
      if (parameters_.accepts.completed) end_response(payload, now() + delay);
      break;
  }
}

void ProtocolTarget::end_response(Payload& payload, const sc_time& when) {
  responding_ = nullptr;
  response_free_ = when;
  forget(payload);
  if (!ready_.empty()) response_may_begin_.notify(when > now() ? when - now() : SC_ZERO_TIME);
}

void ProtocolTarget::forget(Payload& payload) {
  transactions_.erase(&payload);
  ++ended_;
  payload.release();
}

}  // namespace deburr::tb
