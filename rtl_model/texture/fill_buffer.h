// SPDX-License-Identifier: MIT
// Lines in flight from memory: entries are reserved and released in the order of fills, and filled
// in any order.
//
// Position  Inside the MissQueue, which requests lines and fills their entries. The DataStage
//           accesses them through a Reader, like a memory port.
// Latency   The oldest line is prefetched to the output register as soon as it has arrived. An
//           entry released in cycle t can be reserved from t + 1 on.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/memory_port.h"
#include "spec/error.h"

namespace deburr::rtl::texture {

class FillBuffer {
 public:
  // Interface for the DataStage: the oldest fill only. Copies refer to the same interface.
  class Reader {
   public:
    // Call last in every cycle: reads the next line if it has arrived and the output register is
    // free.
    void read_ahead(Cycle cycle) { lines_->read_ahead(cycle); }
    bool ready(Cycle cycle) const { return lines_->ready(cycle); }
    const std::uint8_t* line(Cycle cycle) const { return lines_->line(cycle); }
    void release(Cycle cycle) { lines_->release(cycle); }

   private:
    friend class FillBuffer;
    explicit Reader(FillBuffer& lines) : lines_(&lines) {}
    FillBuffer* lines_;
  };

  FillBuffer(const char* name, std::uint32_t entries, std::uint32_t line_bytes)
      : entries_(entries),
        line_bytes_(line_bytes),
        memory_(name, {.words = entries,
                       .word_bits = line_bytes * 8,
                       .kind = MemoryBase::kind_for(std::uint64_t{entries} * line_bytes * 8),
                       .latency = 1,
                       .mask_bits = line_bytes > kLineBytes ? kLineBytes * 8 : 0,
                       .content = "lines in flight from memory"}),
        bytes_(std::size_t{entries} * line_bytes + kPadding),
        bits_((std::string(name) + "_arrived").c_str(),
              {.words = entries,
               .word_bits = 1,
               .kind = MemoryKind::kFlops,
               .write_ports = 2,
               .latency = 0,
               .content = "per line in flight: has it arrived?"}),
        arrived_(entries, kNever) {}

  Reader reader() { return Reader(*this); }

  // --- Interface of the MissQueue ---
  bool can_reserve(Cycle cycle) const { return held(cycle) < entries_; }
  std::uint32_t reserve(Cycle cycle) {
    DEBURR_CHECK(can_reserve(cycle), std::string(memory_.name()) + ": no free entry");
    const auto entry = static_cast<std::uint32_t>(reserved_ % entries_);
    ++reserved_;
    return entry;
  }
  // Writes a beat of the line; `complete`: the last one.
  void fill(Cycle cycle, std::uint32_t entry, std::uint32_t offset,
            std::span<const std::uint8_t> beat, bool complete) {
    if (entry >= entries_ || arrived_[entry] != kNever || offset + beat.size() > line_bytes_)
        [[unlikely]]
      reject(entry, offset, beat.size());
    write_.write(cycle, entry);
    std::copy(beat.begin(), beat.end(), &bytes_[std::size_t{entry} * line_bytes_ + offset]);
    if (!complete) return;
    arrives_.write(cycle, entry);
    arrived_[entry] = cycle;
  }

  // Entries held by fills that were not used before `cycle`.
  std::uint64_t held(Cycle cycle) const { return reserved_ - released_ + (released_at_ == cycle); }
  void reset() {
    reserved_ = released_ = read_ = 0;
    released_at_ = read_at_ = kNever;
    std::fill(arrived_.begin(), arrived_.end(), kNever);
  }

  static Datasheet datasheet();

 private:
  void read_ahead(Cycle cycle) {
    if (read_ != released_ || reserved_ == released_) return;
    oldest_.read(cycle, oldest());
    if (arrived_[oldest()] >= cycle) return;
    read_port_.read(cycle, oldest());
    ++read_;
    read_at_ = cycle;
  }
  bool ready(Cycle cycle) const { return read_ != released_ && read_at_ < cycle; }
  const std::uint8_t* line(Cycle cycle) const {
    read_port_.check(cycle, oldest(), read_at_);
    return &bytes_[std::size_t{oldest()} * line_bytes_];
  }
  void release(Cycle cycle) {
    leaves_.write(cycle, oldest());
    arrived_[oldest()] = kNever;
    ++released_;
    released_at_ = cycle;
  }

  // Throws CheckFailed. Not inlined, to keep the check cheap.
  [[gnu::cold, gnu::noinline]] void reject(std::uint32_t entry, std::uint32_t offset,
                                           std::size_t bytes) const;

  std::uint32_t oldest() const { return static_cast<std::uint32_t>(released_ % entries_); }

  // A word may be read at the last byte of the last line.
  static constexpr std::size_t kPadding = 3;

  std::uint32_t entries_, line_bytes_;
  Memory<void> memory_;
  ReadPort<void> read_port_{memory_, "data_stage"};
  WritePort<void> write_{memory_, "miss_queue"};
  std::vector<std::uint8_t> bytes_;
  Memory<void> bits_;
  ReadPort<void> oldest_{bits_, "data_stage"};
  WritePort<void> arrives_{bits_, "miss_queue"}, leaves_{bits_, "data_stage"};
  std::vector<Cycle> arrived_;  // cycle in which the bit was set; kNever: not set
  std::uint64_t reserved_ = 0, released_ = 0, read_ = 0;
  Cycle released_at_ = kNever, read_at_ = kNever;
};

}  // namespace deburr::rtl::texture
