// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/resolve/frame_copier.h"

#include "rtl_model/geometric/common/hardware_lists.h"
#include "spec/geometric/records.h"

namespace deburr::rtl::geometric {

using spec::geometric::kLineBytes;

FrameCopier::FrameCopier(const sc_core::sc_module_name& name, ClockDomain& clock,
                         const spec::geometric::Parameters& p)
    : Unit(name, clock),
      buffer_("copy_buffer", p.copy_lines, 8 * kLineBytes, "lines between read and write",
              MemoryBase::kind_for(std::uint64_t{8} * kLineBytes *
                                   static_cast<std::uint64_t>(p.copy_lines))),
      stalled_memory_(declare_stall("memory", "the next line has not arrived")) {}

Activity FrameCopier::tick(Cycle cycle) {
  const Phase phase = phase_in.read(cycle);
  const bool copies = phase == Phase::kBegin || phase == Phase::kEdges;
  return copies == copied_out.driven() ? kIdle : work(cycle);
}

Activity FrameCopier::work(Cycle cycle) {
  if (copied_out.driven()) {  // of the previous frame
    copied_out.drive(cycle, false);
    asked_ = written_ = answered_ = 0;
    return kIdle;
  }
  const FrameConfiguration& configuration = configuration_in.read(cycle);
  const std::uint32_t lines = configuration.frame_copy ? configuration.frame_lines() : 0;
  bool did = false;
  if (memory.responses_in.can_pop(cycle)) {
    const MemoryResponse& response = memory.responses_in.take(cycle);
    if (response.write)
      ++answered_;
    else
      buffer_.fill(cycle, response.tag, response.data);
    did = true;
  }
  // Reads have priority, so that all entries stay in flight.
  const bool reads = asked_ != lines && buffer_.can_reserve(cycle),
             blocked = !memory.requests_out.can_push(cycle);
  if ((reads || buffer_.ready(cycle)) && !blocked) {
    if (reads) {
      memory.read(cycle, configuration.colour_base + asked_ * kLineBytes, buffer_.reserve());
      ++asked_;
    } else {
      memory.write(cycle, configuration.copy_base + written_ * kLineBytes, 0, ~std::uint64_t{0}) =
          buffer_.line(cycle);
      buffer_.release(cycle);
      ++written_;
      ++lines_copied;
    }
    did = true;
  }
  buffer_.read_ahead(cycle);
  if (answered_ == lines) copied_out.drive(cycle, true);
  if (did || answered_ == lines) return did ? kBusy : kIdle;
  return blocked ? kStalledDownstream : stalled_memory_;
}

void FrameCopier::reset() {
  buffer_.reset();
  asked_ = written_ = answered_ = 0;
}

Datasheet FrameCopier::datasheet(const spec::geometric::Parameters& p) {
  const Hardware buffer = fill_store(p.copy_lines);
  return {.unit = "FrameCopier",
          .does = "Copies the whole frame before it is resolved (`frame_copy`).",
          .latency = {0, "-"},
          .interval = {2,
                       "2 cycles of the port per line if M + 8 <= 2 copy_lines, otherwise (M + 8) "
                       "/ copy_lines"},
          .stages = {{.clock = "1",
                      .work = "reads a line while an entry is free, otherwise writes the oldest "
                              "line; the number of lines is constant in a frame",
                      .operators =
                          built({op::add(14), op::mux(14, 2), op::multiply(11, 14), 3 * op::add(23),
                                 3 * op::equal(23), 2 * op::add(26), op::mux(38, 2), op::logic(20)},
                                buffer.operators),
                      .longest = {op::add(26), op::mux(38, 2)},
                      .registers = 3 * 23 + 1 + buffer.registers}}};
}

}  // namespace deburr::rtl::geometric
