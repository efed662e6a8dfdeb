// SPDX-License-Identifier: MIT
#include "rtl_model/texture/wide_tag_stage.h"

#include <algorithm>

#include "rtl_model/texture/datasheets.h"

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
  const LineGroup& group = groups_in.take(cycle);
  occupied_ = true;
  read_at_ = cycle;
  out_.count = group.count;
  out_.lines = group.lines;
  out_.at = group.at;
  out_.turned = group.turned;
  for (std::size_t k = 0; k < group.lines; ++k) lines_[k].number = group.line[k];
  // All sets are read in the same cycle, so one of them is enough for the checks.
  if (group.lines != 0) tags_.read(cycle, 0, group.line[0]);
}

// Calls use(k) for each distinct line of a request in the order of its texels.
template <class Use>
inline void WideTagStage::each_use(const GroupRequest& request, const Use& use) {
  const auto& index = request.index;
  use(index[0]);
  if (index[1] != index[0]) use(index[1]);
  if (index[2] != index[0] && index[2] != index[1]) use(index[2]);
  if (index[3] != index[0] && index[3] != index[1] && index[3] != index[2]) use(index[3]);
}

// Stage 2: each request uses its distinct lines in the order of its texels.
inline void WideTagStage::look_up(Cycle cycle) {
  looked_up_ = true;
  missed_.count = 0;
  valid_requests_ = 0;
  if (out_.lines != 0) tags_.check(cycle, 0, lines_[0].number, read_at_);
  std::uint32_t found = 0;  // lines that have been used
  for (std::size_t r = 0; r < out_.count; ++r) {
    if (!out_.at[r].ticket.valid) continue;
    ++valid_requests_;
    each_use(out_.at[r], [&](std::uint32_t k) {
      Line& line = lines_[k];
      if ((found >> k & 1) != 0) {
        ++line.uses;
        tags_.use(line.slot);
        return;
      }
      found |= 1u << k;
      line.uses = 1;
      line.slot = tags_.find(line.number);
      out_.missed[k] = line.slot == TagStore::kAbsent;
      if (out_.missed[k]) {
        allocate(k);
      } else {
        line.fill = fill_number_[line.slot];
        out_.turned[k] = tags_.turned(line.slot);
        tags_.use(line.slot);
      }
      // Way and set are swapped, so that the low bits select the line bank.
      out_.slot[k] = static_cast<std::uint16_t>((line.slot & way_mask_) << set_log2_ |
                                                line.slot >> ways_log2_);
    });
  }
  tags_.commit(cycle);
  left_ = missed_.count == 0 ? 0 : (missed_.count - 1) / allocations_;
}

void WideTagStage::allocate(std::size_t k) {
  Line& line = lines_[k];
  const TagStore::Place place = tags_.allocate(line.number, out_.turned[k]);
  line.slot = place.slot;
  if (place.evicted) ++evictions;
  line.fill = fill_number_[place.slot] = ++ordered_;
  missed_.line[missed_.count++] = line.number;
}

// In the cycle in which the group leaves.
inline void WideTagStage::count_uses(Cycle cycle) {
  requests += valid_requests_;
  misses += missed_.count;
  std::uint64_t uses = 0, in_flight = 0;
  for (std::size_t k = 0; k < out_.lines; ++k) {
    const Line& line = lines_[k];
    uses += line.uses;
    if (line.fill > used_) in_flight += line.uses;
  }
  // A line that missed is in flight.
  hits += uses - in_flight;
  merged += in_flight - missed_.count;
  if (observer) [[unlikely]]
    report_uses(cycle);
}

void WideTagStage::report_uses(Cycle cycle) const {
  std::uint32_t found = 0;
  for (std::size_t r = 0; r < out_.count; ++r) {
    if (!out_.at[r].ticket.valid) continue;
    each_use(out_.at[r], [&](std::uint32_t k) {
      const bool missed = out_.missed[k] && (found >> k & 1) == 0;
      found |= 1u << k;
      observer(cycle, lines_[k].number,
               missed                   ? LookUp::kMiss
               : lines_[k].fill > used_ ? LookUp::kMerged
                                        : LookUp::kHit);
    });
  }
}

void WideTagStage::reset() {
  tags_.reset();
  std::fill(fill_number_.begin(), fill_number_.end(), 0);
  ordered_ = used_ = 0;
  occupied_ = looked_up_ = false;
  left_ = 0;
}

Datasheet WideTagStage::datasheet(const spec::texture::Parameters& p) {
  const Sizes z(p);
  const std::uint32_t lines = z.lookups, pairs = lines * (lines - 1) / 2;
  const std::uint32_t in_series = std::min(z.allocations, z.ways);
  const bool random = p.cache_replacement == spec::texture::Replacement::kRandom;
  return {
      .unit = "WideTagStage",
      .variant = sets_text(p) + ", " + chosen("cache.lookups", lines) + ", " +
                 chosen("cache.allocations", z.allocations) + with_decode(p),
      .does = "Looks up the lines of a group, allocates those that miss and requests them.",
      .latency = {2},
      .interval = {1, "max(1, misses / `allocations`) cycles per group"},
      .stages = {{.clock = "1",
                  .work = "read the sets of the distinct lines",
                  .operators = {pairs * op::equal(z.set)},
                  .longest = {op::mux(z.set_word, z.sets)},
                  .registers = Payload::of<LineGroup>(line_group_shape(p)).bits() +
                               lines * z.set_word + pairs + 1},
                 // As in the TagStage. Order of use: the last use of each line, of up to four
                 // texels per request. Lines allocated in an earlier cycle of the group stay.
                 {.clock = "2",
                  .work = "up to `lookups` lookups, allocation, misses to the queue",
                  .operators = {lines * z.ways * op::equal(z.tag + 1),
                                lines * op::priority(z.texels), pairs * op::compare(4),
                                lines * op::mux(z.set_word, in_series + 1),
                                lines * z.ways * op::mux(z.tag + 2, 2),
                                z.allocations * op::mux(z.line + 1, lines),
                                op::logic(lines * z.ways * (2 * z.ways + 2) + (random ? 200 : 0)),
                                lines * op::mux(z.line, lines / 2),
                                lines * op::count_ones(lines / 2), lines * lines * op::equal(z.set),
                                lines * op::mux(z.set_word, lines + 1)},
                  .longest = {op::equal(z.tag + 1), op::priority(lines),
                              in_series * op::mux(z.tag + 2, std::max(z.ways, 2U)),
                              op::mux(z.set_word, lines + 1)},
                  .registers = lines * (z.slot + 1) + 3}},
      .shared_registers = random ? 16U : 0U};
}

}  // namespace deburr::rtl::texture
