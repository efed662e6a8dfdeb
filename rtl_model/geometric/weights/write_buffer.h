// SPDX-License-Identifier: MIT
// Function  A ring of blocks of weights that the cache has replaced, before they are written to
//           memory.
// Position  Inside the WeightCombiner, which updates the tags in stage 2 and moves the data in
//           stages 3 (read) and 4 (write). A written word bypasses the memory to a read of the same
//           cycle.
// Stalls    None.
// Cost      N blocks, N tags, two pointers. Longest path: a 23-bit compare with all tags.
//
// An entry is empty until a block is stored in it, so the full entries are all, or those from 0 on.
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
                               // A block may be taken back in the cycle that replaces it.
                               .read_during_write = ReadDuringWrite::kNewWord,
                               .content = "replaced blocks of weights"}),
        tags_("write_tags", {.words = static_cast<std::uint64_t>(places),
                             .word_bits = WeightPlaces::kTagBits,
                             .kind = MemoryKind::kFlops,
                             .read_ports = static_cast<std::uint32_t>(places),
                             .latency = 0,
                             .content = "x, y of each, valid, compared in parallel"}),
        tag_(static_cast<std::size_t>(places), 0) {}

  // --- Tags ---
  std::optional<std::uint8_t> find(std::uint32_t tag) const {
    const auto there = std::find(tag_.begin(), tag_.end(), tag);
    if (there == tag_.end()) return std::nullopt;
    return static_cast<std::uint8_t>(there - tag_.begin());
  }
  // The entry for the next block (unless it takes the entry of a hit), and the tag of an entry; 0:
  // empty.
  std::uint8_t next() const { return static_cast<std::uint8_t>(next_); }
  std::uint32_t tag(std::uint8_t place) const { return tag_[place]; }
  void put_next(std::uint32_t tag) {
    full_ += tag_[next_] == 0;
    tag_[next_] = tag;
    advance();
  }
  // Replaces the block of a hit.
  void exchange(std::uint8_t place, std::uint32_t tag) { tag_[place] = tag; }

  // --- Data ---
  void read(Cycle cycle, std::uint8_t place) { read_.read(cycle, place); }
  const BlockWeights& at(Cycle cycle, std::uint8_t place) const { return read_.at(cycle, place); }
  void write(Cycle cycle, std::uint8_t place, const BlockWeights& block) {
    write_.write(cycle, place, block);
  }

  // --- After the last edge: all blocks, from `next` on ---
  std::uint32_t full() const { return full_; }
  // True if the first block's word is on the output register.
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

  // Called at the start of a frame: clears all entries.
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
  MemoryBase tags_;  // by entry: stored in tag_
  std::vector<std::uint32_t> tag_;
  std::uint32_t next_ = 0, full_ = 0;  // U7, U8
  bool has_first_ = false;
};

}  // namespace deburr::rtl::geometric
