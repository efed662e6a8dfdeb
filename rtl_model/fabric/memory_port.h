// SPDX-License-Identifier: MIT
// Function  Connects a unit's memory requests to a TLM-2.0 initiator socket: links on one side, any
//           target of the base protocol on the other (the testbench's memory, a DRAM simulator).
// Interval  One request per cycle while the target ends requests immediately; one response beat per
//           cycle.
// Stalls    `outstanding` (limit reached), `request_channel` (the target has not ended the last
//           request), `downstream` (the responses are not taken).
//
// Non-blocking, four phases, several outstanding requests, matched by transaction. A target may
// skip phases, complete early, or implement only b_transport (tlm_utils::simple_target_socket). The
// port ends a response when it begins, since it has room for all outstanding ones; ResponseEnd
// selects the protocol form.
//
// The interconnect is not modelled: a burst is one transaction in each direction. The response
// buffer is 1R1W: of lines that arrive before the same edge it takes one per edge, in the order of
// arrival, and the interconnect holds the others. One beat per cycle leaves it in the same order,
// so it adds no delay, except with `in_order`, where an older line may arrive last.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <systemc>
#include <tlm>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/unit.h"

namespace deburr::rtl {

inline constexpr std::uint32_t kLineBytes = 64;
using Line = std::array<std::uint8_t, kLineBytes>;

// One beat. A burst read is one beat with lines > 1. A burst write is `lines` consecutive beats:
// the first carries address, tag and lines, the others only data.
struct MemoryRequest {
  std::uint64_t address = 0;  // bytes; a multiple of the port's line_bytes
  std::uint32_t tag = 0;      // returned with the response; chosen by the unit
  std::uint16_t lines = 1;    // burst length: at most max_burst_lines, of a write max_write_lines
  bool write = false;
  std::uint64_t byte_mask = 0;  // bit i: byte i is written; only used in the first beat of a write
  Line data{};

  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("address", self.address, 64, "U64");
    visit("tag", self.tag, 32, "U32");
    visit("lines", self.lines, 7, "U7");
    visit("write", self.write);
    visit("byte_mask", self.byte_mask, kLineBytes, "one bit per byte");
    visit("data", self.data, 8, "U8");
  }
};

enum class MemoryStatus : std::uint8_t { kOk, kAddressError, kError };

// One beat per line for reads, one beat in all for writes.
struct MemoryResponse {
  std::uint64_t address = 0;  // of this line
  std::uint32_t tag = 0;
  std::uint16_t line = 0;  // number of the line within its burst
  bool last = true;
  bool write = false;
  MemoryStatus status = MemoryStatus::kOk;  // if not kOk, data is zero
  Line data{};

  template <class Self, class Visit>
  static constexpr void fields(Self& self, Visit&& visit) {
    visit("address", self.address, 64, "U64");
    visit("tag", self.tag, 32, "U32");
    visit("line", self.line, 6, "U6");
    visit("last", self.last);
    visit("write", self.write);
    visit("status", self.status, 2, "0 ok, 1 address, 2 error");
    visit("data", self.data, 8, "U8");
  }
};

struct MemoryPortParameters {
  std::uint32_t outstanding = 16;         // transactions; 1..1024
  std::uint32_t max_burst_lines = 1;      // lines; 1..64
  std::uint32_t max_write_lines = 1;      // lines of a write burst; 1..max_burst_lines
  bool in_order = false;                  // responses in the order of requests
  bool read_only = false;                 // no writes: its links carry no write data
  std::uint32_t line_bytes = kLineBytes;  // 4..kLineBytes: used bytes of each beat
};

// The part of a beat that is built for a port with these parameters, address width and tag width.
// With `read_only` a request has no data, no mask and no write flag, and a response no write flag.
PayloadShape request_shape(const MemoryPortParameters& port, std::uint32_t address_bits,
                           std::uint32_t tag_bits);
PayloadShape response_shape(const MemoryPortParameters& port, std::uint32_t address_bits,
                            std::uint32_t tag_bits);

// How the port ends a response that the target begins by a call; the time is the same. The base
// protocol allows all three and a target must accept each, but not every target does. A response
// that begins in the return from BEGIN_REQ can only be ended by a call.
enum class ResponseEnd : std::uint8_t {
  kUpdated,    // returns TLM_UPDATED with END_RESP
  kCompleted,  // returns TLM_COMPLETED
  kCall        // returns TLM_ACCEPTED and sends END_RESP forward
};

// A buffer whose words the port moves itself; each is written once and read once.
class PortBuffer final : public MemoryBase {
 public:
  using MemoryBase::MemoryBase;
  std::uint64_t reads() const override { return words_; }
  std::uint64_t writes() const override { return words_; }
  void reset() override { words_ = 0; }
  void count_word() { ++words_; }

