// SPDX-License-Identifier: MIT
#include "rtl_model/texture/tag_stage.h"

#include <algorithm>
#include <bit>

namespace deburr::rtl::texture {

TagStage::TagStage(const sc_core::sc_module_name& name, ClockDomain& clock,
                   const spec::texture::Parameters& p, const FillBuffer& fills)
    : Unit(name, clock),
      fills_(fills),
      tags_("tags", p),
      line_log2_(static_cast<std::uint32_t>(
          std::countr_zero(static_cast<std::uint32_t>(p.cache_line_bytes)))),
      fill_number_(tags_.slots()),
      miss_queue_full_(declare_stall("miss_queue_full", "a line is missing and cannot be queued")),
      fifo_full_(declare_stall("fifo_full", "the latency FIFO takes nothing")) {}

Activity TagStage::tick(Cycle cycle) {
  if (!texels_in.can_pop(cycle)) return kIdle;
  if (!requests_out.can_push(cycle)) return fifo_full_;
  const TexelToken& in = texels_in.front(cycle);
  const bool queue_ready = misses_out.can_push(cycle);
  if (!queue_ready && in.ticket.valid && would_miss(in)) return miss_queue_full_;

  CacheToken& out = requests_out.emplace(cycle);
  out.ticket = in.ticket;
  out.control = in.control;
  out.fills = 0;
  out.bank = in.bank;
  out.column_conflict = out.row_conflict = false;
  if (in.ticket.valid) {
    out.column_conflict = in.column_conflict;
    out.row_conflict = in.row_conflict;
    MissToken missed{};
    look_up(cycle, in, out, missed);
    if (out.fills != 0) {
      missed.count = out.fills;
      misses_out.push(cycle, missed);
    }
  }
  texels_in.pop(cycle);
  return kBusy;
}

// Up to four distinct lines, each looked up once, in the order of their first use.
void TagStage::look_up(Cycle cycle, const TexelToken& in, CacheToken& out, MissToken& missed) {
  ++requests;
  const std::uint32_t offset_mask = (1u << line_log2_) - 1;
  std::array<std::uint32_t, 4> line, base;
  for (std::size_t i = 0; i < 4; ++i) {
    line[i] = in.address[i] >> line_log2_;
    std::size_t same = 0;
    while (line[same] != line[i]) ++same;
    if (same != i) {
      base[i] = base[same];
      out.source[i] = out.source[same];
    } else if (const std::uint32_t slot = tags_.find(line[i]); slot != TagStore::kAbsent) {
      tags_.use(slot);
      fill_number_[slot] > fills_.released(cycle) ? ++merged : ++hits;
      base[i] = slot << line_log2_;
      out.source[i] = 0;
    } else {
      const TagStore::Place place = tags_.allocate(line[i]);
      ++misses;
      if (place.evicted) ++evictions;
      fill_number_[place.slot] = ++ordered_;
      missed.line[out.fills] = line[i];
      out.victim[out.fills] = static_cast<std::uint16_t>(place.slot);
      base[i] = 0;
      out.source[i] = ++out.fills;
    }
    out.place[i] = base[i] | (in.address[i] & offset_mask);
  }
}

// Without changing anything. A request that misses nothing allocates nothing, so each line can be
// looked at by itself.
bool TagStage::would_miss(const TexelToken& in) const {
  return std::any_of(in.address.begin(), in.address.end(), [&](std::uint32_t address) {
    return tags_.find(address >> line_log2_) == TagStore::kAbsent;
  });
}

void TagStage::reset() {
  tags_.reset();
  std::fill(fill_number_.begin(), fill_number_.end(), 0);
  ordered_ = 0;
}

}  // namespace deburr::rtl::texture
