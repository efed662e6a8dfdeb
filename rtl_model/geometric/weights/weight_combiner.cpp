// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/weights/weight_combiner.h"

#include <algorithm>
#include <bit>

#include "rtl_model/geometric/common/block_pixels.h"
#include "spec/geometric/records.h"

namespace deburr::rtl::geometric {
namespace {

using spec::geometric::Weights;

constexpr std::uint32_t kBlockMask = spec::geometric::kBlocksInWord - 1;
constexpr std::uint64_t kWholeLine = ~std::uint64_t{0};

}  // namespace

WeightCombiner::WeightCombiner(const sc_core::sc_module_name& name, ClockDomain& clock,
                               const spec::geometric::Parameters& p, EdgeLatency& latency)
    : Unit(name, clock),
      latency_(latency),
      places_(p),
      blocks_(spec::geometric::kCacheLineCount[static_cast<std::size_t>(p.weight_blocks)]),
      tags_("weight_tags", {.words = blocks_,
                            .word_bits = WeightPlaces::kTagBits,
                            .read_during_write = ReadDuringWrite::kNewWord,
                            .content = "x, y of a block, valid"}),
      touched_("touched", {.words = static_cast<std::uint64_t>(p.touched_words),
                           .word_bits = spec::geometric::kBlocksInWord,
                           .read_during_write = ReadDuringWrite::kNewWord,
                           .content = "a bit a block: a line has cut it"}),
      data_("weight_data", {.words = blocks_,
                            .word_bits = 8 * spec::geometric::kLineBytes,
                            .read_during_write = ReadDuringWrite::kNewWord,
                            .content = "sixteen pixels of four weights"}),
      fills_("weight_fills", p.fills, 8 * spec::geometric::kLineBytes, "weights on their way"),
      spill_("spill", {.words = static_cast<std::uint64_t>(p.fills),
                       .word_bits = WeightPlaces::kTagBits,
                       .kind = MemoryKind::kFlops,
                       .read_ports = static_cast<std::uint32_t>(p.fills),
                       .write_ports = 2,
                       .latency = 0,
                       .content = "blocks on their way out, compared at once"}),
      fifo_("latency_fifo", static_cast<std::uint32_t>(p.latency_fifo),
            {.lanes = spec::geometric::kLaneCount[static_cast<std::size_t>(p.walkers)]}),
      stalled_weights_(declare_stall("weights", "a block of weights has not come")),
      stalled_fills_(declare_stall("fills", "no place for a block of weights is free")),
      stalled_spill_(declare_stall("spill", "a block is still on its way out")),
      spilled_(static_cast<std::size_t>(p.fills), 0) {}

Activity WeightCombiner::clear(Cycle cycle) {
  const std::uint32_t words = rules_in.read(cycle).touched_words, all = std::max(words, blocks_);
  if (clearing_ == all) return kIdle;
  if (clearing_ < words) touched_write_.write(cycle, clearing_, TouchedWord{});
  if (clearing_ < blocks_) tag_write_.write(cycle, clearing_, 0);
  if (++clearing_ == all) cleared_out.drive(cycle, true);
  return kBusy;
}

std::uint32_t WeightCombiner::address_of(Cycle cycle, std::uint32_t x, std::uint32_t y) const {
  const FrameRules& rules = rules_in.read(cycle);
  return rules.weight_base + spec::geometric::kLineBytes * (y * rules.blocks_across + x);
}

bool WeightCombiner::spilling(std::uint32_t tag) const {
  return std::find(spilled_.begin(), spilled_.end(), tag) != spilled_.end();
}

// Stage 2; kIdle: done.
Activity WeightCombiner::look_up_block(Cycle cycle) {
  const std::uint32_t x = lookup_.group.block_x, y = lookup_.group.block_y,
                      tag = WeightPlaces::tag_of(x, y);
  const std::uint32_t there = tag_port_.at(cycle, lookup_.index, looked_);
  lookup_.missed = there != tag;
  lookup_.reads = lookup_.replaces = false;
  if (lookup_.missed) {
    const TouchedWord& touched = touched_port_.at(cycle, touched_at_, looked_);
    lookup_.reads = touched.get(x & kBlockMask);
    lookup_.replaces = there != 0;
    if (lookup_.reads) {
      if (spilling(tag)) return stalled_spill_;
      if (!fills_.can_reserve(cycle)) return stalled_fills_;
      if (!memory.requests_out.can_push(cycle)) return kStalledDownstream;
    }
    if (lookup_.replaces) {
      const auto free = std::find(spilled_.begin(), spilled_.end(), 0u);
      if (free == spilled_.end()) return stalled_spill_;
      *free = there;
      lookup_.spill = static_cast<std::uint8_t>(free - spilled_.begin());
      lookup_.old_x = there & 0x7FF;
      lookup_.old_y = there >> 11 & 0x7FF;
    }
    if (lookup_.reads) {
      memory.read(cycle, address_of(cycle, x, y), fills_.reserve());
      ++blocks_read;
    } else {
      TouchedWord word = touched;
      word.set(x & kBlockMask);
      touched_write_.write(cycle, touched_at_, word);
    }
    tag_write_.write(cycle, lookup_.index, tag);
    ++misses;
  }
  ++lookups;
  return kIdle;
}

// Stages 2 and 1.
Activity WeightCombiner::look_up(Cycle cycle) {
  if (looking_) {
    if (!fifo_.can_push(cycle)) return kStalledDownstream;
    if (!lookup_.group.end)
      if (const Activity done = look_up_block(cycle); done != kIdle) return done;
    fifo_.push(cycle, lookup_);
    looking_ = false;
    if (lookup_.more) {
      lookup_.group = waiting_;
      lookup_.more = false;
      address(cycle);
      return kBusy;
    }
  }
  if (!weights_in.can_pop(cycle)) return kIdle;
  lookup_.group = weights_in.take(cycle);
  keep_own_block();
  address(cycle);
  return kBusy;
}

// Second candidates of another block wait; they all lie in the same one.
void WeightCombiner::keep_own_block() {
  WeightToken& group = lookup_.group;
  lookup_.more = false;
  if (group.end) return;
  std::uint8_t beyond = 0;
  for (std::uint32_t left = group.seconds; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(left));
    if (across(group.place[lane], group.vertical, group.forward >> lane & 1).beyond)
      beyond |= static_cast<std::uint8_t>(1u << lane);
  }
  if (beyond == 0) return;
  lookup_.more = true;
  waiting_ = group;
  waiting_.candidates = 0;
  waiting_.seconds = beyond;
  group.seconds &= static_cast<std::uint8_t>(~beyond);
  const bool forward = group.forward >> std::countr_zero(beyond) & 1;
  std::uint16_t& along = group.vertical ? waiting_.block_x : waiting_.block_y;
  along = static_cast<std::uint16_t>((forward ? along + 1 : along - 1) & 0x7FF);
}

