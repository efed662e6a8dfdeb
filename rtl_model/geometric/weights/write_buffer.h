// SPDX-License-Identifier: MIT
// Blocks of weights that the cache has replaced, in a ring, before they are written to memory.
//
// Where: inside the WeightCombiner, which changes the tags in stage 2 and moves the data in stages
// 3 (read) and 4 (write): a word that is written goes past the memory to a read of the same clock.
// A place is empty until a block has come to it, so the full ones are all, or those from 0 on.
// Never stalls. Made for 250 MHz; longest path: a compare of 23 bits with all tags. Cost: N blocks,
// N tags, two pointers.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "rtl_model/fabric/memory.h"
#include "rtl_model/geometric/common/tokens.h"
#include "rtl_model/geometric/weights/weight_memories.h"
#include "spec/geometric/records.h"

namespace deburr::rtl::geometric {

class WriteBuffer {
 public:
  explicit WriteBuffer(std::int32_t places)
      : data_("write_buffer", {.words = static_cast<std::uint64_t>(places),
                               .word_bits = 8 * spec::geometric::kLineBytes,
                               // A block may be taken back in the clock that replaces it.
                               .read_during_write = ReadDuringWrite::kNewWord,
                               .content = "blocks of weights that were replaced"}),
        tags_("write_tags", {.words = static_cast<std::uint64_t>(places),
                             .word_bits = WeightPlaces::kTagBits,
                             .kind = MemoryKind::kFlops,
                             .read_ports = static_cast<std::uint32_t>(places),
                             .latency = 0,
                             .content = "x, y of each, valid, compared at once"}),
        tag_(static_cast<std::size_t>(places), 0) {}

  // --- Tags ---
  std::optional<std::uint8_t> find(std::uint32_t tag) const {
    const auto there = std::find(tag_.begin(), tag_.end(), tag);
    if (there == tag_.end()) return std::nullopt;
    return static_cast<std::uint8_t>(there - tag_.begin());
  }
  // The place of the next block that does not take that of a hit, and the block there; 0: none.
  std::uint8_t next() const { return static_cast<std::uint8_t>(next_); }
  std::uint32_t tag(std::uint8_t place) const { return tag_[place]; }
  void put_next(std::uint32_t tag) {
    full_ += tag_[next_] == 0;
    tag_[next_] = tag;
    advance();
  }
  // In the place of a hit.
  void exchange(std::uint8_t place, std::uint32_t tag) { tag_[place] = tag; }

  // --- Data ---
  void read(Cycle cycle, std::uint8_t place) { read_.read(cycle, place); }
  const BlockWeights& at(Cycle cycle, std::uint8_t place) const { return read_.at(cycle, place); }
  void write(Cycle cycle, std::uint8_t place, const BlockWeights& block) {
    write_.write(cycle, place, block);
  }

  // --- At the end of the edges: all blocks, from `next` on ---
  std::uint32_t full() const { return full_; }
  // Is the word of the first one on the output register?
  bool has_first() const { return has_first_; }
  void read_first(Cycle cycle) {
    has_first_ = full_ != 0;
    if (!has_first_) return;
    if (tag_[next_] == 0) next_ = 0;
    read_.read(cycle, next_);
  }
  void drop_first() {
    tag_[next_] = 0;
    --full_;
    advance();
  }

  // A frame begins with all places empty.
  void clear() {
    std::fill(tag_.begin(), tag_.end(), 0);
    next_ = full_ = 0;
    has_first_ = false;
  }

 private:
  void advance() { next_ = next_ + 1 == tag_.size() ? 0 : next_ + 1; }

  Memory<BlockWeights> data_;
  ReadPort<BlockWeights> read_{data_, "place"};
  WritePort<BlockWeights> write_{data_, "place"};
  MemoryBase tags_;  // by place: in tag_
  std::vector<std::uint32_t> tag_;
  std::uint32_t next_ = 0, full_ = 0;  // U7, U8
  bool has_first_ = false;
};

}  // namespace deburr::rtl::geometric
