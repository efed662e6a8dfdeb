// SPDX-License-Identifier: MIT
// Lines on their way from memory: entries are reserved and released in the order of fills, and
// filled in any order.
//
// Where: inside the MissQueue, read by the DataStage. Timing as of a link: what arrives in clock t
// can be read from t+1 on, an entry released in t can be reserved from t+1 on; one reservation, one
// arriving beat and one release a clock. Cost: outstanding x line bits, one write and one read
// port.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/clocked.h"
#include "rtl_model/fabric/storage.h"
#include "spec/error.h"

namespace deburr::rtl::texture {

class FillBuffer final : public Storage {
 public:
  FillBuffer(const char* name, std::uint32_t entries, std::uint32_t line_bytes)
      : Storage(name, entries, line_bytes * 8 + 1, "1R1W"),
        entries_(entries),
        line_bytes_(line_bytes),
        bytes_(std::size_t{entries} * line_bytes + kPadding),
        arrived_(entries, kNever) {}

  // --- Side of the MissQueue ---
  bool can_reserve(Cycle cycle) const { return held(cycle) < entries_; }
  std::uint32_t reserve(Cycle cycle) {
    DEBURR_CHECK(can_reserve(cycle), std::string(name()) + ": no entry is free");
    const auto entry = static_cast<std::uint32_t>(reserved_ % entries_);
    ++reserved_;
    return entry;
  }
  // A beat of the line; `complete` with its last one.
  void fill(Cycle cycle, std::uint32_t entry, std::uint32_t offset,
            std::span<const std::uint8_t> beat, bool complete) {
    DEBURR_CHECK(entry < entries_ && arrived_[entry] == kNever,
                 std::string(name()) + ": entry " + std::to_string(entry) + " filled twice");
    std::copy(beat.begin(), beat.end(), bytes_.begin() + entry * line_bytes_ + offset);
    if (complete) arrived_[entry] = cycle;
  }

  // --- Side of the DataStage: the oldest fill only ---
  bool ready(Cycle cycle) const { return arrived_[oldest()] < cycle; }
  const std::uint8_t* line() const { return &bytes_[std::size_t{oldest()} * line_bytes_]; }
  void release(Cycle cycle) {
    arrived_[oldest()] = kNever;
    ++released_;
    released_at_ = cycle;
  }

  // Fills that have been used, as seen in `cycle`.
  std::uint64_t released(Cycle cycle) const { return released_ - (released_at_ == cycle); }
  // Entries held by fills that had not been used before `cycle`.
  std::uint64_t held(Cycle cycle) const { return reserved_ - released(cycle); }
  void reset() override {
    reserved_ = released_ = 0;
    released_at_ = kNever;
    std::fill(arrived_.begin(), arrived_.end(), kNever);
  }

 private:
  std::uint32_t oldest() const { return static_cast<std::uint32_t>(released_ % entries_); }

  // A word may be read at the last byte of the last line.
  static constexpr std::size_t kPadding = 3;

  std::uint32_t entries_, line_bytes_;
  std::vector<std::uint8_t> bytes_;
  std::vector<Cycle> arrived_;  // kNever: not yet
  std::uint64_t reserved_ = 0, released_ = 0;
  Cycle released_at_ = kNever;
};

}  // namespace deburr::rtl::texture
