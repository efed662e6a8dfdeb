// SPDX-License-Identifier: MIT
// Memory model: a TLM-2.0 target (base protocol) with configurable latency, bandwidth, banks and
// number of outstanding transactions, for any number of initiators. It counts bytes and records the
// order of line reads and writes, which is compared with the prediction of the golden model.
//
// A transaction that begins at time t in a free bank transfers its last byte at
//   t + latency + (bytes / bytes_per_cycle, rounded up, - 1) cycles,
// later if its bank or the data bus is busy. With random or listed latencies, responses can
// overtake each other. A read samples its data when it begins; a write updates the memory when its
// last byte arrives, so a read of a line before the response to its write returns the old data.
// b_transport() does both at once.
//
// With a fixed latency, transactions stay in order (unless banks are busy), so the response time is
// known when a request begins. The response is then sent immediately with that time as its delay,
// which saves one SystemC event per line. This requires that the initiator ended its previous
// response when it began, so it cannot hold back another. The data of such an early-answered write
// are applied before the next access to the contents; the payload keeps them until then.
#pragma once

#include <tlm_utils/multi_passthrough_target_socket.h>

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <queue>
#include <span>
#include <string>
#include <systemc>
#include <tlm>
#include <vector>

#include "rtl_model/platform/host.h"
#include "rtl_model/platform/memory_model_parameters.h"

namespace deburr::platform {

class MemoryModel final : public sc_core::sc_module, public HostMemory {
 public:
  tlm_utils::multi_passthrough_target_socket<MemoryModel> ports{"ports"};

  MemoryModel(const sc_core::sc_module_name& name, const sc_core::sc_time& clock_period,
              const MemoryModelParameters& parameters = {});

  // --- Contents at sc_time_stamp(), which does not advance while a clock domain runs on: access
  // them between runs ---
  // ConfigError if the range is outside the memory.
  void preload(std::uint64_t address, std::span<const std::uint8_t> data);
  std::vector<std::uint8_t> dump(std::uint64_t address, std::uint64_t bytes);
  using sc_module::dump;  // SystemC's own dump, to a stream
  // The same for a driver.
  void write(std::uint64_t address, std::span<const std::uint8_t> data) override {
    preload(address, data);
  }
  std::vector<std::uint8_t> read(std::uint64_t address, std::uint64_t bytes) override {
    return dump(address, bytes);
  }
  std::uint64_t size() const override { return contents_.size(); }

  // --- Injected errors; requests are numbered from 0 in the order of arrival ---
  void fail_range(std::uint64_t from, std::uint64_t to,
                  tlm::tlm_response_status status = tlm::TLM_ADDRESS_ERROR_RESPONSE);  // [from, to)
  void fail_request(std::uint64_t number,
                    tlm::tlm_response_status status = tlm::TLM_GENERIC_ERROR_RESPONSE);
  void lose_request(std::uint64_t number);  // never answered

  // --- Recorded traffic ---
  std::uint64_t reads() const { return reads_; }
  std::uint64_t writes() const { return writes_; }
  std::uint64_t bytes_read() const { return bytes_read_; }
  std::uint64_t bytes_written() const { return bytes_written_; }
  std::uint64_t errors() const { return errors_; }
  std::uint32_t max_outstanding() const { return most_outstanding_; }
  // Addresses in the order of requests; one per 64 bytes of a burst.
  const std::vector<std::uint64_t>& lines_read() const { return lines_read_; }
  const std::vector<std::uint64_t>& lines_written() const { return lines_written_; }
  // Discards the recorded addresses after a check.
  void forget_lines();
  // True if every request was answered and every write applied, except lost requests. Call between
  // runs, like the contents.
  bool at_rest() const;
  // Restarts the statistics; requests that are still withheld count as earlier ones.
  void clear_statistics();

