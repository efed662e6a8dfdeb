// SPDX-License-Identifier: MIT
#include "rtl_model/texture/data_stage.h"

#include <algorithm>

#include "spec/texture/descriptor.h"

namespace deburr::rtl::texture {
namespace {

// A texel is the low bits of the word that is read.
std::uint32_t texel_mask(const FilterControl& control) {
  constexpr std::array<std::uint32_t, 5> kMask = {~0u, 0xFFFF, 0xFFFF, 0xFF, ~0u};
  static_assert(kMask.size() == spec::texture::kFormatNames.size());
  return kMask[control.format];
}

}  // namespace

DataStage::DataStage(const sc_core::sc_module_name& name, ClockDomain& clock,
                     const spec::texture::Parameters& p, FillBuffer& fills)
    : Unit(name, clock),
      fills_(fills),
      banks_(static_cast<std::uint32_t>(p.cache_bytes / p.cache_line_bytes),
             static_cast<std::uint32_t>(p.cache_line_bytes)),
      wait_fill_(declare_stall("wait_fill", "a line of the request has not arrived")),
      write_fill_(declare_stall("write_fill", "the request has more lines to write")),
      bank_conflict_(declare_stall("bank_conflict", "the request has more texels in one bank")) {}

Activity DataStage::tick(Cycle cycle) {
  if (!requests_in.can_pop(cycle)) return kIdle;
  const CacheToken& request = requests_in.front(cycle);
  if (request.fills != 0 || request.column_conflict || request.row_conflict)
    return tick_slow(cycle, request);
  if (!texels_out.can_push(cycle)) return kStalledDownstream;
  TexelQuadToken& out = texels_out.emplace(cycle);
  out.ticket = request.ticket;
  out.control = request.control;
  if (request.ticket.valid) {
    const std::uint32_t mask = texel_mask(request.control);
    for (std::size_t i = 0; i < 4; ++i)
      out.texel[i] = banks_.read(cycle, request.bank[i], request.place[i]) & mask;
  } else {
    out.texel = {};
  }
  requests_in.pop(cycle);
  return kBusy;
}

// In each bank, one distinct texel a pass, in texel order.
DataStage::Schedule DataStage::schedule(const CacheToken& request) {
  Schedule s{(request.column_conflict ? 2 : 1) * (request.row_conflict ? 2 : 1), 0, {}};
  for (std::size_t i = 0; i < 4; ++i) {
    s.pass[i] = -1;
    if (request.source[i] != 0) continue;
    s.pass[i] = 0;
    for (std::size_t j = 0; j < i; ++j) {
      if (s.pass[j] < 0 || request.bank[j] != request.bank[i]) continue;
      const bool same = request.place[j] == request.place[i];
      s.pass[i] = same ? s.pass[j] : std::max(s.pass[i], s.pass[j] + 1);
      if (same) break;
    }
    s.hit_passes = std::max(s.hit_passes, s.pass[i] + 1);
  }
  return s;
}

Activity DataStage::tick_slow(Cycle cycle, const CacheToken& request) {
  if (!started_) {
    started_ = true;
    schedule_ = schedule(request);
    passes_done_ = fills_done_ = 0;
    if (schedule_.passes > 1) ++conflicts;
  }
  const bool reads = passes_done_ < schedule_.passes;
  const int passes_after = passes_done_ + (reads ? 1 : 0);
  // A line may replace one of which a texel is read: not before its last pass, which sees the old
  // word.
  const bool may_write = fills_done_ < request.fills && passes_after >= schedule_.hit_passes;
  const bool writes = may_write && fills_.ready(cycle);
  const bool completes =
      passes_after == schedule_.passes && fills_done_ + (writes ? 1 : 0) == request.fills;
  if (completes && !texels_out.can_push(cycle)) return kStalledDownstream;

  if (reads) {
    for (std::size_t i = 0; i < 4; ++i)
      if (schedule_.pass[i] == passes_done_)
        texel_[i] = banks_.read(cycle, request.bank[i], request.place[i]);
    passes_done_ = passes_after;
  }
  if (writes) write_fill(cycle, request);
  if (!completes) {
    if (may_write && !writes) return wait_fill_;
    return writes ? write_fill_ : bank_conflict_;
  }
  const std::uint32_t mask = texel_mask(request.control);
  TexelQuadToken& out = texels_out.emplace(cycle);
  out.ticket = request.ticket;
  out.control = request.control;
  for (std::size_t i = 0; i < 4; ++i) out.texel[i] = texel_[i] & mask;
  requests_in.pop(cycle);
  started_ = false;
  return kBusy;
}

void DataStage::write_fill(Cycle cycle, const CacheToken& request) {
  const std::uint8_t* const line = fills_.line();
  const auto fill = static_cast<std::size_t>(fills_done_);
  for (std::size_t i = 0; i < 4; ++i)
    if (request.source[i] == fill + 1) texel_[i] = DataBanks::word(line + request.place[i]);
  banks_.write(cycle, request.victim[fill], line);
  fills_.release(cycle);
  ++lines_written;
  ++fills_done_;
}

void DataStage::reset() {
  banks_.reset();
  started_ = false;
}

}  // namespace deburr::rtl::texture