// Stage 1.
void WeightCombiner::address(Cycle cycle) {
  lookup_.missed = lookup_.reads = lookup_.replaces = false;
  looking_ = true;
  looked_ = cycle;
  if (lookup_.group.end) return;
  const std::uint32_t x = lookup_.group.block_x, y = lookup_.group.block_y;
  lookup_.index = static_cast<std::uint16_t>(places_.index_of(x, y));
  touched_at_ = y * rules_in.read(cycle).words_across + x / spec::geometric::kBlocksInWord;
  tag_port_.read(cycle, lookup_.index);
  touched_port_.read(cycle, touched_at_);
}

// Stage 4.
void WeightCombiner::combine(Cycle cycle, Work& work) {
  const Lookup& l = work.lookup;
  const Work* const before = pipe_.at(3);
  const bool past = before && !before->lookup.group.end && before->lookup.index == l.index;
  if (!l.missed || l.replaces) {
    const BlockWeights& there = past ? before->block : data_port_.at(cycle, l.index);
    if (l.replaces) {
      Line& line = memory.write(cycle, address_of(cycle, l.old_x, l.old_y), l.spill, kWholeLine);
      for (std::size_t i = 0; i < there.size(); ++i)
        std::copy(there[i].begin(), there[i].end(),
                  line.begin() + static_cast<std::ptrdiff_t>(4 * i));
      ++writes_;
      ++blocks_written;
    }
    if (!l.missed) work.block = there;
  }
  using spec::geometric::Combine;
  const Combine rule = rules_in.read(cycle).combine;
  const auto set = [&](std::uint8_t place, bool forward, std::uint8_t coverage, bool nearer) {
    Weights& weights = work.block[place];
    if (rule == Combine::kLast) weights = {};
    std::uint8_t& weight = weights[2u * l.group.vertical + forward];
    const bool smallest = rule == Combine::kOutermost && nearer && weight != 0;
    weight = smallest ? std::min(weight, coverage) : std::max(weight, coverage);
  };
  // All of them are different pixels.
  const WeightToken& group = l.group;
  for (std::uint32_t left = group.candidates; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(left));
    set(group.place[lane], group.forward >> lane & 1, group.coverage[lane],
        group.nearer >> lane & 1);
  }
  for (std::uint32_t left = group.seconds; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(left));
    const bool forward = group.forward >> lane & 1;
    set(across(group.place[lane], group.vertical, forward).place, !forward, group.second[lane],
        group.farther >> lane & 1);
  }
}

