// SPDX-License-Identifier: MIT
// Lines in flight from memory: entries are reserved and released in the order of fills, and filled
// in any order. Entry e is in bank e mod D (D lines are used per cycle, 1 except in wide builds).
//
// Position  Inside the MissQueue, which requests lines and fills their entries. The DataStage
//           accesses them through a Reader, like a memory port.
// Latency   The oldest line of a bank is prefetched to its output register as soon as it has
//           arrived. An entry released in cycle t can be reserved from t + 1 on.
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
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class FillBuffer {
 public:
  // Interface for the DataStage: the oldest fill only, and after its release the next one. Copies
  // refer to the same interface.
  class Reader {
   public:
    // Call last in every cycle: reads the next line of a bank if it has arrived and the output
    // register is free.
    void read_ahead(Cycle cycle) { lines_->read_ahead(cycle); }
    bool ready(Cycle cycle) const { return lines_->ready(cycle); }
    const std::uint8_t* line(Cycle cycle) const { return lines_->line(cycle); }
    void release(Cycle cycle) { lines_->release(cycle); }

   private:
    friend class FillBuffer;
    explicit Reader(FillBuffer& lines) : lines_(&lines) {}
    FillBuffer* lines_;
  };

  FillBuffer(const char* name, std::uint32_t entries, std::uint32_t line_bytes,
             std::uint32_t banks = 1)
      : entries_(entries),
        line_bytes_(line_bytes),
        memory_(name, {.words = entries,
                       .word_bits = line_bytes * 8,
                       .kind = MemoryBase::kind_for(std::uint64_t{entries} * line_bytes * 8),
                       .read_ports = banks,
                       .latency = 1,
                       .banks = banks,
                       .mask_bits = line_bytes > kLineBytes ? kLineBytes * 8 : 0,
                       .separate_banks = banks > 1,
                       .content = "lines in flight from memory"}),
        bytes_(std::size_t{entries} * line_bytes + kPadding),
        bits_((std::string(name) + "_arrived").c_str(),
              {.words = entries,
               .word_bits = 1,
               .kind = MemoryKind::kFlops,
               .read_ports = banks,
               .write_ports = 1 + banks,
               .latency = 0,
               .content = "per line in flight: has it arrived?"}),
        arrived_(entries, kNever) {
    for (std::uint32_t i = 0; i < banks; ++i) {
      const std::string user = banks == 1 ? "data_stage" : "data_stage_" + std::to_string(i);
      banks_.push_back({.read_port = {memory_, user},
                        .oldest = {bits_, user},
                        .leaves = {bits_, user},
                        .number = i,
                        .entry = i});
    }
    next_ = banks_.data();
  }

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
  std::uint64_t held(Cycle cycle) const {
    return reserved_ - released_ + (released_at_ == cycle ? released_now_ : 0);
  }
  void reset() {
    reserved_ = released_ = 0;
    released_at_ = kNever;
    for (std::uint32_t i = 0; i < banks_.size(); ++i) {
      banks_[i].number = banks_[i].entry = i;
      banks_[i].is_read = false;
    }
    next_ = banks_.data();
    std::fill(arrived_.begin(), arrived_.end(), kNever);
  }

  static Datasheet datasheet(const spec::texture::Parameters& parameters = {});

 private:
  // The oldest unused line of a bank.
  struct Bank {
    ReadPort<void> read_port, oldest;
    WritePort<void> leaves;
    std::uint64_t number;  // in the order of fills
    std::uint32_t entry;
    bool is_read = false;  // it is, or will be, on the output register
    Cycle read_at = kNever;
  };

  void read_ahead(Cycle cycle) {
    for (Bank& bank : banks_) {
      if (bank.is_read || bank.number >= reserved_) continue;
      bank.oldest.read(cycle, bank.entry);
      if (arrived_[bank.entry] >= cycle) continue;
      bank.read_port.read(cycle, bank.entry);
      bank.is_read = true;
      bank.read_at = cycle;
    }
  }
  bool ready(Cycle cycle) const { return next_->is_read && next_->read_at < cycle; }
  const std::uint8_t* line(Cycle cycle) const {
    next_->read_port.check(cycle, next_->entry, next_->read_at);
    return &bytes_[std::size_t{next_->entry} * line_bytes_];
  }
  void release(Cycle cycle) {
    Bank& bank = *next_;
    bank.leaves.write(cycle, bank.entry);
    arrived_[bank.entry] = kNever;
    bank.is_read = false;
    bank.number += banks_.size();
    bank.entry += static_cast<std::uint32_t>(banks_.size());
    if (bank.entry >= entries_) bank.entry -= entries_;
    if (++next_ == banks_.data() + banks_.size()) next_ = banks_.data();
    ++released_;
    released_now_ = released_at_ == cycle ? released_now_ + 1 : 1;
    released_at_ = cycle;
  }

  // Throws CheckFailed. Not inlined, to keep the check cheap.
  [[gnu::cold, gnu::noinline]] void reject(std::uint32_t entry, std::uint32_t offset,
                                           std::size_t bytes) const;

  // A word, or a block, may be read at the last byte of the last line.
  static constexpr std::size_t kPadding = 15;

  std::uint32_t entries_, line_bytes_;
  Memory<void> memory_;
  WritePort<void> write_{memory_, "miss_queue"};
  std::vector<std::uint8_t> bytes_;
  Memory<void> bits_;
  WritePort<void> arrives_{bits_, "miss_queue"};
  std::vector<Cycle> arrived_;  // cycle in which the bit was set; kNever: not set
  std::vector<Bank> banks_;
  Bank* next_ = nullptr;  // of the oldest fill
  std::uint64_t reserved_ = 0, released_ = 0;
  Cycle released_at_ = kNever;
  std::uint32_t released_now_ = 0;  // in that cycle
};

}  // namespace deburr::rtl::texture
