// SPDX-License-Identifier: MIT
#include "protocol_checker.h"

#include <algorithm>
#include <sstream>

#include "spec/error.h"

namespace platform {

using sc_core::sc_time;
using sc_core::sc_time_stamp;
using tlm::tlm_phase;
using tlm::tlm_sync_enum;

namespace {

std::string word(const tlm_phase& phase) { return phase.get_name(); }

}  // namespace

ProtocolChecker::ProtocolChecker(const sc_core::sc_module_name& name) : sc_module(name) {
  from_initiator.register_nb_transport_fw(this, &ProtocolChecker::forward);
  from_initiator.register_b_transport(this, &ProtocolChecker::b_transport);
  from_initiator.register_transport_dbg(this, &ProtocolChecker::transport_dbg);
  from_initiator.register_get_direct_mem_ptr(this, &ProtocolChecker::get_direct_mem_ptr);
  to_target.register_nb_transport_bw(this, &ProtocolChecker::backward);
  to_target.register_invalidate_direct_mem_ptr(this, &ProtocolChecker::invalidate);
}

ProtocolChecker::Attributes::Attributes(const Payload& payload)
    : command(payload.get_command()),
      data(payload.get_data_ptr()),
      enables(payload.get_byte_enable_ptr()),
      length(payload.get_data_length()),
      enables_length(payload.get_byte_enable_length()),
      width(payload.get_streaming_width()) {}

void ProtocolChecker::require(bool holds, const char* rule, const Payload& payload,
                              const std::string& what) const {
  if (holds) return;
  std::ostringstream text;
  text << name() << ": " << rule << ": " << what << " (address 0x" << std::hex
       << payload.get_address() << ", at " << sc_time_stamp() << ")";
  throw deburr::spec::SimulationError(text.str());
}

void ProtocolChecker::check_finished() const {
  for (const auto& [payload, transaction] : transactions_)
    require(false, "unfinished", *payload, "the transaction was never ended");
}

// ---- attributes of every transaction, of its request and of its response ----

void ProtocolChecker::check_request(const Payload& payload) {
  require(payload.get_data_ptr() && payload.get_data_length() > 0, "attributes", payload,
          "no data");
  require(payload.get_streaming_width() > 0, "attributes", payload, "streaming width 0");
  require(!payload.get_byte_enable_ptr() || payload.get_byte_enable_length() > 0, "attributes",
          payload, "byte enables of length 0");
  require(payload.get_response_status() == tlm::TLM_INCOMPLETE_RESPONSE, "response status", payload,
          "a request comes with " + payload.get_response_string());
  require(!payload.is_dmi_allowed(), "attributes", payload, "a request allows direct memory");
}

void ProtocolChecker::check_response(const Payload& payload) {
  require(payload.get_response_status() != tlm::TLM_INCOMPLETE_RESPONSE, "response status", payload,
          "the response is TLM_INCOMPLETE_RESPONSE");
}

// ---- blocking ----

void ProtocolChecker::b_transport(Payload& payload, sc_time& delay) {
  check_request(payload);
  const Attributes before(payload);
  const sc_time begun = sc_time_stamp() + delay;
  to_target->b_transport(payload, delay);
  require(Attributes(payload) == before, "attributes", payload, "the target changed them");
  require(sc_time_stamp() + delay >= begun, "timing", payload, "b_transport ended before it began");
  check_response(payload);
  ++blocking_;
  bytes_ += payload.get_data_length();
}

// ---- non-blocking ----

// A phase in either direction, by call or by return value.
void ProtocolChecker::take(Payload& payload, const tlm_phase& phase, const sc_time& delay) {
  const sc_time when = sc_time_stamp() + delay;
  const auto found = transactions_.find(&payload);
  if (phase == tlm::BEGIN_REQ) {
    require(found == transactions_.end(), "phases", payload,
            "BEGIN_REQ of a transaction that is under way");
    require(payload.has_mm(), "memory manager", payload, "the payload has no memory manager");
    require(payload.get_ref_count() > 0, "memory manager", payload,
            "the initiator holds no reference");
    check_request(payload);
    require(!requesting_, "request exclusion", payload,
            "BEGIN_REQ before the last request was ended");
    requesting_ = &payload;
    transactions_.emplace(&payload, Transaction{Attributes(payload), Stage::kRequest, when});
    most_ = std::max<std::uint64_t>(most_, transactions_.size());
    return;
  }
  require(found != transactions_.end(), "phases", payload,
          word(phase) + " of a transaction that is not under way");
  Transaction& transaction = found->second;
  require(Attributes(payload) == transaction.attributes, "attributes", payload,
          "they changed before " + word(phase));
  require(when >= transaction.last, "timing", payload,
          word(phase) + " is earlier than the phase before it");
  transaction.last = when;
  if (phase == tlm::END_REQ) {
    require(transaction.stage == Stage::kRequest, "phases", payload, "a second END_REQ");
    transaction.stage = Stage::kRequestEnded;
    requesting_ = nullptr;
  } else if (phase == tlm::BEGIN_RESP) {
    require(transaction.stage != Stage::kResponse, "phases", payload, "a second BEGIN_RESP");
    require(!responding_, "response exclusion", payload,
            "BEGIN_RESP before the last response was ended");
    check_response(payload);
    if (requesting_ == &payload) requesting_ = nullptr;
    responding_ = &payload;
    transaction.stage = Stage::kResponse;
  } else {
    require(phase == tlm::END_RESP, "phases", payload,
            word(phase) + " is not a phase of the protocol");
    require(transaction.stage == Stage::kResponse, "phases", payload, "END_RESP before BEGIN_RESP");
    finish(payload);
  }
}

void ProtocolChecker::finish(Payload& payload) {
  if (requesting_ == &payload) requesting_ = nullptr;
  if (responding_ == &payload) responding_ = nullptr;
  transactions_.erase(&payload);
  ++non_blocking_;
  bytes_ += payload.get_data_length();
}

// The return value of an nb_transport call.
void ProtocolChecker::returned(Payload& payload, tlm_sync_enum status, const tlm_phase& sent,
                               const tlm_phase& phase, const sc_time& sent_delay,
                               const sc_time& delay) {
  const bool over = sent == tlm::END_RESP;
  if (status == tlm::TLM_ACCEPTED) {
    require(phase == sent && delay == sent_delay, "return", payload,
            "TLM_ACCEPTED with another phase or delay");
  } else if (status == tlm::TLM_COMPLETED) {
    require(delay >= sent_delay, "timing", payload, "TLM_COMPLETED in the past");
    require(sent != tlm::END_REQ, "return", payload, "END_REQ was answered with TLM_COMPLETED");
    if (over) return;
    check_response(payload);
    require(transactions_.count(&payload) > 0, "return", payload, "completed twice");
    require(Attributes(payload) == transactions_.at(&payload).attributes, "attributes", payload,
            "they changed before TLM_COMPLETED");
    finish(payload);
  } else {
    const bool legal = sent == tlm::BEGIN_REQ ? phase == tlm::END_REQ || phase == tlm::BEGIN_RESP
                                              : sent == tlm::BEGIN_RESP && phase == tlm::END_RESP;
    require(legal, "return", payload, word(sent) + " was answered with " + word(phase));
    take(payload, phase, delay);
  }
}

tlm_sync_enum ProtocolChecker::forward(Payload& payload, tlm_phase& phase, sc_time& delay) {
  require(phase == tlm::BEGIN_REQ || phase == tlm::END_RESP, "phases", payload,
          word(phase) + " from an initiator");
  take(payload, phase, delay);
  const tlm_phase sent = phase;
  const sc_time sent_delay = delay;
  const tlm_sync_enum status = to_target->nb_transport_fw(payload, phase, delay);
  returned(payload, status, sent, phase, sent_delay, delay);
  return status;
}

tlm_sync_enum ProtocolChecker::backward(Payload& payload, tlm_phase& phase, sc_time& delay) {
  require(phase == tlm::END_REQ || phase == tlm::BEGIN_RESP, "phases", payload,
          word(phase) + " from a target");
  take(payload, phase, delay);
  const tlm_phase sent = phase;
  const sc_time sent_delay = delay;
  const tlm_sync_enum status = from_initiator->nb_transport_bw(payload, phase, delay);
  returned(payload, status, sent, phase, sent_delay, delay);
  return status;
}

// ---- debug and direct memory ----

unsigned ProtocolChecker::transport_dbg(Payload& payload) {
  const unsigned done = to_target->transport_dbg(payload);
  require(done <= payload.get_data_length(), "debug", payload,
          "more bytes than requested: " + std::to_string(done));
  return done;
}

bool ProtocolChecker::get_direct_mem_ptr(Payload& payload, tlm::tlm_dmi& dmi) {
  const bool given = to_target->get_direct_mem_ptr(payload, dmi);
  if (!given) return false;
  const std::uint64_t address = payload.get_address();
  require(dmi.get_dmi_ptr() != nullptr, "direct memory", payload, "no pointer");
  require(dmi.get_start_address() <= address && address <= dmi.get_end_address(), "direct memory",
          payload, "the requested address is outside the returned range");
  require(payload.is_read() ? dmi.is_read_allowed() : dmi.is_write_allowed(), "direct memory",
          payload, "the requested access is not allowed");
  return true;
}

void ProtocolChecker::invalidate(sc_dt::uint64 from, sc_dt::uint64 to) {
  from_initiator->invalidate_direct_mem_ptr(from, to);
}

}  // namespace platform
