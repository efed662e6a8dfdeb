// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/edges/edge_reader.h"

#include <algorithm>

#include "rtl_model/geometric/common/hardware_lists.h"
#include "spec/geometric/records.h"

namespace deburr::rtl::geometric {

using spec::geometric::kIndexMask;
using spec::geometric::kLineBytes;

EdgeReader::EdgeReader(const sc_core::sc_module_name& name, ClockDomain& clock,
                       const spec::geometric::Parameters& p, EdgeLatency& latency)
    : Unit(name, clock),
      latency_(latency),
      split_(p.records == spec::geometric::RecordsLayout::kSplit),
      in_line_(split_ ? spec::geometric::kSplitInLine : spec::geometric::kEdgesInLine),
      lanes_(spec::geometric::kLaneCount[static_cast<std::size_t>(p.edge_lanes)]),
      buffer_("edge_buffer", p.edge_lines, kLineBytes * 8, "prefetched edges"),
      stalled_facing_(declare_stall("facing", "the begin phase of the frame is not finished")),
      stalled_edges_(declare_stall("edges", "the next line of edges has not arrived")) {}

bool EdgeReader::ask(Cycle cycle) {
  const FrameConfiguration& configuration = configuration_in.read(cycle);
  if (asked_edges_ >= configuration.edge_count || !buffer_.can_reserve(cycle) ||
      !memory.requests_out.can_push(cycle))
    return false;
  memory.read(cycle, configuration.edge_base + asked_ * kLineBytes, buffer_.reserve());
  ++asked_;
  asked_edges_ += in_line_;
  ++lines_read;
  return true;
}

void EdgeReader::decode(const Line& line, std::size_t place, EdgeFields& edge) const {
  if (split_) {
    const std::uint64_t record = split_record_of(line, place);
    edge.f0 = static_cast<std::uint32_t>(record) & spec::geometric::kSplitFaceMask;
    edge.f1 = static_cast<std::uint32_t>(record >> spec::geometric::kSplitFaceBits) &
              spec::geometric::kSplitFaceMask;
    edge.flags = static_cast<std::uint8_t>(record >> spec::geometric::kSplitFlagShift & 0xF);
    return;
  }
  const std::size_t word = 4 * place;
  const std::uint32_t faces = word_of(line, word + 2);
  edge.v0 = word_of(line, word) & kIndexMask;
  edge.v1 = word_of(line, word + 1) & kIndexMask;
  edge.f0 = faces & kIndexMask;
  edge.f1 = word_of(line, word + 3) & kIndexMask;
  edge.flags = static_cast<std::uint8_t>(faces >> spec::geometric::kFlagShift & 0xF);
}

Activity EdgeReader::hand_on(Cycle cycle) {
  const std::uint32_t left = configuration_in.read(cycle).edge_count - handed_;
  if (phase_in.read(cycle) != Phase::kEdges) return left ? stalled_facing_ : kIdle;
  if (left != 0 && !buffer_.ready(cycle)) return stalled_edges_;
  if (!edges_out.can_push(cycle)) return kStalledDownstream;
  EdgeBeat& beat = edges_out.emplace(cycle);
  beat.end = ended_ = left == 0;
  beat.count = static_cast<std::uint8_t>(std::min({left, lanes_, in_line_ - place_}));
  if (ended_) return kBusy;
  latency_.leave(cycle, beat.count);
  const Line& line = buffer_.line(cycle);
  for (std::uint32_t lane = 0; lane < beat.count; ++lane)
    decode(line, place_ + lane, beat.edge[lane]);
  handed_ += beat.count;
  place_ += beat.count;
  if (place_ == in_line_ || left == beat.count) {
    buffer_.release(cycle);
    place_ = 0;
  }
  return kBusy;
}

Activity EdgeReader::tick(Cycle cycle) {
  const Phase phase = phase_in.read(cycle);
  if (phase == Phase::kIdle) return kIdle;
  if (phase == Phase::kResolve) {
    begin();
    return kIdle;
  }
  if (ended_) return kIdle;
  const Activity activity = hand_on(cycle);
  bool did = ask(cycle);
  if (memory.responses_in.can_pop(cycle)) {
    const MemoryResponse& response = memory.responses_in.take(cycle);
    buffer_.fill(cycle, response.tag, response.data);
    did = true;
  }
  buffer_.read_ahead(cycle);
  return did ? kBusy : activity;
}

void EdgeReader::begin() {
  asked_ = asked_edges_ = handed_ = place_ = 0;
  ended_ = false;
}

void EdgeReader::reset() {
  latency_.reset();
  buffer_.reset();
  begin();
}

Datasheet EdgeReader::datasheet(const spec::geometric::Parameters& p) {
  const bool split = p.records == spec::geometric::RecordsLayout::kSplit;
  const std::uint32_t lanes = lane_count(p.edge_lanes), in_line = split ? 10 : 4,
                      place_bits = split ? 4 : 2;
  // A beat begins at a multiple of `lanes`.
  const Operator edge = op::mux(split ? 46 : 100, (in_line + lanes - 1) / lanes);
  const Hardware buffer = fill_store(p.edge_lines);
  return {.unit = "EdgeReader",
          .variant = split ? "`records = split`" : "`records = joined`",
          .does = "Prefetches the edge table and forwards its records.",
          .latency = {2, "2 from the response with a line"},
          .interval = {1, "1 for edge_lanes edges of a line"},
          .stages = {{.clock = "1",
                      .work = "line",
                      .path = "SRAM read",
                      .operators = built({op::add(26), op::add(23), (split ? 1U : 0U) * op::add(25),
                                          op::compare(25), op::logic(20)},
                                         buffer.operators),
                      .registers = 23 + (split ? 25U : 0U) + buffer.registers},
                     {.clock = "2",
                      .work = "selection of edges",
                      .operators = built({lanes * edge, op::subtract(25), op::add(25),
                                          op::add(place_bits), op::logic(20)}),
                      .longest = built({edge}),
                      .registers = 25 + place_bits + 1}}};
}

}  // namespace deburr::rtl::geometric