// Stages 5 to 3.
Activity WeightCombiner::deliver(Cycle cycle) {
  if (!fifo_.can_pop(cycle) && pipe_.empty()) return kIdle;
  if (const Work* next = pipe_.at(1);
      next && next->lookup.replaces && !memory.requests_out.can_push(cycle))
    return kStalledDownstream;
  pipe_.move();
  if (const Work* work = pipe_.at(3)) {
    if (work->lookup.group.end) {
      ended_ = true;
      note(latency_.end());
    } else {
      data_write_.write(cycle, work->lookup.index, work->block);
      if (!work->lookup.more) note(latency_.write(cycle));
    }
  }
  if (Work* work = pipe_.at(2); work && !work->lookup.group.end) combine(cycle, *work);
  if (!fifo_.can_pop(cycle)) return kBusy;
  const Lookup& l = fifo_.front(cycle);
  if (l.reads && !fills_.ready(cycle)) return stalled_weights_;
  Work& work = pipe_.enter();
  if (l.reads) {
    work.block = fills_.line(cycle);
    fills_.release(cycle);
  } else if (l.missed) {
    work.block = {};
  }
  if (!l.group.end && (!l.missed || l.replaces)) data_port_.read(cycle, l.index);
  work.lookup = l;
  fifo_.pop(cycle);
  return kBusy;
}

void WeightCombiner::answer(Cycle cycle) {
  const MemoryResponse& response = memory.responses_in.take(cycle);
  if (response.write) {
    spilled_[response.tag] = 0;
    --writes_;
    return;
  }
  BlockWeights block;
  for (std::size_t i = 0; i < block.size(); ++i)
    std::copy_n(response.data.begin() + static_cast<std::ptrdiff_t>(4 * i), 4, block[i].begin());
  fills_.fill(cycle, response.tag, block);
}

Activity WeightCombiner::tick(Cycle cycle) {
  const Phase phase = phase_in.read(cycle);
  if (phase == Phase::kBegin) return clear(cycle);
  if (phase != Phase::kEdges) {
    if (ended_) {
      ended_ = false;
      drawn_out.drive(cycle, false);
    }
    return kIdle;
  }
  if (clearing_ != 0) {
    clearing_ = 0;
    cleared_out.drive(cycle, false);
  }
  const Activity data = deliver(cycle);
  const Activity tags = look_up(cycle);
  bool did = data == kBusy || tags == kBusy;
  if (memory.responses_in.can_pop(cycle)) {
    answer(cycle);
    did = true;
  }
  fills_.read_ahead(cycle);
  if (ended_ && writes_ == 0 && !drawn_out.driven()) drawn_out.drive(cycle, true);
  return did ? kBusy : data != kIdle ? data : tags;
}

void WeightCombiner::reset() {
  fills_.reset();
  fifo_.reset();
  pipe_.reset();
  clearing_ = 0;
  looking_ = ended_ = false;
  std::fill(spilled_.begin(), spilled_.end(), 0);
  writes_ = 0;
}

Datasheet WeightCombiner::datasheet() {
  return {
      .unit = "WeightCombiner",
      .does = "Keeps the weights of each pixel that a line has cut, and which blocks these are.",
      .latency = {5, "5, and the wait for a block"},
      .interval = {1, "1, a group with second candidates in another block 2"},
      .stages = {{"1", "address of tag and touched word, product of the block's address",
                  "11 x 11 multiply"},
                 {"2", "tag, touched bit, the blocks on their way out; a read ordered; FIFO",
                  "SRAM read + 23-bit compare"},
                 {"3", "a block installed, address of the word"},
                 {"4",
                  "the word, or what came for it, and the maxima and minima; a replaced block "
                  "written back",
                  "SRAM read + 16 : 1 choice + 8-bit compare"},
                 {"5", "written, past the memory to the group after it"}},
      .cost =
          "tags, touched map and data 1R1W, the blocks on their way, the FIFO; the spill "
          "list, 23 bits each, compared with a tag at once: `fills` compares of 23 bits (108 "
          "for a memory of 100 clocks) and a choice of its first free place; two 11 x 11 "
          "multiplies; a lane, of each "
          "of its two candidates, a 16 : 1 place and an 8-bit compare."};
}

}  // namespace deburr::rtl::geometric
