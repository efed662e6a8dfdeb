// SPDX-License-Identifier: MIT
#include "rtl_model/geometric/weights/weight_combiner.h"

#include <algorithm>
#include <bit>
#include <string>

#include "rtl_model/geometric/common/block_pixels.h"
#include "rtl_model/geometric/common/hardware_lists.h"
#include "spec/geometric/records.h"

namespace deburr::rtl::geometric {
namespace {

using spec::geometric::Weights;

constexpr std::uint32_t kBlockMask = spec::geometric::kBlocksInWord - 1;
constexpr std::uint64_t kWholeLine = ~std::uint64_t{0};

PayloadShape lookup_shape(const spec::geometric::Parameters& p) {
  PayloadShape shape{.lanes = spec::geometric::kLaneCount[static_cast<std::size_t>(p.walkers)]};
  if (p.write_buffer == 0) shape.widths = {{"writes", 0}, {"hit", 0}, {"ring", 0}};
  return shape;
}

}  // namespace

WeightCombiner::WeightCombiner(const sc_core::sc_module_name& name, ClockDomain& clock,
                               const spec::geometric::Parameters& p, EdgeLatency& latency)
    : Unit(name, clock),
      latency_(latency),
      places_(p),
      touched_("touched", {.words = static_cast<std::uint64_t>(p.touched_words),
                           .word_bits = spec::geometric::kBlocksInWord,
                           // Consecutive groups may set bits of the same word.
                           .read_during_write = ReadDuringWrite::kNewWord,
                           .content = "one bit per block: a line cuts it"}),
      cache_({.lines = spec::geometric::kCacheLineCount[static_cast<std::size_t>(p.weight_blocks)],
              .ports = 1,
              .tags = {"weight_tags", "block position x, y, valid", WeightPlaces::kTagBits},
              .data = {"weight_data", "sixteen pixels of four weights",
                       8 * spec::geometric::kLineBytes, MemoryKind::kSram,
                       // Consecutive groups may update the same block.
                       ReadDuringWrite::kNewWord},
              .fills = {"weight_fills", "weights in flight", p.fills},
              .no_line = declare_stall("weights", "a block of weights has not arrived"),
              .no_fill = declare_stall("fills", "no fill entry for a block of weights is free")}),
      spill_("spill", {.words = static_cast<std::uint64_t>(p.fills),
                       .word_bits = WeightPlaces::kTagBits,
                       .kind = MemoryKind::kFlops,
                       .read_ports = static_cast<std::uint32_t>(p.fills),
                       .write_ports = 2,
                       .latency = 0,
                       .content = "blocks being written back, compared in parallel"}),
      fifo_("latency_fifo", static_cast<std::uint32_t>(p.latency_fifo), lookup_shape(p)),
      stalled_spill_(declare_stall("spill", "a block is still being written back")),
      spilled_(static_cast<std::size_t>(p.fills), 0) {
  if (p.write_buffer > 0) buffer_ = std::make_unique<WriteBuffer>(p.write_buffer);
}

Activity WeightCombiner::clear(Cycle cycle) {
  const std::uint32_t words = configuration_in.read(cycle).touched_words,
                      all = std::max(words, cache_.lines());
  if (clearing_ == all) return kIdle;
  if (buffer_ && clearing_ == 0) buffer_->clear();
  if (clearing_ < words) touched_write_.write(cycle, clearing_, TouchedWord{});
  cache_.clear(cycle);
  if (++clearing_ == all) cleared_out.drive(cycle, true);
  return kBusy;
}

std::uint32_t WeightCombiner::address_of(Cycle cycle, std::uint32_t x, std::uint32_t y) const {
  const FrameConfiguration& configuration = configuration_in.read(cycle);
  return configuration.weight_base +
         spec::geometric::kLineBytes * (y * configuration.blocks_across + x);
}

bool WeightCombiner::spilling(std::uint32_t tag) const {
  return std::find(spilled_.begin(), spilled_.end(), tag) != spilled_.end();
}

// Adds the block to the spill list; false if it is full.
bool WeightCombiner::spill(Lookup& lookup, std::uint32_t tag) {
  const auto free = std::find(spilled_.begin(), spilled_.end(), 0u);
  if (free == spilled_.end()) return false;
  *free = tag;
  lookup.spill = static_cast<std::uint8_t>(free - spilled_.begin());
  lookup.old_x = tag & 0x7FF;
  lookup.old_y = tag >> 11 & 0x7FF;
  return true;
}

// Stage 2, for a block that leaves the cache; kIdle: done.
Activity WeightCombiner::replace(std::uint32_t tag) {
  if (!buffer_) return spill(lookup_, tag) ? kIdle : stalled_spill_;
  lookup_.writes = false;
  if (lookup_.hit) {
    buffer_->exchange(lookup_.ring, tag);
    return kIdle;
  }
  lookup_.ring = buffer_->next();
  const std::uint32_t leaves = buffer_->tag(lookup_.ring);
  lookup_.writes = leaves != 0;
  if (lookup_.writes && !spill(lookup_, leaves)) return stalled_spill_;
  buffer_->put_next(tag);
  return kIdle;
}

// Stage 2; kIdle: done.
Activity WeightCombiner::look_up_block(Cycle cycle) {
  const std::uint32_t x = lookup_.group.block_x, y = lookup_.group.block_y,
                      tag = WeightPlaces::tag_of(x, y);
  const std::uint32_t there = cache_.tag(cycle, 0);
  lookup_.missed = there != tag;
  lookup_.reads = lookup_.replaces = lookup_.hit = false;
  if (lookup_.missed) {
    const TouchedWord& touched = touched_port_.at(cycle, touched_at_, looked_);
    const bool was_touched = touched.get(x & kBlockMask);
    if (const auto place = buffer_ ? buffer_->find(tag) : std::nullopt) {
      lookup_.hit = true;
      lookup_.ring = *place;
    }
    lookup_.reads = was_touched && !lookup_.hit;
    lookup_.replaces = there != 0;
    if (lookup_.reads) {
      if (spilling(tag)) return stalled_spill_;
      if (const Activity done = cache_.can_request(cycle, memory); done != kIdle) return done;
    }
    if (lookup_.replaces)
      if (const Activity done = replace(there); done != kIdle) return done;
    if (lookup_.reads) {
      cache_.request(cycle, memory, address_of(cycle, x, y));
      ++blocks_read;
    }
    if (!was_touched) {
      TouchedWord word = touched;
      word.set(x & kBlockMask);
      touched_write_.write(cycle, touched_at_, word);
    }
    buffer_hits += lookup_.hit;
    cache_.set_tag(cycle, 0);
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

// Defers second candidates of another block; they are all in the same one.
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
  lookup_.missed = lookup_.reads = lookup_.replaces = lookup_.hit = false;
  looking_ = true;
  looked_ = cycle;
  if (lookup_.group.end) return;
  const std::uint32_t x = lookup_.group.block_x, y = lookup_.group.block_y;
  lookup_.index = static_cast<std::uint16_t>(places_.index_of(x, y));
  touched_at_ = y * configuration_in.read(cycle).words_across + x / spec::geometric::kBlocksInWord;
  cache_.find(cycle, 0, lookup_.index, WeightPlaces::tag_of(x, y));
  touched_port_.read(cycle, touched_at_);
}

// Writes a whole block to memory; the tag holds its entry in the spill list.
void WeightCombiner::write_out(Cycle cycle, const Lookup& l, const BlockWeights& block) {
  Line& line = memory.write(cycle, address_of(cycle, l.old_x, l.old_y), l.spill, kWholeLine);
  for (std::size_t i = 0; i < block.size(); ++i)
    std::copy(block[i].begin(), block[i].end(), line.begin() + static_cast<std::ptrdiff_t>(4 * i));
  ++writes_;
  ++blocks_written;
}

// Moves the replaced block out of the cache.
void WeightCombiner::move_out(Cycle cycle, Work& work, const BlockWeights& there) {
  const Lookup& l = work.lookup;
  if (!buffer_) return write_out(cycle, l, there);
  if (l.hit) work.block = buffer_->at(cycle, l.ring);
  if (l.writes) write_out(cycle, l, buffer_->at(cycle, l.ring));
  buffer_->write(cycle, l.ring, there);
}

// Stage 4.
void WeightCombiner::combine(Cycle cycle, Work& work) {
  const Lookup& l = work.lookup;
  const Work* const before = pipe_.at(3);
  const bool past = before && !before->lookup.group.end && before->lookup.index == l.index;
  if (!l.missed || l.replaces) {
    const BlockWeights& there = past ? before->block : cache_.word(cycle, 0, l.index);
    if (l.replaces) move_out(cycle, work, there);
    if (!l.missed) work.block = there;
  }
  using spec::geometric::Combine;
  const Combine rule = configuration_in.read(cycle).combine;
  const auto set = [&](std::uint8_t place, bool forward, std::uint8_t coverage, bool nearer) {
    Weights& weights = work.block[place];
    if (rule == Combine::kLast) weights = {};
    std::uint8_t& weight = weights[2u * l.group.vertical + forward];
    const bool smallest = rule == Combine::kOutermost && nearer && weight != 0;
    weight = smallest ? std::min(weight, coverage) : std::max(weight, coverage);
  };
  // All candidates are different pixels.
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
      next && writes(next->lookup) && !memory.requests_out.can_push(cycle))
    return kStalledDownstream;
  pipe_.move();
  if (const Work* work = pipe_.at(3)) {
    if (work->lookup.group.end) {
      ended_ = true;
      if (buffer_) buffered_blocks.record(buffer_->full());
      note(latency_.end());
    } else {
      cache_.write(cycle, work->lookup.index, work->block);
      if (!work->lookup.more) note(latency_.write(cycle));
    }
  }
  if (Work* work = pipe_.at(2); work && !work->lookup.group.end) combine(cycle, *work);
  if (!fifo_.can_pop(cycle)) return kBusy;
  const Lookup& l = fifo_.front(cycle);
  if (l.reads)
    if (const Activity can = cache_.can_take(cycle); can != kIdle) return can;
  Work& work = pipe_.enter();
  if (l.missed) work.block = l.reads ? cache_.take(cycle) : BlockWeights{};
  if (!l.group.end && (!l.missed || l.replaces)) cache_.read(cycle, 0, l.index);
  if (buffer_ && (l.hit || writes(l))) buffer_->read(cycle, l.ring);
  work.lookup = l;
  fifo_.pop(cycle);
  return kBusy;
}

// After the last token: writes the contents of the write buffer, one block per cycle.
Activity WeightCombiner::flush(Cycle cycle) {
  if (buffer_->full() == 0) return kIdle;
  if (buffer_->has_first()) {
    if (!memory.requests_out.can_push(cycle)) return kStalledDownstream;
    if (!spill(lookup_, buffer_->tag(buffer_->next()))) return stalled_spill_;
    write_out(cycle, lookup_, buffer_->at(cycle, buffer_->next()));
    buffer_->drop_first();
  }
  buffer_->read_first(cycle);
  return kBusy;
}

// Handles the response to a write.
bool WeightCombiner::answer(Cycle cycle) {
  if (!memory.responses_in.can_pop(cycle) || !memory.responses_in.front(cycle).write) return false;
  spilled_[memory.responses_in.take(cycle).tag] = 0;
  --writes_;
  return true;
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
  const Activity data = ended_ && buffer_ ? flush(cycle) : deliver(cycle);
  const Activity tags = look_up(cycle), answered = answer(cycle) ? kBusy : tags;
  const Activity done =
      cache_.finish(cycle, memory, data, answered, [](BlockWeights& block, const Line& line) {
        for (std::size_t i = 0; i < block.size(); ++i)
          std::copy_n(line.begin() + static_cast<std::ptrdiff_t>(4 * i), 4, block[i].begin());
      });
  if (ended_ && writes_ == 0 && !(buffer_ && buffer_->full()) && !drawn_out.driven())
    drawn_out.drive(cycle, true);
  return done;
}

void WeightCombiner::reset() {
  cache_.reset();
  fifo_.reset();
  pipe_.reset();
  clearing_ = 0;
  looking_ = ended_ = false;
  if (buffer_) buffer_->clear();
  std::fill(spilled_.begin(), spilled_.end(), 0);
  writes_ = 0;
}

Datasheet WeightCombiner::datasheet(const spec::geometric::Parameters& p) {
  const std::uint32_t
      lanes = lane_count(p.walkers),
      both = 2 * lanes, ring = static_cast<std::uint32_t>(p.write_buffer), kept = ring > 0,
      fills = static_cast<std::uint32_t>(p.fills),
      blocks = spec::geometric::kCacheLineCount[static_cast<std::size_t>(p.weight_blocks)],
      index = bits_below(blocks), tag = WeightPlaces::kTagBits,
      group = Payload::of<WeightToken>({.lanes = lanes}).bits(),
      lookup = Payload::of<Lookup>(lookup_shape(p)).bits();
  constexpr std::uint32_t kBlock = 8 * spec::geometric::kLineBytes;
  const Hardware store = fill_store(p.fills), tags = line_cache(blocks, tag, 1, true);
  return {
      .unit = "WeightCombiner",
      .variant = kept ? "with `write_buffer`" : "without `write_buffer`",
      .does = "Combines the weights of each pixel cut by a line, and marks the touched blocks.",
      .latency = {5, "5, plus the wait for a block"},
      .interval = {1, "1; 2 for a group with second candidates in another block"},
      .stages =
          {{.clock = "1",
            .work = "address of tag and touched word, product of the block's address",
            .operators = {op::logic(12 * lanes), op::add(11), op::mux(group, 2),
                          op::multiply(11, 5), op::add(16), op::multiply(11, 12), op::add(23)},
            .longest = {op::mux(group, 2), op::multiply(11, 12), op::add(23)},
            .registers = group + lanes + 11 + 1 + 16 + 23 + 1},
           {.clock = "2",
            .work = std::string("tag, touched bit, spill list") + (kept ? ", write buffer" : "") +
                    "; read request; FIFO",
            .path = "SRAM read",
            .operators =
                built({fills * op::equal(tag), op::priority(fills), op::mux(1, 128), op::logic(256),
                       op::mux(16, 2), op::add(17), 2 * op::add(9), op::add(26), op::mux(38, 2),
                       ring * op::equal(tag), kept * op::mux(tag, ring), kept * op::mux(tag, 2),
                       kept * op::logic(6 * ring), 2 * kept * op::add(8)},
                      built(tags.operators, store.operators)),
            .longest = built(
                {op::equal(tag), kept * op::mux(tag, ring), op::logic(8), kept * op::mux(tag, 2)}),
            .registers = tags.registers + store.registers + 17 + 9 + 3 + kept * (7 + 8 + 1)},
           {.clock = "3",
            .work = std::string("block install, address of the word") +
                    (kept ? " and of the one in the write buffer" : ""),
            .operators = {op::logic(kBlock), op::multiply(11, 12), op::add(23)},
            .longest = {op::multiply(11, 12), op::add(23)},
            .registers = kBlock + lookup + 23 - 22},
           {.clock = "4",
            .work = std::string("the word or its fill, maxima and minima; the replaced block "
                                "written back") +
                    (kept ? ", or into the write buffer, whose oldest block is written back" : ""),
            .path = "SRAM read",
            .operators = {op::mux(kBlock, 2), op::mux(kBlock, 2 + kept), op::mux(256, 2),
                          both * op::mux(8, 32), both * op::compare(8), both * op::mux(8, 2),
                          op::logic(60 * both), 16 * op::mux(8, both), op::mux(kBlock, 2),
                          op::equal(index), op::add(26)},
            .longest = {op::mux(kBlock, 2), op::mux(kBlock, 2 + kept), op::mux(256, 2),
                        op::mux(8, 32), op::compare(8), op::mux(8, 2), op::mux(8, both),
                        op::mux(kBlock, 2)},
            .registers = kBlock + index + 3},
           {.clock = "5", .work = "write, with a bypass to the next group"}},
      .cost = "walkers = " + std::to_string(lanes) + ", fills = " + std::to_string(fills) +
              (kept ? ", write_buffer = " + std::to_string(ring) : "") + "."};
}

}  // namespace deburr::rtl::geometric
