// SPDX-License-Identifier: MIT
// Tags and replacement state of the texture cache.
//
// Where: inside the TagStage; cost and longest path in its datasheet. A word is a set: tag, valid
// bit and turned bit of each way, and the order of their last uses, a bit for each pair of ways.
// Flip-flops with four read and four write ports: the sets of a request's lines are read in one
// clock, and come in the next one with what the request before them has changed (a write is seen by
// a read of the same clock). Then the lines are looked up one after the other: a later look-up sees
// what an earlier one has allocated, so four choices among the ways stand behind each other.
// Flip-flops end at 16 kbit, which is kMostLines lines; the chain ends at kMostWays ways. Source:
// docs/reference/texture/formats.md, cache and traffic.
#pragma once

#include <array>
#include <cstdint>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/memory.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class TagStore {
 public:
  static constexpr std::int32_t kMostLines = spec::texture::kMostCacheLines,
                                kMostWays = spec::texture::kMostCacheWays;

  struct Place {
    std::uint32_t slot;  // set x ways + way
    bool evicted;        // a valid line was replaced
  };
  static constexpr std::uint32_t kAbsent = ~std::uint32_t{0};

  TagStore(const char* name, const spec::texture::Parameters& parameters);

  // --- Clock 1: the set of a line, through port 0..3 ---
  void read(Cycle cycle, std::size_t port, std::uint32_t line) {
    reads_[port].read(cycle, line & set_mask_);
  }

  // --- Clock 2 ---
  // The word that this port has read in clock `issued` is there: the set may have been read before.
  void check(Cycle cycle, std::size_t port, std::uint32_t line, Cycle issued) const {
    reads_[port].check(cycle, line & set_mask_, issued);
  }
  // The slot of the line, or kAbsent.
  std::uint32_t find(std::uint32_t line) const {
    const std::uint32_t first = (line & set_mask_) << ways_log2_;
    for (std::uint32_t way = 0; way <= way_mask_; ++way)
      if (tags_[first + way] == line) return first + way;
    return kAbsent;
  }
  // A hit: the line becomes the most recently used.
  void use(std::uint32_t slot) {
    if (replacement_ == spec::texture::Replacement::kLru && age_[slot] != 0) make_youngest(slot);
  }
  // A miss: chooses a way and puts the line's tag into it.
  Place allocate(std::uint32_t line, bool turned);
  // The banks of the line in this slot are turned.
  bool turned(std::uint32_t slot) const { return turned_[slot] != 0; }
  // Writes what the look-ups of this clock have changed.
  void commit(Cycle cycle) {
    for (std::size_t i = 0; i < changes_; ++i) writes_[i].write(cycle, changed_[i]);
    changes_ = 0;
  }

  std::uint32_t slots() const { return static_cast<std::uint32_t>(tags_.size()); }
  // All in one clock; the shift register of `random` goes on.
  void invalidate();
  void reset();

 private:
  // A line number has at most 27 bits, so this one never matches: the valid bit of the hardware.
  static constexpr std::uint32_t kInvalid = ~std::uint32_t{0};
  static constexpr std::uint16_t kRandomStart = 0xACE1;
  static constexpr std::size_t kPorts = 4;

  void make_youngest(std::uint32_t slot);
  std::uint32_t victim(std::uint32_t first);
  void change(std::uint32_t set);

  spec::texture::Replacement replacement_;
  std::uint32_t set_mask_, way_mask_, ways_log2_;
  Memory<void> memory_;
  std::array<ReadPort<void>, kPorts> reads_{
      ReadPort<void>{memory_, "line_0"}, ReadPort<void>{memory_, "line_1"},
      ReadPort<void>{memory_, "line_2"}, ReadPort<void>{memory_, "line_3"}};
  std::array<WritePort<void>, kPorts> writes_{
      WritePort<void>{memory_, "line_0"}, WritePort<void>{memory_, "line_1"},
      WritePort<void>{memory_, "line_2"}, WritePort<void>{memory_, "line_3"}};
  std::vector<std::uint32_t> tags_;   // U27 and valid
  std::vector<std::uint8_t> turned_;  // U1
  std::vector<std::uint8_t> age_;  // the order of uses; 0: most recent; a permutation in each set
  std::uint16_t random_ = kRandomStart;
  // Sets that this clock writes.
  std::array<std::uint32_t, kPorts> changed_{};
  std::size_t changes_ = 0;
};

}  // namespace deburr::rtl::texture
