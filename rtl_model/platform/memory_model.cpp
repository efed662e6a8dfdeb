// SPDX-License-Identifier: MIT
#include "rtl_model/platform/memory_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "spec/error.h"

namespace deburr::platform {
namespace {

constexpr std::uint64_t kLine = 64;

// splitmix64, so that a seed gives the same latencies on every host: 0..bound-1.
std::uint32_t next_below(std::uint64_t& state, std::uint32_t bound) {
  std::uint64_t z = (state += 0x9E3779B97F4A7C15ULL);
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  z ^= z >> 31;
  return static_cast<std::uint32_t>(((z >> 32) * bound) >> 32);
}

// Calls visit(first, count) for each repetition of the byte enables over the data.
template <class Visit>
void for_each_round(const tlm::tlm_generic_payload& payload, Visit&& visit) {
  const std::uint64_t length = payload.get_data_length(), round = payload.get_byte_enable_length();
  for (std::uint64_t first = 0; first < length; first += round)
    visit(first, std::min(round, length - first));
}

std::uint64_t enabled_bytes(const tlm::tlm_generic_payload& payload) {
  const unsigned char* const enables = payload.get_byte_enable_ptr();
  if (!enables) return payload.get_data_length();
  std::uint32_t bytes = 0;
  for_each_round(payload, [&](std::uint64_t, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) bytes += enables[i] == TLM_BYTE_ENABLED;
  });
  return bytes;
}

}  // namespace

MemoryModel::MemoryModel(const sc_core::sc_module_name& name, const sc_core::sc_time& clock_period,
                         const MemoryModelParameters& parameters)
    : sc_module(name),
      parameters_(parameters),
      period_(clock_period.value()),
      random_(parameters.seed),
      contents_(parameters.bytes),
      ordered_(parameters.latencies.empty() && parameters.latency_min == parameters.latency_max &&
               (parameters.bank_busy == 0 || parameters.banks == 1)) {
  if (parameters.latency_max < parameters.latency_min || parameters.banks == 0 ||
      parameters.interleave_bytes == 0 || parameters.outstanding == 0)
    throw spec::ConfigError(fmt::format(
        "{}: latency {}..{}, {} banks of {} bytes, {} outstanding transactions: not a valid memory",
        this->name(), parameters.latency_min, parameters.latency_max, parameters.banks,
        parameters.interleave_bytes, parameters.outstanding));
  bank_free_.resize(parameters.banks);
  ports.register_nb_transport_fw(this, &MemoryModel::nb_transport_fw);
  ports.register_b_transport(this, &MemoryModel::b_transport);
  ports.register_transport_dbg(this, &MemoryModel::transport_dbg);
  SC_METHOD(serve);
  sensitive << wake_;
  dont_initialize();
}

void MemoryModel::preload(std::uint64_t address, std::span<const std::uint8_t> data) {
  if (address > contents_.size() || data.size() > contents_.size() - address)
    throw spec::ConfigError(fmt::format("{}: {} bytes at {:#x} do not fit into {} bytes", name(),
                                        data.size(), address, contents_.size()));
  land_answered();
  std::copy(data.begin(), data.end(), contents_.begin() + static_cast<std::ptrdiff_t>(address));
}

std::vector<std::uint8_t> MemoryModel::dump(std::uint64_t address, std::uint64_t bytes) {
  if (address > contents_.size() || bytes > contents_.size() - address)
    throw spec::ConfigError(fmt::format("{}: {} bytes at {:#x} exceed the memory of {} bytes",
                                        name(), bytes, address, contents_.size()));
  land_answered();
  const auto begin = contents_.begin() + static_cast<std::ptrdiff_t>(address);
  return {begin, begin + static_cast<std::ptrdiff_t>(bytes)};
}

void MemoryModel::fail_range(std::uint64_t from, std::uint64_t to,
                             tlm::tlm_response_status status) {
  failing_ranges_.push_back({from, to, status});
}
void MemoryModel::fail_request(std::uint64_t number, tlm::tlm_response_status status) {
  failing_requests_[number] = status;
}
void MemoryModel::lose_request(std::uint64_t number) { lost_requests_[number] = true; }

void MemoryModel::forget_lines() {
  lines_read_.clear();
  lines_written_.clear();
}