 private:
  std::uint64_t words_ = 0;
};

class MemoryPort final : public Unit, public tlm::tlm_bw_transport_if<>, tlm::tlm_mm_interface {
 public:
  In<MemoryRequest> requests_in{"requests_in"};
  Out<MemoryResponse> responses_out{"responses_out"};
  tlm::tlm_initiator_socket<> memory{"memory"};  // default bus width: binds to most targets

  MemoryPort(const sc_core::sc_module_name& name, ClockDomain& clock,
             const MemoryPortParameters& parameters = {});
  ~MemoryPort() override;

  Activity tick(Cycle cycle) override;
  void reset() override;

  // Lines that have arrived and wait for the link, with their status.
  PortBuffer response_buffer;
  // The write burst being gathered until it is sent. nullptr: writes are one line.
  const std::unique_ptr<PortBuffer> gather_buffer;

  std::uint32_t in_flight() const;
  const MemoryPortParameters& parameters() const { return parameters_; }
  // May be changed before the first request.
  ResponseEnd response_end = ResponseEnd::kUpdated;
  // Called with every transaction when it is sent.
  std::function<void(Cycle, const tlm::tlm_generic_payload&)> observer;
  // Untimed access through transport_dbg, from the end of elaboration on; returns the number of
  // bytes that the target handled.
  unsigned debug_read(std::uint64_t address, void* data, unsigned bytes);
  unsigned debug_write(std::uint64_t address, const void* data, unsigned bytes);

  Counter reads{"reads", "transactions", "read transactions sent"};
  Counter writes{"writes", "transactions", "write transactions sent"};
  Counter bytes_read{"bytes_read", "bytes", "bytes requested from memory"};
  Counter bytes_written{"bytes_written", "bytes", "bytes enabled in write transactions"};
  Counter errors{"errors", "transactions", "transactions with an error response"};
  Counter max_outstanding{"max_outstanding", "transactions", "largest number in flight"};
  Histogram latency{"latency", "clk", "from sending a request to receiving its response"};

  // `tag_bits`: of the tags that the unit uses.
  static Datasheet datasheet(const MemoryPortParameters& parameters = {},
                             std::uint32_t tag_bits = 4);

 private:
  SC_HAS_PROCESS(MemoryPort);
  struct Transaction;
  tlm::tlm_sync_enum nb_transport_bw(tlm::tlm_generic_payload& payload, tlm::tlm_phase& phase,
                                     sc_core::sc_time& delay) override;
  void invalidate_direct_mem_ptr(sc_dt::uint64, sc_dt::uint64) override {}
  void free(tlm::tlm_generic_payload* payload) override;
  Transaction& allocate();
  void send(Transaction& transaction, Cycle cycle);
  void arrived(Transaction& transaction, const sc_core::sc_time& now, const sc_core::sc_time& when);
  void send_end_response();
  void count(Transaction& transaction);
  static void put_in_order(std::deque<Transaction*>& list, Transaction& transaction);
  [[gnu::noinline]] static void put_before(std::deque<Transaction*>& list,
                                           Transaction& transaction);
  void take_coming(Cycle cycle);
  void take_lines(Cycle cycle);
  [[gnu::noinline]] Activity work(Cycle cycle);
  bool respond(Cycle cycle);
  bool busy() const { return gathering_ || !in_flight_.empty(); }

  MemoryPortParameters parameters_;
  Activity stalled_outstanding_, stalled_channel_, stalled_memory_;
  std::vector<std::unique_ptr<Transaction>> pool_;
  std::vector<Transaction*> free_;
  std::deque<Transaction*> in_flight_;  // in the order of requests
  std::deque<Transaction*> arrived_;    // in the order of arrival
  // Responses whose arrival the target has already announced, in order of arrival; and the first
  // edge at which one has arrived.
  std::deque<Transaction*> coming_;
  Cycle next_comes_ = kNever;
  Cycle intake_free_ = 0;              // `in_order`: first edge at which the buffer can take a line
  Transaction* requesting_ = nullptr;  // BEGIN_REQ sent, END_REQ not yet seen
  Transaction* responding_ = nullptr;  // BEGIN_RESP seen, END_RESP to be sent by a call
  Transaction* gathering_ = nullptr;   // burst write whose beats are still being gathered
  sc_core::sc_event end_response_;
  sc_core::sc_time channel_free_;  // end of the last request
  std::uint32_t epoch_ = 0;        // counts resets: late responses of older epochs are dropped
};

}  // namespace deburr::rtl
