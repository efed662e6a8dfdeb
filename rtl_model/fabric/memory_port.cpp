// SPDX-License-Identifier: MIT
#include "rtl_model/fabric/memory_port.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

namespace deburr::rtl {
namespace {

constexpr std::uint32_t kStatusBits = 2;

MemoryShape buffer_shape(const MemoryPortParameters& p) {
  const std::uint64_t words = std::uint64_t{p.outstanding} * p.max_burst_lines;
  const std::uint32_t bits = 8 * p.line_bytes + kStatusBits;
  return {.words = words,
          .word_bits = bits,
          .kind = MemoryBase::kind_for(words * bits),
          .latency = 1,
          .content = "lines received from memory, with their status"};
}

std::unique_ptr<PortBuffer> make_gather_buffer(const MemoryPortParameters& p) {
  if (p.max_write_lines == 1) return nullptr;
  const std::uint32_t bits = 8 * p.line_bytes;
  return std::make_unique<PortBuffer>(
      "gather_buffer",
      MemoryShape{.words = p.max_write_lines,
                  .word_bits = bits,
                  .kind = MemoryBase::kind_for(std::uint64_t{p.max_write_lines} * bits),
                  .latency = 1,
                  .content = "lines of a write burst"});
}

}  // namespace

PayloadShape request_shape(const MemoryPortParameters& port, std::uint32_t address_bits,
                           std::uint32_t tag_bits) {
  PayloadShape shape{.widths = {{"address", address_bits}, {"tag", tag_bits}}};
  if (port.read_only) {
    for (const char* field : {"write", "byte_mask", "data"}) shape.widths.emplace_back(field, 0);
  } else {
    shape.widths.emplace_back("byte_mask", port.line_bytes);
    shape.counts.emplace_back("data", port.line_bytes);
  }
  return shape;
}

PayloadShape response_shape(const MemoryPortParameters& port, std::uint32_t address_bits,
                            std::uint32_t tag_bits) {
  PayloadShape shape{.widths = {{"address", address_bits}, {"tag", tag_bits}},
                     .counts = {{"data", port.line_bytes}}};
  if (port.read_only) shape.widths.emplace_back("write", 0);
  return shape;
}

struct MemoryPort::Transaction final : tlm::tlm_generic_payload {
  explicit Transaction(tlm::tlm_mm_interface* owner) : tlm_generic_payload(owner) {}
  std::vector<std::uint8_t> data, enables;
  std::uint64_t address = 0;  // as sent: an interconnect may change that of the payload
  std::uint32_t tag = 0, epoch = 0;
  std::uint16_t lines = 1;
  std::uint16_t next_line = 0;  // write: beats gathered; read: beats responded
  bool write = false, arrived = false, masked = false, taken = false;
  std::uint64_t bytes = 0;  // read or enabled bytes
  Cycle sent = 0;
  sc_core::sc_time when;  // arrival time of the response
  // come: first edge at or after the arrival. visible: first edge that sees the response.
  Cycle come = 0, visible = 0;
  Cycle in_buffer = 0;  // `in_order`: the edge at which its (first) line is taken
};

MemoryPort::MemoryPort(const sc_core::sc_module_name& name, ClockDomain& clock,
                       const MemoryPortParameters& parameters)
    : Unit(name, clock),
      response_buffer("response_buffer", buffer_shape(parameters)),
      gather_buffer(make_gather_buffer(parameters)),
      parameters_(parameters),
      stalled_outstanding_(
          declare_stall("outstanding", "the limit of outstanding transactions is reached")),
      stalled_channel_(
          declare_stall("request_channel", "the target has not yet accepted the last request")),
      stalled_memory_(declare_stall("memory", "waits for responses and has no other work")) {
  DEBURR_CHECK(parameters.outstanding >= 1 && parameters.outstanding <= 1024,
               fmt::format("{}: {} outstanding transactions, expected 1..1024", this->name(),
                           parameters.outstanding));
  DEBURR_CHECK(parameters.max_burst_lines >= 1 && parameters.max_burst_lines <= 64,
               fmt::format("{}: bursts of {} lines, expected 1..64", this->name(),
                           parameters.max_burst_lines));
  DEBURR_CHECK(
      parameters.max_write_lines >= 1 && parameters.max_write_lines <= parameters.max_burst_lines,
      fmt::format("{}: write bursts of {} lines, expected 1..{}", this->name(),
                  parameters.max_write_lines, parameters.max_burst_lines));
  DEBURR_CHECK(parameters.line_bytes >= 4 && parameters.line_bytes <= kLineBytes,
               fmt::format("{}: lines of {} bytes, expected 4..{}", this->name(),
                           parameters.line_bytes, kLineBytes));
  memory.bind(*this);
  SC_METHOD(send_end_response);
  sensitive << end_response_;
  dont_initialize();
}

MemoryPort::~MemoryPort() = default;

std::uint32_t MemoryPort::in_flight() const {
  return static_cast<std::uint32_t>(in_flight_.size()) + (gathering_ ? 1U : 0U);
}

Activity MemoryPort::tick(Cycle cycle) {
  if (cycle >= next_comes_) take_coming(cycle);
  if (arrived_.empty() && !requests_in.can_pop(cycle)) return busy() ? stalled_memory_ : kIdle;
  return work(cycle);
}

Activity MemoryPort::work(Cycle cycle) {
  const bool waiting = !arrived_.empty();
  bool did = respond(cycle);
  const bool response_blocked = waiting && !did && !responses_out.can_push(cycle);
  Activity lost = response_blocked ? kStalledDownstream : busy() ? stalled_memory_ : kIdle;
  if (requests_in.can_pop(cycle)) {
    const MemoryRequest& request = requests_in.front(cycle);
    const bool starts = !gathering_;
    const std::uint16_t beats =
        starts ? (request.write ? request.lines : std::uint16_t{1}) : gathering_->lines;
    const bool completes = (starts ? 1 : gathering_->next_line + 1) == beats;
    if (starts && in_flight_.size() >= parameters_.outstanding) {
      lost = stalled_outstanding_;
    } else if (completes && (requesting_ || channel_free_ > clock().time_of(cycle))) {
      lost = stalled_channel_;
    } else {
      if (starts) {
        const std::uint32_t most =
            request.write ? parameters_.max_write_lines : parameters_.max_burst_lines;
        DEBURR_CHECK(!request.write || !parameters_.read_only,
                     fmt::format("{}: cycle {}: write to {:#x} through a read-only port", name(),
                                 cycle, request.address));
        DEBURR_CHECK(
            request.address % parameters_.line_bytes == 0 && request.lines >= 1 &&
                request.lines <= most,
            fmt::format("{}: cycle {}: {} of {} lines at {:#x}, expected 1..{} lines from a "
                        "multiple of {} bytes on",
                        name(), cycle, request.write ? "write" : "read", request.lines,
                        request.address, most, parameters_.line_bytes));
        gathering_ = &allocate();
        Transaction& t = *gathering_;
        t.tag = request.tag;
        t.epoch = epoch_;
        t.lines = request.lines;
        t.next_line = 0;
        t.write = request.write;
        t.arrived = t.taken = false;
        t.address = request.address;
        t.set_address(t.address);
        t.data.resize(std::size_t{t.lines} * parameters_.line_bytes);
        t.bytes = t.data.size();
        t.masked = false;
        if (request.write) {
          const std::uint64_t all = ~std::uint64_t{0} >> (kLineBytes - parameters_.line_bytes);
          const std::uint64_t left_out = ~request.byte_mask & all;
          t.masked = left_out != 0;
          t.bytes -= static_cast<std::uint64_t>(std::popcount(left_out));
          if (t.masked) t.enables.assign(t.data.size(), TLM_BYTE_ENABLED);
          for (std::uint64_t left = left_out; left != 0; left &= left - 1)
            t.enables[static_cast<std::size_t>(std::countr_zero(left))] = TLM_BYTE_DISABLED;
        }
      }
      Transaction& t = *gathering_;
      if (t.write) {
        std::memcpy(t.data.data() + std::size_t{t.next_line++} * parameters_.line_bytes,
                    request.data.data(), parameters_.line_bytes);
        if (gather_buffer) gather_buffer->count_word();
      }
      requests_in.pop(cycle);
      if (completes) {
        gathering_ = nullptr;
        t.next_line = 0;
        send(t, cycle);
      }
      did = true;
    }
  }
  return did ? kBusy : lost;
}

void MemoryPort::send(Transaction& t, Cycle cycle) {
  const auto length = static_cast<unsigned>(t.data.size());
  t.set_command(t.write ? tlm::TLM_WRITE_COMMAND : tlm::TLM_READ_COMMAND);
  t.set_data_ptr(t.data.data());
  t.set_data_length(length);
  t.set_streaming_width(length);
  t.set_byte_enable_ptr(t.masked ? t.enables.data() : nullptr);
  t.set_byte_enable_length(t.masked ? length : 0);
  t.set_dmi_allowed(false);
  t.set_response_status(tlm::TLM_INCOMPLETE_RESPONSE);
  t.sent = cycle;
  in_flight_.push_back(&t);
  max_outstanding.raise_to(in_flight_.size());
  if (t.write) {
    ++writes;
    bytes_written += t.bytes;
  } else {
    ++reads;
    bytes_read += t.bytes;
  }
  if (observer) observer(cycle, t);

  requesting_ = &t;
  tlm::tlm_phase phase = tlm::BEGIN_REQ;
  sc_core::sc_time delay = clock().offset();
  const tlm::tlm_sync_enum status = memory->nb_transport_fw(t, phase, delay);
  if (status == tlm::TLM_ACCEPTED) return;
  // The target answers immediately: it ended the request, also began the response, or completed the
  // transaction.
  const sc_core::sc_time& now = sc_core::sc_time_stamp();
  const sc_core::sc_time when = now + delay;
  if (requesting_ == &t) {
    requesting_ = nullptr;
    channel_free_ = when;
  }
  if (status == tlm::TLM_COMPLETED) {
    arrived(t, now, when);
  } else if (phase == tlm::BEGIN_RESP) {
    t.acquire();
    arrived(t, now, when);
    phase = tlm::END_RESP;
    memory->nb_transport_fw(t, phase, delay);
    t.release();
  }
}

tlm::tlm_sync_enum MemoryPort::nb_transport_bw(tlm::tlm_generic_payload& payload,
                                               tlm::tlm_phase& phase, sc_core::sc_time& delay) {
  auto& t = static_cast<Transaction&>(payload);
  const sc_core::sc_time& now = sc_core::sc_time_stamp();
  const sc_core::sc_time when = now + delay;
  const bool begins = phase == tlm::BEGIN_RESP;
  if (!begins && phase != tlm::END_REQ) {
    if (phase == tlm::BEGIN_REQ || phase == tlm::END_RESP)
      throw spec::SimulationError(fmt::format(
          "{}: the memory sent phase {} backwards, for address {:#x}: only END_REQ and BEGIN_RESP "
          "may come from a target",
          name(), phase.get_name(), t.address));
    return tlm::TLM_ACCEPTED;  // a phase of an extended protocol, which a base-protocol port
                               // ignores
  }
  if (requesting_ == &t) {
    requesting_ = nullptr;
    channel_free_ = when;
  }
  if (!begins) return tlm::TLM_ACCEPTED;
  if (t.arrived)
    throw spec::SimulationError(fmt::format("{}: the memory responded twice to the {} of {:#x}",
                                            name(), t.write ? "write" : "read", t.address));
  if (responding_)
    throw spec::SimulationError(
        fmt::format("{}: the memory began the response for {:#x} before the one for {:#x} was "
                    "ended",
                    name(), t.address, responding_->address));
  if (response_end == ResponseEnd::kCall) {
    t.acquire();
    responding_ = &t;
    end_response_.notify(delay);
  }
  arrived(t, now, when);
  switch (response_end) {
    case ResponseEnd::kUpdated:
      phase = tlm::END_RESP;
      return tlm::TLM_UPDATED;
    case ResponseEnd::kCompleted:
      return tlm::TLM_COMPLETED;
    case ResponseEnd::kCall:
      break;
  }
  return tlm::TLM_ACCEPTED;
}

void MemoryPort::send_end_response() {
  Transaction& t = *std::exchange(responding_, nullptr);
  tlm::tlm_phase phase = tlm::END_RESP;
  sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
  memory->nb_transport_fw(t, phase, delay);
  t.release();
}

void MemoryPort::arrived(Transaction& t, const sc_core::sc_time& now,
                         const sc_core::sc_time& when) {
  t.arrived = true;
  t.when = when;
  if (t.epoch != epoch_) {  // requested before a reset
    t.release();
    return;
  }
  if (clock().follows()) {  // its edges are not known in advance
    t.come = 0;
    put_in_order(coming_, t);
    next_comes_ = 0;
    return;
  }
  const std::uint64_t period = clock().period().value();
  t.visible = when.value() / period + 1;
  t.come = (when.value() + period - 1) / period;
  if (when > now) {
    put_in_order(coming_, t);
    next_comes_ = coming_.front()->come;
  } else {
    put_in_order(arrived_, t);
    count(t);
  }
}

// Inserts by arrival time; most arrive last.
void MemoryPort::put_in_order(std::deque<Transaction*>& list, Transaction& t) {
  if (list.empty() || t.when >= list.back()->when) [[likely]]
    list.push_back(&t);
  else
    put_before(list, t);
}
void MemoryPort::put_before(std::deque<Transaction*>& list, Transaction& t) {
  const auto earlier = [](const Transaction* a, const Transaction* b) { return a->when < b->when; };
  list.insert(std::upper_bound(list.begin(), list.end(), &t, earlier), &t);
}

void MemoryPort::count(Transaction& t) {
  if (t.get_response_status() != tlm::TLM_OK_RESPONSE) ++errors;
  latency.record(t.visible - t.sent);
}

// Takes the responses that have arrived by now, of those announced by the target.
void MemoryPort::take_coming(Cycle cycle) {
  const bool follows = clock().follows();
  while (!coming_.empty() && coming_.front()->come <= cycle) {
    Transaction& t = *coming_.front();
    if (follows) {
      if (t.when >= clock().time_of(cycle)) break;
      t.visible = cycle;
    }
    coming_.pop_front();
    if (t.epoch != epoch_) {  // requested before a reset
      t.release();
      continue;
    }
    count(t);
    put_in_order(arrived_, t);
  }
  next_comes_ = coming_.empty() ? kNever : coming_.front()->come;
}

// The buffer takes one line per edge, in the order of arrival; a write response has no line.
void MemoryPort::take_lines(Cycle cycle) {
  for (Transaction* t : arrived_) {
    if (t->taken || cycle < t->visible) continue;
    t->taken = true;
    t->in_buffer = std::max(t->visible, t->write ? 0 : intake_free_);
    if (!t->write) intake_free_ = t->in_buffer + t->lines;
  }
}

// Pushes one beat of a response that arrived before this edge, if there is one.
bool MemoryPort::respond(Cycle cycle) {
  if (parameters_.in_order) take_lines(cycle);
  if (arrived_.empty() || !responses_out.can_push(cycle)) return false;
  Transaction* t = parameters_.in_order ? in_flight_.front() : arrived_.front();
  if (!t->arrived || cycle < t->visible) return false;
  if (parameters_.in_order && cycle < t->in_buffer) return false;

  MemoryResponse& response = responses_out.emplace(cycle);
  response.address = t->address + std::uint64_t{t->next_line} * parameters_.line_bytes;
  response.tag = t->tag;
  response.line = t->next_line;
  response.write = t->write;
  response.last = t->write || t->next_line + 1 == t->lines;
  switch (t->get_response_status()) {
    case tlm::TLM_OK_RESPONSE:
      response.status = MemoryStatus::kOk;
      break;
    case tlm::TLM_ADDRESS_ERROR_RESPONSE:
      response.status = MemoryStatus::kAddressError;
      break;
    default:
      response.status = MemoryStatus::kError;
  }
  if (response.status == MemoryStatus::kOk && !t->write)
    std::memcpy(response.data.data(),
                t->data.data() + std::size_t{t->next_line} * parameters_.line_bytes,
                parameters_.line_bytes);
  else
    response.data.fill(0);
  ++t->next_line;
  if (!t->write) response_buffer.count_word();
  if (response.last) {
    // Nearly always the oldest transaction.
    for (std::deque<Transaction*>* list : {&in_flight_, &arrived_})
      if (list->front() == t)
        list->pop_front();
      else
        list->erase(std::find(list->begin(), list->end(), t));
    t->release();
  }
  return true;
}

void MemoryPort::reset() {
  // Responses that the target still owes belong to an old epoch and are dropped on arrival. The
  // request channel belongs to the target and is not reset.
  ++epoch_;
  for (Transaction* t : arrived_) t->release();
  arrived_.clear();
  intake_free_ = 0;
  if (gathering_) gathering_->release();
  gathering_ = nullptr;
  in_flight_.clear();
}

MemoryPort::Transaction& MemoryPort::allocate() {
  if (free_.empty()) {
    pool_.push_back(std::make_unique<Transaction>(static_cast<tlm::tlm_mm_interface*>(this)));
    free_.push_back(pool_.back().get());
  }
  Transaction& t = *free_.back();
  free_.pop_back();
  t.acquire();
  return t;
}

// The last reference was released; a target may keep its own longer than this port.
void MemoryPort::free(tlm::tlm_generic_payload* payload) {
  payload->reset();
  free_.push_back(static_cast<Transaction*>(payload));
}

unsigned MemoryPort::debug_read(std::uint64_t address, void* data, unsigned bytes) {
  tlm::tlm_generic_payload payload;
  payload.set_command(tlm::TLM_READ_COMMAND);
  payload.set_address(address);
  payload.set_data_ptr(static_cast<unsigned char*>(data));
  payload.set_data_length(bytes);
  payload.set_streaming_width(bytes);
  return memory->transport_dbg(payload);
}

unsigned MemoryPort::debug_write(std::uint64_t address, const void* data, unsigned bytes) {
  std::vector<unsigned char> copy(bytes);
  std::memcpy(copy.data(), data, bytes);
  tlm::tlm_generic_payload payload;
  payload.set_command(tlm::TLM_WRITE_COMMAND);
  payload.set_address(address);
  payload.set_data_ptr(copy.data());
  payload.set_data_length(bytes);
  payload.set_streaming_width(bytes);
  return memory->transport_dbg(payload);
}

Datasheet MemoryPort::datasheet(const MemoryPortParameters& p, std::uint32_t tag_bits) {
  const std::uint32_t n = p.outstanding;
  const auto number = static_cast<std::uint32_t>(std::bit_width(n - 1));
  Datasheet sheet = {
      .unit = "MemoryPort",
      .variant = fmt::format("{} outstanding requests, tags of {} bits", n, tag_bits),
      .does = "Sends an engine's requests to a TLM-2.0 target and returns the responses.",
      .latency = {2, "2 plus the latency of memory"},
      .interval = {1, "one request and one response beat per cycle"},
      // A table of tags in the order of arrival, or with `in_order` of requests and who has
      // arrived.
      .stages = {{.clock = "1",
                  .work = "a request popped in c leaves in c",
                  .operators = {2 * op::add(number + 1), op::compare(number + 1), op::logic(2 * n)},
                  .longest = {op::compare(number + 1)},
                  .registers = 2 * number + 1},
                 {.clock = "2",
                  .work = "a response that arrives before edge d > c is pushed in d, and can be "
                          "popped in d + 1",
                  .operators = {2 * op::add(number), op::mux(tag_bits, n)},
                  .longest = {op::mux(tag_bits, n)},
                  .registers = n * tag_bits + 2 * number}}};
  Stage& response = sheet.stages[1];
  if (p.in_order) {
    response.operators.push_back(op::mux(1, n));
    response.registers += n;
  }
  if (p.max_burst_lines > 1) {
    response.operators.push_back(op::add(6));
    response.registers += 6;
  }
  return sheet;
}

}  // namespace deburr::rtl
