// SPDX-License-Identifier: MIT
// Sits between an initiator and a target, forwards everything, and checks both against the base
// protocol of TLM-2.0 (IEEE 1666-2011, 11 to 16). A violation ends the simulation with
// deburr::spec::SimulationError, which names the checker and the rule.
//
// It counts the transactions that it forwards.
#pragma once

#include <tlm_utils/simple_initiator_socket.h>
#include <tlm_utils/simple_target_socket.h>

#include <cstdint>
#include <map>
#include <string>
#include <systemc>
#include <tlm>

namespace platform {

class ProtocolChecker final : public sc_core::sc_module {
 public:
  tlm_utils::simple_target_socket<ProtocolChecker> from_initiator{"from_initiator"};
  tlm_utils::simple_initiator_socket<ProtocolChecker> to_target{"to_target"};

  explicit ProtocolChecker(const sc_core::sc_module_name& name);

  // True when every transaction that began has ended.
  void check_finished() const;
  std::uint64_t blocking() const { return blocking_; }
  std::uint64_t non_blocking() const { return non_blocking_; }
  std::uint64_t bytes() const { return bytes_; }
  std::uint64_t most_in_flight() const { return most_; }

 private:
  using Payload = tlm::tlm_generic_payload;
  // Attributes that a target must not change. An interconnect may change the address, which then
  // belongs to the next hop.
  struct Attributes {
    explicit Attributes(const Payload& payload);
    friend bool operator==(const Attributes&, const Attributes&) = default;
    tlm::tlm_command command;
    const unsigned char *data, *enables;
    unsigned length, enables_length, width;
  };
  enum class Stage { kRequest, kRequestEnded, kResponse };
  struct Transaction {
    Attributes attributes;
    Stage stage = Stage::kRequest;
    sc_core::sc_time last;  // of its last phase, in effective local time
  };

  tlm::tlm_sync_enum forward(Payload& payload, tlm::tlm_phase& phase, sc_core::sc_time& delay);
  tlm::tlm_sync_enum backward(Payload& payload, tlm::tlm_phase& phase, sc_core::sc_time& delay);
  void b_transport(Payload& payload, sc_core::sc_time& delay);
  unsigned transport_dbg(Payload& payload);
  bool get_direct_mem_ptr(Payload& payload, tlm::tlm_dmi& dmi);
  void invalidate(sc_dt::uint64 from, sc_dt::uint64 to);

  void check_request(const Payload& payload);
  void check_response(const Payload& payload);
  void take(Payload& payload, const tlm::tlm_phase& phase, const sc_core::sc_time& delay);
  void returned(Payload& payload, tlm::tlm_sync_enum status, const tlm::tlm_phase& sent,
                const tlm::tlm_phase& phase, const sc_core::sc_time& sent_delay,
                const sc_core::sc_time& delay);
  void finish(Payload& payload);
  void require(bool holds, const char* rule, const Payload& payload, const std::string& what) const;

  std::map<const Payload*, Transaction> transactions_;
  const Payload* requesting_ = nullptr;
  const Payload* responding_ = nullptr;
  std::uint64_t blocking_ = 0, non_blocking_ = 0, bytes_ = 0, most_ = 0;
};

}  // namespace platform