 private:
  struct Request {
    tlm::tlm_generic_payload* payload;
    int port;
    std::uint64_t number;
    bool lost;
    bool writes_late;  // the data are applied when its last byte arrives
    bool counted;
  };
  enum class Step { kReady, kRespond };
  struct Event {
    std::uint64_t time;  // sc_time value
    std::uint64_t order;
    Step step;
    Request request;
    bool operator>(const Event& other) const {
      return time != other.time ? time > other.time : order > other.order;
    }
  };
  struct Port {
    bool responding = false;                   // BEGIN_RESP sent, END_RESP not yet seen
    bool ends_at_once = false;                 // its initiator ended the last response immediately
    std::deque<Request> responses;             // responses whose time has come
    tlm::tlm_generic_payload* held = nullptr;  // BEGIN_REQ seen, END_REQ withheld
  };
  // A write that was answered early. An interconnect may have changed the payload's address on the
  // way back.
  struct Landing {
    std::uint64_t time, address;
    tlm::tlm_generic_payload* payload;
  };
  SC_HAS_PROCESS(MemoryModel);
  void end_of_elaboration() override { ports_.resize(ports.size()); }

  tlm::tlm_sync_enum nb_transport_fw(int port, tlm::tlm_generic_payload& payload,
                                     tlm::tlm_phase& phase, sc_core::sc_time& delay);
  void b_transport(int port, tlm::tlm_generic_payload& payload, sc_core::sc_time& delay);
  unsigned transport_dbg(int port, tlm::tlm_generic_payload& payload);

  void serve();
  void begin(int port, tlm::tlm_generic_payload& payload, bool counted, std::uint64_t time,
             const sc_core::sc_time& delay);
  // Returns the time of the response if it may be sent early.
  std::optional<std::uint64_t> accept(Request request, std::uint64_t time);
  // Applies the early-answered writes that arrive before `end`.
  void land(std::uint64_t end);
  // For untimed access: applies writes that arrive before now and those whose response was taken.
  void land_answered();
  std::uint64_t take_bus(std::uint64_t ready, const tlm::tlm_generic_payload& payload);
  void settle(std::uint64_t time);
  void wake_for_held();
  void schedule(std::uint64_t time, Step step, const Request& request);
  void respond(int port);
  void send_response(int port, tlm::tlm_generic_payload& payload, sc_core::sc_time delay);
  void finished();
  Port& port_at(int port) { return ports_[static_cast<std::size_t>(port)]; }
  // Counts the request and sets the response status; admit() is false if no data may be
  // transferred.
  void count(const tlm::tlm_generic_payload& payload);
  bool admit(tlm::tlm_generic_payload& payload, std::uint64_t number, bool counted);
  // Reads or writes the contents.
  void transfer(tlm::tlm_generic_payload& payload, std::uint64_t address);
  std::uint64_t transfer_cycles(std::uint64_t bytes) const;
  std::uint32_t draw_latency(std::uint64_t number);

  MemoryModelParameters parameters_;
  std::uint64_t period_;
  std::uint64_t random_;  // random state of the latencies
  std::vector<std::uint8_t> contents_;
  struct Range {
    std::uint64_t from, to;
    tlm::tlm_response_status status;
  };
  std::vector<Range> failing_ranges_;
  std::map<std::uint64_t, tlm::tlm_response_status> failing_requests_;
  std::map<std::uint64_t, bool> lost_requests_;

  std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
  std::uint64_t order_ = 0, requests_ = 0;
  std::vector<std::uint64_t> bank_free_;
  std::uint64_t bus_free_ = 0;
  const bool ordered_;               // transactions stay in order
  std::deque<std::uint64_t> ahead_;  // times of pending early responses
  std::deque<Landing> landing_;      // the writes among them
  std::vector<Port> ports_;          // one per bound initiator
  std::deque<int> held_;             // ports with withheld requests, in order of arrival
  std::size_t uncounted_ = 0;        // number of the first of these that are not counted
  std::uint32_t outstanding_ = 0, most_outstanding_ = 0;
  sc_core::sc_event wake_;

  std::uint64_t reads_ = 0, writes_ = 0, bytes_read_ = 0, bytes_written_ = 0, errors_ = 0;
  std::vector<std::uint64_t> lines_read_, lines_written_;
};

}  // namespace deburr::platform
