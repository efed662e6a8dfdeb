// SPDX-License-Identifier: MIT
#include "rtl_model/texture/miss_queue.h"

#include <algorithm>
#include <span>
#include <string>

#include "rtl_model/texture/datasheets.h"
#include "spec/texture/registers.h"

namespace deburr::rtl::texture {
MissQueue::MissQueue(const sc_core::sc_module_name& name, ClockDomain& clock,
                     const spec::texture::Parameters& p, ControlRegisters& registers)
    : Unit(name, clock),
      fills("fill_buffer", static_cast<std::uint32_t>(p.cache_outstanding),
            static_cast<std::uint32_t>(p.cache_line_bytes),
            static_cast<std::uint32_t>(p.cache_fill_writes)),
      registers_(registers),
      line_bytes_(static_cast<std::uint32_t>(p.cache_line_bytes)),
      address_unit_(has_fetcher(p) ? 1 : line_bytes_),
      lines_("lines", {.words = static_cast<std::uint64_t>(p.cache_outstanding),
                       .word_bits = line_bits(p),
                       .kind = MemoryKind::kFlops,
                       .read_ports = 1,
                       .write_ports = static_cast<std::uint32_t>(p.cache_lookups),
                       .latency = 0,
                       .content = "lines waiting to be sent"}),
      failed_("failed", {.words = static_cast<std::uint64_t>(p.cache_outstanding),
                         .word_bits = 1,
                         .kind = MemoryKind::kFlops,
                         .latency = 0,
                         .content = "per line in flight: did a beat have an error?"}),
      fill_buffer_full_(
          declare_stall("fill_buffer_full", "all entries of the fill buffer are held")),
      wait_memory_(
          declare_stall("wait_memory", "waits for lines from memory, nothing else to do")) {
  for (int i = 0; i < p.cache_lookups; ++i)
    new_lines_.emplace_back(lines_, "line_" + std::to_string(i));
}

Activity MissQueue::tick(Cycle cycle) {
  if (waiting_ == 0 && !responses_in.can_pop(cycle) && !misses_in.can_pop(cycle))
    return fills.held(cycle) != 0 ? wait_memory_ : kIdle;
  return work(cycle);
}

Activity MissQueue::work(Cycle cycle) {
  const bool received = receive(cycle);
  const Activity issued = issue(cycle);  // before accept(): a new line is sent one cycle later
  const bool accepted = accept(cycle);
  if (received || accepted) return kBusy;
  if (issued == kIdle && fills.held(cycle) != 0) return wait_memory_;
  return issued;
}

// Receives one beat of at most 64 bytes from memory.
inline bool MissQueue::receive(Cycle cycle) {
  if (!responses_in.can_pop(cycle)) return false;
  const MemoryResponse& response = responses_in.front(cycle);
  const std::uint32_t entry = response.tag;
  const bool failed = response.status != MemoryStatus::kOk || had_error_.now(cycle, entry) != 0;
  has_error_.write(cycle, entry, failed && !response.last);
  if (response.last && failed) {
    ++memory_errors;
    registers_.set_sticky(spec::texture::reg::kStatusMemoryError);
  }
  // After an error, the port delivers zeros.
  fills.fill(cycle, entry, response.line * kLineBytes,
             std::span(response.data).first(std::min(line_bytes_, kLineBytes)), response.last);
  responses_in.pop(cycle);
  return true;
}

inline Activity MissQueue::issue(Cycle cycle) {
  if (waiting_ == 0) return kIdle;
  if (!fills.can_reserve(cycle)) return fill_buffer_full_;
  if (!requests_out.can_push(cycle)) return kStalledDownstream;
  MemoryRequest& request = requests_out.emplace(cycle);
  request.address = std::uint64_t{next_line_.now(cycle, head_)} * address_unit_;
  request.tag = fills.reserve(cycle);
  request.lines = static_cast<std::uint16_t>(std::max(line_bytes_ / kLineBytes, 1u));
  request.write = false;
  head_ = head_ + 1 == lines_.words() ? 0 : head_ + 1;
  --waiting_;
  ++line_fills;
  fill_bytes += line_bytes_;
  return kBusy;
}

// Accepts all lines that a request (or group) misses, or none.
inline bool MissQueue::accept(Cycle cycle) {
  if (!misses_in.can_pop(cycle)) return false;
  const MissToken& missed = misses_in.front(cycle);
  const auto places = static_cast<std::uint32_t>(lines_.words());
  if (waiting_ + missed.count > places) return false;
  for (std::uint32_t i = 0; i < missed.count; ++i) {
    const std::uint32_t place = head_ + waiting_++;
    new_lines_[i].write(cycle, place < places ? place : place - places, missed.line[i]);
  }
  max_waiting.raise_to(waiting_);
  misses_in.pop(cycle);
  return true;
}

void MissQueue::reset() {
  fills.reset();
  head_ = waiting_ = 0;
  failed_.clear();
}

Datasheet MissQueue::datasheet(const spec::texture::Parameters& p) {
  const Sizes z(p);
  const auto entry = static_cast<std::uint32_t>(std::bit_width(z.outstanding - 1));
  return {.unit = "MissQueue",
          .variant = std::to_string(z.outstanding) + " entries, " +
                     chosen("cache.lookups", z.lookups) + (has_fetcher(p) ? with_decode(p) : ""),
          .does = "Sends missed lines to memory and collects them in the fill buffer.",
          .latency = {0, "-"},
          .interval = {1, "one line per cycle in each direction"},
          .stages = {
              {.clock = "-",
               .work = "line to send; its entry is held from issue until the line is used",
               .operators = {(z.lookups + 2) * op::add(entry), op::add(entry + 1),
                             op::compare(entry + 1), op::logic(40)},
               .longest = {op::add(entry + 1), op::compare(entry + 1), op::mux(z.line, z.lookups)},
               .registers = entry + entry + 1}}};
}

}  // namespace deburr::rtl::texture
