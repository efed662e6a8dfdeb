// SPDX-License-Identifier: MIT
// Tags, valid bits and replacement state of the texture cache.
//
// Where: inside the TagStage. The lines of a request are looked up one after the other in the same
// clock: the tags stand in registers with four read and four write ports, and a later lookup sees
// what an earlier one has allocated. Cost: sets x ways x (tag + valid + age) bits, 4 x ways
// comparators. Source: docs/number_formats.md, cache and traffic.
#pragma once

#include <cstdint>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/storage.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class TagStore final : public Storage {
 public:
  struct Place {
    std::uint32_t slot;  // set x ways + way
    bool evicted;        // a valid line was replaced
  };
  static constexpr std::uint32_t kAbsent = ~std::uint32_t{0};

  TagStore(const char* name, const spec::texture::Parameters& parameters);

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
  Place allocate(std::uint32_t line);

  std::uint32_t slots() const { return static_cast<std::uint32_t>(tags_.size()); }
  // All in one clock; the shift register of `random` goes on.
  void invalidate();
  void reset() override;

 private:
  // A line number has at most 27 bits, so this one never matches: the valid bit of the hardware.
  static constexpr std::uint32_t kInvalid = ~std::uint32_t{0};
  static constexpr std::uint16_t kRandomStart = 0xACE1;

  void make_youngest(std::uint32_t slot);
  std::uint32_t victim(std::uint32_t first);

  spec::texture::Replacement replacement_;
  std::uint32_t set_mask_, way_mask_, ways_log2_;
  std::vector<std::uint32_t> tags_;  // U27 and valid
  std::vector<std::uint8_t> age_;    // U4, 0: most recent; a permutation within each set
  std::uint16_t random_ = kRandomStart;
};

}  // namespace deburr::rtl::texture
