// SPDX-License-Identifier: MIT
#include "rtl_model/texture/wide_tag_stage.h"

#include <algorithm>

namespace deburr::rtl::texture {

WideTagStage::WideTagStage(const sc_core::sc_module_name& name, ClockDomain& clock,
                           const spec::texture::Parameters& p)
    : TagUnit(name, clock, p),
      allocations_(static_cast<std::uint32_t>(p.cache_allocations)),
      set_log2_(log2_of(p.cache_bytes) - log2_of(p.cache_line_bytes) - log2_of(p.cache_ways)),
      way_mask_(static_cast<std::uint32_t>(p.cache_ways) - 1),
      ways_log2_(log2_of(p.cache_ways)),
      allocate_(declare_stall("allocate", "more lines of the group to allocate")) {}

Activity WideTagStage::tick(Cycle cycle) {
  used_ += lines_used_in.read(cycle);
  SlotStall stall = SlotStall::kNone;
  const Activity activity = work(cycle, stall);
  if (stall_out.driven() != stall) stall_out.drive(cycle, stall);
  return activity;
}

inline Activity WideTagStage::work(Cycle cycle, SlotStall& stall) {
  if (occupied_) {
    if (!looked_up_) look_up(cycle);
    if (left_ != 0) {
      --left_;
      stall = SlotStall::kAllocate;
      return allocate_;
    }
    if (!requests_out.can_push(cycle)) {
      stall = stall_in.read(cycle);
      return fifo_full_;
    }
    if (missed_.count != 0) {
      if (!misses_out.can_push(cycle)) {
        stall = SlotStall::kMissQueue;
        return miss_queue_full_;
      }
      misses_out.push(cycle, missed_);
    }
    requests_out.push(cycle, out_);
    count_uses(cycle);
    occupied_ = looked_up_ = false;
    if (groups_in.can_pop(cycle)) read_sets(cycle);
    return kBusy;
  }
  if (!groups_in.can_pop(cycle)) return kIdle;
  read_sets(cycle);
  return kBusy;
}

// Stage 1: one port per distinct line.
inline void WideTagStage::read_sets(Cycle cycle) {
  group_ = groups_in.take(cycle);
  occupied_ = true;
  read_at_ = cycle;
  for (std::size_t i = 0; i < group_.lines; ++i) tags_.read(cycle, i, group_.line[i]);
}

// Stage 2: each request uses its distinct lines in the order of its texels.
inline void WideTagStage::look_up(Cycle cycle) {
  looked_up_ = true;
  out_.count = group_.count;
  out_.lines = group_.lines;
  std::copy_n(group_.at.begin(), group_.count, out_.at.begin());
  missed_.count = 0;
  used_lines_ = valid_requests_ = 0;
  std::array<std::uint32_t, spec::texture::kMostLookups> slot{};
  std::uint32_t found = 0;  // lines that an earlier request has used
  for (std::size_t r = 0; r < group_.count; ++r) {
    if (!group_.at[r].ticket.valid) continue;
    ++valid_requests_;
    std::uint32_t uses = 0;  // lines that this request has used
    for (const std::uint8_t k : group_.at[r].index) {
      if ((uses >> k & 1) != 0) continue;
      uses |= 1u << k;
      Use& use = uses_[used_lines_++];
      use.line = group_.line[k];
      if ((found >> k & 1) == 0) {
        found |= 1u << k;
        tags_.check(cycle, k, use.line, read_at_);
        slot[k] = tags_.find(use.line);
        out_.missed[k] = slot[k] == TagStore::kAbsent;
        if (out_.missed[k]) {
          const TagStore::Place place = tags_.allocate(use.line, group_.turned[k]);
          slot[k] = place.slot;
          out_.turned[k] = group_.turned[k];
          if (place.evicted) ++evictions;
          fill_number_[place.slot] = ++ordered_;
          missed_.line[missed_.count++] = use.line;
          use.fill = kMissed;
          continue;
        }
        out_.turned[k] = tags_.turned(slot[k]);
      }
      tags_.use(slot[k]);
      use.fill = fill_number_[slot[k]];
    }
  }
  // Way and set are swapped, so that the low bits select the line bank.
  for (std::size_t k = 0; k < group_.lines; ++k)
    out_.slot[k] =
        static_cast<std::uint16_t>((slot[k] & way_mask_) << set_log2_ | slot[k] >> ways_log2_);
  tags_.commit(cycle);
  left_ = missed_.count == 0 ? 0 : (missed_.count - 1) / allocations_;
}

// In the cycle in which the group leaves.
inline void WideTagStage::count_uses(Cycle cycle) {
  requests += valid_requests_;
  for (std::size_t i = 0; i < used_lines_; ++i) {
    const Use& use = uses_[i];
    const bool missed = use.fill == kMissed, under_way = use.fill > used_;
    ++(missed ? misses : under_way ? merged : hits);
    if (observer) [[unlikely]]
      observer(cycle, use.line,
               missed      ? LookUp::kMiss
               : under_way ? LookUp::kMerged
                           : LookUp::kHit);
  }
}

void WideTagStage::reset() {
  tags_.reset();
  std::fill(fill_number_.begin(), fill_number_.end(), 0);
  ordered_ = used_ = 0;
  occupied_ = looked_up_ = false;
  left_ = 0;
}

Datasheet WideTagStage::datasheet() {
  return {.unit = "WideTagStage",
          .does = "Looks up the lines of a group, allocates those that miss and requests them.",
          .latency = {2},
          .interval = {1, "max(1, misses / `allocations`) cycles per group"},
          .stages =
              {{"1", "read the sets of the distinct lines", "512 : 1 mux of sets"},
               {"2", "up to `lookups` lookups, allocation, misses to the queue",
                "tag comparison, then at most min(`allocations`, ways) choices of a way in series, "
                "since a group has at most `ways` lines of a set: about 1.3 x the 24 x 24 multiply "
                "by estimate"}},
          .cost =
              "tags and order of use as in the TagStage with `lookups` read and write ports, "
              "`lookups` x ways comparators of tags; order of up to 16 uses; registers for a "
              "group."};
}

}  // namespace deburr::rtl::texture