bool MemoryModel::at_rest() const {
  const std::uint64_t now = sc_core::sc_time_stamp().value();
  const bool answered = ahead_.empty() || ahead_.back() <= now,
             landed = landing_.empty() || landing_.back().time < now;
  return answered && landed && events_.empty() &&
         std::all_of(ports_.begin(), ports_.end(),
                     [](const Port& port) { return port.responses.empty() && !port.responding; });
}

void MemoryModel::clear_statistics() {
  settle(sc_core::sc_time_stamp().value());  // first applies the writes that arrived by now
  reads_ = writes_ = bytes_read_ = bytes_written_ = errors_ = 0;
  most_outstanding_ = outstanding_;
  uncounted_ = held_.size();
  forget_lines();
}

std::uint64_t MemoryModel::transfer_cycles(std::uint64_t bytes) const {
  if (parameters_.bytes_per_cycle == 0) return 1;
  return std::max<std::uint64_t>(
      1, (bytes + parameters_.bytes_per_cycle - 1) / parameters_.bytes_per_cycle);
}

std::uint32_t MemoryModel::draw_latency(std::uint64_t number) {
  if (!parameters_.latencies.empty())
    return parameters_.latencies[number % parameters_.latencies.size()];
  const std::uint32_t span = parameters_.latency_max - parameters_.latency_min;
  return parameters_.latency_min + (span ? next_below(random_, span + 1) : 0);
}

void MemoryModel::count(const tlm::tlm_generic_payload& payload) {
  const std::uint64_t address = payload.get_address(), length = payload.get_data_length();
  const auto record = [&](std::vector<std::uint64_t>& lines) {
    for (std::uint64_t line = address; line < address + length; line += kLine)
      lines.push_back(line);
  };
  if (payload.is_read()) {
    ++reads_;
    bytes_read_ += length;
    if (parameters_.record_reads) record(lines_read_);
  } else {
    ++writes_;
    if (parameters_.record_writes) record(lines_written_);
  }
}

bool MemoryModel::admit(tlm::tlm_generic_payload& payload, std::uint64_t number, bool counted) {
  const std::uint64_t address = payload.get_address();
  const std::uint64_t length = payload.get_data_length();
  const std::uint64_t width = payload.get_streaming_width();
  const auto fail = [&](tlm::tlm_response_status status) {
    payload.set_response_status(status);
    if (counted) ++errors_;
    return false;
  };
  if (payload.get_command() == tlm::TLM_IGNORE_COMMAND) {
    payload.set_response_status(tlm::TLM_OK_RESPONSE);
    return false;
  }
  if (counted) count(payload);
  if (const auto found = failing_requests_.find(number); found != failing_requests_.end())
    return fail(found->second);
  for (const Range& range : failing_ranges_)
    if (address < range.to && address + length > range.from) return fail(range.status);
  if (length == 0 || width < length) return fail(tlm::TLM_BURST_ERROR_RESPONSE);
  if (address > contents_.size() || length > contents_.size() - address)
    return fail(tlm::TLM_ADDRESS_ERROR_RESPONSE);

  if (payload.get_byte_enable_ptr() && payload.get_byte_enable_length() == 0)
    return fail(tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE);
  if (counted && payload.is_write()) bytes_written_ += enabled_bytes(payload);
  payload.set_dmi_allowed(false);
  payload.set_response_status(tlm::TLM_OK_RESPONSE);
  return true;
}

void MemoryModel::transfer(tlm::tlm_generic_payload& payload, std::uint64_t address) {
  const std::uint64_t length = payload.get_data_length();
  std::uint8_t* to = contents_.data() + address;
  unsigned char* from = payload.get_data_ptr();
  if (payload.is_read()) std::swap(to, from);
  const unsigned char* const enables = payload.get_byte_enable_ptr();
  if (!enables) {
    std::memcpy(to, from, length);
    return;
  }
  for_each_round(payload, [&](std::uint64_t first, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint8_t before = to[first + i], now = from[first + i];
      to[first + i] = enables[i] == TLM_BYTE_ENABLED ? now : before;
    }
  });
}

