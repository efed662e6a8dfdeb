// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/edges/facing_store.h"

#include <array>
#include <span>

#include "rtl_model/geometric/common/hardware_lists.h"

namespace deburr::rtl::geometric {
namespace {

std::uint32_t edge_lanes_of(const spec::geometric::Parameters& p) {
  return spec::geometric::kLaneCount[static_cast<std::size_t>(p.edge_lanes)];
}

}  // namespace

FacingStore::FacingStore(const sc_core::sc_module_name& name, ClockDomain& clock,
                         const spec::geometric::Parameters& p)
    : Unit(name, clock),
      words("facing", {.words = static_cast<std::uint64_t>(p.face_limit) / 32,
                       .word_bits = 32,
                       .read_ports = 2 * edge_lanes_of(p),
                       .banks = kWordsInLine,
                       .span = kWordsInLine,
                       .content = "facing bits"}),
      stalled_memory_(declare_stall("memory", "waits for facing bits")) {}

Activity FacingStore::tick(Cycle cycle) {
  if (phase_in.read(cycle) != Phase::kBegin && !loaded_out.driven() &&
      !memory.responses_in.can_pop(cycle))
    return kIdle;
  return work(cycle);
}

Activity FacingStore::work(Cycle cycle) {
  bool did = false;
  if (memory.responses_in.can_pop(cycle)) {
    const MemoryResponse& response = memory.responses_in.take(cycle);
    std::array<std::uint32_t, kWordsInLine> line;
    std::size_t i = 0;
    for (std::uint32_t& word : line) word = word_of(response.data, i++);
    write_.write(cycle, response.tag * kWordsInLine, std::span<const std::uint32_t>(line));
    ++answered_;
    did = true;
  }
  if (phase_in.read(cycle) != Phase::kBegin) {
    if (loaded_out.driven()) {
      loaded_out.drive(cycle, false);
      asked_ = answered_ = 0;
    }
    return did ? kBusy : kIdle;
  }
  const FrameConfiguration& configuration = configuration_in.read(cycle);
  const std::uint32_t lines = configuration.select != spec::geometric::Select::kEdges
                                  ? 0
                                  : (configuration.face_count + spec::geometric::kFacesInLine - 1) /
                                        spec::geometric::kFacesInLine;
  if (asked_ < lines) {
    if (!memory.requests_out.can_push(cycle)) return did ? kBusy : kStalledDownstream;
    memory.read(cycle, configuration.face_base + asked_ * spec::geometric::kLineBytes, asked_);
    ++asked_;
    ++lines_read;
    return kBusy;
  }
  if (answered_ == lines && !loaded_out.driven()) loaded_out.drive(cycle, true);
  return did ? kBusy : answered_ == lines ? kIdle : stalled_memory_;
}

void FacingStore::reset() { asked_ = answered_ = 0; }

Datasheet FacingStore::datasheet(const spec::geometric::Parameters& p) {
  const std::uint32_t lines = bits_below(static_cast<std::uint32_t>(p.face_limit / 512) + 1),
                      reads = 2 * lane_count(p.edge_lanes);
  return {.unit = "FacingStore",
          .does = "Stores the facing bits of a frame's faces.",
          .latency = {2, "2 for a reader"},
          .interval = {1, "one line of 512 bits in and 2 x edge_lanes bits out per cycle"},
          .stages = {{.clock = "1",
                      .work = "word",
                      .path = "SRAM read",
                      .operators = {op::add(21), op::add(26), 2 * op::add(lines),
                                    2 * op::equal(lines), op::logic(20)},
                      .registers = 2 * lines + 1 + 4 * reads},
                     {.clock = "2",
                      .work = "selection of one of 32 bits, in the reader",
                      .operators = {reads * op::mux(32, 16)},
                      .longest = {op::mux(32, 16), op::mux(1, 32)}}}};
}

}  // namespace deburr::rtl::geometric
