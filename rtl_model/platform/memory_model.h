// SPDX-License-Identifier: MIT
// A memory: a TLM-2.0 target (base protocol) with latency, bandwidth, banks and a limit of
// outstanding transactions, all parameters; any number of initiators. It counts bytes and keeps the
// order of the lines that were read and written, which is compared with what the golden model
// predicts.
//
// A transaction that begins at time t and finds its bank free has its last byte at
//   t + latency + (bytes / bytes_per_cycle, rounded up, - 1) cycles,
// later if its bank or the data bus is busy. With a random latency responses overtake each other.
// A read takes its data when it begins, a write gives them up when its last byte is there: who
// reads a line before its write was answered gets the old one. b_transport() does both at once.
//
// With a fixed latency transactions keep their order (banks that are busy change it), so the time
// of a response is known when its request begins. It is then sent at once, with this time as its
// delay, which spares SystemC an event a line: to an initiator that ended the response before it as
// it began, and so holds back no other. The data of a write that was answered so come in before the
// next look at the contents; the payload keeps them until then.
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

  // --- Contents, as they are at sc_time_stamp(), which stands still while a clock domain runs on:
  // to be looked at between its runs ---
  // ConfigError if outside.
  void preload(std::uint64_t address, std::span<const std::uint8_t> data);
  std::vector<std::uint8_t> dump(std::uint64_t address, std::uint64_t bytes);
  using sc_module::dump;  // SystemC's, into a stream
  // The same for a driver.
  void write(std::uint64_t address, std::span<const std::uint8_t> data) override {
    preload(address, data);
  }
  std::vector<std::uint8_t> read(std::uint64_t address, std::uint64_t bytes) override {
    return dump(address, bytes);
  }
  std::uint64_t size() const override { return contents_.size(); }

  // --- Errors on purpose; request numbers count from 0 in the order of arrival ---
  void fail_range(std::uint64_t from, std::uint64_t to,
                  tlm::tlm_response_status status = tlm::TLM_ADDRESS_ERROR_RESPONSE);  // [from, to)
  void fail_request(std::uint64_t number,
                    tlm::tlm_response_status status = tlm::TLM_GENERIC_ERROR_RESPONSE);
  void lose_request(std::uint64_t number);  // never answered

  // --- What went by ---
  std::uint64_t reads() const { return reads_; }
  std::uint64_t writes() const { return writes_; }
  std::uint64_t bytes_read() const { return bytes_read_; }
  std::uint64_t bytes_written() const { return bytes_written_; }
  std::uint64_t errors() const { return errors_; }
  std::uint32_t max_outstanding() const { return most_outstanding_; }
  // Addresses in the order of requests; of a burst, one for each 64 bytes.
  const std::vector<std::uint64_t>& lines_read() const { return lines_read_; }
  const std::vector<std::uint64_t>& lines_written() const { return lines_written_; }
  // Addresses that have been checked.
  void forget_lines();
  // Nothing that was asked is still to be answered or written; what is lost never is. Between runs,
  // as the contents.
  bool at_rest() const;
  // Everything from here on; what is still withheld was asked before, and is not counted.
  void clear_statistics();

 private:
  struct Request {
    tlm::tlm_generic_payload* payload;
    int port;
    std::uint64_t number;
    bool lost;
    bool writes_late;  // the data go to the contents when its last byte is there
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
    bool ends_at_once = false;                 // its initiator ended the last response at once
    std::deque<Request> responses;             // whose time has come
    tlm::tlm_generic_payload* held = nullptr;  // BEGIN_REQ seen, END_REQ withheld
  };
  // A write that was answered ahead. On the answer's way back an interconnect may have put its own
  // address into the payload.
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
  // The time of its response, if that may be sent ahead.
  std::optional<std::uint64_t> accept(Request request, std::uint64_t time);
  // Of the writes that were answered ahead, those that come in before `end`.
  void land(std::uint64_t end);
  // For a look without time: those that come in before now, and those whose answer has been taken.
  void land_answered();
  std::uint64_t take_bus(std::uint64_t ready, const tlm::tlm_generic_payload& payload);
  void settle(std::uint64_t time);
  void wake_for_held();
  void schedule(std::uint64_t time, Step step, const Request& request);
  void respond(int port);
  void send_response(int port, tlm::tlm_generic_payload& payload, sc_core::sc_time delay);
  void finished();
  Port& port_at(int port) { return ports_[static_cast<std::size_t>(port)]; }
  // Counts it and sets the response status; false if no data may go.
  void count(const tlm::tlm_generic_payload& payload);
  bool admit(tlm::tlm_generic_payload& payload, std::uint64_t number, bool counted);
  // Reads or writes the contents.
  void transfer(tlm::tlm_generic_payload& payload, std::uint64_t address);
  std::uint64_t transfer_cycles(std::uint64_t bytes) const;
  std::uint32_t draw_latency();

  MemoryModelParameters parameters_;
  std::uint64_t period_;
  std::uint64_t random_;  // state of the latencies
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
  const bool ordered_;               // transactions keep their order
  std::deque<std::uint64_t> ahead_;  // times of responses that were sent ahead, while to come
  std::deque<Landing> landing_;      // the writes among them
  std::vector<Port> ports_;          // as many as are bound
  std::deque<int> held_;             // ports in the order in which their requests are withheld
  std::size_t uncounted_ = 0;        // of these, the first ones
  std::uint32_t outstanding_ = 0, most_outstanding_ = 0;
  sc_core::sc_event wake_;

  std::uint64_t reads_ = 0, writes_ = 0, bytes_read_ = 0, bytes_written_ = 0, errors_ = 0;
  std::vector<std::uint64_t> lines_read_, lines_written_;
};

}  // namespace deburr::platform