tlm::tlm_sync_enum MemoryModel::nb_transport_fw(int port, tlm::tlm_generic_payload& payload,
                                                tlm::tlm_phase& phase, sc_core::sc_time& delay) {
  Port& here = port_at(port);
  const std::uint64_t time = (sc_core::sc_time_stamp() + delay).value();
  if (phase == tlm::END_RESP) {
    here.responding = false;
    if (!here.responses.empty()) wake_.notify(delay);
    return tlm::TLM_COMPLETED;
  }
  if (phase != tlm::BEGIN_REQ)
    throw spec::SimulationError(
        fmt::format("{}: unexpected phase {} from an initiator", name(), phase.get_name()));
  if (here.held)
    throw spec::SimulationError(
        fmt::format("{}: a request began before the previous one was ended (address {:#x})", name(),
                    payload.get_address()));
  payload.acquire();
  settle(time);
  if (outstanding_ >= parameters_.outstanding) {
    here.held = &payload;
    held_.push_back(port);
    wake_for_held();
  } else {
    begin(port, payload, true, time, delay);
  }
  return tlm::TLM_ACCEPTED;
}

// Accepts a request at `time`, which is `delay` from now, and ends it.
void MemoryModel::begin(int port, tlm::tlm_generic_payload& payload, bool counted,
                        std::uint64_t time, const sc_core::sc_time& delay) {
  const std::optional<std::uint64_t> response =
      accept({&payload, port, 0, false, false, counted}, time);
  tlm::tlm_phase phase = tlm::END_REQ;
  sc_core::sc_time when = delay;
  ports[port]->nb_transport_bw(payload, phase, when);
  if (!response) return;
  ahead_.push_back(*response);
  send_response(port, payload, delay + sc_core::sc_time::from_value(*response - time));
}

std::optional<std::uint64_t> MemoryModel::accept(Request request, std::uint64_t time) {
  request.number = requests_++;
  request.lost = lost_requests_.count(request.number) != 0;
  ++outstanding_;
  most_outstanding_ = std::max(most_outstanding_, outstanding_);
  tlm::tlm_generic_payload& payload = *request.payload;
  if (admit(payload, request.number, request.counted)) {
    request.writes_late = payload.is_write() && parameters_.write_at_response;
    if (!request.writes_late) transfer(payload, payload.get_address());
  }
  std::uint64_t& bank =
      bank_free_[payload.get_address() / parameters_.interleave_bytes % parameters_.banks];
  const std::uint64_t start = std::max(time, bank);
  bank = start + parameters_.bank_busy * period_;
  const std::uint64_t ready = start + draw_latency(request.number) * period_;
  if (!ordered_) {
    schedule(ready, Step::kReady, request);
    return std::nullopt;
  }
  const std::uint64_t response = take_bus(ready, payload);
  const Port& here = port_at(request.port);
  if (parameters_.answer_ahead && here.ends_at_once && !request.lost && here.responses.empty()) {
    if (request.writes_late) {
      payload.acquire();
      const auto later = [](std::uint64_t when, const Landing& l) { return when < l.time; };
      landing_.insert(std::upper_bound(landing_.begin(), landing_.end(), response, later),
                      {response, payload.get_address(), &payload});
    }
    return response;
  }
  schedule(response, Step::kRespond, request);
  return std::nullopt;
}

void MemoryModel::land(std::uint64_t end) {
  for (; !landing_.empty() && landing_.front().time < end; landing_.pop_front()) {
    const Landing& write = landing_.front();
    transfer(*write.payload, write.address);
    write.payload->release();
  }
}

// SystemC's time does not advance while a clock domain runs on. A write whose payload its initiator
// has released was answered, whatever the time.
void MemoryModel::land_answered() {
  while (!landing_.empty() && landing_.front().payload->get_ref_count() == 1)
    land(landing_.front().time + 1);
  land(sc_core::sc_time_stamp().value());
}

// Time of the last byte of a transaction whose first byte may be transferred at `ready`. The first
// transaction that is ready gets the bus.
std::uint64_t MemoryModel::take_bus(std::uint64_t ready, const tlm::tlm_generic_payload& payload) {
  const std::uint64_t cycles = transfer_cycles(payload.get_data_length());
  std::uint64_t start = ready;
  if (parameters_.bytes_per_cycle != 0) {
    start = std::max(start, bus_free_);
    bus_free_ = start + cycles * period_;
  }
  return start + (cycles - 1) * period_;
}

