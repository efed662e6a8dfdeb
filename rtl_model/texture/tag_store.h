// SPDX-License-Identifier: MIT
// Tags and replacement state of the texture cache.
//
// Position  Inside the TagStage; cost and longest path in its datasheet.
// Layout    A word is a set: per way a tag, a valid bit and a rotation bit; and the order of last
//           uses, one bit per pair of ways. Flip-flops with four read and four write ports, in a
//           wide build one of each per lookup.
// Latency   1: the sets of a request's lines are read in one cycle and available in the next,
//           including changes by the previous request (a read returns the new word). The lines are
//           then looked up in series: a lookup sees what earlier ones allocated, so four way muxes
//           are in series. This limits the size: kMostLines is 16 kbit of flip-flops, kMostWays the
//           chain of muxes.
// Source    docs/reference/texture/formats.md, cache and traffic.
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

  // --- Cycle 1: read the set of a line, through port 0..3 (wide: 0..L - 1) ---
  void read(Cycle cycle, std::size_t port, std::uint32_t line) {
    reads_[port].read(cycle, line & set_mask_);
  }

  // --- Cycle 2 ---
  // Checks that the port's word, read in cycle `issued`, is valid; it may have been read earlier.
  void check(Cycle cycle, std::size_t port, std::uint32_t line, Cycle issued) const {
    reads_[port].check(cycle, line & set_mask_, issued);
  }
  // Slot of the line, or kAbsent.
  std::uint32_t find(std::uint32_t line) const {
    const std::uint32_t first = (line & set_mask_) << ways_log2_;
    for (std::uint32_t way = 0; way <= way_mask_; ++way)
      if (tags_[first + way] == line) return first + way;
    return kAbsent;
  }
  // Hit: the line becomes the most recently used.
  void use(std::uint32_t slot) {
    if (replacement_ == spec::texture::Replacement::kLru && age_[slot] != 0) make_youngest(slot);
  }
  // Miss: selects a way and writes the line's tag.
  Place allocate(std::uint32_t line, bool turned);
  // Is the line in this slot stored with rotated banks?
  bool turned(std::uint32_t slot) const { return turned_[slot] != 0; }
  // Writes the sets changed by the lookups of this cycle.
  void commit(Cycle cycle) {
    for (std::size_t i = 0; i < changes_; ++i) writes_[i].write(cycle, changed_[i]);
    changes_ = 0;
  }

  std::uint32_t sets() const { return set_mask_ + 1; }
  std::uint32_t ways() const { return way_mask_ + 1; }
  std::uint32_t slots() const { return static_cast<std::uint32_t>(tags_.size()); }
  // Invalidates all lines in one cycle; does not reset the shift register of `random`.
  void invalidate();
  void reset();

 private:
  // Never matches: a line number has at most 27 bits, and no decoded block has 29 ones below its
  // codec 7, whose blocks have 16 bytes. Models the valid bit.
  static constexpr std::uint32_t kInvalid = ~std::uint32_t{0};
  static constexpr std::uint16_t kRandomStart = 0xACE1;
  static constexpr std::size_t kMostPorts = spec::texture::kMostLookups;
  template <class Port>
  using Ports = std::array<Port, kMostPorts>;  // those that are not built are copies of the last

  void make_youngest(std::uint32_t slot);
  std::uint32_t victim(std::uint32_t first);
  void change(std::uint32_t set);

  spec::texture::Replacement replacement_;
  std::uint32_t set_mask_, way_mask_, ways_log2_;
  Memory<void> memory_;
  Ports<ReadPort<void>> reads_;
  Ports<WritePort<void>> writes_;
  std::vector<std::uint32_t> tags_;   // U27 (decode = before: U32) and valid
  std::vector<std::uint8_t> turned_;  // U1
  std::vector<std::uint8_t> age_;     // order of uses, 0: most recent; a permutation per set
  std::uint16_t random_ = kRandomStart;
  // Sets written in this cycle.
  std::array<std::uint32_t, kMostPorts> changed_{};
  std::size_t changes_ = 0;
};

}  // namespace deburr::rtl::texture