void MemoryModel::schedule(std::uint64_t time, Step step, const Request& request) {
  events_.push({time, order_++, step, request});
  wake_.notify(sc_core::sc_time::from_value(time) - sc_core::sc_time_stamp());
}

void MemoryModel::serve() {
  const std::uint64_t now = sc_core::sc_time_stamp().value();
  while (!events_.empty() && events_.top().time <= now) {
    const Event event = events_.top();
    events_.pop();
    if (event.step == Step::kReady) {
      events_.push(
          {take_bus(event.time, *event.request.payload), order_++, Step::kRespond, event.request});
    } else {
      tlm::tlm_generic_payload& payload = *event.request.payload;
      if (event.request.writes_late) transfer(payload, payload.get_address());
      if (!event.request.lost) port_at(event.request.port).responses.push_back(event.request);
    }
  }
  settle(now);
  for (std::size_t port = 0; port < ports_.size(); ++port) respond(static_cast<int>(port));
  if (!events_.empty())
    wake_.notify(sc_core::sc_time::from_value(events_.top().time) - sc_core::sc_time_stamp());
  wake_for_held();
}

void MemoryModel::respond(int port) {
  Port& here = port_at(port);
  while (!here.responding && !here.responses.empty()) {
    const Request request = here.responses.front();
    here.responses.pop_front();
    send_response(port, *request.payload, sc_core::SC_ZERO_TIME);
    finished();
  }
}

void MemoryModel::send_response(int port, tlm::tlm_generic_payload& payload,
                                sc_core::sc_time delay) {
  Port& here = port_at(port);
  here.responding = true;
  tlm::tlm_phase phase = tlm::BEGIN_RESP;
  const tlm::tlm_sync_enum status = ports[port]->nb_transport_bw(payload, phase, delay);
  here.ends_at_once =
      status == tlm::TLM_COMPLETED || (status == tlm::TLM_UPDATED && phase == tlm::END_RESP);
  if (here.ends_at_once) here.responding = false;
  payload.release();
}

// Removes transactions whose early response has reached its time.
void MemoryModel::settle(std::uint64_t time) {
  land(time + 1);
  while (!ahead_.empty() && ahead_.front() <= time) {
    ahead_.pop_front();
    finished();
  }
}

// A transaction is finished: admits a waiting request.
void MemoryModel::finished() {
  --outstanding_;
  if (held_.empty()) return;
  const int port = held_.front();
  held_.pop_front();
  tlm::tlm_generic_payload* payload = std::exchange(port_at(port).held, nullptr);
  const bool counted = uncounted_ == 0;
  if (!counted) --uncounted_;
  begin(port, *payload, counted, sc_core::sc_time_stamp().value(), sc_core::SC_ZERO_TIME);
}

// No event marks the time at which an early response makes room.
void MemoryModel::wake_for_held() {
  if (held_.empty() || ahead_.empty()) return;
  wake_.notify(sc_core::sc_time::from_value(ahead_.front()) - sc_core::sc_time_stamp());
}

void MemoryModel::b_transport(int, tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
  land_answered();
  land((sc_core::sc_time_stamp() + delay).value() + 1);
  const std::uint64_t number = requests_++;
  if (admit(payload, number, true)) transfer(payload, payload.get_address());
  const std::uint64_t cycles =
      draw_latency(number) + transfer_cycles(payload.get_data_length()) - 1;
  delay += sc_core::sc_time::from_value(cycles * period_);
}

unsigned MemoryModel::transport_dbg(int, tlm::tlm_generic_payload& payload) {
  const std::uint64_t address = payload.get_address();
  if (address >= contents_.size()) return 0;
  land_answered();
  const std::uint64_t length =
      std::min<std::uint64_t>(payload.get_data_length(), contents_.size() - address);
  std::uint8_t* here = contents_.data() + address;
  if (payload.is_write())
    std::memcpy(here, payload.get_data_ptr(), length);
  else if (payload.is_read())
    std::memcpy(payload.get_data_ptr(), here, length);
  else
    return 0;
  return static_cast<unsigned>(length);
}

}  // namespace deburr::platform
